//! Exact 3D Delaunay tetrahedra and alpha complexes.

use bonemesh_task::{Cancelled, Task};

/// What cannot be tetrahedralised, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum DelaunayError {
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The points to tetrahedralise.
#[derive(Clone, Copy, Debug)]
pub enum Points<'a> {
    /// Integer coordinates with the metric (Gram matrix of the lattice axes, mm^2).
    Lattice {
        /// Coordinates of each point.
        coordinates: &'a [[i32; 3]],
        /// Squared length of `v` is `v^T gram v`.
        gram: [[f64; 3]; 3],
    },
    /// Free points in mm.
    Free(&'a [[f64; 3]]),
}

/// Tetrahedra over indices of the input points, each positively oriented in the input's coordinates.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Tetrahedra {
    /// Four point indices a cell.
    pub cells: Vec<[u32; 4]>,
}

/// The Delaunay tetrahedra of `points`.
///
/// # Errors
/// see DelaunayError
pub fn tetrahedralize(points: Points<'_>, task: &Task) -> Result<Tetrahedra, DelaunayError> {
    let _ = (points, task);
    todo!()
}

/// The Delaunay tetrahedra with circumradius at most `alpha` (mm).
///
/// # Errors
/// see DelaunayError
pub fn alpha_complex(
    points: Points<'_>,
    alpha: f64,
    task: &Task,
) -> Result<Tetrahedra, DelaunayError> {
    let _ = (points, alpha, task);
    todo!()
}

impl Tetrahedra {
    /// Triangles that bound the cells, outward-oriented (in the input's coordinates).
    pub fn boundary(&self) -> Vec<[u32; 3]> {
        todo!()
    }
}
