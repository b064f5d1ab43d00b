//! By lot.

use rand::RngExt;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::Percent;

/// `ceil(percent * points)` different indices, in no order.
pub(super) fn keep(points: usize, percent: Percent, seed: u64) -> Vec<u32> {
    // The tiny factor keeps 10 % of 30 points at 3 although 0.1 * 30 is a little more.
    let wanted = (percent.fraction() * points as f64 * (1.0 - 1e-12)).ceil() as usize;
    let wanted = wanted.min(points);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut indices: Vec<u32> = (0..points as u32).collect();
    // The first steps of a Fisher-Yates shuffle; drawn as u64 so that 32-bit and 64-bit
    // machines keep the same points.
    for at in 0..wanted {
        let other = rng.random_range(at as u64..points as u64) as usize;
        indices.swap(at, other);
    }
    indices.truncate(wanted);
    indices
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn percent(value: f64) -> Percent {
        Percent::new(value).unwrap()
    }

    #[test]
    fn the_count_is_rounded_up_and_no_point_is_kept_twice() {
        for (points, value, expected) in [
            (30, 10.0, 3),
            (31, 10.0, 4),
            (1, 0.001, 1),
            (7, 100.0, 7),
            (0, 50.0, 0),
            (1000, 33.3, 333),
            (282_938, 10.0, 28_294),
        ] {
            let kept = keep(points, percent(value), 5);
            assert_eq!(kept.len(), expected, "{value} % of {points}");
            let different: BTreeSet<u32> = kept.iter().copied().collect();
            assert_eq!(different.len(), expected);
            assert!(different.iter().all(|i| (*i as usize) < points));
        }
    }

    #[test]
    fn a_seed_always_keeps_the_same_points() {
        assert_eq!(keep(1000, percent(5.0), 1), keep(1000, percent(5.0), 1));
        assert_ne!(keep(1000, percent(5.0), 1), keep(1000, percent(5.0), 2));
    }

    #[test]
    fn every_point_has_the_same_chance() {
        let mut hits = [0_u32; 20];
        for seed in 0..4000 {
            for index in keep(20, percent(25.0), seed) {
                hits[index as usize] += 1;
            }
        }
        // 1000 expected each, standard deviation 27.
        assert!(hits.iter().all(|h| (860..1140).contains(h)), "{hits:?}");
    }
}
