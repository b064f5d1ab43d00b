//! The body that is cut out with: from just above the patch down to the thickness, with upright sides.
//!
//! 1. `Lattice::around`: a lattice around the patch, fine enough for its size and the thickness.
//! 2. `values`: how far each node is inside of the cutter, the least of the distances from its lid, its
//!    bottom and its sides. Blocks of nodes that are far from the patch are passed over.
//! 3. The surface where that is 0.

use bonemesh_mesh::TriangleMesh;
use bonemesh_surface::level_surface;
use bonemesh_task::Task;
use bonemesh_volume::Affine;
use rayon::prelude::*;

use super::crop::Space;
use super::sheet::Lookup;
use crate::RoiError;
use crate::vector::Vector;

/// Largest and smallest step between nodes (mm).
const STEPS_MM: [f64; 2] = [0.5, 0.08];
/// At least so many steps in the thickness, and in the patch's width.
const IN_THICKNESS: f64 = 5.0;
const IN_WIDTH: f64 = 12.0;
/// Most nodes of a lattice.
const MOST_NODES: f64 = 2e7;
/// Steps that the lid lies above the patch.
const LID_STEPS: f64 = 2.5;
/// Nodes along a block's side.
const BLOCK: usize = 8;
/// How much faster than a place the nearest place of the patch moves, at most: below a curled patch it
/// does so.
const MOST_SLOPE: f64 = 3.0;

/// What is cut, by depth below the patch (mm).
#[derive(Clone, Copy, Debug)]
pub(super) struct Depths {
    /// Where it begins, below 0 above the patch.
    pub(super) top_mm: f64,
    pub(super) bottom_mm: f64,
}

/// Nodes at equal steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    first_mm: Vector,
    step_mm: f64,
    shape: [usize; 3],
}

/// How far apart nodes are for a patch and a thickness.
pub(super) fn step_mm(area_mm2: f64, thickness_mm: f64) -> f64 {
    let [largest, least] = STEPS_MM;
    let step = (thickness_mm / IN_THICKNESS).min(area_mm2.sqrt() / IN_WIDTH);
    step.clamp(least, largest)
}

/// How far above the patch the lid is.
pub(super) fn lid_mm(step_mm: f64) -> f64 {
    LID_STEPS * step_mm
}

impl Lattice {
    /// Fills `space`, with at least `step_mm` between nodes; moved by parts of a step (`shift`).
    pub(super) fn around(space: Space, step_mm: f64, shift: Vector) -> Self {
        let size = [0, 1, 2].map(|axis| space.high[axis] - space.low[axis]);
        let volume = size.iter().product::<f64>();
        let step_mm = step_mm.max((volume / MOST_NODES).cbrt());
        let nodes = |axis: usize| (size[axis] / step_mm).ceil() as usize + 3;
        Self {
            first_mm: [0, 1, 2].map(|axis| space.low[axis] - (1.0 - shift[axis]) * step_mm),
            step_mm,
            shape: [0, 1, 2].map(nodes),
        }
    }

    fn place(&self, node: [usize; 3]) -> Vector {
        [0, 1, 2].map(|axis| self.first_mm[axis] + self.step_mm * node[axis] as f64)
    }
}

/// The cutter's surface, closed and outward-oriented.
///
/// # Errors
/// [`RoiError::NothingCut`] where it has no inside, or the work was cancelled.
pub(super) fn cutter(
    lookup: &Lookup<'_>,
    lattice: &Lattice,
    depths: Depths,
    task: &Task,
) -> Result<TriangleMesh, RoiError> {
    let values = values(lookup, lattice, depths, task)?;
    let step = lattice.step_mm;
    let affine = Affine::from_axes(
        [step, 0.0, 0.0],
        [0.0, step, 0.0],
        [0.0, 0.0, step],
        lattice.first_mm,
    );
    level_surface(&values, lattice.shape, &affine, task)?.ok_or(RoiError::NothingCut)
}

/// How far (mm) each node is inside, below 0 outside.
fn values(
    lookup: &Lookup<'_>,
    lattice: &Lattice,
    depths: Depths,
    task: &Task,
) -> Result<Vec<f32>, RoiError> {
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
                fill_block(lookup, lattice, depths, first, values);
            }
            task.advance(1)
        })?;
    Ok(values)
}

/// Fills one block of a layer of blocks.
fn fill_block(
    lookup: &Lookup<'_>,
    lattice: &Lattice,
    depths: Depths,
    first: [usize; 3],
    values: &mut [f32],
) {
    let [columns, rows, _] = lattice.shape;
    let reach_mm = depths.bottom_mm.max(-depths.top_mm) + 2.0 * lattice.step_mm;
    let half = BLOCK as f64 / 2.0 * lattice.step_mm;
    let middle = lattice.place(first).map(|v| v + half);
    let around_mm = half * 3.0_f64.sqrt();
    let Some(seen) = lookup.see(middle, reach_mm + around_mm) else {
        return;
    };
    let is_beyond = seen.depth_mm < depths.top_mm - around_mm
        || seen.depth_mm > depths.bottom_mm + around_mm
        || seen.inside_mm < -MOST_SLOPE * around_mm;
    if is_beyond {
        return;
    }
    let slices = values.len() / (columns * rows);
    let end = [columns, rows, first[2] + slices];
    let range = |axis: usize| first[axis]..(first[axis] + BLOCK).min(end[axis]);
    for k in range(2) {
        for j in range(1) {
            let mut within_mm = reach_mm;
            for i in range(0) {
                let seen = lookup.see(lattice.place([i, j, k]), within_mm);
                // The next node is at most a step further away.
                within_mm = seen.map_or(reach_mm, |seen| {
                    reach_mm.min((seen.away_mm + lattice.step_mm) * (1.0 + 1e-9))
                });
                let Some(seen) = seen else { continue };
                let depth = seen.depth_mm;
                let inside = (depth - depths.top_mm)
                    .min(depths.bottom_mm - depth)
                    .min(seen.inside_mm);
                values[((k - first[2]) * rows + j) * columns + i] = inside as f32;
            }
        }
    }
}
