//! A surface between bone and air that nowhere only touches itself.
//!
//! Around a vertex, cells form a ball, and the surface there is one disc if the bone among them
//! hangs together through facets, and so does the air. Where every vertex has one disc, the
//! surface is a 2-manifold.
//!
//! 1. `touched`: the vertices of the boundary with more than one fan of triangles.
//! 2. `Ball::fill`: at each of them, air apart from the rest of the air is filled, and bone apart
//!    from other bone is joined through the least volume of air.
//! 3. What was filled changes the balls of other vertices: look at these again.
//!
//! Air only ever becomes bone, so this ends.

mod ball;
mod fans;

use bonemesh_delaunay::Tetrahedra;
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::points::Grid;
use super::shallow::smooth;
use ball::Ball;

/// The boundary of the bone.
pub(super) struct Surface {
    /// Outward, over points.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Volume of air that became bone.
    pub(super) filled_mm3: f64,
}

/// Smooths the boundary of the cells that are bone by the `shallow` ones, and makes it a
/// 2-manifold. The stage is `surface`.
pub(super) fn surface(
    cells: &[[u32; 4]],
    shallow: &[u32],
    is_bone: &mut [bool],
    grid: &Grid,
    task: &Task,
) -> Result<Surface, Cancelled> {
    task.begin("surface", 4);
    let mut triangles = boundary(cells, is_bone, task)?;
    task.advance(1)?;
    if smooth(cells, shallow, is_bone, &triangles, grid, task)? {
        triangles = boundary(cells, is_bone, task)?;
    }
    task.advance(1)?;
    let mut vertices = fans::touched(&triangles, grid.coordinates.len());
    task.advance(1)?;
    let mut filled_steps = 0;
    let is_touched = !vertices.is_empty();
    while !vertices.is_empty() {
        let mut changed = Vec::new();
        let around = cells_around(cells, &vertices, grid.coordinates.len(), task)?;
        for (&vertex, around) in vertices.iter().zip(&around) {
            task.check()?;
            let ball = Ball::new(vertex, around, cells, grid);
            changed.extend(ball.fill(is_bone));
        }
        filled_steps += changed
            .iter()
            .map(|&c| six_volumes(cells[c as usize], grid))
            .sum::<i64>();
        vertices = changed.iter().flat_map(|&c| cells[c as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
    }
    if is_touched {
        triangles = boundary(cells, is_bone, task)?;
    }
    task.advance(1)?;
    Ok(Surface {
        triangles,
        filled_mm3: filled_steps as f64 / 6.0 * grid.step_mm.powi(3),
    })
}

fn boundary(cells: &[[u32; 4]], is_bone: &[bool], task: &Task) -> Result<Vec<[u32; 3]>, Cancelled> {
    let bone = cells.par_iter().zip(is_bone).filter(|(_, bone)| **bone);
    let cells = bone.map(|(cell, _)| *cell).collect();
    Tetrahedra { cells }.boundary(task)
}

/// The cells that have each of some vertices (ascending), in ascending order.
fn cells_around(
    cells: &[[u32; 4]],
    vertices: &[u32],
    points: usize,
    task: &Task,
) -> Result<Vec<Vec<u32>>, Cancelled> {
    const STRIDE: usize = 1 << 16;
    let mut is_wanted = vec![false; points];
    for &v in vertices {
        is_wanted[v as usize] = true;
    }
    let found: Vec<Vec<u32>> = cells
        .par_chunks(STRIDE)
        .enumerate()
        .map(|(chunk, cells)| {
            task.check()?;
            let is_near = |cell: &[u32; 4]| cell.iter().any(|&v| is_wanted[v as usize]);
            let near = cells.iter().enumerate().filter(|(_, cell)| is_near(cell));
            Ok(near.map(|(i, _)| (chunk * STRIDE + i) as u32).collect())
        })
        .collect::<Result<_, Cancelled>>()?;
    let mut around = vec![Vec::new(); vertices.len()];
    for c in found.into_iter().flatten() {
        for v in cells[c as usize] {
            if let Ok(place) = vertices.binary_search(&v) {
                around[place].push(c);
            }
        }
    }
    Ok(around)
}

/// Six times the volume of a cell in steps of the grid.
fn six_volumes([a, b, c, d]: [u32; 4], grid: &Grid) -> i64 {
    let at = |v: u32| grid.coordinates[v as usize].map(i64::from);
    let start = at(a);
    let [u, v, w] = [b, c, d].map(|p| {
        let p = at(p);
        [0, 1, 2].map(|k| p[k] - start[k])
    });
    u[0] * (v[1] * w[2] - v[2] * w[1])
        + u[1] * (v[2] * w[0] - v[0] * w[2])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}
