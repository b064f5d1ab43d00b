//! What every sampler promises.

use super::*;
use crate::{Lattice, PointCloud};
use bonemesh_volume::Affine;
use proptest::prelude::*;

fn lattice_cloud(coordinates: Vec<[i32; 3]>) -> PointCloud {
    let frame_from_lattice =
        Affine::from_axes([0.4, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 2.5], [7.0; 3]);
    PointCloud::from_lattice(Lattice {
        coordinates,
        frame_from_lattice,
    })
    .unwrap()
}

fn samplings(percent: f64) -> Vec<Sampling> {
    let percent = Percent::new(percent).unwrap();
    vec![
        Sampling::Uniform { percent },
        Sampling::Targeted { percent },
        Sampling::Random { percent, seed: 3 },
        Sampling::ThesisUniform { percent },
        Sampling::ThesisTargeted(SimilarityRanges::default()),
    ]
}

fn keep(cloud: &PointCloud, sampling: &Sampling) -> Vec<u32> {
    sample(cloud, sampling, &Task::default()).unwrap()
}

fn is_ours(sampling: &Sampling) -> bool {
    matches!(
        sampling,
        Sampling::Uniform { .. } | Sampling::Targeted { .. }
    )
}

fn assert_sample(
    cloud: &PointCloud,
    sampling: &Sampling,
    percent: f64,
) -> Result<(), TestCaseError> {
    let kept = keep(cloud, sampling);
    prop_assert!(kept.windows(2).all(|w| w[0] < w[1]), "{sampling:?}");
    prop_assert!(kept.iter().all(|i| (*i as usize) < cloud.len()));
    if is_ours(sampling) {
        let wanted = (percent / 100.0 * cloud.len() as f64).max(0.5);
        prop_assert!(
            (kept.len() as f64 - wanted).abs() <= 0.500_01,
            "{sampling:?}: {}",
            kept.len()
        );
        prop_assert!(!kept.is_empty());
    }
    Ok(())
}

proptest! {
    #[test]
    fn samples_of_pixels_are_points_of_the_cloud_and_ours_exactly_as_many_as_asked_for(
        coordinates in prop::collection::vec(
            (0..3_i32, 0..30_i32, 0..30_i32).prop_map(|(k, j, i)| [i, j, k]), 1..500),
        percent in 0.01..=100.0_f64,
        is_free in any::<bool>(),
    ) {
        // Equal points are among them.
        let mut cloud = lattice_cloud(coordinates);
        if is_free {
            cloud = PointCloud::from_points(cloud.points_mm().to_vec()).unwrap();
        }
        for sampling in samplings(percent) {
            if is_free && sampling.sampler() == Sampler::ThesisTargeted {
                continue;
            }
            assert_sample(&cloud, &sampling, percent)?;
        }
    }

    #[test]
    fn free_points_in_a_plane_or_anywhere_are_sampled_too(
        points in prop::collection::vec(prop::array::uniform3(-9.0..9.0_f64), 1..120),
        is_flat in any::<bool>(),
        percent in 0.01..=100.0_f64,
    ) {
        let flat = |p: &[f64; 3]| [p[0], p[1], if is_flat { 1.5 } else { p[2] }];
        let cloud = PointCloud::from_points(points.iter().map(flat).collect()).unwrap();
        for sampling in samplings(percent).into_iter().take(4) {
            assert_sample(&cloud, &sampling, percent)?;
        }
    }
}

/// A square with sides of `side` pixels.
fn square(side: i32, slices: i32) -> PointCloud {
    let mut coordinates = Vec::new();
    for k in 0..slices {
        for j in 0..side {
            let rim = |i: &i32| [0, side - 1].contains(i) || [0, side - 1].contains(&j);
            coordinates.extend((0..side).filter(rim).map(|i| [i, j, k]));
        }
    }
    lattice_cloud(coordinates)
}

#[test]
fn targeted_keeps_more_near_corners_and_no_side_without_points() {
    let side = 100;
    let cloud = square(side, 2);
    let percent = Percent::new(5.0).unwrap();
    let lattice = cloud.lattice().unwrap();
    let near_corners = |kept: &[u32]| {
        let off = |c: i32| c.min(side - 1 - c);
        let places = kept.iter().map(|i| lattice.coordinates[*i as usize]);
        places.filter(|c| off(c[0]) + off(c[1]) <= 8).count()
    };
    let uniform = keep(&cloud, &Sampling::Uniform { percent });
    let targeted = keep(&cloud, &Sampling::Targeted { percent });
    assert_eq!(uniform.len(), targeted.len());
    assert!(near_corners(&targeted) > near_corners(&uniform));
    // No stretch of a side is longer than three even steps.
    for k in 0..2 {
        let mut top: Vec<i32> = targeted
            .iter()
            .map(|i| lattice.coordinates[*i as usize])
            .filter(|c| c[2] == k && c[1] == 0)
            .map(|c| c[0])
            .collect();
        top.sort_unstable();
        assert!(top.windows(2).all(|w| w[1] - w[0] <= 3 * 20), "{top:?}");
    }
}

#[test]
fn a_straight_line_is_targeted_as_it_is_sampled_evenly() {
    let line = lattice_cloud((0..400).map(|i| [i, 3, 0]).collect());
    for percent in [2.0, 10.0, 50.0, 90.0] {
        let percent = Percent::new(percent).unwrap();
        let [uniform, targeted] = [
            Sampling::Uniform { percent },
            Sampling::Targeted { percent },
        ]
        .map(|sampling| keep(&line, &sampling));
        assert_eq!(uniform, targeted);
    }
}

#[test]
fn a_sample_of_a_sample_still_follows_the_contour() {
    // Kept points are not adjacent pixels any more.
    let cloud = square(200, 1);
    let percent = Percent::new(25.0).unwrap();
    let once = cloud.subset(&keep(&cloud, &Sampling::Uniform { percent }));
    let twice = once.subset(&keep(&once, &Sampling::Uniform { percent }));
    let angle = |p: &[f64; 3]| (p[1] - 7.0 - 0.5 * 99.5).atan2(p[0] - 7.0 - 0.4 * 99.5);
    let mut angles: Vec<f64> = twice.points_mm().iter().map(angle).collect();
    angles.sort_by(f64::total_cmp);
    let even = std::f64::consts::TAU / angles.len() as f64;
    assert!(
        angles.windows(2).all(|w| w[1] - w[0] < 3.0 * even),
        "{angles:?}"
    );
}

#[test]
fn nothing_and_few_points_are_sampled() {
    let empty = PointCloud::from_points(Vec::new()).unwrap();
    let one = lattice_cloud(vec![[5, 5, 5]]);
    let equal = lattice_cloud(vec![[5, 5, 5]; 40]);
    for sampling in samplings(25.0) {
        assert!(keep(&empty, &sampling).is_empty());
        assert!(keep(&one, &sampling).len() <= 1);
        assert!(keep(&equal, &sampling).len() <= 11, "{sampling:?}");
    }
}

#[test]
fn samples_are_the_same_for_any_number_of_threads() {
    let cloud = square(60, 9);
    for sampling in samplings(17.0) {
        let samples: Vec<Vec<u32>> = [1, 2, 5]
            .into_iter()
            .map(|threads| {
                let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
                pool.install(|| keep(&cloud, &sampling))
            })
            .collect();
        assert!(samples.iter().all(|s| *s == samples[0]), "{sampling:?}");
    }
}

#[test]
fn a_cancel_stops_every_sampler() {
    let cloud = square(60, 9);
    for sampling in samplings(17.0) {
        let task = Task::default();
        task.cancel().cancel();
        let error = sample(&cloud, &sampling, &task).unwrap_err();
        assert!(matches!(error, CloudError::Cancelled(_)), "{sampling:?}");
    }
}
