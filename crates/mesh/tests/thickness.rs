//! Wall thickness of bodies whose thickness is known.

#![allow(clippy::unwrap_used, reason = "tests")]

mod shapes;

use std::num::NonZeroUsize;

use bonemesh_mesh::{MeshError, TriangleMesh, TriangleTree, WallThickness, wall_thickness};
use bonemesh_task::{Task, pool};
use shapes::{box_mesh, mesh, together, torus};

fn measure(mesh: &TriangleMesh) -> WallThickness {
    let task = Task::default();
    wall_thickness(&TriangleTree::new(mesh, &task).unwrap(), &task).unwrap()
}

fn thinnest_mm(measured: &WallThickness) -> f64 {
    measured.thinnest.unwrap().thickness_mm
}

/// The same surface seen from the other side.
fn turned(from: &TriangleMesh) -> TriangleMesh {
    let triangles = from.triangles().iter().map(|[a, b, c]| [*a, *c, *b]);
    mesh(from.vertices_mm().to_vec(), triangles.collect())
}

/// A box whose every triangle is cut in four, `times` over.
fn fine_box(low: [f64; 3], high: [f64; 3], times: usize) -> TriangleMesh {
    let mut fine = box_mesh(low, high);
    for _ in 0..times {
        let mut vertices = fine.vertices_mm().to_vec();
        let mut triangles = Vec::new();
        for t in fine.triangles() {
            let corners = fine.corners_mm(*t);
            let middles = [0, 1, 2].map(|i| {
                let (p, q) = (corners[i], corners[(i + 1) % 3]);
                vertices.push([0, 1, 2].map(|axis| f64::midpoint(p[axis], q[axis])));
                vertices.len() as u32 - 1
            });
            let [[a, b, c], [d, e, f]] = [*t, middles];
            triangles.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        fine = mesh(vertices, triangles).merged(&Task::default()).unwrap();
    }
    fine
}

#[test]
fn a_plate_is_as_thick_as_it_is() {
    let plate = fine_box([0.0; 3], [40.0, 30.0, 2.0], 4);
    let measured = measure(&plate);
    let on_faces = plate.vertices_mm().iter().zip(&measured.at_vertex_mm);
    let on_faces = on_faces.filter(|([x, y, _], _)| *x > 3.0 && *x < 37.0 && *y > 3.0 && *y < 27.0);
    let mut count = 0;
    for (place, thickness) in on_faces {
        assert!((thickness - 2.0).abs() < 1e-12, "{place:?}: {thickness}");
        count += 1;
    }
    assert!(count > 100);
    assert!((thinnest_mm(&measured) - 2.0).abs() < 1e-9);
}

#[test]
fn few_triangles_are_enough_for_the_thickness_of_a_plate() {
    let plate = measure(&box_mesh([0.0; 3], [50.0, 50.0, 1.0]));
    assert!((thinnest_mm(&plate) - 1.0).abs() < 1e-12);
    let sides = plate
        .at_triangle_mm
        .iter()
        .filter(|t| (**t - 50.0).abs() < 1e-12);
    assert_eq!(sides.count(), 8);
}

#[test]
fn a_block_has_no_thin_walls_along_its_edges() {
    let measured = measure(&fine_box([0.0; 3], [20.0; 3], 5));
    assert!(thinnest_mm(&measured) > 19.9);
}

#[test]
fn a_step_in_a_plate_is_found() {
    // A plate of 3 mm beside one of 1 mm, as two bodies.
    let thin = fine_box([50.0, 0.0, 0.0], [80.0, 30.0, 1.0], 3);
    let both = together(&fine_box([0.0; 3], [40.0, 30.0, 3.0], 3), &thin);
    let measured = measure(&both);
    assert!(measured.thinnest.unwrap().place_mm[0] >= 50.0);
    assert!((thinnest_mm(&measured) - 1.0).abs() < 1e-9);
}

#[test]
fn the_tube_of_a_torus_is_measured_within_its_limits() {
    let measured = measure(&torus(200, 100));
    for thickness in measured.at_vertex_mm {
        assert!((19.2..20.01).contains(&thickness), "{thickness}");
    }
}

#[test]
fn a_shell_is_as_thick_as_its_wall() {
    let shell = together(
        &fine_box([0.0; 3], [20.0; 3], 3),
        &turned(&fine_box([1.5; 3], [18.5; 3], 3)),
    );
    let measured = measure(&shell);
    assert!((thinnest_mm(&measured) - 1.5).abs() < 1e-9);
    let thin = measured
        .at_vertex_mm
        .iter()
        .filter(|t| (**t - 1.5).abs() < 1e-9);
    assert!(thin.count() > measured.at_vertex_mm.len() / 2);
}

#[test]
fn nothing_lies_opposite_an_open_sheet_or_an_unused_vertex() {
    let sheet = mesh(
        vec![[0.0; 3], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0], [1.0, 1.0, 1.0]],
        vec![[0, 1, 2], [1, 1, 2]],
    );
    let measured = measure(&sheet);
    assert_eq!(measured.at_vertex_mm, [f64::INFINITY; 4]);
    assert_eq!(measured.thinnest, None);
    assert_eq!(measure(&TriangleMesh::default()), WallThickness::default());
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let torus = torus(120, 60);
    let results: Vec<WallThickness> = [1, 2, 3, 8]
        .into_iter()
        .map(|n| {
            pool(NonZeroUsize::new(n))
                .unwrap()
                .install(|| measure(&torus))
        })
        .collect();
    assert!(results.iter().all(|result| *result == results[0]));
}

#[test]
fn a_cancelled_measurement_ends() {
    let (mesh, task) = (torus(60, 40), Task::default());
    let tree = TriangleTree::new(&mesh, &task).unwrap();
    task.cancel().cancel();
    let measured = wall_thickness(&tree, &task);
    assert!(matches!(measured, Err(MeshError::Cancelled(_))));
}
