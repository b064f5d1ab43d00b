//! What is typed behind the options of after-care.

use bonemesh_mesh::Islands;

use crate::{Cavities, Holes};

/// `largest`, a volume in mm3, or places in mm.
///
/// # Errors
/// One line that says what to write instead.
pub(super) fn islands(text: &str) -> Result<Islands, String> {
    if text.contains([',', ';']) {
        let places: Result<Vec<[f64; 3]>, String> = text.split(';').map(place).collect();
        return places.map(Islands::At);
    }
    match text {
        "largest" => Ok(Islands::Largest),
        _ => volume(text, "largest` or a place `X,Y,Z").map(Islands::AtLeastMm3),
    }
}

/// Three coordinates in mm.
fn place(text: &str) -> Result<[f64; 3], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    let place = numbers.ok().and_then(|numbers| numbers.try_into().ok());
    place
        .filter(|place: &[f64; 3]| place.iter().all(|mm| mm.is_finite()))
        .ok_or_else(|| format!("`{text}` is no place; write X,Y,Z in mm, for example 0,-90,40"))
}

/// `all`, or a volume in mm3.
///
/// # Errors
/// One line that says what to write instead.
pub(super) fn cavities(text: &str) -> Result<Cavities, String> {
    match text {
        "all" => Ok(Cavities::All),
        _ => volume(text, "all").map(Cavities::AtMostMm3),
    }
}

/// `all`, or a length in mm.
///
/// # Errors
/// One line that says what to write instead.
pub(super) fn holes(text: &str) -> Result<Holes, String> {
    match text.parse() {
        _ if text == "all" => Ok(Holes::All),
        Ok(most) if (0.0..=f64::MAX).contains(&most) => Ok(Holes::AtMostMm(most)),
        _ => Err(format!(
            "`{text}` is no length; write a number of mm, or `all`"
        )),
    }
}

fn volume(text: &str, word: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=f64::MAX).contains(&value) => Ok(value),
        _ => Err(format!(
            "`{text}` is no volume; write a number of mm3, or `{word}`"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_length_of_holes_is_refused_with_a_remedy() {
        for text in ["", "every", "-1", "nan", "inf"] {
            let message = holes(text).expect_err("it is no length");
            assert!(message.contains("or `all`"), "{message}");
        }
    }
}
