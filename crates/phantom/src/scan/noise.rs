//! Noise of the scanner: white, Gaussian, the same for the same seed.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Adds noise of `sigma_hu`; each slice draws from a stream of its own.
pub(super) fn add(image: &mut [f32], sigma_hu: f64, seed: u64, slice: usize) {
    if sigma_hu <= 0.0 {
        return;
    }
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(slice as u64);
    // Box and Muller (1958): two uniform numbers make two normal ones.
    for pair in image.chunks_mut(2) {
        let radius = sigma_hu * (-2.0 * open_unit(&mut rng).ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * open_unit(&mut rng)).sin_cos();
        for (value, part) in pair.iter_mut().zip([cos, sin]) {
            *value += (radius * part) as f32;
        }
    }
}

/// Uniform in (0, 1): 32 bits, moved off both ends by half a step.
fn open_unit(rng: &mut ChaCha8Rng) -> f64 {
    (f64::from(rng.next_u32()) + 0.5) / 4_294_967_296.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_the_asked_mean_and_deviation() {
        let mut image = vec![100.0_f32; 200_000];
        add(&mut image, 15.0, 7, 3);
        let n = image.len() as f64;
        let mean = image.iter().map(|v| f64::from(*v)).sum::<f64>() / n;
        let variance = image
            .iter()
            .map(|v| (f64::from(*v) - mean).powi(2))
            .sum::<f64>()
            / n;
        assert!((mean - 100.0).abs() < 0.2, "{mean}");
        assert!((variance.sqrt() - 15.0).abs() < 0.15, "{variance}");
    }

    #[test]
    fn slices_and_seeds_differ_and_repeat() {
        let draw = |seed, slice| {
            let mut image = vec![0.0_f32; 64];
            add(&mut image, 1.0, seed, slice);
            image
        };
        assert_eq!(draw(1, 2), draw(1, 2));
        assert_ne!(draw(1, 2), draw(1, 3));
        assert_ne!(draw(1, 2), draw(2, 2));
    }
}
