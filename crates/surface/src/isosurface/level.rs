//! The grey of the true edge near every voxel of it: the threshold that the surface follows.
//!
//! 1. `edges`: on the surface of the threshold that was asked for, find the edges (`edge`) and the
//!    grey at their true places (`blur`).
//! 2. `spread`: each voxel within reach of an edge takes the weighted mean of the greys around
//!    it; elsewhere the threshold that was asked for stays.
//!
//! The surface of grey minus this level is a surface of voxels like any other: closed, without
//! folds, whatever the levels are.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::blur::{Blur, level_hu};
use super::edge::{Edge, edge_near};
use super::grey::Grey;
use super::march::cut_edges;
use super::place_on_edge;
use super::signs::Signs;

/// How far an edge's grey is spread along the surface, in voxels of a slice.
const SPREAD: f32 = 2.5;
/// Least and greatest spread along slices, in slices.
const SPREAD_SLICES: (f32, f32) = (1.5, 2.5);
/// Part of an edge beyond its own ends in which its grey still counts.
const BEYOND: f32 = 1.15;
/// Weight of the threshold that was asked for: that of an edge of so many HU.
const THRESHOLD_WEIGHT: f32 = 2.0;

/// Grey above the level, voxel by voxel: positive inside.
pub(super) fn above_level(
    grey: &Grey<'_>,
    threshold_hu: f32,
    voxel_mm: [f32; 3],
    steepest: impl Fn([f32; 3]) -> [f32; 3] + Sync,
    task: &Task,
) -> Result<Vec<f32>, Cancelled> {
    let shape = grey.shape();
    let signs = Signs::of(shape, |at| grey.at(at) > threshold_hu, task)?;
    task.begin("edges", 2 * shape[2]);
    let edges: Vec<Vec<Edge>> = (0..signs.slices())
        .into_par_iter()
        .map(|k| {
            task.advance(1)?;
            let mut edges = Vec::new();
            cut_edges(&signs, k, |node, axis| {
                let value = |at: [usize; 3]| grey.at(at) - threshold_hu;
                if let Some(place) = place_on_edge(node, axis, shape, value) {
                    edges.extend(edge_near(grey, place, &steepest));
                }
            });
            Ok(edges)
        })
        .collect::<Result<_, Cancelled>>()?;
    drop(signs);
    let blur = Blur::of(&edges);
    let by_slice = by_slice(edges, shape[2]);
    let pixel_mm = f32::midpoint(voxel_mm[0], voxel_mm[1]);
    let (least, greatest) = SPREAD_SLICES;
    let reach = [
        SPREAD * pixel_mm / voxel_mm[0],
        SPREAD * pixel_mm / voxel_mm[1],
        (SPREAD * pixel_mm / voxel_mm[2]).clamp(least, greatest),
    ];
    let mut above = vec![0.0; shape.iter().product()];
    above
        .par_chunks_mut(shape[0] * shape[1])
        .enumerate()
        .try_for_each(|(k, slice)| {
            task.advance(1)?;
            let sums = spread(&by_slice, blur, k, shape, reach);
            for (place, ((value, weighted), weight)) in slice
                .iter_mut()
                .zip(sums.levels)
                .zip(sums.weights)
                .enumerate()
            {
                let level =
                    (weighted + THRESHOLD_WEIGHT * threshold_hu) / (weight + THRESHOLD_WEIGHT);
                *value = grey.at([place % shape[0], place / shape[0], k]) - level;
            }
            Ok(())
        })?;
    Ok(above)
}

/// The edges of each slice of voxels, in their order.
fn by_slice(edges: Vec<Vec<Edge>>, slices: usize) -> Vec<Vec<Edge>> {
    let mut by_slice = vec![Vec::new(); slices];
    for edge in edges.into_iter().flatten() {
        let slice = edge.at[2].round().clamp(0.0, (slices - 1) as f32);
        by_slice[slice as usize].push(edge);
    }
    by_slice
}

/// Sums over the edges around each voxel of a slice.
struct Sums {
    levels: Vec<f32>,
    weights: Vec<f32>,
}

fn spread(
    edges: &[Vec<Edge>],
    blur: Option<Blur>,
    k: usize,
    shape: [usize; 3],
    reach: [f32; 3],
) -> Sums {
    let [columns, rows, slices] = shape;
    let mut sums = Sums {
        levels: vec![0.0; columns * rows],
        weights: vec![0.0; columns * rows],
    };
    let around = reach[2].ceil() as usize + 1;
    let window = k.saturating_sub(around)..(k + around + 1).min(slices);
    let range = |at: f32, reach: f32, end: usize| {
        let first = (at - reach).ceil().max(0.0) as usize;
        first..((at + reach).floor() + 1.0).clamp(0.0, end as f32) as usize
    };
    for edge in edges[window].iter().flatten() {
        let z = k as f32 - edge.at[2];
        let near_z = nearness(z, reach[2]);
        if near_z <= 0.0 {
            continue;
        }
        let (level_hu, contrast_hu) = (level_hu(edge, blur), edge.contrast_hu());
        for j in range(edge.at[1], reach[1], rows) {
            let y = j as f32 - edge.at[1];
            let near_yz = near_z * nearness(y, reach[1]);
            for i in range(edge.at[0], reach[0], columns) {
                let x = i as f32 - edge.at[0];
                let outward = edge.outward[0] * x + edge.outward[1] * y + edge.outward[2] * z;
                let end = if outward > 0.0 {
                    edge.outer
                } else {
                    edge.inner
                };
                let weight =
                    contrast_hu * near_yz * nearness(x, reach[0]) * nearness(outward, BEYOND * end);
                sums.levels[j * columns + i] += weight * level_hu;
                sums.weights[j * columns + i] += weight;
            }
        }
    }
    sums
}

/// 1 at a distance of 0, falling to 0 at `reach`.
#[inline]
fn nearness(distance: f32, reach: f32) -> f32 {
    let part = distance / reach;
    let rest = (1.0 - part * part).max(0.0);
    rest * rest
}
