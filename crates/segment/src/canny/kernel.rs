//! The sampled Gaussian, with `NumPy`'s rounding.

/// Standard deviations after which the Gaussian is cut off.
const TRUNCATE: f64 = 4.0;

/// Below this sigma `SciPy` takes the filter as the identity.
const NO_SMOOTHING: f64 = 1e-15;

/// Weights of a normalised Gaussian at distance 0, 1, .. radius (pixels).
///
/// Both sides hold the same weights, so one is enough.
pub(super) fn gaussian_weights(sigma: f64) -> Vec<f64> {
    if sigma <= NO_SMOOTHING {
        return vec![1.0];
    }
    let radius = (TRUNCATE * sigma + 0.5) as usize;
    let scale = -0.5 / (sigma * sigma);
    let side: Vec<f64> = (0..=radius)
        .map(|distance| (scale * (distance * distance) as f64).exp())
        .collect();
    let whole: Vec<f64> = side[1..].iter().rev().chain(&side).copied().collect();
    let sum = pairwise_sum(&whole);
    side.into_iter().map(|weight| weight / sum).collect()
}

/// Sum in the order of `numpy.sum` on a contiguous array: eight running sums over blocks of at
/// most 128 values, longer arrays halved.
fn pairwise_sum(values: &[f64]) -> f64 {
    const LANES: usize = 8;
    const BLOCK: usize = 128;
    let n = values.len();
    if n < LANES {
        return values.iter().sum();
    }
    if n > BLOCK {
        let half = n / 2;
        let (left, right) = values.split_at(half - half % LANES);
        return pairwise_sum(left) + pairwise_sum(right);
    }
    let chunks = values.chunks_exact(LANES);
    let rest = chunks.remainder();
    let mut lanes = [0.0; LANES];
    for chunk in chunks {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane += value;
        }
    }
    let [a, b, c, d, e, f, g, h] = lanes;
    let sum = ((a + b) + (c + d)) + ((e + f) + (g + h));
    rest.iter().fold(sum, |sum, value| sum + value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_of_both_sides_sum_to_one() {
        for sigma in [0.1, 0.7, 1.0, 2.5, 20.0, 100.0] {
            let weights = gaussian_weights(sigma);
            let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
            assert!((sum - 1.0).abs() < 1e-14, "{sigma}: {sum}");
            assert_eq!(weights.len(), (4.0 * sigma + 0.5) as usize + 1);
        }
    }

    #[test]
    fn sigma_zero_is_the_identity() {
        assert_eq!(gaussian_weights(0.0), [1.0]);
    }

    #[test]
    fn the_pairwise_sum_adds_every_value_once() {
        for n in [0_u32, 1, 7, 8, 9, 127, 128, 129, 255, 401, 1000] {
            let values: Vec<f64> = (0..n).map(f64::from).collect();
            let expected = f64::from(n) * (f64::from(n) - 1.0) / 2.0;
            assert!((pairwise_sum(&values) - expected).abs() < 1e-9, "{n}");
        }
    }
}
