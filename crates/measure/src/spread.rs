//! What is said of many distances.

/// Distances in a few numbers (mm); of none, all are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean_mm: f64,
    /// Root of the mean square.
    pub rms_mm: f64,
    /// 95 % are at most this.
    pub p95_mm: f64,
    /// The largest.
    pub max_mm: f64,
    /// Mean with signs, positive outside.
    pub signed_mean_mm: f64,
}

impl Spread {
    /// Of signed distances that count alike.
    pub fn of(signed_mm: &[f64]) -> Self {
        Self::weighted(signed_mm.iter().map(|d| (*d, 1.0)))
    }

    /// Of signed distances with weights.
    pub(crate) fn weighted(signed_mm: impl Iterator<Item = (f64, f64)>) -> Self {
        let mut sorted: Vec<(f64, f64)> = signed_mm.collect();
        sorted.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        let total: f64 = sorted.iter().map(|(_, weight)| weight).sum();
        let Some((largest, _)) = sorted.last().filter(|_| total > 0.0) else {
            return Self::default();
        };
        let mean = |of: fn(f64) -> f64| {
            let sum: f64 = sorted.iter().map(|(d, weight)| of(*d) * weight).sum();
            sum / total
        };
        let mut seen = 0.0;
        let p95 = sorted.iter().find(|(_, weight)| {
            seen += weight;
            // Rounding may leave the sum a hair below.
            seen >= 0.95 * total * (1.0 - 1e-12)
        });
        Self {
            mean_mm: mean(f64::abs),
            rms_mm: mean(|d| d * d).sqrt(),
            p95_mm: p95.map_or(largest.abs(), |(d, _)| d.abs()),
            max_mm: largest.abs(),
            signed_mean_mm: mean(|d| d),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_those_of_their_names() {
        let distances: Vec<f64> = (1..=100)
            .map(|i| if i % 2 == 0 { 1.0 } else { -1.0 } * f64::from(i))
            .collect();
        let spread = Spread::of(&distances);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(near(spread.mean_mm, 50.5) && near(spread.signed_mean_mm, 0.5));
        assert!(near(spread.p95_mm, 95.0) && near(spread.max_mm, 100.0));
        assert!(near(spread.rms_mm, 3383.5_f64.sqrt()));
        assert_eq!(Spread::of(&[]), Spread::default());
    }
}
