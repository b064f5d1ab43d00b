//! Colours for signed distances.

/// From inside over none to outside.
const COLOURS: [[u8; 3]; 5] = [
    [33, 60, 160],
    [120, 165, 225],
    [240, 240, 238],
    [235, 150, 110],
    [165, 20, 30],
];

/// The colour of each signed distance: blue inside, white at none, red outside, full from `end_mm` on.
/// What is no number is white.
pub fn heat_colours(signed_mm: &[f64], end_mm: f64) -> Vec<[u8; 3]> {
    let last = COLOURS.len() - 1;
    let colour = |distance: &f64| {
        let part = 0.5 * (1.0 + distance / end_mm);
        let part = if part.is_nan() {
            0.5
        } else {
            part.clamp(0.0, 1.0)
        };
        let at = part * last as f64;
        let from = (at as usize).min(last - 1);
        let mix = at - from as f64;
        [0, 1, 2].map(|c| {
            let [low, high] = [from, from + 1].map(|i| f64::from(COLOURS[i][c]));
            (low + mix * (high - low)).round() as u8
        })
    };
    signed_mm.iter().map(colour).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blue_is_inside_red_outside_and_white_between() {
        let colours = heat_colours(&[-9.0, -1.0, 0.0, 1.0, f64::INFINITY, f64::NAN], 1.0);
        assert_eq!(colours[0], COLOURS[0]);
        assert_eq!(colours[1], COLOURS[0]);
        assert_eq!(colours[2], COLOURS[2]);
        assert_eq!(colours[3], COLOURS[4]);
        assert_eq!(colours[4], COLOURS[4]);
        assert_eq!(colours[5], COLOURS[2]);
        assert_eq!(heat_colours(&[0.0, 0.1], 0.0), [COLOURS[2], COLOURS[4]]);
    }
}
