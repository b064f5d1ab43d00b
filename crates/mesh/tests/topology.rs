//! The topology report against shapes that are closed, and shapes broken on purpose.

mod shapes;

use bonemesh_mesh::{MeshError, Topology, TriangleMesh, check_topology};
use bonemesh_task::{Task, pool};
use proptest::prelude::*;
use shapes::{BOX, box_mesh, box_vertices, mesh, together, torus};

const LOW: [f64; 3] = [100.0, -200.0, 30.0];
const HIGH: [f64; 3] = [102.0, -197.0, 34.0];

fn check(mesh: &TriangleMesh) -> Topology {
    check_topology(mesh, &Task::default()).expect("nobody cancels")
}

fn unit_box() -> Vec<[f64; 3]> {
    box_vertices([0.0; 3], [1.0; 3])
}

#[test]
fn a_box_is_closed_and_has_its_volume_and_area() {
    let topology = check(&box_mesh(LOW, HIGH));
    assert!((topology.volume_mm3 - 24.0).abs() < 1e-9);
    assert!((topology.area_mm2 - 52.0).abs() < 1e-9);
    let expected = Topology {
        vertices: 8,
        triangles: 12,
        components: 1,
        watertight: true,
        manifold: true,
        volume_mm3: topology.volume_mm3,
        area_mm2: topology.area_mm2,
        bounds_mm: Some([LOW, HIGH]),
        ..Topology::default()
    };
    assert_eq!(topology, expected);
}

#[test]
fn a_torus_is_closed() {
    let topology = check(&torus(60, 30));
    assert!(topology.watertight && topology.manifold);
    assert_eq!(topology.components, 1);
    // Volume of the round torus, less what flat facets cut off.
    let round = 2.0 * std::f64::consts::PI.powi(2) * 40.0 * 100.0;
    assert!(topology.volume_mm3 < round && topology.volume_mm3 > 0.98 * round);
}

#[test]
fn an_open_box_has_the_rim_of_its_lid_as_boundary() {
    let topology = check(&mesh(unit_box(), BOX[..10].to_vec()));
    assert_eq!(topology.boundary_edges, 4);
    assert!(!topology.watertight && topology.manifold);
    assert_eq!(topology.inconsistent_edges, 0);
}

#[test]
fn a_flipped_triangle_makes_its_three_edges_inconsistent() {
    let mut triangles = BOX.to_vec();
    triangles[5].swap(0, 1);
    let topology = check(&mesh(unit_box(), triangles));
    assert_eq!(topology.inconsistent_edges, 3);
    assert_eq!(topology.boundary_edges, 0);
    assert!(!topology.watertight && topology.manifold);
}

#[test]
fn a_box_turned_inside_out_has_a_negative_volume() {
    let triangles = BOX.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let topology = check(&mesh(unit_box(), triangles));
    assert!((topology.volume_mm3 + 1.0).abs() < 1e-12);
    assert!(topology.watertight);
}

#[test]
fn three_triangles_at_an_edge_are_non_manifold() {
    let vertices = vec![
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, -1.0, 0.0],
    ];
    let topology = check(&mesh(vertices, vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]]));
    assert_eq!(topology.non_manifold_edges, 1);
    assert_eq!(topology.boundary_edges, 6);
    assert_eq!(topology.non_manifold_vertices, 0);
    assert!(!topology.manifold && !topology.watertight);
}

#[test]
fn boxes_that_touch_at_a_corner_share_a_non_manifold_vertex() {
    let boxes = together(&box_mesh([0.0; 3], [1.0; 3]), &box_mesh([1.0; 3], [2.0; 3]))
        .merged(&Task::default())
        .unwrap();
    let topology = check(&boxes);
    assert_eq!(topology.vertices, 15);
    assert_eq!(topology.non_manifold_vertices, 1);
    assert_eq!(topology.non_manifold_edges, 0);
    assert_eq!(topology.components, 1);
    assert!(topology.watertight && !topology.manifold);
}

#[test]
fn boxes_that_touch_along_an_edge_are_watertight_but_not_manifold() {
    let boxes = together(
        &box_mesh([0.0; 3], [1.0; 3]),
        &box_mesh([1.0, 1.0, 0.0], [2.0, 2.0, 1.0]),
    )
    .merged(&Task::default())
    .unwrap();
    let topology = check(&boxes);
    assert_eq!(topology.non_manifold_edges, 1);
    assert!(topology.watertight && !topology.manifold);
    assert!((topology.volume_mm3 - 2.0).abs() < 1e-12);
}

#[test]
fn a_bow_tie_of_two_triangles_is_a_non_manifold_vertex() {
    let vertices = vec![
        [0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0, -1.0, 0.0],
        [-1.0, 1.0, 0.0],
        [-1.0, -1.0, 0.0],
    ];
    let topology = check(&mesh(vertices, vec![[0, 2, 1], [0, 3, 4]]));
    assert_eq!(topology.non_manifold_vertices, 1);
    assert_eq!(topology.boundary_edges, 6);
    assert!(!topology.manifold);
}

#[test]
fn apart_bodies_and_unused_vertices_are_counted() {
    let two = together(&box_mesh([0.0; 3], [1.0; 3]), &box_mesh([5.0; 3], [6.0; 3]));
    let (mut vertices, triangles) = two.into_parts();
    vertices.push([9.0; 3]);
    let topology = check(&mesh(vertices, triangles));
    assert_eq!(topology.components, 2);
    assert_eq!((topology.vertices, topology.unused_vertices), (17, 1));
    assert_eq!(topology.bounds_mm, Some([[0.0; 3], [9.0; 3]]));
}

#[test]
fn collapsed_triangles_are_counted_and_connect_nothing() {
    let two = together(&box_mesh([0.0; 3], [1.0; 3]), &box_mesh([5.0; 3], [6.0; 3]));
    let (vertices, mut triangles) = two.into_parts();
    triangles.extend([[0, 8, 0], [3, 3, 3], [1, 1, 9]]);
    let topology = check(&mesh(vertices, triangles));
    assert_eq!(topology.degenerate_triangles, 3);
    assert_eq!(topology.components, 2);
    assert!(topology.watertight && topology.manifold);
}

#[test]
fn a_triangle_without_area_is_degenerate_but_closes_the_surface() {
    // A box whose top edge 4-5 has a vertex in its middle on one side only; a flat triangle joins.
    let mut vertices = unit_box();
    vertices.push([0.5, 0.0, 1.0]);
    let mut triangles = BOX.to_vec();
    triangles.retain(|t| *t != [4, 5, 7]);
    triangles.extend([[4, 8, 7], [8, 5, 7], [4, 5, 8]]);
    let topology = check(&mesh(vertices, triangles));
    assert_eq!(topology.degenerate_triangles, 1);
    assert!(topology.watertight && topology.manifold);
}

#[test]
fn a_mesh_of_nothing_is_not_watertight() {
    let topology = check(&TriangleMesh::default());
    assert_eq!(topology.bounds_mm, None);
    assert!(!topology.watertight && topology.manifold);
}

#[test]
fn the_report_is_the_same_for_any_number_of_threads() {
    let torus = torus(300, 200);
    let reports: Vec<Topology> = [1, 2, 5]
        .into_iter()
        .map(|n| {
            pool(std::num::NonZeroUsize::new(n))
                .unwrap()
                .install(|| check(&torus))
        })
        .collect();
    assert!(reports.iter().all(|r| {
        *r == reports[0] && r.volume_mm3.to_bits() == reports[0].volume_mm3.to_bits()
    }));
}

#[test]
fn a_cancelled_check_says_so() {
    let task = Task::default();
    task.cancel().cancel();
    let error = check_topology(&torus(9, 9), &task).unwrap_err();
    assert!(matches!(error, MeshError::Cancelled(_)));
}

/// The same counts from a table of all edges, which is how one would write it first.
fn edge_counts_by_table(triangles: &[[u32; 3]]) -> [usize; 4] {
    let mut table = std::collections::BTreeMap::<(u32, u32), [usize; 2]>::new();
    for t in triangles {
        if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
            continue;
        }
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            table.entry((a.min(b), a.max(b))).or_default()[usize::from(a < b)] += 1;
        }
    }
    let count = |test: &dyn Fn([usize; 2]) -> bool| table.values().filter(|e| test(**e)).count();
    [
        count(&|[down, up]| down + up == 1),
        count(&|[down, up]| down + up > 2),
        count(&|[down, up]| down + up == 2 && down != up),
        count(&|[down, up]| down != up),
    ]
}

/// Parts and bow ties by flooding over triangles, the way one would write it first.
fn parts_and_bow_ties(vertices: u32, triangles: &[[u32; 3]]) -> [usize; 2] {
    let real = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    let triangles: Vec<[u32; 3]> = triangles.iter().copied().filter(real).collect();
    let flood = |members: &[[u32; 3]], need: usize| {
        let mut left: Vec<[u32; 3]> = members.to_vec();
        let mut parts = 0;
        while let Some(seed) = left.pop() {
            parts += 1;
            let mut front = vec![seed];
            while let Some(t) = front.pop() {
                let touches = |o: &[u32; 3]| o.iter().filter(|v| t.contains(v)).count() >= need;
                front.extend(left.extract_if(.., |o| touches(o)));
            }
        }
        parts
    };
    let bow_ties = (0..vertices).filter(|v| {
        let around: Vec<[u32; 3]> = triangles
            .iter()
            .copied()
            .filter(|t| t.contains(v))
            .collect();
        flood(&around, 2) > 1
    });
    [flood(&triangles, 1), bow_ties.count()]
}

proptest! {
    #[test]
    fn counts_agree_with_the_plain_definition(
        triangles in prop::collection::vec([0_u32..9, 0_u32..9, 0_u32..9], 0..40),
    ) {
        let vertices = (0..9).map(|i| [f64::from(i), f64::from(i * i), f64::from(i % 4)]).collect();
        let topology = check(&mesh(vertices, triangles.clone()));
        let [boundary, non_manifold, inconsistent, unbalanced] = edge_counts_by_table(&triangles);
        prop_assert_eq!(topology.boundary_edges, boundary);
        prop_assert_eq!(topology.non_manifold_edges, non_manifold);
        prop_assert_eq!(topology.inconsistent_edges, inconsistent);
        let [parts, bow_ties] = parts_and_bow_ties(9, &triangles);
        prop_assert_eq!(topology.components, parts);
        prop_assert_eq!(topology.non_manifold_vertices, bow_ties);
        prop_assert_eq!(topology.watertight, parts > 0 && unbalanced == 0);
        prop_assert_eq!(topology.manifold, non_manifold == 0 && bow_ties == 0);
    }

    #[test]
    fn volume_does_not_change_with_place(shift in -1e5_f64..1e5) {
        let moved = |v: [f64; 3]| v.map(|c| c + shift);
        let topology = check(&box_mesh(moved(LOW), moved(HIGH)));
        prop_assert!((topology.volume_mm3 - 24.0).abs() < 1e-7);
    }
}
