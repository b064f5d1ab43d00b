//! What lies below the patch, or on it, along the surface's own normals.
//!
//! How far each node is inside is the least of its distances from the lid, the bottom and the sides.
//! Blocks of nodes that are far from all of these, on one side or the other, are not looked at node by node.

use bonemesh_task::Task;
use rayon::prelude::*;

use super::lattice::Lattice;
use super::sheet::{Lookup, Seen};
use crate::RoiError;
use crate::vector::Vector;

/// Nodes along a block's side.
const BLOCK: usize = 4;
/// How much faster than a place the nearest place of the patch moves, at most: below a curled patch it
/// does so.
const MOST_SLOPE: f64 = 3.0;

/// What is inside, by depth below the patch.
pub(super) struct Below<'a> {
    pub(super) sheet: Lookup<'a>,
    /// Where it begins (mm), below 0 above the patch.
    pub(super) top_mm: f64,
    /// Where it ends (mm) at the latest.
    pub(super) bottom_mm: f64,
    /// The bone that it must keep a distance (mm) from.
    pub(super) kept_off: Option<(Lookup<'a>, f64)>,
}

impl Below<'_> {
    /// How far (mm) each node is inside, below 0 outside.
    pub(super) fn values(&self, lattice: &Lattice, task: &Task) -> Result<Vec<f32>, RoiError> {
        let [columns, rows, slices] = lattice.shape;
        let blocks = [columns, rows].map(|nodes| nodes.div_ceil(BLOCK));
        task.begin("cutter", slices.div_ceil(BLOCK));
        // Where nothing is near, any value below 0 will do.
        let mut values = vec![-1.0_f32; columns * rows * slices];
        values
            .par_chunks_mut(columns * rows * BLOCK)
            .enumerate()
            .try_for_each(|(layer, values)| {
                for block in 0..blocks[0] * blocks[1] {
                    task.check()?;
                    let first = [block % blocks[0], block / blocks[0], layer].map(|b| b * BLOCK);
                    self.fill_block(lattice, first, values);
                }
                task.advance(1)
            })?;
        Ok(values)
    }

    /// Fills one block of a layer of blocks.
    fn fill_block(&self, lattice: &Lattice, first: [usize; 3], values: &mut [f32]) {
        let [columns, rows, _] = lattice.shape;
        let reach_mm = self.bottom_mm.max(-self.top_mm) + 2.0 * lattice.step_mm;
        let half = BLOCK as f64 / 2.0;
        let around_mm = half * lattice.step_mm * 3.0_f64.sqrt();
        let middle = lattice.place(first.map(|node| node + BLOCK / 2));
        let Some(seen) = self.sheet.see(middle, reach_mm + around_mm) else {
            return;
        };
        let is_beyond = seen.depth_mm < self.top_mm - around_mm
            || seen.depth_mm > self.bottom_mm + around_mm
            || seen.inside_mm < -MOST_SLOPE * around_mm;
        if is_beyond {
            return;
        }
        let slices = values.len() / (columns * rows);
        let end = [columns, rows, first[2] + slices];
        let range = |axis: usize| first[axis]..(first[axis] + BLOCK).min(end[axis]);
        let is_within = self.kept_off.is_none()
            && seen.depth_mm > self.top_mm + around_mm
            && seen.depth_mm < seen.bottom_mm - MOST_SLOPE * around_mm
            && seen.inside_mm > MOST_SLOPE * around_mm;
        if is_within {
            for k in range(2) {
                for j in range(1) {
                    let row = ((k - first[2]) * rows + j) * columns;
                    values[row + first[0]..row + range(0).end].fill(1.0);
                }
            }
            return;
        }
        for k in range(2) {
            for j in range(1) {
                let mut within_mm = reach_mm;
                for i in range(0) {
                    let place = lattice.place([i, j, k]);
                    let seen = self.sheet.see(place, within_mm);
                    // The next node is at most a step further away.
                    within_mm = seen.map_or(reach_mm, |seen| {
                        reach_mm.min((seen.away_mm + lattice.step_mm) * (1.0 + 1e-9))
                    });
                    if let Some(seen) = seen {
                        let inside = self.inside(place, &seen, reach_mm, lattice.step_mm);
                        values[((k - first[2]) * rows + j) * columns + i] = inside as f32;
                    }
                }
            }
        }
    }

    fn inside(&self, place: Vector, seen: &Seen, reach_mm: f64, step_mm: f64) -> f64 {
        let depth = seen.depth_mm;
        let inside = (depth - self.top_mm)
            .min(seen.bottom_mm - depth)
            .min(seen.inside_mm);
        match &self.kept_off {
            // Next to the inside the value decides where between nodes the surface is.
            Some((bone, distance_mm)) if inside > -2.0 * step_mm => {
                let seen = bone.see(place, reach_mm);
                let above = seen.map_or(reach_mm, |seen| -seen.depth_mm);
                inside.min(above - distance_mm)
            }
            _ => inside,
        }
    }
}
