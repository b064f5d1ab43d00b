//! Our even sampling: as many points a millimetre of contour everywhere.
//!
//! 1. Every slice's points are ordered along its contours.
//! 2. `weights` gives each point the part of a kept point that its length of contour is due; no
//!    point can be kept more than once, so what is cut off is shared by the others.
//! 3. The parts are added up along the contours, and a point is kept whenever the sum has reached
//!    the next whole number; the rest is carried on, from contour to contour and slice to slice.
//!    So the number of points is exact, and small contours get their share.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::Percent;
use super::contours::{Step, walk_lattice, walk_nearest};
use super::slices::Slices;
use crate::PointCloud;

/// Shortest length a point is taken to stand for, in usual ones: points that crowd still count.
const SHORTEST: f64 = 0.25;

/// The indices to keep, along the contours.
pub(super) fn keep(
    cloud: &PointCloud,
    percent: Percent,
    task: &Task,
) -> Result<Vec<u32>, Cancelled> {
    let slices = Slices::of(cloud);
    let walks: Vec<Vec<Step>> = slices
        .par_iter()
        .map(|members| {
            task.check()?;
            let mut steps = match slices.pixels(members) {
                Some(pixels) => walk_lattice(&pixels, slices.metric()),
                None => walk_nearest(&slices.places(members), slices.metric(), task)?,
            };
            for step in &mut steps {
                step.point = members[step.point as usize];
            }
            task.advance(members.len())?;
            Ok(steps)
        })
        .collect::<Result<_, Cancelled>>()?;
    let steps = walks.concat();
    // Half a point in advance rounds the number to the nearest; a little more than half is
    // wanted in any case, so that rounding cannot leave a cloud without points.
    let wanted = (percent.fraction() * steps.len() as f64).max(0.5 + 1e-6);
    let mut due = 0.5;
    let mut kept = Vec::with_capacity(wanted as usize + 1);
    for (step, weight) in steps.iter().zip(weights(&steps, wanted)) {
        due += weight;
        if due >= 1.0 {
            due -= 1.0;
            kept.push(step.point);
        }
    }
    Ok(kept)
}

/// Parts of a point, at most 1 each, that add up to `wanted` and follow the lengths of contour.
fn weights(steps: &[Step], wanted: f64) -> Vec<f64> {
    let known: Vec<f64> = steps.iter().filter_map(|s| s.arc_mm).collect();
    let usual = known.iter().sum::<f64>() / known.len().max(1) as f64;
    if usual <= 0.0 || wanted >= steps.len() as f64 {
        return vec![wanted / steps.len() as f64; steps.len()];
    }
    let arc = |step: &Step| step.arc_mm.map_or(1.0, |arc| (arc / usual).max(SHORTEST));
    let mut parts: Vec<f64> = steps.iter().map(arc).collect();
    // Each round the scale grows a little, until no further part passes 1.
    let mut scale = 0.0;
    loop {
        let is_whole = |part: &f64| part * scale >= 1.0;
        let whole = parts.iter().filter(|p| is_whole(p)).count();
        let open: f64 = parts.iter().filter(|p| !is_whole(p)).sum();
        let next = (wanted - whole as f64) / open;
        if !(next.is_finite() && next > scale * (1.0 + 1e-12)) {
            break;
        }
        scale = next;
    }
    for part in &mut parts {
        *part = (*part * scale).min(1.0);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lattice, Sampler, sample};
    use bonemesh_volume::Affine;
    use proptest::prelude::*;

    fn keep_sorted(cloud: &PointCloud, percent: f64) -> Vec<u32> {
        let percent = Percent::new(percent).unwrap();
        sample(cloud, Sampler::Uniform, percent, 0, &Task::default()).unwrap()
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

    proptest! {
        #[test]
        fn the_number_kept_is_exact_and_no_point_is_kept_twice(
            coordinates in prop::collection::btree_set(
                (0..3_i32, 0..30_i32, 0..30_i32).prop_map(|(k, j, i)| [i, j, k]), 1..500),
            percent in 0.01..=100.0_f64,
            is_free in any::<bool>(),
        ) {
            let frame_from_lattice = Affine::from_axes(
                [0.3, 0.0, 0.0], [0.0, 0.7, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
            let coordinates: Vec<[i32; 3]> = coordinates.into_iter().collect();
            let lattice = Lattice { coordinates, frame_from_lattice };
            let mut cloud = PointCloud::from_lattice(lattice).unwrap();
            if is_free {
                cloud = PointCloud::from_points(cloud.points_mm().to_vec()).unwrap();
            }
            let kept = keep_sorted(&cloud, percent);
            prop_assert!(kept.windows(2).all(|w| w[0] < w[1]));
            prop_assert!(kept.iter().all(|i| (*i as usize) < cloud.len()));
            let wanted = (percent / 100.0 * cloud.len() as f64).max(0.5);
            prop_assert!((kept.len() as f64 - wanted).abs() <= 0.500_01);
            prop_assert!(!kept.is_empty());
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

    #[test]
    fn equal_points_do_no_harm() {
        let cloud = PointCloud::from_points(vec![[1.0, 2.0, 3.0]; 40]).unwrap();
        assert_eq!(keep_sorted(&cloud, 25.0).len(), 10);
        let empty = PointCloud::from_points(Vec::new()).unwrap();
        assert!(keep_sorted(&empty, 25.0).is_empty());
    }

    #[test]
    fn the_sample_is_the_same_for_any_number_of_threads() {
        let cloud = circles(40.0, 9);
        let samples: Vec<Vec<u32>> = [1, 2, 5]
            .into_iter()
            .map(|threads| {
                let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
                pool.install(|| keep_sorted(&cloud, 17.0))
            })
            .collect();
        assert!(samples.iter().all(|s| *s == samples[0]));
    }
}
