//! The surface of the function whose gradient fits the normals best: screened Poisson.
//!
//! 1. `samples`: each point with its normal, the piece of surface that it stands for and the size of
//!    the cells that its neighbours' distances allow.
//! 2. `splat`: the normals, spread over cells of that size, are the gradient that is wanted.
//! 3. `solve`: the function of that gradient that is one half at the points, by conjugate gradients
//!    with a multigrid cycle in each step.
//! 4. The surface at the mean value of the function at the points, as an isosurface.

mod grid;
mod samples;
mod solve;
mod splat;

use bonemesh_cloud::{NormalSettings, PointCloud, estimate_normals};
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;
use bonemesh_volume::Affine;

use crate::SurfaceError;
use crate::isosurface::{cut, surface};
use grid::Grid;
use samples::{Sample, samples};
use solve::solve;

/// Least depth: a grid of 8 cells.
const MIN_DEPTH: u32 = 3;
/// Greatest depth: a grid of 256 cells takes some 700 MB.
const MAX_DEPTH: u32 = 8;
/// Greatest scale; beyond, next to nothing of the grid is left for the points.
const MAX_SCALE: f64 = 10.0;

/// How finely and how widely the function is solved for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoissonSettings {
    /// The cube around the points has 2 to the power of this many cells along each side; 3 to 8.
    pub depth: u32,
    /// Side of that cube over the longest side of the points' bounding box, from 1 to 10.
    pub scale: f64,
    /// How normals are estimated.
    pub normals: NormalSettings,
}

impl Default for PoissonSettings {
    /// Those of the published study: depth 8, scale 1.1.
    fn default() -> Self {
        Self {
            depth: 8,
            scale: 1.1,
            normals: NormalSettings::default(),
        }
    }
}

/// The screened Poisson surface of `cloud`, outward-oriented.
///
/// Promise: a closed 2-manifold; where it meets the cube around the points, it is closed there.
///
/// Limits: the grid is regular, not an octree: its cells are 1 / 2^depth of the cube, finer detail
/// is lost, and memory grows by 8 with each step of depth (some 700 MB at 8). `Open3D` and the
/// authors' own program refine an octree instead; their surfaces are close to this one, not equal.
/// It is closed at any price: over holes, and away from the points, it follows nothing but
/// smoothness. One slice gives a sheet across the cube; slices far apart, layers that need not join.
/// It is no better than the estimated normals.
///
/// M. Kazhdan, H. Hoppe, *Screened Poisson surface reconstruction*, 2013. The stages are those of
/// [`estimate_normals`], `solve` and `surface`.
///
/// # Errors
/// [`SurfaceError::Depth`], [`SurfaceError::Scale`], [`SurfaceError::Cloud`] for clouds too small
/// for normals, [`SurfaceError::NoDistance`] where all points share one place,
/// [`SurfaceError::NothingEnclosed`], [`SurfaceError::Cancelled`].
pub fn poisson(
    cloud: &PointCloud,
    settings: &PoissonSettings,
    task: &Task,
) -> Result<TriangleMesh, SurfaceError> {
    if !(MIN_DEPTH..=MAX_DEPTH).contains(&settings.depth) {
        return Err(SurfaceError::Depth(settings.depth));
    }
    if !(1.0..=MAX_SCALE).contains(&settings.scale) {
        return Err(SurfaceError::Scale(settings.scale));
    }
    let grid = Grid::around(cloud.points_mm(), settings.depth, settings.scale)
        .ok_or(SurfaceError::NoDistance)?;
    let normals = estimate_normals(cloud, settings.normals, task)?;
    let samples = samples(cloud.points_mm(), &normals, &grid, settings.normals, task)?;
    let function = solve(&grid, &samples, task)?;
    let level = mean_at(&samples, &grid, &function);
    let n = grid.nodes;
    let affine = Affine::from_axes(
        [grid.cell_mm, 0.0, 0.0],
        [0.0, grid.cell_mm, 0.0],
        [0.0, 0.0, grid.cell_mm],
        grid.origin_mm,
    );
    let value = |[i, j, k]: [usize; 3]| function[(k * n + j) * n + i] - level;
    surface([n; 3], value, cut::linear, &affine, None, task)?.ok_or(SurfaceError::NothingEnclosed)
}

/// Mean of the function at the points, each counting as its piece of the surface.
fn mean_at(samples: &[Sample], grid: &Grid, function: &[f32]) -> f32 {
    let (mut sum, mut area) = (0.0, 0.0);
    for sample in samples {
        sum += sample.area_mm2 * f64::from(sample.on(grid).value(grid.nodes, function));
        area += sample.area_mm2;
    }
    (sum / area) as f32
}

#[cfg(test)]
mod tests;
