//! Our even sampling: as many points a millimetre of contour everywhere.
//!
//! Every slice's points are ordered along its contours, and the points kept are spread over these by
//! their lengths: exactly as many as asked for, at even steps.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::Percent;
use super::contours::{Walk, walk};
use super::slices::Slices;
use super::spread::spread;
use crate::PointCloud;

/// The indices to keep, along the contours.
pub(super) fn keep(
    cloud: &PointCloud,
    percent: Percent,
    task: &Task,
) -> Result<Vec<u32>, Cancelled> {
    let slices = Slices::of(cloud);
    let walks: Vec<Vec<Walk>> = slices
        .par_iter()
        .map(|members| {
            task.check()?;
            let walks = walk(&slices, members, task)?;
            task.advance(members.len())?;
            Ok(walks)
        })
        .collect::<Result<_, Cancelled>>()?;
    let walks = walks.concat();
    let even: Vec<Vec<f64>> = walks.iter().map(|w| vec![1.0; w.points.len()]).collect();
    Ok(spread(&walks, &even, percent.fraction()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lattice, Sampling, sample};
    use bonemesh_volume::Affine;

    fn keep_sorted(cloud: &PointCloud, percent: f64) -> Vec<u32> {
        let percent = Percent::new(percent).unwrap();
        sample(cloud, &Sampling::Uniform { percent }, &Task::default()).unwrap()
    }

    /// Circles of pixels, one above the other, with their angles.
    fn circles(radius: f64, slices: i32) -> PointCloud {
        let reach = radius.ceil() as i32 + 1;
        let is_edge = |i: i32, j: i32| {
            let inside = |i: i32, j: i32| f64::from(i * i + j * j) <= radius * radius;
            inside(i, j)
                && !(inside(i + 1, j) && inside(i - 1, j) && inside(i, j + 1) && inside(i, j - 1))
        };
        let mut coordinates = Vec::new();
        for k in 0..slices {
            for j in -reach..=reach {
                coordinates.extend(
                    (-reach..=reach)
                        .filter(|i| is_edge(*i, j))
                        .map(|i| [i, j, k]),
                );
            }
        }
        PointCloud::from_lattice(Lattice {
            coordinates,
            frame_from_lattice: Affine::from_axes(
                [0.5, 0.0, 0.0],
                [0.0, 0.5, 0.0],
                [0.0, 0.0, 2.0],
                [1.3, -7.7, 0.1],
            ),
        })
        .unwrap()
    }

    /// Largest way (mm) along the circle without a kept point, over all slices.
    fn largest_gap(cloud: &PointCloud, kept: &[u32], radius_mm: f64) -> f64 {
        let lattice = cloud.lattice().unwrap();
        let slices = lattice.coordinates.iter().map(|c| c[2]).max().unwrap() + 1;
        let mut largest = 0.0_f64;
        for slice in 0..slices {
            let mut angles: Vec<f64> = kept
                .iter()
                .map(|i| lattice.coordinates[*i as usize])
                .filter(|c| c[2] == slice)
                .map(|c| f64::from(c[1]).atan2(f64::from(c[0])))
                .collect();
            angles.sort_by(f64::total_cmp);
            angles.push(angles[0] + std::f64::consts::TAU);
            for pair in angles.windows(2) {
                largest = largest.max((pair[1] - pair[0]) * radius_mm);
            }
        }
        largest
    }

    #[test]
    fn no_gap_is_longer_than_a_few_sample_steps() {
        let cloud = circles(75.0, 6);
        for cloud in [
            cloud.clone(),
            PointCloud::from_points(cloud.points_mm().to_vec()).unwrap(),
        ] {
            for percent in [2.0, 5.0, 10.0, 30.0, 70.0] {
                let kept = keep_sorted(&cloud, percent);
                let step = 6.0 * std::f64::consts::TAU * 37.5 / kept.len() as f64;
                let lattice = circles(75.0, 6);
                let gap = largest_gap(&lattice, &kept, 37.5);
                assert!(
                    gap < 2.5 * step + 1.0,
                    "{percent} %: gap {gap} mm, step {step} mm"
                );
            }
        }
    }

    #[test]
    fn a_tiny_part_of_a_few_points_is_one_point() {
        for points in 1..200 {
            let row = (0..points).map(|i| [f64::from(i) * 0.37, 0.0, 0.0]);
            let cloud = PointCloud::from_points(row.collect()).unwrap();
            assert_eq!(keep_sorted(&cloud, 0.01).len(), 1);
        }
    }

    #[test]
    fn everything_is_kept_at_one_hundred_percent() {
        let cloud = circles(20.0, 3);
        let all: Vec<u32> = (0..cloud.len() as u32).collect();
        assert_eq!(keep_sorted(&cloud, 100.0), all);
    }
}
