//! The nearest of any points, by k-d trees of parts of them: one tree of all of them could not be
//! stopped while it grows.
//!
//! 1. `parts`: the points, halved across their longest extent until none has too many.
//! 2. A k-d tree of each.
//! 3. A search goes through the trees by the distance of their boxes, and ends where no box is near
//!    enough.

use std::num::NonZero;

use bonemesh_task::{Cancelled, Task};
use kiddo::SquaredEuclidean;
use kiddo::immutable::float::kdtree::ImmutableKdTree;
use rayon::prelude::*;

/// Points in a leaf; the fastest of 32, 64 and 128 on clouds of skulls.
const LEAF: usize = 64;
/// Points in a tree at most: it grows in some hundredths of a second.
const PART: usize = 1 << 16;

/// Points in which the nearest are found.
pub struct Forest {
    trees: Vec<Tree>,
}

/// A point that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// Square of its distance (mm2).
    pub squared_mm2: f64,
    /// Its number.
    pub point: u32,
}

struct Tree {
    /// The immutable tree takes any number of points that share a coordinate, which the mutable
    /// one does not, and the points of a slice always do.
    points: ImmutableKdTree<f64, u32, 3, LEAF>,
    numbers: Vec<u32>,
    low: [f64; 3],
    high: [f64; 3],
}

type Numbered = ([f64; 3], u32);

impl Forest {
    /// Of points that are numbered from 0.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(points_mm: &[[f64; 3]], task: &Task) -> Result<Self, Cancelled> {
        let mut numbered = Vec::with_capacity(points_mm.len());
        let mut numbers = 0..;
        for chunk in points_mm.chunks(PART) {
            task.check()?;
            numbered.extend(chunk.iter().copied().zip(&mut numbers));
        }
        let trees = parts(&mut numbered, task)?
            .into_par_iter()
            .map(|part| {
                task.check()?;
                Ok(Tree::of(part))
            })
            .collect::<Result<_, Cancelled>>()?;
        Ok(Self { trees })
    }

    /// Up to `count` nearest points, the nearest first, of equally near ones that of the lower
    /// number; none of them further than the reach.
    pub fn nearest(
        &self,
        place_mm: [f64; 3],
        count: NonZero<usize>,
        squared_reach_mm2: f64,
    ) -> Vec<Near> {
        let away = self.trees.iter().map(|tree| (tree.away(place_mm), tree));
        let mut away: Vec<_> = away.filter(|(mm2, _)| *mm2 <= squared_reach_mm2).collect();
        away.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let mut found: Vec<Near> = Vec::new();
        for (away_mm2, tree) in away {
            let reach = match found.get(count.get() - 1) {
                Some(last) => last.squared_mm2,
                None => squared_reach_mm2,
            };
            if away_mm2 > reach {
                break;
            }
            let points = &tree.points;
            let more = points.nearest_n_within::<SquaredEuclidean>(&place_mm, reach, count, false);
            found.extend(more.iter().map(|n| tree.near(n.distance, n.item)));
            found.sort_unstable_by(Near::nearer);
            found.truncate(count.get());
        }
        found
    }

    /// All points within a reach, the nearest first.
    pub fn within(&self, place_mm: [f64; 3], squared_reach_mm2: f64) -> Vec<Near> {
        let mut found = self.within_unsorted(place_mm, squared_reach_mm2);
        found.sort_unstable_by(Near::nearer);
        found
    }

    /// All points within a reach, in an order that the points alone decide.
    pub fn within_unsorted(&self, place_mm: [f64; 3], squared_reach_mm2: f64) -> Vec<Near> {
        let mut found = Vec::new();
        for tree in &self.trees {
            if tree.away(place_mm) <= squared_reach_mm2 {
                let points = &tree.points;
                let more = points.within_unsorted::<SquaredEuclidean>(&place_mm, squared_reach_mm2);
                found.extend(more.iter().map(|n| tree.near(n.distance, n.item)));
            }
        }
        found
    }
}

impl Near {
    fn nearer(&self, other: &Self) -> std::cmp::Ordering {
        let by_distance = self.squared_mm2.total_cmp(&other.squared_mm2);
        by_distance.then(self.point.cmp(&other.point))
    }
}

impl Tree {
    fn of(part: &[Numbered]) -> Self {
        let points: Vec<[f64; 3]> = part.iter().map(|(p, _)| *p).collect();
        let bound = |axis: usize, of: fn(f64, f64) -> f64| {
            points.iter().map(|p| p[axis]).reduce(of).unwrap_or(0.0)
        };
        Self {
            points: ImmutableKdTree::new_from_slice(&points),
            numbers: part.iter().map(|(_, number)| *number).collect(),
            low: std::array::from_fn(|axis| bound(axis, f64::min)),
            high: std::array::from_fn(|axis| bound(axis, f64::max)),
        }
    }

    fn near(&self, squared_mm2: f64, item: u32) -> Near {
        Near {
            squared_mm2,
            point: self.numbers[item as usize],
        }
    }

    /// Square of the distance to the box around its points.
    fn away(&self, place: [f64; 3]) -> f64 {
        (0..3)
            .map(|k| {
                let out = (self.low[k] - place[k]).max(place[k] - self.high[k]);
                out.max(0.0).powi(2)
            })
            .sum()
    }
}

/// The points in parts of which none has too many.
fn parts<'a>(all: &'a mut [Numbered], task: &Task) -> Result<Vec<&'a mut [Numbered]>, Cancelled> {
    let mut small = Vec::new();
    let mut large = vec![all];
    while let Some(part) = large.pop() {
        task.check()?;
        if part.len() <= PART {
            small.push(part);
            continue;
        }
        let axis = longest(part);
        let middle = part.len() / 2;
        part.select_nth_unstable_by(middle, |a, b| {
            a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1))
        });
        let (left, right) = part.split_at_mut(middle);
        large.extend([right, left]);
    }
    Ok(small)
}

/// The axis along which points reach furthest.
fn longest(part: &[Numbered]) -> usize {
    let extent = |axis: usize| {
        let along = part.iter().map(|(p, _)| p[axis]);
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        });
        high - low
    };
    let extents = [0, 1, 2].map(extent);
    (0..3)
        .max_by(|a, b| extents[*a].total_cmp(&extents[*b]))
        .expect("there are three axes")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More points than a tree takes, on a lattice with many ties.
    fn lattice() -> Vec<[f64; 3]> {
        let at = |i: usize| [i % 70, i / 70 % 40, i / 2800].map(|v| v as f64);
        (0..2800 * 60).map(at).collect()
    }

    #[test]
    fn several_trees_find_what_a_look_at_all_points_finds() {
        let points = lattice();
        let forest = Forest::new(&points, &Task::default()).unwrap();
        assert!(forest.trees.len() > 2);
        let count = NonZero::new(30).unwrap();
        for place in [[35.0, 20.0, 30.0], [34.5, 20.5, 29.5], [-3.0, 50.0, 10.2]] {
            let squared = |p: &[f64; 3]| (0..3).map(|k| (p[k] - place[k]).powi(2)).sum::<f64>();
            let mut all: Vec<f64> = points.iter().map(squared).collect();
            all.sort_by(f64::total_cmp);
            let nearest = forest.nearest(place, count, f64::INFINITY);
            let found: Vec<f64> = nearest.iter().map(|n| n.squared_mm2).collect();
            assert_eq!(found, all[..30]);
            assert!(
                nearest.iter().all(|n| {
                    (squared(&points[n.point as usize]) - n.squared_mm2).abs() < 1e-12
                })
            );
            let within = forest.within(place, 150.0);
            assert_eq!(
                within.len(),
                all.iter().filter(|mm2| **mm2 <= 150.0).count()
            );
            assert!(within.is_sorted_by(|a, b| a.nearer(b).is_le()));
        }
    }

    #[test]
    fn a_cancel_stops_it() {
        let task = Task::default();
        task.cancel().cancel();
        assert!(Forest::new(&lattice(), &task).is_err());
    }
}
