//! What is promised of connected components.

use super::*;
use bonemesh_task::pool;
use bonemesh_volume::{Affine, Geometry};
use proptest::prelude::*;
use std::num::NonZeroUsize;

fn mask(voxels: Array3<bool>) -> Mask {
    let (k, j, i) = voxels.dim();
    let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
    let geometry = Geometry::new([k, j, i], affine).unwrap();
    Mask { voxels, geometry }
}

fn components(voxels: &Array3<bool>, connectivity: Connectivity) -> Components {
    connected_components(&mask(voxels.clone()), connectivity, &Task::default()).unwrap()
}

/// The labels by walking from voxel to voxel.
fn flooded(voxels: &Array3<bool>, connectivity: Connectivity) -> Array3<u32> {
    let (slices, rows, columns) = voxels.dim();
    let mut labels = Array3::zeros(voxels.raw_dim());
    let mut label = 0;
    for (start, _) in voxels.indexed_iter().filter(|(_, v)| **v) {
        if labels[start] != 0 {
            continue;
        }
        label += 1;
        labels[start] = label;
        let mut ahead = vec![start];
        while let Some((k, j, i)) = ahead.pop() {
            for near in 0..27 {
                let step = [near / 9, near / 3 % 3, near % 3];
                let straight = step.iter().filter(|s| **s != 1).count() == 1;
                if connectivity == Connectivity::Faces && !straight {
                    continue;
                }
                let at = ((k + step[0]), (j + step[1]), (i + step[2]));
                let is_inside = (1..=slices).contains(&at.0)
                    && (1..=rows).contains(&at.1)
                    && (1..=columns).contains(&at.2);
                let at = (
                    at.0.wrapping_sub(1),
                    at.1.wrapping_sub(1),
                    at.2.wrapping_sub(1),
                );
                if is_inside && voxels[at] && labels[at] == 0 {
                    labels[at] = label;
                    ahead.push(at);
                }
            }
        }
    }
    labels
}

/// Voxels that are marked as often as `part` says, the same for the same seed.
fn noise(shape: [usize; 3], part: f64, seed: u64) -> Array3<bool> {
    let mut state = seed.wrapping_mul(2) + 1;
    Array3::from_shape_fn(shape, |_| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / 16_777_216.0 < part
    })
}

#[test]
fn only_corners_connect_a_diagonal() {
    let diagonal = Array3::from_shape_fn([20, 20, 20], |(k, j, i)| k == j && j == i);
    assert_eq!(components(&diagonal, Connectivity::Corners).sizes(), [20]);
    assert_eq!(components(&diagonal, Connectivity::Faces).sizes(), [1; 20]);
}

#[test]
fn a_spiral_through_all_slabs_is_one_piece() {
    // Each slice holds one voxel of a ring; neighbours along the ring lie in the next slice.
    let spiral = Array3::from_shape_fn([60, 8, 8], |(k, j, i)| {
        let place = |k: usize| {
            let at = k % 28;
            match at / 7 {
                0 => (0, at),
                1 => (at - 7, 7),
                2 => (7, 21 - at),
                _ => (28 - at, 0),
            }
        };
        (j, i) == place(k)
    });
    assert_eq!(components(&spiral, Connectivity::Corners).sizes(), [60]);
}

#[test]
fn the_first_of_equally_large_pieces_is_the_largest() {
    let mut voxels = Array3::from_elem([1, 5, 40], false);
    for (row, columns) in [(0, 3..5), (2, 0..17), (4, 20..37)] {
        for column in columns {
            voxels[[0, row, column]] = true;
        }
    }
    let found = components(&voxels, Connectivity::Faces);
    assert_eq!(
        (found.sizes(), found.largest()),
        (&[2, 17, 17][..], Some(1))
    );
    let largest = largest_component(&mask(voxels), Connectivity::Faces, &Task::default());
    let largest = largest.unwrap().voxels;
    assert_eq!(largest.iter().filter(|v| **v).count(), 17);
    assert!(largest[[0, 2, 16]] && !largest[[0, 4, 20]]);
}

#[test]
fn an_empty_mask_has_no_largest_piece() {
    let empty = mask(Array3::from_elem([2, 3, 4], false));
    let found = components(&empty.voxels, Connectivity::Corners);
    assert!(found.is_empty() && found.largest().is_none());
    let error = largest_component(&empty, Connectivity::Corners, &Task::default()).unwrap_err();
    assert!(matches!(error, SegmentError::NoComponent));
}

#[test]
fn a_mask_that_is_not_of_its_geometry_is_refused() {
    let mut wrong = mask(Array3::from_elem([2, 3, 4], true));
    wrong.voxels = Array3::from_elem([2, 3, 5], true);
    let error = connected_components(&wrong, Connectivity::Faces, &Task::default()).unwrap_err();
    assert!(matches!(error, SegmentError::Shape { .. }));
}

#[test]
fn cancelling_stops_the_search() {
    let task = Task::default();
    task.cancel().cancel();
    let mask = mask(Array3::from_elem([2, 3, 4], true));
    let stopped = connected_components(&mask, Connectivity::Faces, &task);
    assert!(matches!(stopped, Err(SegmentError::Cancelled(_))));
}

#[test]
fn the_numbers_are_the_same_for_any_number_of_threads() {
    let voxels = noise([50, 40, 40], 0.3, 5);
    let labels = [1, 2, 3, 8].map(|n| {
        let pool = pool(NonZeroUsize::new(n)).unwrap();
        pool.install(|| components(&voxels, Connectivity::Faces).labels())
    });
    assert!(labels.iter().all(|l| *l == labels[0]));
}

proptest! {
    #[test]
    fn walking_from_voxel_to_voxel_finds_the_same_pieces(
        shape in [1_usize..24, 1_usize..9, 1_usize..40],
        part in 0.02_f64..0.98,
        seed in any::<u64>(),
        is_corners in any::<bool>(),
    ) {
        let connectivity = if is_corners { Connectivity::Corners } else { Connectivity::Faces };
        let voxels = noise(shape, part, seed);
        let found = components(&voxels, connectivity);
        let labels = found.labels();
        prop_assert_eq!(&labels, &flooded(&voxels, connectivity));
        for ((k, j, i), label) in labels.indexed_iter() {
            let number = found.at([k, j, i]).map_or(0, |c| c as u32 + 1);
            prop_assert_eq!(number, *label);
        }
        for (number, size) in found.sizes().iter().enumerate() {
            let voxels = labels.iter().filter(|l| **l == number as u32 + 1).count() as u64;
            prop_assert_eq!(voxels, *size);
            let mask = found.mask(|component| component == number);
            let marked = mask.voxels.iter().filter(|v| **v).count() as u64;
            prop_assert_eq!(marked, *size);
        }
    }
}
