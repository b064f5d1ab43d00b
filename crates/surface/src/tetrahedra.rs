//! All Delaunay tetrahedra of a cloud, and the surface around them: its convex hull.

use bonemesh_cloud::PointCloud;
use bonemesh_task::Task;

use crate::{AlphaSurface, SurfaceError, alpha_surface};

/// The surface of all Delaunay tetrahedra of `cloud`: the method with alpha, without alpha.
///
/// The published study made tetrahedra with `Open3D` and turned them into triangles. Each inner
/// facet belongs to two tetrahedra, so what bounds them is the convex hull: it is closed, exact,
/// and right for a body without hollows and dents. [`AlphaSurface::tetrahedra`] counts what fills
/// it; the tetrahedra themselves are those of `bonemesh_delaunay::tetrahedralize`.
///
/// Limits: everything that is not convex is filled, the bore of a bone as well as its orbits.
///
/// # Errors
/// [`SurfaceError::Delaunay`] where the points enclose no space, [`SurfaceError::Cancelled`].
pub fn tetrahedra_surface(cloud: &PointCloud, task: &Task) -> Result<AlphaSurface, SurfaceError> {
    alpha_surface(cloud, f64::INFINITY, task)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{cylinder, line_model};
    use bonemesh_delaunay::DelaunayError;
    use bonemesh_mesh::check_topology;

    #[test]
    fn the_bore_of_a_cylinder_is_filled() {
        let cloud = cylinder(8, 1.0, [50.0, 40.0]);
        let surface = tetrahedra_surface(&cloud, &Task::default()).unwrap();
        let topology = check_topology(&surface.mesh, &Task::default()).unwrap();
        assert!(topology.watertight && topology.manifold);
        let solid = std::f64::consts::PI * (50.0 * 0.4492_f64).powi(2) * 7.0;
        assert!((surface.volume_mm3 / solid - 1.0).abs() < 0.02);
    }

    #[test]
    fn the_line_model_is_its_bar() {
        for slice_mm in [1.0, 5.0] {
            let surface = tetrahedra_surface(&line_model(2, slice_mm), &Task::default()).unwrap();
            let bar = 20.0 * 256.0 * 0.4492_f64.powi(2) * slice_mm;
            assert!((surface.volume_mm3 / bar - 1.0).abs() < 1e-9);
        }
        let error = tetrahedra_surface(&line_model(1, 1.0), &Task::default()).unwrap_err();
        assert!(matches!(
            error,
            SurfaceError::Delaunay(DelaunayError::Coplanar { .. })
        ));
    }
}
