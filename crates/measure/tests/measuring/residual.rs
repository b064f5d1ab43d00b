//! The residual volume of bodies for which it is known.

use std::f64::consts::PI;

use crate::bodies::{ball, cuboid, moved, together, turned};
use bonemesh_measure::{MeasureError, mesh_volume_mm3, residual_volume};
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;
use proptest::prelude::*;

/// How exact it is where bodies are made of triangles.
const PART: f64 = 1e-3;

fn residual_mm3(a: &TriangleMesh, b: &TriangleMesh) -> f64 {
    residual_volume(a, b, &Task::default())
        .unwrap()
        .residual_mm3
}

fn assert_near(found: f64, expected: f64, part: f64) {
    assert!(
        (found - expected).abs() <= part * expected.abs() + 1e-9,
        "{found}, not {expected}"
    );
}

#[test]
fn shifted_cubes_have_twice_what_the_shift_leaves_over() {
    let cube = cuboid([0.0; 3], [10.0; 3]);
    for (by, common) in [
        ([0.5, 0.0, 0.0], 950.0),
        ([0.0, -3.0, 0.0], 700.0),
        ([1.0, 2.0, 3.0], 9.0 * 8.0 * 7.0),
        ([1e-3, 0.0, 0.0], 999.9),
        ([10.0, 0.0, 0.0], 0.0),
        ([50.0, 0.0, 0.0], 0.0),
        ([0.0; 3], 1000.0),
    ] {
        let found = residual_volume(&cube, &moved(&cube, by), &Task::default()).unwrap();
        assert_near(found.common_mm3, common, 1e-9);
        assert_near(found.residual_mm3, 2.0 * (1000.0 - common), 1e-6);
        assert_near(found.mesh_mm3, 1000.0, 1e-12);
    }
}

#[test]
fn shifted_spheres_have_what_the_lens_leaves_over() {
    let radius = 20.0;
    let sphere = ball([3.0, -7.0, 100.0], radius, 200);
    for by in [0.1, 1.0, 5.0, 30.0] {
        let other = ball([3.0 + by, -7.0, 100.0], radius, 200);
        // Two caps of the height radius - by / 2.
        let height = radius - by / 2.0;
        let lens = 2.0 * PI * height * height * (3.0 * radius - height) / 3.0;
        let expected = 2.0 * (4.0 / 3.0 * PI * radius.powi(3) - lens);
        assert_near(residual_mm3(&sphere, &other), expected, PART);
    }
}

#[test]
fn coinciding_faces_add_nothing() {
    let cube = cuboid([0.0; 3], [10.0; 3]);
    assert_near(
        residual_mm3(&cube, &cuboid([0.0; 3], [10.0, 10.0, 4.0])),
        600.0,
        1e-9,
    );
    assert_near(
        residual_mm3(&cube, &cuboid([2.0, 0.0, 0.0], [8.0, 10.0, 10.0])),
        400.0,
        1e-9,
    );
    assert_near(
        residual_mm3(&cube, &cuboid([2.0; 3], [8.0; 3])),
        784.0,
        1e-9,
    );
}

#[test]
fn a_hollow_is_not_inside_and_a_mesh_that_faces_inward_is_turned() {
    let cube = cuboid([0.0; 3], [10.0; 3]);
    let hollow = together(&cube, &turned(&cuboid([2.0; 3], [8.0; 3])));
    assert_near(residual_mm3(&cube, &hollow), 216.0, 1e-9);
    assert_near(residual_mm3(&turned(&cube), &hollow), 216.0, 1e-9);
}

#[test]
fn bodies_that_touch_themselves_along_an_edge_are_measured_too() {
    // Two cubes with a common edge, whose vertices are shared.
    let pair = together(
        &cuboid([0.0; 3], [10.0; 3]),
        &cuboid([10.0, 10.0, 0.0], [20.0, 20.0, 10.0]),
    );
    let pair = pair.merged(&Task::default()).unwrap();
    let slab = cuboid([0.0; 3], [20.0, 20.0, 10.0]);
    assert_near(residual_mm3(&pair, &slab), 2000.0, 1e-9);
}

#[test]
fn what_is_open_or_nothing_is_refused_by_its_name() {
    let cube = cuboid([0.0; 3], [10.0; 3]);
    let open =
        TriangleMesh::new(cube.vertices_mm().to_vec(), cube.triangles()[1..].to_vec()).unwrap();
    let refused = |a: &TriangleMesh, b: &TriangleMesh| {
        residual_volume(a, b, &Task::default())
            .unwrap_err()
            .to_string()
    };
    assert!(refused(&open, &cube).contains("the mesh is not closed"));
    assert!(refused(&cube, &open).contains("the reference is not closed"));
    assert!(refused(&TriangleMesh::default(), &cube).contains("no triangle"));
}

#[test]
fn a_cancel_stops_it() {
    let task = Task::default();
    task.cancel().cancel();
    let sphere = ball([0.0; 3], 5.0, 40);
    let error = residual_volume(&sphere, &moved(&sphere, [1.0; 3]), &task).unwrap_err();
    assert!(error.is_cancelled(), "{error}");
    assert!(!MeasureError::Open("mesh").is_cancelled());
}

#[test]
fn a_ball_of_many_triangles_has_nearly_the_volume_of_a_sphere() {
    let found = mesh_volume_mm3(&ball([1e3, 0.0, 0.0], 10.0, 100));
    assert_near(found, 4.0 / 3.0 * PI * 1e3, 2e-3);
    assert_near(
        mesh_volume_mm3(&turned(&ball([0.0; 3], 10.0, 100))),
        -found,
        1e-9,
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn boxes_on_a_lattice_have_what_their_sides_say(
        low in prop::array::uniform3(0..4_i32), sides in prop::array::uniform3(1..4_i32),
        other_low in prop::array::uniform3(0..4_i32), other_sides in prop::array::uniform3(1..4_i32),
    ) {
        let boxed = |low: [i32; 3], sides: [i32; 3]| {
            let high = [0, 1, 2].map(|a| f64::from(low[a] + sides[a]));
            cuboid(low.map(f64::from), high)
        };
        let common: i32 = (0..3)
            .map(|a| {
                let end = (low[a] + sides[a]).min(other_low[a] + other_sides[a]);
                (end - low[a].max(other_low[a])).max(0)
            })
            .product();
        let whole = |sides: [i32; 3]| sides.iter().product::<i32>();
        let expected = f64::from(whole(sides) + whole(other_sides) - 2 * common);
        let found = residual_mm3(&boxed(low, sides), &boxed(other_low, other_sides));
        prop_assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
}
