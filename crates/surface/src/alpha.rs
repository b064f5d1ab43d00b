//! The boundary of the regularised alpha complex.
//!
//! 1. Tetrahedralise the cloud and keep the tetrahedra with a circumradius of at most alpha, on
//!    the cloud's lattice where it has one: there the metric is exact, and the many points of
//!    one sphere or plane are told from those that nearly are.
//! 2. Take the facets of exactly one kept tetrahedron, outward.
//! 3. Keep the vertices in use, in the cloud's order.
//!
//! The surface is closed and oriented, but may touch itself in an edge or a vertex. Loose
//! triangles and edges of the full alpha complex (Edelsbrunner and Muecke 1994) are left out:
//! they bound no volume.

use bonemesh_cloud::PointCloud;
use bonemesh_delaunay::{AlphaBoundary, Points};
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;

use crate::SurfaceError;

/// A vertex that no triangle uses.
const UNUSED: u32 = u32::MAX;

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

/// The surface of the Delaunay tetrahedra of `cloud` with a circumradius of at most `alpha_mm`:
/// [`alpha_boundary`], then [`boundary_surface`].
///
/// # Errors
/// Those of both.
pub fn alpha_surface(
    cloud: &PointCloud,
    alpha_mm: f64,
    task: &Task,
) -> Result<AlphaSurface, SurfaceError> {
    let boundary = alpha_boundary(cloud, alpha_mm, task)?;
    boundary_surface(cloud, boundary, task)
}

/// The boundary of the Delaunay tetrahedra of `cloud` with a circumradius of at most `alpha_mm`.
///
/// An infinite alpha keeps them all. The stage is `tetrahedra`.
///
/// # Errors
/// [`SurfaceError::Alpha`], [`SurfaceError::NothingKept`], and [`SurfaceError::Delaunay`] where
/// the points enclose no space.
pub fn alpha_boundary(
    cloud: &PointCloud,
    alpha_mm: f64,
    task: &Task,
) -> Result<AlphaBoundary, SurfaceError> {
    if alpha_mm.is_nan() || alpha_mm <= 0.0 {
        return Err(SurfaceError::Alpha(alpha_mm));
    }
    let boundary = bonemesh_delaunay::alpha_boundary(points(cloud), alpha_mm, task)?;
    if boundary.tetrahedra == 0 {
        return Err(SurfaceError::NothingKept { alpha_mm });
    }
    Ok(boundary)
}

/// The boundary of tetrahedra over the points of `cloud` as a mesh. The stage is `surface`.
///
/// # Errors
/// [`SurfaceError::Cancelled`]
pub fn boundary_surface(
    cloud: &PointCloud,
    boundary: AlphaBoundary,
    task: &Task,
) -> Result<AlphaSurface, SurfaceError> {
    task.begin("surface", 2);
    let volume_mm3 = boundary.volume_mm3(points(cloud));
    let tetrahedra = boundary.tetrahedra;
    let mut triangles = boundary.triangles;
    task.advance(1)?;
    let frame = cloud.lattice().map(|l| &l.frame_from_lattice);
    if frame.is_some_and(|f| f.determinant() < 0.0) {
        // Outward among columns, rows and slices is inward in a frame of the other hand.
        for triangle in &mut triangles {
            triangle.swap(1, 2);
        }
    }
    let vertices_mm = keep_used(cloud.points_mm(), &mut triangles);
    let mesh = TriangleMesh::new(vertices_mm, triangles)?;
    task.advance(1)?;
    Ok(AlphaSurface {
        mesh,
        tetrahedra,
        volume_mm3,
    })
}

/// The cloud as its lattice, where it has one, or as free points.
pub(crate) fn points(cloud: &PointCloud) -> Points<'_> {
    match cloud.lattice() {
        Some(lattice) => Points::Lattice {
            coordinates: &lattice.coordinates,
            gram: lattice.frame_from_lattice.gram(),
        },
        None => Points::Free(cloud.points_mm()),
    }
}

/// The points that triangles name, in order; renumbers the triangles.
fn keep_used(points_mm: &[[f64; 3]], triangles: &mut [[u32; 3]]) -> Vec<[f64; 3]> {
    let mut place = vec![UNUSED; points_mm.len()];
    for &v in triangles.as_flattened() {
        place[v as usize] = 0;
    }
    let mut used = Vec::new();
    for (place, &point) in place.iter_mut().zip(points_mm) {
        if *place != UNUSED {
            *place = used.len() as u32;
            used.push(point);
        }
    }
    for v in triangles.as_flattened_mut() {
        *v = place[*v as usize];
    }
    used
}

#[cfg(test)]
mod tests {
    use super::*;
    use bonemesh_cloud::Lattice;
    use bonemesh_delaunay::DelaunayError;
    use bonemesh_task::Cancel;
    use bonemesh_volume::Affine;
    use proptest::prelude::*;

    /// Lattice points of a thick sphere shell.
    fn shell() -> Vec<[i32; 3]> {
        let side = 21;
        (0..side * side * side)
            .map(|i| [i % side, i / side % side, i / side / side])
            .filter(|p| {
                let r2: i32 = p.iter().map(|v| (v - 10) * (v - 10)).sum();
                (49..=100).contains(&r2)
            })
            .collect()
    }

    fn cloud(coordinates: Vec<[i32; 3]>, frame_from_lattice: Affine) -> PointCloud {
        PointCloud::from_lattice(Lattice {
            coordinates,
            frame_from_lattice,
        })
        .unwrap()
    }

    fn spacing(x: f64, y: f64, z: f64) -> Affine {
        Affine::from_axes(
            [x, 0.0, 0.0],
            [0.0, y, 0.0],
            [0.0, 0.0, z],
            [5.0, -3.0, 8.0],
        )
    }

    /// Volume that the triangles enclose; positive if they face outward.
    fn enclosed_mm3(mesh: &TriangleMesh) -> f64 {
        let cone = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| mesh.vertices_mm()[v as usize]);
            a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        mesh.triangles().iter().map(cone).sum::<f64>() / 6.0
    }

    #[test]
    fn a_surface_faces_outward_in_a_frame_of_either_hand() {
        for affine in [
            spacing(0.5, 0.5, 0.5),
            spacing(0.5, 0.5, -0.5),
            spacing(-0.4, 0.5, 0.6),
            Affine::from_axes([0.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.0, 0.1, 0.5], [0.0; 3]),
        ] {
            let surface = alpha_surface(&cloud(shell(), affine), 1.2, &Task::default()).unwrap();
            let enclosed = enclosed_mm3(&surface.mesh);
            assert!(surface.volume_mm3 > 0.0);
            assert!(
                (enclosed / surface.volume_mm3 - 1.0).abs() < 1e-9,
                "{enclosed}"
            );
        }
    }

    #[test]
    fn every_vertex_is_in_use_and_in_the_order_of_the_cloud() {
        let mut points = shell();
        points.insert(7, [500, 0, 0]);
        let cloud = cloud(points, spacing(0.5, 0.5, 0.5));
        let mesh = alpha_surface(&cloud, 1.2, &Task::default()).unwrap().mesh;
        let mut used = vec![false; mesh.vertices_mm().len()];
        for &v in mesh.triangles().as_flattened() {
            used[v as usize] = true;
        }
        assert!(used.into_iter().all(|u| u));
        let bits = |p: &[f64; 3]| p.map(f64::to_bits);
        let mut points = cloud.points_mm().iter();
        assert!(
            mesh.vertices_mm()
                .iter()
                .all(|v| points.any(|p| bits(p) == bits(v)))
        );
    }

    #[test]
    fn an_infinite_alpha_gives_the_convex_hull() {
        let cube: Vec<[i32; 3]> = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9]).collect();
        let cloud = cloud(cube, spacing(1.0, 1.0, 2.0));
        let hull = alpha_surface(&cloud, f64::INFINITY, &Task::default()).unwrap();
        assert!((hull.volume_mm3 - 16.0).abs() < 1e-12);
        assert!((enclosed_mm3(&hull.mesh) - 16.0).abs() < 1e-9);
    }

    #[test]
    fn what_cannot_be_meshed_is_named() {
        let task = Task::default();
        let sphere = cloud(shell(), spacing(0.5, 0.5, 0.5));
        for alpha in [0.0, -2.0, f64::NAN] {
            let error = alpha_surface(&sphere, alpha, &task).unwrap_err();
            assert!(matches!(error, SurfaceError::Alpha(_)));
        }
        let error = alpha_surface(&sphere, 0.1, &task).unwrap_err();
        assert!(matches!(error, SurfaceError::NothingKept { .. }));
        let plane = cloud(
            vec![[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]],
            spacing(1.0, 1.0, 1.0),
        );
        let error = alpha_surface(&plane, 1.0, &task).unwrap_err();
        assert!(matches!(
            error,
            SurfaceError::Delaunay(DelaunayError::Coplanar { .. })
        ));
        let cancel = Cancel::default();
        cancel.cancel();
        let error = alpha_surface(&sphere, 1.2, &Task::new(cancel)).unwrap_err();
        assert!(matches!(error, SurfaceError::Cancelled(_)), "{error:?}");
    }

    proptest! {
        #[test]
        fn every_surface_is_closed_and_encloses_its_volume(
            points in prop::collection::vec(prop::array::uniform3(0..9i32), 4..120),
            alpha in 0.8..5.0f64,
            z in prop_oneof![Just(1.0), Just(-2.5)],
            free in any::<bool>(),
        ) {
            let mut cloud = cloud(points, spacing(1.0, 1.0, z));
            if free {
                cloud = PointCloud::from_points(cloud.points_mm().to_vec()).unwrap();
            }
            if let Ok(surface) = alpha_surface(&cloud, alpha, &Task::default()) {
                let mut open = std::collections::BTreeMap::new();
                for [a, b, c] in surface.mesh.triangles() {
                    for (u, v) in [(a, b), (b, c), (c, a)] {
                        *open.entry((u.min(v), u.max(v))).or_insert(0) += if u < v { 1 } else { -1 };
                    }
                }
                prop_assert!(open.values().all(|&b| b == 0));
                let enclosed = enclosed_mm3(&surface.mesh);
                prop_assert!((enclosed - surface.volume_mm3).abs() < 1e-6);
            }
        }
    }
}
