//! The grey of the true edge near every voxel of it: the threshold that the surface follows.
//!
//! 1. `edges`: on the surface of the threshold that was asked for, find the edges (`edge`) and the
//!    grey at their true places (`blur`, `layer`).
//! 2. `spread`: each voxel within reach of an edge takes the weighted mean of the greys around
//!    it; elsewhere the threshold that was asked for stays.
//!
//! The surface of grey minus this level is a surface of voxels like any other: closed, without
//! folds, whatever the levels are.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::blur::{Blur, level_hu};
use super::cut;
use super::edge::{Edge, edge_near};
use super::grey::{Grey, Voxel};
use super::layer;
use super::march::cut_edges;
use super::signs::Signs;

/// How far an edge's grey is spread along the surface, in voxels of a slice.
const SPREAD: f32 = 2.5;
/// Least and greatest spread along slices, in slices.
const SPREAD_SLICES: (f32, f32) = (1.5, 2.5);
/// Part of an edge beyond its own ends in which its grey still counts.
const BEYOND: f32 = 1.15;
/// Weight of the threshold that was asked for: that of an edge of so many HU.
const THRESHOLD_WEIGHT: f32 = 2.0;
/// Contrast of an edge where none was found, HU: soft tissue to bone.
const THRESHOLD_CONTRAST_HU: f32 = 1000.0;

/// Grey above the level as a part of the edge's contrast, voxel by voxel: positive inside, from
/// -0.5 to 0.5 across an edge, lower where something darker lies beyond it.
pub(super) fn above_level<T: Voxel>(
    grey: &Grey<'_, T>,
    above_threshold_hu: impl Fn([usize; 3]) -> f32 + Sync,
    voxel_mm: [f32; 3],
    steepest: impl Fn([f32; 3]) -> [f32; 3] + Sync,
    task: &Task,
) -> Result<Vec<f32>, Cancelled> {
    let shape = grey.shape();
    task.begin("edges", 2 * shape[2] + 1);
    let edges = edges(grey, &above_threshold_hu, steepest, task)?;
    let blur = Blur::of(&edges);
    let has_soft_tissue = layer::has_soft_tissue(&edges);
    let level_hu = |edge: &Edge| level_hu(edge, blur, has_soft_tissue);
    let sources = by_slice(&edges, level_hu, shape[2]);
    drop(edges);
    let reach = reach(voxel_mm);
    let mut above = vec![0.0; shape.iter().product()];
    above
        .par_chunks_mut(shape[0] * shape[1])
        .enumerate()
        .try_for_each(|(k, slice)| {
            task.advance(1)?;
            let sums = spread(&sources, k, shape, reach);
            for (place, (value, sum)) in slice.iter_mut().zip(sums).enumerate() {
                let at = [place % shape[0], place / shape[0], k];
                let hu = grey.at(at);
                *value = sum.above(hu, hu - above_threshold_hu(at));
            }
            Ok(())
        })?;
    Ok(above)
}

/// The edges near the threshold's surface, slice by slice.
fn edges<T: Voxel>(
    grey: &Grey<'_, T>,
    above_threshold_hu: impl Fn([usize; 3]) -> f32 + Sync,
    steepest: impl Fn([f32; 3]) -> [f32; 3] + Sync,
    task: &Task,
) -> Result<Vec<Vec<Edge>>, Cancelled> {
    let shape = grey.shape();
    let signs = Signs::of(shape, |at| above_threshold_hu(at) > 0.0, task)?;
    (0..signs.slices())
        .into_par_iter()
        .map(|k| {
            task.advance(1)?;
            let mut edges = Vec::new();
            cut_edges(&signs, k, |node, axis| {
                if !is_looked_at(node, axis) {
                    return;
                }
                let Some([a, b]) = cut::voxels(node, axis, shape) else {
                    return;
                };
                let part = cut::linear(above_threshold_hu(a), above_threshold_hu(b));
                let gradient = grey.gradient_between(a, b, part);
                let place = cut::place(a, axis, part);
                edges.extend(edge_near(grey, place, gradient, &steepest));
            });
            Ok(edges)
        })
        .collect()
}

/// Whether a cut's edge is looked at. Half of them are enough, since neighbours show much the same;
/// they are scattered, as a pattern would leave out whole surfaces that run along it.
fn is_looked_at([i, j, k]: [usize; 3], axis: usize) -> bool {
    let place = (i as u64) << 42 ^ (j as u64) << 22 ^ (k as u64) << 2 ^ axis as u64;
    // Fibonacci hashing: the golden ratio scatters any number over its top bit.
    place.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 63 == 0
}

/// How far a grey is spread along columns, rows and slices, in voxels.
fn reach(voxel_mm: [f32; 3]) -> [f32; 3] {
    let spread_mm = SPREAD * f32::midpoint(voxel_mm[0], voxel_mm[1]);
    let (least, greatest) = SPREAD_SLICES;
    let [x, y, z] = voxel_mm.map(|mm| spread_mm / mm);
    [x, y, z.clamp(least, greatest)]
}

/// An edge's grey, to be spread around it.
struct Source {
    at: [f32; 3],
    outward: [f32; 3],
    level_hu: f32,
    /// From as far below that level as the bone's grey is above it.
    contrast_hu: f32,
    /// How far it counts inward and outward.
    inner: f32,
    outer: f32,
}

/// The edges of each slice of voxels, in their order.
fn by_slice(
    edges: &[Vec<Edge>],
    level_hu: impl Fn(&Edge) -> f32,
    slices: usize,
) -> Vec<Vec<Source>> {
    let mut by_slice: Vec<Vec<Source>> = (0..slices).map(|_| Vec::new()).collect();
    for edge in edges.iter().flatten() {
        let slice = edge.at[2].round().clamp(0.0, (slices - 1) as f32);
        let level_hu = level_hu(edge);
        by_slice[slice as usize].push(Source {
            at: edge.at,
            outward: edge.outward,
            level_hu,
            contrast_hu: 2.0 * (edge.high_hu - level_hu),
            inner: BEYOND * edge.inner,
            outer: BEYOND * edge.outer,
        });
    }
    by_slice
}

/// Weighted sums over the edges around a voxel.
#[derive(Clone, Copy, Default)]
struct Sum {
    level: f32,
    contrast: f32,
    weight: f32,
}

impl Sum {
    fn above(self, hu: f32, threshold_hu: f32) -> f32 {
        let mean = |sum: f32, otherwise: f32| {
            (sum + THRESHOLD_WEIGHT * otherwise) / (self.weight + THRESHOLD_WEIGHT)
        };
        (hu - mean(self.level, threshold_hu)) / mean(self.contrast, THRESHOLD_CONTRAST_HU)
    }
}

fn spread(sources: &[Vec<Source>], k: usize, shape: [usize; 3], reach: [f32; 3]) -> Vec<Sum> {
    let [columns, rows, slices] = shape;
    let mut sums = vec![Sum::default(); columns * rows];
    let around = reach[2].ceil() as usize + 1;
    let window = k.saturating_sub(around)..(k + around + 1).min(slices);
    // An edge may lie beyond the border, where the border's grey goes on.
    let range = |at: f32, reach: f32, end: usize| {
        let within = |voxel: f32| voxel.clamp(0.0, end as f32) as usize;
        within((at - reach).ceil())..within((at + reach).floor() + 1.0)
    };
    for source in sources[window].iter().flatten() {
        let z = k as f32 - source.at[2];
        let near_z = nearness(z / reach[2]);
        if near_z <= 0.0 {
            continue;
        }
        let (inward, outward) = (1.0 / source.inner, 1.0 / source.outer);
        let across = range(source.at[0], reach[0], columns);
        for j in range(source.at[1], reach[1], rows) {
            let y = j as f32 - source.at[1];
            let near = source.contrast_hu * near_z * nearness(y / reach[1]);
            let row = &mut sums[j * columns..][across.clone()];
            for (i, sum) in across.clone().zip(row) {
                let x = i as f32 - source.at[0];
                let out = source.outward[0] * x + source.outward[1] * y + source.outward[2] * z;
                let part = out * if out > 0.0 { outward } else { inward };
                let weight = near * nearness(x / reach[0]) * nearness(part);
                sum.level += weight * source.level_hu;
                sum.contrast += weight * source.contrast_hu;
                sum.weight += weight;
            }
        }
    }
    sums
}

/// 1 at 0, falling to 0 at a part of 1.
#[inline]
fn nearness(part: f32) -> f32 {
    let rest = (1.0 - part * part).max(0.0);
    rest * rest
}
