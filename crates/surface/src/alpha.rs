//! The boundary of the regularised alpha complex.

use bonemesh_cloud::PointCloud;
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;

use crate::SurfaceError;

/// The surface of the kept tetrahedra, and what is said of them.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaSurface {
    /// Boundary of the kept tetrahedra, outward-oriented; only vertices in use.
    pub mesh: TriangleMesh,
    /// How many tetrahedra were kept.
    pub tetrahedra: usize,
    /// Their volume.
    pub volume_mm3: f64,
}

/// The surface of the Delaunay tetrahedra of `cloud` with a circumradius of at most `alpha_mm`.
///
/// # Errors
/// see SurfaceError
pub fn alpha_surface(
    cloud: &PointCloud,
    alpha_mm: f64,
    task: &Task,
) -> Result<AlphaSurface, SurfaceError> {
    let _ = (cloud, alpha_mm, task);
    todo!()
}
