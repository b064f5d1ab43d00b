//! The plane Delaunay triangles of a cloud seen from above.
//!
//! 1. `seen_from_above`: of points one above another, the first.
//! 2. `triangulate`: their Delaunay triangles in the xy plane, points in a scattered order so that
//!    none takes long to find its place.
//! 3. Each corner keeps its own z.

use bonemesh_cloud::PointCloud;
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Cancelled, Task};
use spade::{DelaunayTriangulation, HierarchyHintGenerator, Point2, Triangulation};

use crate::SurfaceError;
use crate::sorted::sorted;

/// A point in the plane and its number in the cloud.
struct Flat {
    place: Point2<f64>,
    point: u32,
}

impl spade::HasPosition for Flat {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.place
    }
}

/// Finds places in logarithmic time.
type Flattened = DelaunayTriangulation<Flat, (), (), (), HierarchyHintGenerator<f64>>;

/// Points inserted between two looks at the cancel switch.
const STRIDE: usize = 256;

/// The Delaunay triangles of `cloud` flattened to its xy plane, all facing up (towards +z).
///
/// Each vertex keeps its own z. Of points one above another, which a stack of like slices is full
/// of, the first is used. The stage is `surface`.
///
/// Promise: seen from above, no point lies in the circle around a triangle, and each edge has one
/// triangle or two.
///
/// Limits: a sheet, never a body: from above there is one surface at most, so of bone that is
/// closed all around only an outline filled with triangles is left, flat where the slices are alike.
/// Points whose coordinates were rounded lie on one line but for that: between them, at the sheet's
/// border, slivers stand upright, which may have no area and pass through others as a file of
/// 32-bit coordinates. It is here because the published study tried it.
///
/// B. Delaunay, *Sur la sphère vide*, 1934.
///
/// # Errors
/// [`SurfaceError::Upright`] where fewer than three points, or only points on one line, are seen
/// from above; [`SurfaceError::Coordinate`], [`SurfaceError::Cancelled`].
pub fn planar_surface(cloud: &PointCloud, task: &Task) -> Result<TriangleMesh, SurfaceError> {
    task.begin("surface", cloud.len());
    let seen = seen_from_above(cloud, task)?;
    let mut plane = Flattened::new();
    for (done, flat) in seen.into_iter().enumerate() {
        task.advance(1)?;
        if done % STRIDE == 0 {
            task.check()?;
        }
        let place = cloud.points_mm()[flat.point as usize];
        plane
            .insert(flat)
            .map_err(|_| SurfaceError::Coordinate { place })?;
    }
    let corners = |face: spade::handles::FaceHandle<'_, _, Flat, _, _, _>| {
        face.vertices().map(|v| v.data().point)
    };
    let triangles: Vec<[u32; 3]> = plane.inner_faces().map(corners).collect();
    if triangles.is_empty() {
        let points = cloud.len();
        return Err(SurfaceError::Upright { points });
    }
    let in_order = |t: &[u32; 3]| {
        let mut sorted = *t;
        sorted.sort_unstable();
        sorted
    };
    let bucket = |t: &[u32; 3]| (256 * in_order(t)[0] as usize / cloud.len()) as u8;
    let triangles = sorted(triangles, bucket, in_order, task)?;
    Ok(TriangleMesh::new(cloud.points_mm().to_vec(), triangles)?.compacted())
}

/// The first point at each place of the plane, in a scattered order that places alone decide.
fn seen_from_above(cloud: &PointCloud, task: &Task) -> Result<Vec<Flat>, Cancelled> {
    let key = |p: &[f64; 3]| [p[0] + 0.0, p[1] + 0.0].map(f64::to_bits);
    let scattered = cloud.points_mm().iter().zip(0..).map(|(p, i)| {
        let [x, y] = key(p);
        let scattered = (x.rotate_left(17) ^ y).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let scattered = (scattered ^ scattered >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (scattered ^ scattered >> 32, [x, y], i)
    });
    let bucket = |of: &(u64, [u64; 2], u32)| (of.0 >> 56) as u8;
    let mut order = sorted(scattered, bucket, |of| *of, task)?;
    order.dedup_by_key(|(_, place, _)| *place);
    let flat = |(_, _, point): (u64, [u64; 2], u32)| {
        let [x, y, _] = cloud.points_mm()[point as usize];
        let place = Point2::new(x + 0.0, y + 0.0);
        Flat { place, point }
    };
    Ok(order.into_iter().map(flat).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::line_model;
    use bonemesh_mesh::check_topology;
    use bonemesh_task::Cancel;
    use proptest::prelude::*;

    #[test]
    fn the_line_model_is_one_flat_bar_for_any_number_of_slices() {
        for count in [1, 2, 10] {
            let mesh = planar_surface(&line_model(count, 5.0), &Task::default()).unwrap();
            let topology = check_topology(&mesh, &Task::default()).unwrap();
            let [low, high] = topology.bounds_mm.unwrap();
            assert!(high[2] - low[2] < 1e-12);
            let bar = 20.0 * 256.0 * 0.4492_f64.powi(2);
            assert!((topology.area_mm2 / bar - 1.0).abs() < 1e-9);
            assert!(topology.manifold && !topology.watertight);
        }
    }

    #[test]
    fn what_has_no_extent_from_above_is_named() {
        let task = Task::default();
        let upright = (0..40)
            .map(|i| [1.0, f64::from(i % 8), f64::from(i)])
            .collect();
        for points in [upright, vec![[1.0; 3]; 5], vec![]] {
            let cloud = PointCloud::from_points(points).unwrap();
            let error = planar_surface(&cloud, &task).unwrap_err();
            assert!(matches!(error, SurfaceError::Upright { .. }));
        }
        let far = vec![[1e70, 0.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0]];
        let error = planar_surface(&PointCloud::from_points(far).unwrap(), &task).unwrap_err();
        assert!(matches!(error, SurfaceError::Coordinate { .. }));
        let cancel = Cancel::default();
        cancel.cancel();
        let error = planar_surface(&line_model(1, 1.0), &Task::new(cancel)).unwrap_err();
        assert!(matches!(error, SurfaceError::Cancelled(_)));
    }

    proptest! {
        #[test]
        fn no_point_lies_in_the_circle_of_a_triangle_and_all_face_up(
            points in prop::collection::vec(prop::array::uniform3(-6..6i32), 3..60),
        ) {
            let points: Vec<[f64; 3]> = points.into_iter().map(|p| p.map(f64::from)).collect();
            let cloud = PointCloud::from_points(points.clone()).unwrap();
            let Ok(mesh) = planar_surface(&cloud, &Task::default()) else { return Ok(()) };
            let topology = check_topology(&mesh, &Task::default()).unwrap();
            prop_assert_eq!((topology.non_manifold_edges, topology.inconsistent_edges), (0, 0));
            for &t in mesh.triangles() {
                let [a, b, c] = mesh.corners_mm(t);
                let at = |p: [f64; 3]| [p[0], p[1], p[0] * p[0] + p[1] * p[1]];
                let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                prop_assert!(turn > 0.0);
                for &p in &points {
                    // Whole numbers this small are exact.
                    use bonemesh_mesh::vector::{cross, dot, minus};
                    let [u, v, w] = [a, b, c].map(|q| minus(at(q), at(p)));
                    prop_assert!(dot(u, cross(v, w)) <= 0.0);
                }
            }
        }
    }
}
