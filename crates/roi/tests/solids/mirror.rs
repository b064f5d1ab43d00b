//! Planes of symmetry, and what lies on their other side.

use bonemesh_mesh::{Plane, TriangleMesh, TriangleTree};
use bonemesh_roi::{RoiError, counterparts, symmetry_plane};
use bonemesh_task::Task;

use crate::bodies::{body, length, selected, shell, solid, volume_mm3};

/// A head of three different radii with a nose, two ears and, on one side alone, a lump.
fn head() -> TriangleMesh {
    body([22.0, 27.0, 25.0], |[x, y, z]| {
        let ball = |at: [f64; 3], radius: f64| radius - length([x - at[0], y - at[1], z - at[2]]);
        let skull = 16.0 * (1.0 - length([x / 16.0, y / 20.0, z / 18.0]));
        let ears = ball([17.0, 3.0, -2.0], 3.5).max(ball([-17.0, 3.0, -2.0], 3.5));
        let nose = ball([0.0, -20.0, -3.0], 4.0);
        skull.max(ears).max(nose).max(ball([9.0, -9.0, 14.0], 5.0))
    })
}

/// Turned about the axis (1, 2, 3) and shifted.
fn moved(place: [f64; 3], angle: f64) -> [f64; 3] {
    let axis = [1.0, 2.0, 3.0].map(|v| v / 14.0_f64.sqrt());
    let along: f64 = (0..3).map(|i| axis[i] * place[i]).sum();
    let cross = [0, 1, 2].map(|i| {
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        axis[j] * place[k] - axis[k] * place[j]
    });
    [0, 1, 2].map(|i| {
        place[i] * angle.cos() + cross[i] * angle.sin() + axis[i] * along * (1.0 - angle.cos())
    })
}

#[test]
fn the_plane_of_symmetry_is_found_in_a_tilted_head_with_a_lump() {
    let head = head();
    for (angle, shift) in [
        (0.0, [0.0; 3]),
        (0.3, [7.0, -40.0, 900.0]),
        (2.0, [-1.0, 2.0, 3.0]),
    ] {
        let places = head.vertices_mm().iter().map(|v| {
            let turned = moved(*v, angle);
            [0, 1, 2].map(|i| turned[i] + shift[i])
        });
        let tilted = TriangleMesh::new(places.collect(), head.triangles().to_vec()).unwrap();
        let found = symmetry_plane(&tilted, &Task::default()).unwrap();
        let normal = moved([1.0, 0.0, 0.0], angle);
        let cosine: f64 = (0..3).map(|i| normal[i] * found.plane.normal()[i]).sum();
        let degrees = cosine.abs().min(1.0).acos().to_degrees();
        let away = found.plane.above_mm(shift).abs();
        assert!(degrees < 0.3 && away < 0.05, "{degrees} degrees, {away} mm");
        assert!(found.error_mm < 0.1 && found.mean_mm < 0.25, "{found:?}");
    }
}

#[test]
fn a_body_without_symmetry_says_so_by_its_error_and_none_without_area_is_refused() {
    let lump = body([22.0; 3], |[x, y, z]| {
        let ball = |at: [f64; 3], r: f64| r - length([x - at[0], y - at[1], z - at[2]]);
        ball([0.0, 0.0, 0.0], 10.0)
            .max(ball([9.0, 3.0, 1.0], 8.0))
            .max(ball([-2.0, 10.0, 5.0], 7.0))
            .max(ball([3.0, -5.0, 12.0], 6.0))
            .max(ball([-9.0, -8.0, -4.0], 5.0))
    });
    let task = Task::default();
    let found = symmetry_plane(&lump, &task).unwrap();
    assert!(found.mean_mm > 0.3, "{found:?}");
    let none = symmetry_plane(&TriangleMesh::default(), &task);
    assert!(matches!(none, Err(RoiError::NoSymmetry)));
    task.cancel().cancel();
    let cancelled = symmetry_plane(&lump, &task);
    assert!(matches!(cancelled, Err(RoiError::Cancelled(_))));
}

#[test]
fn the_healthy_side_of_a_selection_around_a_defect_has_what_the_defect_lacks() {
    // A hollow head, with a hole through one side.
    let skull =
        |p: [f64; 3], r: f64| r * (1.0 - length([p[0] / r, p[1] / (r + 4.0), p[2] / (r + 2.0)]));
    let head = body([18.0, 22.0, 20.0], |p| {
        let wall = skull(p, 16.0).min(-skull(p, 12.0));
        let hole = if p[0] > 0.0 {
            4.0 - p[1].hypot(p[2])
        } else {
            -1.0
        };
        wall.min(-hole)
    });
    let around = selected(&head, |p| {
        p[0] > 0.0 && p[1].hypot(p[2]) < 8.0 && skull(p, 15.8) < 0.0
    });
    let plane = Plane::new([1.0, 0.0, 0.0], 0.0).unwrap();
    let found = counterparts(&head, &around, &plane, false, &Task::default()).unwrap();
    let [other] = &found.sides[..] else {
        panic!("the selection faces one way");
    };
    assert!(
        other
            .iter()
            .all(|v| head.vertices_mm()[*v as usize][0] < 0.0)
    );
    let template = solid(&head, other, 6.0);
    let whole = solid(&head, &around, 6.0);
    // The hole of 4 mm and its sides, which are bone on the other side.
    let missing = volume_mm3(&template) - volume_mm3(&whole);
    let hole = std::f64::consts::PI * 16.0 * 4.0;
    // Half an edge around the hole's rim and around the selection is as much as a fifth.
    assert!((missing / hole - 1.0).abs() < 0.3, "{missing} of {hole}");
    let back = template.mesh.mirrored(&plane);
    let tree = TriangleTree::new(&back, &Task::default()).unwrap();
    assert!(tree.nearest([16.0, 0.0, 0.0], 0.3).is_some());
    let far = Plane::new([1.0, 0.0, 0.0], 300.0).unwrap();
    let none = counterparts(&head, &around, &far, false, &Task::default());
    assert!(matches!(none, Err(RoiError::NoCounterpart)));
}

#[test]
fn pieces_that_face_other_ways_have_counterparts_of_their_own() {
    let ball = body([11.0; 3], |p| 10.0 - length(p));
    let left: fn([f64; 3]) -> bool = |[x, y, z]| x > 0.0 && (y - 3.0).hypot(z) < 3.0;
    let top: fn([f64; 3]) -> bool = |[x, y, z]| z > 0.0 && (x - 4.0).hypot(y) < 2.0;
    let plane = Plane::new([1.0, 0.0, 0.0], 0.0).unwrap();
    let opposite = |selection: &[u32]| {
        counterparts(&ball, selection, &plane, false, &Task::default()).unwrap()
    };
    let apart = [left, top].map(|is_in| opposite(&selected(&ball, is_in)).sides.remove(0));
    let both = opposite(&selected(&ball, |p| left(p) || top(p)));
    assert_eq!((&both.sides[..], both.left_out), (&apart[..], 0));
    let mirrored = |[x, y, z]: [f64; 3]| [-x, y, z];
    // Gaps of the area are closed up to half a cell beyond the selection.
    for vertex in both.sides.concat() {
        let place = mirrored(ball.vertices_mm()[vertex as usize]);
        let [x, y, z] = place;
        assert!(
            (y - 3.0).hypot(z) < 4.0 || (x - 4.0).hypot(y) < 3.0,
            "{place:?}"
        );
    }
}

#[test]
fn the_inner_side_behind_a_selection_has_no_counterpart_of_its_own_unless_asked_for() {
    let shell = shell();
    let through = selected(&shell, |[x, y, z]| x > 0.0 && y.hypot(z) < 5.0);
    let plane = Plane::new([1.0, 0.0, 0.0], 0.0).unwrap();
    let sides = |with_hidden: bool| {
        counterparts(&shell, &through, &plane, with_hidden, &Task::default()).unwrap()
    };
    assert_eq!((sides(false).sides.len(), sides(false).left_out), (1, 1));
    assert_eq!((sides(true).sides.len(), sides(true).left_out), (2, 0));
}
