//! The divergence of the normals, spread over the grid.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::grid::Grid;
use super::samples::Sample;
use super::solve::prolong;

/// Samples between two looks at the cancel switch.
const STRIDE: usize = 1 << 12;

/// At each node, what flows out of it of the field that points into the body at every sample, as
/// wide as the sample's own cells, for differences between nodes.
pub(super) fn divergence(
    grid: &Grid,
    samples: &[Sample],
    task: &Task,
) -> Result<Vec<f32>, Cancelled> {
    let n = grid.nodes;
    let mut out = vec![0.0f32; n * n * n];
    for axis in 0..3 {
        let field = field(grid, samples, axis, task)?;
        let stride = [1, n, n * n][axis];
        out.par_chunks_mut(n * n)
            .enumerate()
            .try_for_each(|(k, plane)| {
                task.check()?;
                for (place, out) in plane.iter_mut().enumerate() {
                    let node = k * n * n + place;
                    let along = node / stride % n;
                    // Half of what flows through the edges on both sides, each the mean of its ends.
                    if along > 0 {
                        *out += f32::midpoint(field[node - stride], field[node]);
                    }
                    if along + 1 < n {
                        *out -= f32::midpoint(field[node], field[node + stride]);
                    }
                }
                Ok(())
            })?;
    }
    Ok(out)
}

/// One component of the field, times the length of a cell.
fn field(grid: &Grid, samples: &[Sample], axis: usize, task: &Task) -> Result<Vec<f32>, Cancelled> {
    let coarsest = samples.iter().map(|s| s.steps).max().unwrap_or(0);
    let mut field: Vec<f32> = Vec::new();
    for steps in (0..=coarsest).rev() {
        let own = grid.coarser(steps);
        let n = own.nodes;
        let mut finer = vec![0.0f32; n * n * n];
        if !field.is_empty() {
            prolong(&field, &mut finer, n, task)?;
        }
        for (i, sample) in samples.iter().enumerate() {
            if i % STRIDE == 0 {
                task.check()?;
            }
            if sample.steps != steps {
                continue;
            }
            let density = sample.area_mm2 / own.cell_mm.powi(3) * grid.cell_mm;
            let value = (-sample.normal[axis] * density) as f32;
            let place = sample.on(&own);
            for upper in [false, true] {
                let first = (place.cell[2] as usize + usize::from(upper)) * n * n;
                for (node, weight) in place.corners(n, upper) {
                    finer[first + node] += weight * value;
                }
            }
        }
        field = finer;
    }
    Ok(field)
}
