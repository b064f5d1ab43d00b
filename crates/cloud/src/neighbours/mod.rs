//! How far apart the points of a cloud are.
//!
//! A lattice is searched by `lattice`, free points by `grid`, and what is too uneven for cells by
//! `tree`. Measured on the 592,212 edge pixels of a skull, 100 neighbours, processor time:
//!
//! | idea | brought |
//! |---|---|
//! | cells of equal size instead of a k-d tree, the ball of one point bounding the next | kept for free points: 4 |
//! | a lattice's points as bits, distances as classes of steps, whole numbers until the end | kept: 4.0 over cells |
//! | of that: up to four rows side by side in a word (a loop over bits ends where no processor can foresee it, so fewer loops) | 1.8 |
//! | of that: beginning with the ball that the row above needed | 1.8 |
//! | balls of 20 or 80 steps a neighbour instead of 40 | dropped: 0.86 (more points left to cells) and 1.0 |
//! | beginning one ball larger, so that fewer points need a second look | dropped: 1.05 |

mod grid;
mod lattice;
mod tree;

use bonemesh_task::{Cancelled, Task, chunked_sum};

use crate::{CloudError, PointCloud};
use grid::Grid;
use lattice::Packed;

/// Points that one worker handles between two looks at the task; fixed, so that results do not
/// depend on the number of workers.
const BATCH: usize = 512;

/// Mean over all points of the mean distance (mm) to the `k` nearest neighbours.
///
/// The nearest neighbour of a point is the point itself, at distance 0. `include_self` averages
/// it with the `k - 1` others; without it the others alone are averaged. Where the cloud has
/// fewer than `k` points, all of them are used.
///
/// # Errors
/// [`CloudError::NeighbourCount`] for `k` below 2, [`CloudError::TooFew`] for a cloud of fewer
/// than two points, [`CloudError::Cancelled`].
pub fn mean_neighbour_distance(
    cloud: &PointCloud,
    k: usize,
    include_self: bool,
    task: &Task,
) -> Result<f64, CloudError> {
    let points = cloud.points_mm();
    if k < 2 {
        return Err(CloudError::NeighbourCount(k));
    }
    if points.len() < 2 {
        return Err(CloudError::TooFew(points.len()));
    }
    let k = k.min(points.len());
    task.begin("neighbours", points.len());
    let sum_mm = match cloud.lattice().and_then(|lattice| Packed::new(lattice, k)) {
        Some(packed) => {
            let sums = packed.sums(task)?;
            let lonely: Vec<_> = sums.lonely.iter().map(|i| points[*i as usize]).collect();
            sums.sum_mm + free_sum(points, Some(&lonely), k, task)?
        }
        None => free_sum(points, None, k, task)?,
    };
    let neighbours = if include_self { k } else { k - 1 };
    Ok(sum_mm / neighbours as f64 / points.len() as f64)
}

/// Sum of the distances (mm) from each of `centres`, or from all `points`, to the `k` nearest of
/// `points`, wherever these lie.
fn free_sum(
    points: &[[f64; 3]],
    centres: Option<&[[f64; 3]]>,
    k: usize,
    task: &Task,
) -> Result<f64, Cancelled> {
    if centres.is_some_and(<[_]>::is_empty) {
        return Ok(0.0);
    }
    let sums = match (Grid::new(points, k, task)?, centres) {
        (Some(grid), Some(centres)) => grid.distance_sums_from(centres, k, task)?,
        (Some(grid), None) => grid.distance_sums(k, task)?,
        (None, centres) => tree::distance_sums(points, centres.unwrap_or(points), k, task)?,
    };
    Ok(chunked_sum(&sums))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Lattice;
    use bonemesh_volume::Affine;
    use proptest::prelude::*;

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// The definition, every point against every other.
    fn by_definition(points: &[[f64; 3]], k: usize, include_self: bool) -> f64 {
        let k = k.min(points.len());
        let mean_of = |p: &[f64; 3]| {
            let mut all: Vec<f64> = points.iter().map(|q| distance(*p, *q)).collect();
            all.sort_by(f64::total_cmp);
            let sum: f64 = all[..k].iter().sum();
            sum / if include_self { k } else { k - 1 } as f64
        };
        points.iter().map(mean_of).sum::<f64>() / points.len() as f64
    }

    fn is_close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * b.abs()
    }

    /// Grid where it applies, tree and definition agree.
    fn check(points: &[[f64; 3]], k: usize) {
        let task = Task::default();
        let cloud = PointCloud::from_points(points.to_vec()).unwrap();
        for include_self in [true, false] {
            let expected = by_definition(points, k, include_self);
            let found = mean_neighbour_distance(&cloud, k, include_self, &task).unwrap();
            assert!(is_close(found, expected), "{found} {expected}");
        }
        let k = k.min(points.len());
        let expected = by_definition(points, k, true) * (k * points.len()) as f64;
        let tree: f64 = tree::distance_sums(points, points, k, &task)
            .unwrap()
            .iter()
            .sum();
        assert!(is_close(tree, expected), "tree {tree} {expected}");
        if let Some(grid) = Grid::new(points, k, &task).unwrap() {
            let grid: f64 = grid.distance_sums(k, &task).unwrap().iter().sum();
            assert!(is_close(grid, expected), "grid {grid} {expected}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn lattice_points_agree_with_the_definition(
            coordinates in prop::collection::btree_set(
                prop::array::uniform3(0..14_i32), 2..300),
            k in 2..120_usize,
            spacing in prop::array::uniform3(0.2..5.0_f64),
        ) {
            let lattice = Lattice {
                coordinates: coordinates.into_iter().collect(),
                frame_from_lattice: Affine::from_axes(
                    [spacing[0], 0.0, 0.0],
                    [0.0, spacing[1], 0.3],
                    [0.0, 0.0, spacing[2]],
                    [-100.0, 5.0, 1.0],
                ),
            };
            check(PointCloud::from_lattice(lattice).unwrap().points_mm(), k);
        }

        #[test]
        fn free_points_agree_with_the_definition(
            points in prop::collection::vec(prop::array::uniform3(-50.0..50.0_f64), 2..200),
            k in 2..120_usize,
        ) {
            check(&points, k);
        }
    }

    #[test]
    fn degenerate_clouds_agree_with_the_definition() {
        let line: Vec<_> = (0..300).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let plane: Vec<_> = (0..400)
            .map(|i| [f64::from(i % 20), f64::from(i / 20), 7.0])
            .collect();
        let mut clumped: Vec<_> = (0..500).map(|i| [f64::from(i) * 1e-6, 1.0, 2.0]).collect();
        clumped.push([1e6, -1e6, 1e6]);
        let same = vec![[3.0, 4.0, 5.0]; 150];
        let mut few_places = plane.clone();
        few_places.extend_from_slice(&plane);
        few_places.extend_from_slice(&plane[..60]);
        let huge: Vec<_> = (0..40).map(|i| [f64::from(i) * 1e150, 0.0, 0.0]).collect();
        for cloud in [line, plane, clumped, few_places, huge] {
            for k in [2, 10, 100] {
                check(&cloud, k);
            }
        }
        let cloud = PointCloud::from_points(same).unwrap();
        let mean = mean_neighbour_distance(&cloud, 100, true, &Task::default()).unwrap();
        assert!(mean.abs() < 1e-300);
    }

    #[test]
    fn a_unit_line_has_the_distances_one_counts() {
        // 1, 1 inside and 1, 2 at the two ends: (998 * 2 + 2 * 3) / 3 / 1000 with the point itself.
        let points = (0..1000).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let cloud = PointCloud::from_points(points).unwrap();
        let mean = |own| mean_neighbour_distance(&cloud, 3, own, &Task::default()).unwrap();
        assert!(is_close(mean(true), 2002.0 / 3000.0));
        assert!(is_close(mean(false), 2002.0 / 2000.0));
    }

    #[test]
    fn the_mean_is_the_same_for_any_number_of_threads() {
        let place = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 12) * 1e-4;
        let points = (0..30_000).map(|i| [place(3 * i), place(3 * i + 1), place(3 * i + 2)]);
        let free = PointCloud::from_points(points.collect()).unwrap();
        let round = |i: u32| [i % 50, i / 50 % 60, i / 3000].map(|c| c as i32);
        let coordinates = (0..30_000).filter(|i| i % 3 > 0).map(round).collect();
        let affine = Affine::from_axes([0.3, 0.0, 0.0], [0.0, 0.3, 0.1], [0.0, 0.0, 0.7], [0.1; 3]);
        let lattice = PointCloud::from_lattice(Lattice {
            coordinates,
            frame_from_lattice: affine,
        });
        for cloud in [free, lattice.unwrap()] {
            let means = [1, 2, 5].map(|threads| {
                let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
                pool.install(|| mean_neighbour_distance(&cloud, 20, true, &Task::default()))
                    .unwrap()
                    .to_bits()
            });
            assert!(means.iter().all(|mean| *mean == means[0]));
        }
    }

    #[test]
    fn what_has_no_distance_is_refused() {
        let task = Task::default();
        let cloud = |n| PointCloud::from_points(vec![[0.0; 3]; n]).unwrap();
        for n in [0, 1] {
            let result = mean_neighbour_distance(&cloud(n), 100, true, &task);
            assert!(matches!(result, Err(CloudError::TooFew(m)) if m == n));
        }
        for k in [0, 1] {
            let result = mean_neighbour_distance(&cloud(5), k, true, &task);
            assert!(matches!(result, Err(CloudError::NeighbourCount(_))));
        }
        task.cancel().cancel();
        let result = mean_neighbour_distance(&cloud(5), 2, true, &task);
        assert!(matches!(result, Err(CloudError::Cancelled(_))));
    }
}
