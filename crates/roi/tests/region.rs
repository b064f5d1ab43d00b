//! Whole regions from meshes made of slices, and selections that cannot give one.

use bonemesh_mesh::{TriangleMesh, check_topology};
use bonemesh_roi::{Region, RoiError, ThicknessMm, select_region};
use bonemesh_task::Task;

type Point = [f64; 3];

/// Contour points of a tube along z, wall 4 mm from radius 16 to 20, centred on `middle`: 0.5 mm
/// along the contours, slices of 1 mm, 32-bit as in a file.
fn tube(middle: Point) -> Vec<Point> {
    let mut points = Vec::new();
    for slice in 0..30 {
        for radius in [16.0, 20.0] {
            let count = (radius * std::f64::consts::TAU / 0.5) as i32;
            points.extend((0..count).map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
                let z = f64::from(slice) - 14.5;
                let offset = [radius * angle.cos(), radius * angle.sin(), z];
                [0, 1, 2].map(|axis| f64::from((middle[axis] + offset[axis]) as f32))
            }));
        }
    }
    points
}

/// Vertices on the outer wall, in the middle slices, within 40 degrees of a direction.
fn patch(points: &[Point], middle: Point, towards: [f64; 2]) -> Vec<u32> {
    (0..)
        .zip(points)
        .filter(|(_, p)| {
            let [x, y, z] = [p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]];
            let radius = x.hypot(y);
            radius > 19.0
                && z.abs() < 8.0
                && (x * towards[0] + y * towards[1]) / radius > 40.0_f64.to_radians().cos()
        })
        .map(|(vertex, _)| vertex)
        .collect()
}

fn region(points: &[Point], selected: &[u32], thickness_mm: f64) -> Result<Region, RoiError> {
    let mesh = TriangleMesh::new(points.to_vec(), vec![]).expect("points are finite");
    let thickness = ThicknessMm::new(thickness_mm)?;
    select_region(&mesh, selected, thickness, &Task::default())
}

#[test]
fn the_region_of_a_tube_is_the_wall_under_the_patch() {
    let middle = [60.0, -35.0, 700.0];
    let points = tube(middle);
    // Only sideways: of a curved patch that faces along y, the point of largest y is the apex or an
    // end, and the normal is far from the patch's own. That is the method's limit.
    for towards in [[1.0, 0.0], [-1.0, 0.0]] {
        let selected = patch(&points, middle, towards);
        let region = region(&points, &selected, 5.0).unwrap();
        assert_eq!(region.selected, selected.len());
        let inward = region.normal[0] * towards[0] + region.normal[1] * towards[1];
        assert!(inward < -0.9, "{:?}", region.normal);
        let topology = check_topology(&region.mesh, &Task::default()).unwrap();
        assert_eq!(topology.boundary_edges, 0);
        assert!((topology.volume_mm3 / region.volume_mm3 - 1.0).abs() < 1e-6);
        // The sector of the wall between the first and last slice of the patch, which its straight
        // back does not fill completely.
        let sector = 80.0_f64.to_radians() / 2.0 * (400.0 - 256.0) * 15.0;
        let part = region.volume_mm3 / sector;
        assert!((0.6..1.05).contains(&part), "{towards:?}: {part}");
    }
}

#[test]
fn the_vertices_of_a_region_are_vertices_of_the_mesh() {
    let middle = [60.0, -35.0, 700.0];
    let points = tube(middle);
    let selected = patch(&points, middle, [1.0, 0.0]);
    let region = region(&points, &selected, 5.0).unwrap();
    assert!(region.kept_points > 0 && region.tetrahedra > 0);
    assert!(region.mesh.vertices_mm().len() <= region.selected + region.kept_points);
    for vertex in region.mesh.vertices_mm() {
        assert!(points.contains(vertex));
    }
}

#[test]
fn the_region_is_the_same_for_any_number_of_threads_and_any_order() {
    let points = tube([0.0; 3]);
    let mut selected = patch(&points, [0.0; 3], [1.0, 0.0]);
    let expected = region(&points, &selected, 5.0).unwrap();
    selected.reverse();
    selected.extend_from_within(..5);
    for threads in [1, 3] {
        let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
        let found = pool.install(|| region(&points, &selected, 5.0)).unwrap();
        assert_eq!(found, expected);
    }
}

#[test]
fn a_selection_that_gives_no_region_says_why() {
    let points = tube([0.0; 3]);
    let selected = patch(&points, [0.0; 3], [1.0, 0.0]);
    let refused = |selected: &[u32], thickness| region(&points, selected, thickness).unwrap_err();
    assert!(matches!(refused(&[], 5.0), RoiError::NoSelection));
    assert!(matches!(refused(&[7, 7], 5.0), RoiError::OneVertex));
    assert!(matches!(
        refused(&[7, 8, u32::MAX], 5.0),
        RoiError::Index { .. }
    ));
    assert!(matches!(refused(&selected, 0.0), RoiError::Thickness(_)));
    assert!(matches!(refused(&selected, -1.0), RoiError::Thickness(_)));
    // Thinner than a contour step: nothing lies within.
    let nothing = refused(&selected, 0.01);
    assert!(matches!(nothing, RoiError::NothingBehind { .. }));
    assert!(nothing.to_string().contains("0.01 mm"));
    let slice = points.len() as u32 / 30;
    let upright: Vec<u32> = (0..5).map(|k| k * slice).collect();
    assert!(matches!(
        refused(&upright, 5.0),
        RoiError::NoSecondPoint { .. }
    ));
}

#[test]
fn a_mesh_without_slices_is_refused() {
    let mut points = tube([0.0; 3]);
    let selected = patch(&points, [0.0; 3], [1.0, 0.0]);
    // Tilted by a degree, as a mesh that was turned would be.
    for point in &mut points {
        point[2] += 0.017 * point[1];
    }
    let error = region(&points, &selected, 5.0).unwrap_err();
    assert!(matches!(error, RoiError::NoLevels { .. }), "{error}");
    assert!(error.to_string().contains("method alpha"), "{error}");
}

#[test]
fn a_cancelled_search_says_so() {
    let points = tube([0.0; 3]);
    let selected = patch(&points, [0.0; 3], [1.0, 0.0]);
    let mesh = TriangleMesh::new(points, vec![]).unwrap();
    let task = Task::default();
    task.cancel().cancel();
    let thickness = ThicknessMm::new(5.0).unwrap();
    let error = select_region(&mesh, &selected, thickness, &task).unwrap_err();
    assert!(matches!(error, RoiError::Cancelled(_)));
}
