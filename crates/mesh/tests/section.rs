//! Planes through bodies of known shape.

#![allow(clippy::unwrap_used, reason = "tests")]

mod shapes;

use bonemesh_mesh::{Outline, Plane, TriangleMesh, section};
use bonemesh_task::{Task, pool};
use proptest::prelude::*;

fn cut(mesh: &TriangleMesh, normal: [f64; 3], offset_mm: f64) -> Vec<Outline> {
    let plane = Plane::new(normal, offset_mm).unwrap();
    section(mesh, &plane, &Task::default()).unwrap()
}

/// Area within a closed line, counted counter-clockwise seen against the normal.
fn signed_area_mm2(outline: &Outline, normal: [f64; 3]) -> f64 {
    let points = &outline.points_mm;
    let origin = points[0];
    let minus = |a: [f64; 3]| [0, 1, 2].map(|i| a[i] - origin[i]);
    let doubled: f64 = (0..points.len())
        .map(|i| {
            let (a, b) = (minus(points[i]), minus(points[(i + 1) % points.len()]));
            let cross = [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ];
            (0..3).map(|axis| cross[axis] * normal[axis]).sum::<f64>()
        })
        .sum();
    doubled / 2.0
}

/// A cube from 0 to 2 whose faces have a vertex in their middle.
fn cube() -> TriangleMesh {
    let mut vertices: Vec<[f64; 3]> = (0..8)
        .map(|i| [0, 1, 2].map(|axis| f64::from(2 * (i >> axis & 1))))
        .collect();
    let faces = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let mut triangles = Vec::new();
    for face in faces {
        let corners = face.map(|corner: u32| vertices[corner as usize]);
        let middle = [0, 1, 2].map(|axis| corners.iter().map(|c| c[axis]).sum::<f64>() / 4.0);
        let number = vertices.len() as u32;
        vertices.push(middle);
        triangles.extend((0..4).map(|i| [face[i], face[(i + 1) % 4], number]));
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

#[test]
fn a_cube_is_cut_in_a_square_with_the_body_on_the_left() {
    for z in [0.3, 1.0, 1.7] {
        let outlines = cut(&cube(), [0.0, 0.0, 1.0], z);
        assert_eq!(outlines.len(), 1);
        assert!(outlines[0].is_closed);
        assert!(
            outlines[0]
                .points_mm
                .iter()
                .all(|p| (p[2] - z).abs() < 1e-12)
        );
        assert!((signed_area_mm2(&outlines[0], [0.0, 0.0, 1.0]) - 4.0).abs() < 1e-9);
        // Seen from the other side it runs the other way.
        let below = cut(&cube(), [0.0, 0.0, -1.0], -z);
        assert!((signed_area_mm2(&below[0], [0.0, 0.0, -1.0]) - 4.0).abs() < 1e-9);
    }
}

#[test]
fn faces_and_vertices_in_the_plane_neither_open_nor_double_the_line() {
    // The plane holds the top face: its rim. It holds the bottom face: the body only stands on it.
    let top = cut(&cube(), [0.0, 0.0, 1.0], 2.0);
    assert_eq!(top.len(), 1);
    assert!((signed_area_mm2(&top[0], [0.0, 0.0, 1.0]) - 4.0).abs() < 1e-12);
    assert!(cut(&cube(), [0.0, 0.0, 1.0], 0.0).is_empty());
    // Through two opposite edges and the middles of faces: a rectangle of 2 by the root of 8.
    let outlines = cut(&cube(), [1.0, -1.0, 0.0], 0.0);
    assert_eq!(outlines.len(), 1);
    let root = 0.5_f64.sqrt();
    let area = signed_area_mm2(&outlines[0], [root, -root, 0.0]);
    assert!((area - 2.0 * 8.0_f64.sqrt()).abs() < 1e-9, "{area}");
    // A corner that touches from below is a point, and no line.
    assert!(cut(&cube(), [1.0, 1.0, 1.0], 6.0).is_empty());
}

#[test]
fn what_is_hollow_runs_the_other_way() {
    let outer = cube();
    let (mut vertices, mut triangles) = outer.clone().into_parts();
    let inner = outer.vertices_mm().iter().map(|v| v.map(|c| 0.5 + c / 2.0));
    let first = vertices.len() as u32;
    vertices.extend(inner);
    triangles.extend(
        outer
            .triangles()
            .iter()
            .map(|[a, b, c]| [a + first, c + first, b + first]),
    );
    let hollow = TriangleMesh::new(vertices, triangles).unwrap();
    let outlines = cut(&hollow, [0.0, 1.0, 0.0], 1.1);
    let areas: Vec<f64> = outlines
        .iter()
        .map(|o| signed_area_mm2(o, [0.0, 1.0, 0.0]))
        .collect();
    assert_eq!(areas.len(), 2);
    assert!(
        (areas[0] - 4.0).abs() < 1e-9 && (areas[1] + 1.0).abs() < 1e-9,
        "{areas:?}"
    );
}

#[test]
fn an_open_surface_has_open_lines() {
    let (vertices, mut triangles) = cube().into_parts();
    triangles.truncate(20); // without its top
    let open = TriangleMesh::new(vertices, triangles).unwrap();
    let outlines = cut(&open, [1.0, 0.0, 0.0], 0.7);
    assert_eq!(outlines.len(), 1);
    assert!(!outlines[0].is_closed);
    let ends = [outlines[0].points_mm.first(), outlines[0].points_mm.last()];
    assert!(
        ends.into_iter()
            .flatten()
            .all(|p| (p[2] - 2.0).abs() < 1e-12)
    );
}

#[test]
fn triangles_turned_over_do_not_break_the_line() {
    let (vertices, mut triangles) = cube().into_parts();
    triangles[0].reverse();
    triangles[5].reverse();
    triangles.push([0, 0, 6]);
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    let outlines = cut(&mesh, [0.0, 0.0, 1.0], 0.9);
    assert_eq!(outlines.len(), 1);
    assert!(outlines[0].is_closed);
    assert!((signed_area_mm2(&outlines[0], [0.0, 0.0, 1.0]).abs() - 4.0).abs() < 1e-9);
}

#[test]
fn bodies_that_touch_along_an_edge_have_a_line_each() {
    let (mut vertices, mut triangles) = cube().into_parts();
    let first = vertices.len() as u32;
    let moved = cube()
        .vertices_mm()
        .iter()
        .map(|v| [v[0] + 2.0, v[1] + 2.0, v[2]])
        .collect::<Vec<_>>();
    vertices.extend(moved);
    triangles.extend(cube().triangles().iter().map(|t| t.map(|v| v + first)));
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    let mesh = mesh.merged(&Task::default()).unwrap();
    let outlines = cut(&mesh, [0.0, 0.0, 1.0], 1.3);
    let area: f64 = outlines
        .iter()
        .map(|o| signed_area_mm2(o, [0.0, 0.0, 1.0]))
        .sum();
    assert!(outlines.iter().all(|o| o.is_closed));
    assert!((area - 8.0).abs() < 1e-9);
}

#[test]
fn nothing_is_cut_in_nothing() {
    assert!(cut(&TriangleMesh::default(), [0.0, 0.0, 1.0], 0.0).is_empty());
}

proptest! {
    /// On a lattice vertices lie in many planes; lines of a closed body stay closed, and the areas
    /// between parallel planes add up to the volume.
    #[test]
    fn lines_of_a_closed_body_are_closed_and_enclose_what_it_has_there(
        normal in proptest::array::uniform3(-2..=2_i32),
        offset in -4..=8_i32,
    ) {
        prop_assume!(normal != [0; 3]);
        let normal = normal.map(f64::from);
        let mesh = cube();
        let outlines = cut(&mesh, normal, f64::from(offset));
        let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
        let unit = normal.map(|c| c / length);
        prop_assert!(outlines.iter().all(|o| o.is_closed));
        // A convex body has one line, and the same area just below.
        prop_assert!(outlines.len() <= 1);
        let area: f64 = outlines.iter().map(|o| signed_area_mm2(o, unit)).sum();
        let below = cut(&mesh, normal, f64::from(offset) - 1e-9);
        let just_below: f64 = below.iter().map(|o| signed_area_mm2(o, unit)).sum();
        prop_assert!((area - just_below).abs() < 1e-6, "{} {}", area, just_below);
    }
}

#[test]
fn the_lines_are_the_same_for_any_number_of_threads() {
    let mesh = shapes::torus(400, 300);
    let plane = Plane::new([0.2, 0.9, 0.1], 0.5).unwrap();
    let of = |threads: usize| {
        pool(std::num::NonZeroUsize::new(threads))
            .unwrap()
            .install(|| section(&mesh, &plane, &Task::default()).unwrap())
    };
    let one = of(1);
    assert!(one.len() >= 2);
    assert_eq!(one, of(4));
}
