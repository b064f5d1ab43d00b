//! The threshold at which bone ends in the grey image itself.
//!
//! A scanner blurs a step from soft tissue to bone symmetrically, so the true border lies where
//! the profile across it is halfway between both sides. The steps, each named as its function is:
//! 1. `grey`: a slice in HU, and Canny's edges of it, those of steps of about 250 HU and more;
//! 2. `Profile::across`: from each edge pixel up and down the gradient, as long as the values go
//!    on rising or falling, which gives the bright and the dark side;
//! 3. `is_bone_edge`: of these edges, those from soft tissue to bone;
//! 4. the median of the halfway values.
//!
//! Sources: K. Rathnayaka, T. Sahama, M. A. Schuetz, B. Schmutz, "Effects of CT image segmentation
//! methods on the accuracy of long bone 3D reconstructions", Medical Engineering & Physics 33(2),
//! 2011, who chose thresholds by Canny's edges of the grey image; J. Canny, "A computational
//! approach to edge detection", IEEE TPAMI 8(6), 1986.

use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};
use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView2, Axis};

use crate::{CannySettings, HuThreshold, SegmentError, canny};

/// Slices that are looked at, evenly spread: what they say is a median, which more would not move.
const MAX_SLICES: usize = 64;

/// Canny's smoothing in pixels, and Sobel's gradients that continue and start an edge in HU: with
/// usual blur a step of 250 HU just starts one.
const SIGMA: f64 = 1.0;
const LOW: f64 = 300.0;
const HIGH: f64 = 600.0;

/// Bone is brighter than this, soft tissue is not.
const BONE_HU: f64 = 300.0;
/// Air and lung are darker than this.
const AIR_HU: f64 = -300.0;
/// Values are cut to this range, in which all tissue lies: padding becomes air.
const GREY_HU: [f64; 2] = [-1024.0, 4095.0];

/// How far along the gradient a side is looked for, and in which steps, in pixels.
const REACH: f64 = 4.0;
const STEP: f64 = 0.5;

/// Fewer edges, or a smaller part of all edges of bone, say nothing: the rest has air beside it.
const MIN_EDGES: usize = 200;
const MIN_PART: f64 = 0.05;

/// A threshold found at the edges of bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeThreshold {
    /// The median of the halfway values, in whole HU.
    pub threshold: HuThreshold,
    /// Between these lies the middle half of the halfway values (HU).
    pub quartiles_hu: [f64; 2],
    /// Edge pixels between soft tissue and bone.
    pub edges: usize,
}

/// The threshold halfway between soft tissue and bone, at the median of the edges between them.
///
/// Works on slices as they are stored, at most 64 of them. Limits: bone whose edges are to air
/// (dry skulls, most phantoms of plastic) has no such edges; at walls thinner than about three
/// pixels the bright side is not reached and the halfway value is too low; where trabecular bone
/// fades into marrow there is no edge. Half the edges lie above the threshold: walls whose blurred
/// peak stays below it are lost.
///
/// # Errors
/// [`SegmentError::FewBoneEdges`] where there are too few such edges, and
/// [`SegmentError::Cancelled`].
pub fn edge_threshold(volume: &Volume, task: &Task) -> Result<EdgeThreshold, SegmentError> {
    let slices = volume.geometry().shape()[0];
    let looked_at = slices.min(MAX_SLICES);
    let settings = CannySettings::new(SIGMA, LOW, HIGH)?;
    task.begin("edges of bone", looked_at);
    let found: Vec<Vec<Profile>> = (0..looked_at)
        .into_par_iter()
        .map(|i| {
            task.check()?;
            let image = grey(volume, i * slices / looked_at);
            let edges = canny(image.view(), settings)?;
            let profiles = edges
                .indexed_iter()
                .filter(|(_, is_edge)| **is_edge)
                .filter_map(|(pixel, _)| Profile::across(&image.view(), pixel))
                .filter(|profile| profile.bright_hu > BONE_HU && profile.dark_hu <= BONE_HU)
                .collect();
            task.advance(1)?;
            Ok(profiles)
        })
        .collect::<Result<_, SegmentError>>()?;
    let of = found.iter().map(Vec::len).sum();
    let mut halfway: Vec<f64> = found
        .into_iter()
        .flatten()
        .filter(Profile::is_bone_edge)
        .map(|profile| profile.halfway_hu())
        .collect();
    let edges = halfway.len();
    if edges < MIN_EDGES || (edges as f64) < MIN_PART * of as f64 {
        return Err(SegmentError::FewBoneEdges { edges, of });
    }
    halfway.sort_unstable_by(f64::total_cmp);
    let at = |quarter: usize| halfway[(edges - 1) * quarter / 4].round();
    Ok(EdgeThreshold {
        threshold: HuThreshold::new(at(2))?,
        quartiles_hu: [at(1), at(3)],
        edges,
    })
}

/// A slice in HU, cut to the range of tissue; what is no number is air.
fn grey(volume: &Volume, slice: usize) -> Array2<f64> {
    let cut = |hu: f64| {
        let hu = if hu.is_nan() { GREY_HU[0] } else { hu };
        hu.clamp(GREY_HU[0], GREY_HU[1])
    };
    match volume.voxels() {
        Voxels::I16(hu) => hu.index_axis(Axis(0), slice).mapv(|v| cut(f64::from(v))),
        Voxels::F32(hu) => hu.index_axis(Axis(0), slice).mapv(|v| cut(f64::from(v))),
    }
}

/// Both sides of an edge.
#[derive(Clone, Copy, Debug)]
struct Profile {
    bright_hu: f64,
    dark_hu: f64,
}

impl Profile {
    /// The profile through `pixel`, which is not on the border, along the gradient there.
    fn across(image: &ArrayView2<'_, f64>, (row, column): (usize, usize)) -> Option<Self> {
        let at = |j: usize, i: usize| image[[row + j - 1, column + i - 1]];
        let across = (0..3)
            .map(|j| f64::from(WEIGHTS[j]) * (at(j, 2) - at(j, 0)))
            .sum::<f64>();
        let down = (0..3)
            .map(|i| f64::from(WEIGHTS[i]) * (at(2, i) - at(0, i)))
            .sum::<f64>();
        let length = down.hypot(across);
        if length <= 0.0 {
            return None;
        }
        let direction = [down / length, across / length];
        let from = [row as f64, column as f64];
        let bright_hu = climb(|t| interpolated(image, from, direction, t));
        let dark_hu = -climb(|t| -interpolated(image, from, direction, -t));
        Some(Self { bright_hu, dark_hu })
    }

    /// Whether the dark side is soft tissue, fat or marrow, the bright one being bone.
    fn is_bone_edge(&self) -> bool {
        self.dark_hu > AIR_HU
    }

    fn halfway_hu(&self) -> f64 {
        f64::midpoint(self.bright_hu, self.dark_hu)
    }
}

/// Weights of Sobel's filter across its direction.
const WEIGHTS: [u8; 3] = [1, 2, 1];

/// The last value of `at` from 0 on that is larger than the one before.
fn climb(at: impl Fn(f64) -> f64) -> f64 {
    let mut highest = at(0.0);
    let mut distance = STEP;
    while distance <= REACH {
        let next = at(distance);
        if next <= highest {
            break;
        }
        highest = next;
        distance += STEP;
    }
    highest
}

/// The image `distance` pixels from a place, bilinearly, the border going on outside.
fn interpolated(
    image: &ArrayView2<'_, f64>,
    from: [f64; 2],
    direction: [f64; 2],
    distance: f64,
) -> f64 {
    let (rows, columns) = image.dim();
    let place = |axis: usize, n: usize| {
        let at = (from[axis] + distance * direction[axis]).clamp(0.0, (n - 1) as f64);
        let first = (at as usize).min(n.saturating_sub(2));
        (first, (first + 1).min(n - 1), at - first as f64)
    };
    let (j, next_j, down) = place(0, rows);
    let (i, next_i, across) = place(1, columns);
    let along = |j: usize| image[[j, i]] * (1.0 - across) + image[[j, next_i]] * across;
    along(j) * (1.0 - down) + along(next_j) * down
}

#[cfg(test)]
mod tests {
    use super::*;
    use bonemesh_phantom::{Phantom, scan};
    use bonemesh_task::pool;
    use bonemesh_volume::{Affine, Geometry};
    use ndarray::Array3;
    use std::num::NonZeroUsize;

    fn found(volume: &Volume) -> Result<EdgeThreshold, SegmentError> {
        edge_threshold(volume, &Task::default())
    }

    #[test]
    fn the_threshold_is_halfway_between_soft_tissue_and_bone() {
        // Bodies of 1240 HU in 40 HU.
        for name in [Phantom::SphereShell, Phantom::Tube, Phantom::BoxWithHole] {
            let settings = name.settings();
            for settings in [settings.ideal(), settings] {
                let volume = scan(name, &settings, &Task::default()).unwrap();
                let hu = found(&volume).unwrap().threshold.hu();
                assert!((hu - 640.0).abs() < 15.0, "{name}: {hu} HU");
            }
        }
    }

    #[test]
    fn bone_in_air_has_no_such_edges() {
        let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        let shape = [20, 40, 40];
        let hu = Array3::from_shape_fn(shape, |(_, j, i)| {
            if (10..30).contains(&j) && (10..30).contains(&i) {
                1240_i16
            } else {
                -1000
            }
        });
        let volume = Volume::new(Voxels::I16(hu), Geometry::new(shape, affine).unwrap()).unwrap();
        let error = found(&volume).unwrap_err();
        assert!(matches!(error, SegmentError::FewBoneEdges { edges: 0, of } if of > 1000));
    }

    #[test]
    fn thin_volumes_and_values_that_are_no_numbers_are_no_trouble() {
        let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        for shape in [[1, 1, 1], [3, 1, 7], [2, 2, 2]] {
            let geometry = Geometry::new(shape, affine).unwrap();
            let voxels = Voxels::F32(Array3::from_elem(shape, f32::NAN));
            let error = found(&Volume::new(voxels, geometry).unwrap()).unwrap_err();
            assert!(matches!(error, SegmentError::FewBoneEdges { .. }));
        }
    }

    #[test]
    fn the_threshold_is_the_same_for_any_number_of_threads() {
        let settings = Phantom::Tube.settings().coarser(1.5);
        let volume = scan(Phantom::Tube, &settings, &Task::default()).unwrap();
        let thresholds = [1, 2, 3, 8].map(|n| {
            let pool = pool(NonZeroUsize::new(n)).unwrap();
            pool.install(|| found(&volume).unwrap())
        });
        assert!(thresholds.iter().all(|t| *t == thresholds[0]));
    }
}
