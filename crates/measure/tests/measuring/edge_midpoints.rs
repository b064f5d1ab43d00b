//! The published comparison beside a plain reading of its text.

use crate::bodies::{ball, cuboid};
use bonemesh_measure::edge_midpoints;
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;
use proptest::prelude::*;

/// By the text: all edges against all vertices.
fn by_definition(mesh: &TriangleMesh, reference: &TriangleMesh) -> (f64, f64, usize) {
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for t in mesh.triangles() {
        for side in 0..3 {
            let [a, b] = [t[side], t[(side + 1) % 3]];
            let level = mesh.vertices_mm()[a as usize][2] == mesh.vertices_mm()[b as usize][2];
            let edge = [a.min(b), a.max(b)];
            if a != b && level && !edges.contains(&edge) {
                edges.push(edge);
            }
        }
    }
    let used: std::collections::BTreeSet<u32> =
        reference.triangles().iter().flatten().copied().collect();
    let (mut all, mut means) = (Vec::new(), Vec::new());
    for [a, b] in edges
        .into_iter()
        .map(|e| e.map(|v| mesh.vertices_mm()[v as usize]))
    {
        let middle = [f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1])];
        let half = (b[0] - a[0]).hypot(b[1] - a[1]) / 2.0;
        let mut near: Vec<(f64, f64)> = used
            .iter()
            .map(|v| reference.vertices_mm()[*v as usize])
            .filter(|p| p[2] == a[2])
            .map(|p| {
                let twice = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                (
                    (p[0] - middle[0]).hypot(p[1] - middle[1]),
                    twice.abs() / (2.0 * half),
                )
            })
            .collect();
        near.sort_by(|x, y| x.partial_cmp(y).unwrap());
        near.truncate(10);
        near.retain(|(away, _)| *away <= half * (1.0 + 1e-9));
        if !near.is_empty() {
            let sum: f64 = near.iter().map(|(_, distance)| distance).sum();
            means.push(sum / near.len() as f64);
            all.extend(near.iter().map(|(_, distance)| *distance));
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    (mean(&all), mean(&means), means.len())
}

/// Triangles over scattered places of two levels.
fn scattered(places: &[[f64; 2]]) -> TriangleMesh {
    let vertices: Vec<[f64; 3]> = places
        .iter()
        .enumerate()
        .map(|(i, [x, y])| [*x, *y, if i % 5 < 3 { 0.0 } else { 2.5 }])
        .collect();
    let count = vertices.len() as u32;
    let triangles = (0..count - 2).map(|i| [i, i + 1, i + 2]);
    let more = (0..count).map(|i| [i, (i * 7 + 3) % count, (i * 5 + 1) % count]);
    TriangleMesh::new(vertices, triangles.chain(more).collect()).unwrap()
}

proptest! {
    #[test]
    fn it_is_what_the_text_says(
        mesh in prop::collection::btree_set((0..4000_i32, 0..4000_i32), 6..60),
        reference in prop::collection::btree_set((0..4000_i32, 0..4000_i32), 6..60),
    ) {
        let places = |set: std::collections::BTreeSet<(i32, i32)>| {
            set.into_iter().map(|(x, y)| [f64::from(x) * 0.013, f64::from(y) * 0.007]).collect::<Vec<_>>()
        };
        let (mesh, reference) = (scattered(&places(mesh)), scattered(&places(reference)));
        let found = edge_midpoints(&mesh, &reference, &Task::default()).unwrap();
        let (overall, midpoint, edges) = by_definition(&mesh, &reference);
        prop_assert_eq!(found.edges.len(), edges);
        prop_assert!((found.overall_mm - overall).abs() < 1e-9);
        prop_assert!((found.midpoint_mm - midpoint).abs() < 1e-9);
    }
}

#[test]
fn an_edge_that_skips_one_vertex_is_as_far_as_that_vertex() {
    // The reference's top is a bend of three vertices; the mesh leaves the middle one out.
    let corner = |x: f64, y: f64, z: f64| [x, y, z];
    let reference = TriangleMesh::new(
        vec![
            corner(0.0, 0.0, 1.0),
            corner(2.0, 0.5, 1.0),
            corner(4.0, 0.0, 1.0),
            corner(2.0, 0.0, 0.0),
        ],
        vec![[0, 1, 3], [1, 2, 3]],
    )
    .unwrap();
    let mesh = TriangleMesh::new(
        vec![
            corner(0.0, 0.0, 1.0),
            corner(4.0, 0.0, 1.0),
            corner(2.0, 0.0, 0.0),
        ],
        vec![[0, 1, 2]],
    )
    .unwrap();
    let found = edge_midpoints(&mesh, &reference, &Task::default()).unwrap();
    assert_eq!(found.edges.len(), 1);
    // Both ends at 0 and the middle at 0.5.
    assert!((found.overall_mm - 0.5 / 3.0).abs() < 1e-12);
    assert_eq!(found.edges[0].count, 3);
    assert_eq!(found.edges[0].middle_mm, [2.0, 0.0, 1.0]);
}

#[test]
fn without_common_slices_there_are_no_edges() {
    let (a, b) = (
        cuboid([0.0; 3], [1.0; 3]),
        cuboid([0.0, 0.0, 0.1], [1.0, 1.0, 1.1]),
    );
    let found = edge_midpoints(&a, &b, &Task::default()).unwrap();
    assert!(found.edges.is_empty() && found.overall_mm == 0.0 && found.midpoint_mm == 0.0);
    let itself = edge_midpoints(&a, &a, &Task::default()).unwrap();
    assert!(!itself.edges.is_empty());
}

#[test]
fn the_order_of_vertices_does_not_matter_and_a_cancel_stops_it() {
    let (small, large) = (ball([0.0; 3], 10.0, 12), ball([0.0; 3], 10.0, 24));
    let mut vertices = large.vertices_mm().to_vec();
    vertices.reverse();
    let last = vertices.len() as u32 - 1;
    let triangles = large
        .triangles()
        .iter()
        .map(|t| t.map(|v| last - v))
        .collect();
    let reversed = TriangleMesh::new(vertices, triangles).unwrap();
    let task = Task::default();
    let found = edge_midpoints(&small, &large, &task).unwrap();
    let again = edge_midpoints(&small, &reversed, &task).unwrap();
    assert!(found.overall_mm > 0.0);
    assert!((found.overall_mm - again.overall_mm).abs() < 1e-12);
    task.cancel().cancel();
    assert!(edge_midpoints(&small, &large, &task).is_err());
}
