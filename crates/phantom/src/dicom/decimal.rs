//! DICOM decimal strings: at most 16 characters.

/// Longest decimal string (value representation DS).
const LONGEST: usize = 16;

/// The 16-character text that reads back nearest to `value`.
pub(super) fn decimal(value: f64) -> String {
    let shortest = format!("{value}");
    if shortest.len() <= LONGEST {
        return if shortest == "-0" {
            "0".to_owned()
        } else {
            shortest
        };
    }
    // The most digits that still fit, with and without an exponent.
    let mut fixed = (0..=15).rev().map(|digits| format!("{value:.digits$}"));
    let fixed = fixed.find(|t| t.len() <= LONGEST).map(without_idle_zeros);
    let mut scientific = (0..=15).rev().map(|digits| format!("{value:.digits$e}"));
    let scientific = scientific.find(|t| t.len() <= LONGEST);
    let miss = |text: &String| {
        text.parse()
            .map_or(f64::INFINITY, |v: f64| (v - value).abs())
    };
    [fixed, scientific]
        .into_iter()
        .flatten()
        .min_by(|a, b| miss(a).total_cmp(&miss(b)))
        .unwrap_or(shortest)
}

fn without_idle_zeros(fixed: String) -> String {
    if fixed.contains('.') {
        fixed.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        fixed
    }
}

/// Several values, separated as DICOM does.
pub(super) fn decimals(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|v| decimal(*v)).collect();
    texts.join("\\")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_length_fits_and_reads_back_to_a_billionth(value in -1e4..1e4f64) {
            let text = decimal(value);
            prop_assert!(text.len() <= 16, "{text}");
            prop_assert!((text.parse::<f64>().unwrap() - value).abs() < 1e-9, "{text}");
        }
    }

    #[test]
    fn short_numbers_are_written_as_people_write_them() {
        assert_eq!(
            decimals(&[0.5, -0.0, 1.0 / 3.0]),
            "0.5\\0\\0.33333333333333"
        );
        assert!(decimal(-6.123_233_995_736_766e-17).len() <= 16);
    }
}
