//! Bone surfaces from point clouds, one file a method.

mod alpha;

pub use alpha::{AlphaSurface, alpha_surface};
use bonemesh_delaunay::DelaunayError;
use bonemesh_mesh::MeshError;
use bonemesh_task::Cancelled;

/// Why no surface could be made, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum SurfaceError {
    /// The points cannot be tetrahedralised.
    #[error(transparent)]
    Delaunay(#[from] DelaunayError),
    /// The triangles do not fit the vertices.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Alpha is no length.
    #[error("alpha is {0} mm; it must be a length above 0")]
    Alpha(f64),
    /// No tetrahedron is small enough.
    #[error(
        "no tetrahedron has a circumradius of {alpha_mm} mm or less; raise alpha (the mean distance to 100 neighbours is the default)"
    )]
    NothingKept {
        /// The alpha asked for.
        alpha_mm: f64,
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
