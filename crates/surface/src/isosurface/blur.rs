//! How grey the true edge is, given the scan's blur.
//!
//! A scanner blurs the step from soft tissue to bone. Whatever the blur, if it is even, the middle
//! of the two greys lies on the step. A wall thinner than the blur never reaches the bone's grey,
//! though: at half its peak it looks too thick, and a narrow gap too wide.
//!
//! 1. `Blur::of`: the sharpest edges tell the blur, in the slice and across slices: a step by its
//!    contrast and slope, a wall or a gap by its width besides.
//! 2. `level_hu`: a wall's width at half its peak, together with the blur, tells its true width
//!    and so the grey at its true edge (after G. M. Treece et al., *High resolution cortical bone
//!    thickness measurement from clinical CT data*, 2010, with the peak in place of a density that
//!    is assumed).

use std::sync::LazyLock;

use super::edge::Edge;
use super::layer;

/// Part of the sharpest edges from which the blur is taken: others are blurred by the bone itself.
const SHARPEST: f64 = 0.3;
/// Part of walls, where there is nothing else: the slope between the steepest samples of one makes
/// it look sharper than it is.
const BLUNTEST: f64 = 0.8;
/// Edges with less of their direction across slices count as lying in the slice, with more as
/// lying across.
const ACROSS: (f32, f32) = (0.3, 0.8);
/// Width, in standard deviations of the blur, from which a wall's shape tells the blur.
const SURE_WIDTH: f32 = 1.8;
/// Steps without a layer look so much broader than the blur says, which the sharpest ones told:
/// measured on a phantom head at faces of bone towards its sinuses.
const BROADER: f32 = 1.25;
/// Fewer edges tell nothing.
const LEAST_EDGES: usize = 30;
/// Edges looked at.
const SAMPLES: usize = 1 << 16;

/// Standard deviation of the scan's blur in voxels, squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Blur {
    in_slice: f32,
    across_slices: f32,
}

impl Blur {
    /// Of any edges; `None` where there are too few.
    pub(super) fn of(edges: &[Vec<Edge>]) -> Option<Self> {
        let count: usize = edges.iter().map(Vec::len).sum();
        let stride = count.div_ceil(SAMPLES).max(1);
        let sharpest = |is_wanted: &dyn Fn(f32) -> bool| {
            let sampled = edges.iter().flatten().step_by(stride);
            let wanted = sampled.filter(|e| is_wanted(e.across_slices));
            let (steps, walls): (Vec<&Edge>, Vec<&Edge>) =
                wanted.partition(|e| e.wall.is_none() && e.gap.is_none());
            let steps = quantile(steps.iter().map(|e| step_variance(e)), SHARPEST);
            steps.or_else(|| quantile(walls.iter().filter_map(|e| wall_variance(e)), BLUNTEST))
        };
        let in_slice = sharpest(&|across| across < ACROSS.0);
        let across_slices = sharpest(&|across| across > ACROSS.1);
        Some(Self {
            in_slice: in_slice.or(across_slices)?,
            across_slices: across_slices.or(in_slice)?,
        })
    }

    /// Standard deviation along an edge's profile, in voxels.
    fn along(self, edge: &Edge) -> f32 {
        let across = edge.across_slices * edge.across_slices;
        (self.in_slice + across * (self.across_slices - self.in_slice)).sqrt()
    }
}

/// The value below which `part` of the values are; `None` of too few.
fn quantile(values: impl Iterator<Item = f32>, part: f64) -> Option<f32> {
    let mut values: Vec<f32> = values.collect();
    let place = (values.len() as f64 * part) as usize;
    (values.len() >= LEAST_EDGES).then(|| *values.select_nth_unstable_by(place, f32::total_cmp).1)
}

/// The variance, in voxels, of the blur that made an edge out of a step.
fn step_variance(edge: &Edge) -> f32 {
    let length = edge.contrast_hu() / edge.slope;
    length * length / std::f32::consts::TAU
}

/// The same of a wall or a gap; `None` where it is too thin to tell, since of the thinnest ones a
/// little noise says anything.
fn wall_variance(edge: &Edge) -> Option<f32> {
    let width = edge.wall.xor(edge.gap)?;
    let sharpness = width * edge.slope / edge.contrast_hu();
    let wall = WALLS.iter().find(|wall| wall.sharpness >= sharpness)?;
    let deviation = width / wall.half_peak_width;
    (wall.width >= SURE_WIDTH).then_some(deviation * deviation)
}

/// The grey at the true edge, HU; `has_soft_tissue` tells whether layers of it may hide (`layer`).
pub(super) fn level_hu(edge: &Edge, blur: Option<Blur>, has_soft_tissue: bool) -> f32 {
    let Some(blur) = blur else {
        return edge.low_hu + 0.5 * edge.contrast_hu();
    };
    let deviation = blur.along(edge);
    let part = |width: Option<f32>| width.map_or(0.5, |w| part_at_edge(w / deviation));
    // Of a thin wall beside a narrow gap the thinner one says more.
    let (wall, gap) = (part(edge.wall), part(edge.gap));
    let part = if wall > gap { wall } else { 1.0 - gap };
    // How far the bone's own step reaches below its grey.
    let contrast_hu = match edge.layer {
        Some(apart) if has_soft_tissue => {
            let soft = (layer::SOFT_HU - edge.low_hu) / edge.contrast_hu();
            2.0 * (1.0 - layer::part_at_edge(soft, apart / (BROADER * deviation)))
                * edge.contrast_hu()
        }
        _ => edge.contrast_hu(),
    };
    edge.high_hu - (1.0 - part) * contrast_hu
}

/// The grey at the edge of a blurred wall, as a part of its peak, by its width at half the peak
/// in standard deviations of the blur.
fn part_at_edge(half_peak_width: f32) -> f32 {
    let table = &*WALLS;
    let place = table.partition_point(|wall| wall.half_peak_width <= half_peak_width);
    let Some(high) = table.get(place) else {
        return 0.5;
    };
    let Some(low) = place.checked_sub(1).map(|i| &table[i]) else {
        return high.part_at_edge;
    };
    let part =
        (half_peak_width - low.half_peak_width) / (high.half_peak_width - low.half_peak_width);
    low.part_at_edge + part * (high.part_at_edge - low.part_at_edge)
}

/// What a wall looks like after a Gaussian blur of standard deviation 1.
struct Wall {
    width: f32,
    half_peak_width: f32,
    /// Steepest change as a part of the peak, times the width at half the peak.
    sharpness: f32,
    part_at_edge: f32,
}

/// Walls from the thinnest whose width can be told from a thinner one's, to those with a plateau.
static WALLS: LazyLock<Vec<Wall>> =
    LazyLock::new(|| (20..=160).map(|i| Wall::of(f64::from(i) / 20.0)).collect());

impl Wall {
    fn of(width: f64) -> Self {
        let below = |x: f64| 0.5 * (1.0 + libm::erf(x / std::f64::consts::SQRT_2));
        let grey = |x: f64| below(x + width / 2.0) - below(x - width / 2.0);
        let peak = grey(0.0);
        let (mut inside, mut outside) = (0.0, width + 4.0);
        for _ in 0..60 {
            let middle = f64::midpoint(inside, outside);
            if grey(middle) > 0.5 * peak {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        let bell = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
        let slope = |x: f64| bell(x - width / 2.0) - bell(x + width / 2.0);
        let steepest = (0..400)
            .map(|i| slope(f64::from(i) * 0.015))
            .fold(0.0, f64::max);
        Self {
            width: width as f32,
            half_peak_width: 2.0 * inside as f32,
            sharpness: (2.0 * inside * steepest / peak) as f32,
            part_at_edge: (grey(width / 2.0) / peak) as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thick_walls_are_cut_at_half_and_thin_ones_nearer_their_peak() {
        assert!((part_at_edge(9.0) - 0.5).abs() < 1e-3);
        // A wall of 2.5 standard deviations: 0.4938 at its edge, 0.7887 at its peak.
        let wall = Wall::of(2.5);
        assert!((wall.part_at_edge - 0.626).abs() < 1e-3);
        assert!((part_at_edge(wall.half_peak_width) - 0.626).abs() < 1e-3);
        assert!(part_at_edge(0.1) > 0.85);
    }
}
