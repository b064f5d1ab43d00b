//! The order in which points are inserted: random rounds, each along a Hilbert curve.
//!
//! Neighbours on the curve are neighbours in space, so a walk to the next point is short and its
//! surroundings are in the cache. The rounds (each about four times the one before) keep the
//! cells of every intermediate state well shaped: a biased randomised insertion order
//! (Amenta, Choi and Rote 2003). The order moves no result, only the time.

use crate::points::Bounds;

/// Levels of the curve, 2^9 steps along the longest side: with the round and the index, a place
/// fits one word, which sorts quickly. A few points of one step keep the order of their
/// coordinates.
const LEVELS: u32 = 9;
/// More points of one step get a finer curve.
const CROWD: usize = 256;
/// Bits of randomness per round: a round is 2^2 times the one before. On skulls one round for all
/// makes 1.8 times as many cells on the way; 2^1 to 2^6 differ by less than a tenth.
const ROUND_BITS: u32 = 2;

fn rotate_right(bits: u32, by: u32) -> u32 {
    ((bits >> by) | (bits << (3 - by))) & 7
}

fn rotate_left(bits: u32, by: u32) -> u32 {
    rotate_right(bits, (3 - by) % 3)
}

/// How the curve runs through the octants of a cube, for each way of running through it: which
/// octant a corner is, and how the curve runs through that one.
struct Curve {
    octants: [[(u8, u8); 8]; WAYS],
}

/// Eight corners of entry, three directions.
const WAYS: usize = 24;

impl Curve {
    /// Octant by octant with the entry corner and the direction of the curve in it
    /// (Hamilton 2006).
    fn new() -> Self {
        let octants = std::array::from_fn(|way| {
            let (entry, direction) = (way as u32 / 3, way as u32 % 3);
            let turn = (direction + 1) % 3;
            std::array::from_fn(|corner| {
                let gray = rotate_right(corner as u32 ^ entry, turn);
                let octant = gray ^ (gray >> 1) ^ (gray >> 2);
                let even = octant.saturating_sub(1) & !1;
                let next_entry = entry ^ rotate_left(even ^ (even >> 1), turn);
                let along = match octant {
                    0 => 0,
                    odd if odd & 1 == 1 => odd.trailing_ones(),
                    _ => (octant - 1).trailing_ones(),
                };
                let next_direction = (direction + along + 1) % 3;
                (octant as u8, (3 * next_entry + next_direction) as u8)
            })
        });
        Self { octants }
    }

    /// Place of a grid point (each coordinate below `2^levels`) along the curve.
    #[inline]
    fn place(&self, [x, y, z]: [u32; 3], levels: u32) -> u64 {
        let (mut way, mut place) = (0, 0);
        for level in (0..levels).rev() {
            let corner = ((x >> level) & 1) | ((y >> level) & 1) << 1 | ((z >> level) & 1) << 2;
            let (octant, next) = self.octants[way as usize][corner as usize];
            place = place << 3 | u64::from(octant);
            way = next;
        }
        place
    }
}

/// A well-mixed hash (the finaliser of splitmix64).
fn mix(value: u64) -> u64 {
    let mut h = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    h ^ (h >> 31)
}

/// Indices of `points` (mm) in the order of insertion.
pub(crate) fn insertion_order(points: impl ExactSizeIterator<Item = [f64; 3]> + Clone) -> Vec<u32> {
    let last_round = (points.len().max(1).ilog2() / ROUND_BITS).min(15);
    let curve = Curve::new();
    let grid = Grid::around(points.clone());
    let again = points.clone();
    let mut keys: Vec<u64> = points
        .zip(0u32..)
        .map(|(point, i)| {
            let round = (mix(i.into()).trailing_zeros() / ROUND_BITS).min(last_round);
            u64::from(last_round - round) << 60 | grid.key(&curve, point, i)
        })
        .collect();
    keys.sort_unstable();
    let mut listed = None;
    for crowd in keys.chunk_by_mut(|a, b| a >> 32 == b >> 32) {
        if crowd.len() > CROWD {
            let points = listed.get_or_insert_with(|| again.clone().collect::<Vec<_>>());
            sort_crowd(crowd, points, &curve);
        }
    }
    keys.into_iter().map(|key| key as u32).collect()
}

/// Puts points of one step in the order of a curve of their own, and so on: a stray point far from
/// all others makes the steps of the first curve larger than everything else.
fn sort_crowd(keys: &mut [u64], points: &[[f64; 3]], curve: &Curve) {
    let place = |key: &u64| points[*key as u32 as usize];
    let grid = Grid::around(keys.iter().map(place));
    if grid.scale == 0.0 {
        return;
    }
    for key in &mut *keys {
        *key = grid.key(curve, place(key), *key as u32);
    }
    keys.sort_unstable();
    for crowd in keys.chunk_by_mut(|a, b| a >> 32 == b >> 32) {
        if crowd.len() > CROWD {
            sort_crowd(crowd, points, curve);
        }
    }
}

/// The curve's steps around some points.
struct Grid {
    low: [f64; 3],
    /// Steps for each mm.
    scale: f64,
}

impl Grid {
    fn around(points: impl Iterator<Item = [f64; 3]>) -> Self {
        let Bounds { low, high } = Bounds::of(points);
        let side = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let steps = f64::from((1u32 << LEVELS) - 1);
        // Equal points have no side; a huge one may overflow to infinity: one cell for all.
        let scale = if side > 0.0 && side.is_finite() {
            steps / side
        } else {
            0.0
        };
        Self { low, scale }
    }

    /// Place along the curve, then index.
    #[inline]
    fn key(&self, curve: &Curve, point: [f64; 3], index: u32) -> u64 {
        let [x, y, z] = [0, 1, 2].map(|k| ((point[k] - self.low[k]) * self.scale) as u32);
        curve.place([x, y, z], LEVELS) << 32 | u64::from(index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_every_grid_point_once_and_in_unit_steps() {
        let (side, curve) = (16u32, Curve::new());
        let mut visits: Vec<(u64, [u32; 3])> = (0..side * side * side)
            .map(|i| [i % side, i / side % side, i / side / side])
            .map(|p| (curve.place(p, 4), p))
            .collect();
        visits.sort_unstable();
        for (i, (place, _)) in visits.iter().enumerate() {
            assert_eq!(*place, i as u64);
        }
        for pair in visits.windows(2) {
            let step: u32 = (0..3).map(|k| pair[0].1[k].abs_diff(pair[1].1[k])).sum();
            assert_eq!(step, 1);
        }
    }

    #[test]
    fn the_order_holds_every_point_once() {
        let points: Vec<[f64; 3]> = (0..1000)
            .map(|i| [f64::from(i % 10), f64::from(i), 0.0])
            .collect();
        let mut order = insertion_order(points.iter().copied());
        order.sort_unstable();
        assert!(order.into_iter().eq(0..1000));
        assert_eq!(insertion_order([[5.0; 3]; 3].into_iter()).len(), 3);
        assert!(insertion_order(std::iter::empty()).is_empty());
    }

    #[test]
    fn a_stray_point_does_not_spoil_the_order_of_the_others() {
        // Steps between successive points, summed: the curve's own are about a step each.
        let length = |order: &[u32], points: &[[f64; 3]]| -> f64 {
            let steps = order.windows(2).map(|pair| {
                let [a, b] = [pair[0], pair[1]].map(|i| points[i as usize]);
                (0..3).map(|k| (a[k] - b[k]).abs()).sum::<f64>()
            });
            steps.filter(|step| *step < 1e6).sum()
        };
        let side = 24;
        let mut points: Vec<[f64; 3]> = (0..side * side * side)
            .map(|i| [i % side, i / side % side, i / side / side].map(f64::from))
            .collect();
        let even = length(&insertion_order(points.iter().copied()), &points);
        points.push([1e9, 0.0, 0.0]);
        let order = insertion_order(points.iter().copied());
        assert!(length(&order, &points) < 1.3 * even);
    }
}
