//! Holes are closed with sound triangles, or left with the reason.

#![allow(clippy::unwrap_used, reason = "tests")]

mod shapes;

use std::num::NonZeroUsize;

use bonemesh_mesh::{
    HoleLimits, HoleReason, HolesFilled, MeshError, Topology, TriangleMesh, TriangleTree,
    check_topology, fill_holes, find_intersections,
};
use bonemesh_task::{Task, pool};
use proptest::prelude::*;
use shapes::{BOX, box_mesh, box_vertices, mesh, together, torus};

fn topology(mesh: &TriangleMesh) -> Topology {
    check_topology(mesh, &Task::default()).unwrap()
}

fn meetings(mesh: &TriangleMesh) -> usize {
    let tree = TriangleTree::new(mesh, &Task::default()).unwrap();
    find_intersections(&tree, 0, &Task::default())
        .unwrap()
        .count
}

fn filled(mesh: &TriangleMesh) -> HolesFilled {
    fill_holes(mesh, HoleLimits::default(), &Task::default()).unwrap()
}

/// The mesh without the triangles of these numbers.
fn without(given: &TriangleMesh, gone: impl Fn(u32) -> bool) -> TriangleMesh {
    let numbered = (0..).zip(given.triangles());
    let kept = numbered.filter(|(number, _)| !gone(*number));
    let triangles = kept.map(|(_, triangle)| *triangle).collect();
    mesh(given.vertices_mm().to_vec(), triangles)
}

/// A sphere of radius 20 with two poles, numbered first, and rings of `2 * rings` vertices.
fn sphere(rings: u32) -> TriangleMesh {
    let columns = 2 * rings;
    let mut vertices = vec![[0.0, 0.0, 20.0], [0.0, 0.0, -20.0]];
    for ring in 1..rings {
        let down = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        for column in 0..columns {
            let turn = std::f64::consts::TAU * f64::from(column) / f64::from(columns);
            let [x, y] = [turn.cos(), turn.sin()].map(|v| v * down.sin() * 20.0);
            vertices.push([x, y, 20.0 * down.cos()]);
        }
    }
    let at = |ring: u32, column: u32| 2 + (ring - 1) * columns + column % columns;
    let mut triangles = Vec::new();
    for c in 0..columns {
        triangles.push([0, at(1, c), at(1, c + 1)]);
        triangles.push([1, at(rings - 1, c + 1), at(rings - 1, c)]);
        for r in 1..rings - 1 {
            triangles.push([at(r, c), at(r + 1, c), at(r + 1, c + 1)]);
            triangles.push([at(r, c), at(r + 1, c + 1), at(r, c + 1)]);
        }
    }
    mesh(vertices, triangles)
}

/// Whether a triangle is within some distance of a place.
fn is_near(given: &TriangleMesh, number: u32, place: [f64; 3], radius: f64) -> bool {
    let corners = given.corners_mm(given.triangles()[number as usize]);
    let centre: [f64; 3] =
        std::array::from_fn(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 3.0);
    let squared: f64 = (0..3).map(|i| (centre[i] - place[i]).powi(2)).sum();
    squared < radius * radius
}

/// Closed, manifold, meeting itself nowhere, all that was given still there in its order.
fn assert_closed(given: &TriangleMesh, result: &HolesFilled, holes: usize) {
    assert_eq!(result.left, []);
    assert_eq!(result.filled, holes);
    let topology = topology(&result.mesh);
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    assert_eq!(topology.inconsistent_edges, 0);
    assert_eq!(topology.degenerate_triangles, 0);
    assert_eq!(meetings(&result.mesh), 0);
    let given = given.as_written(&Task::default()).unwrap();
    assert_eq!(result.mesh.vertices_mm(), given.vertices_mm());
    let kept = &result.mesh.triangles()[..given.triangles().len()];
    assert_eq!(kept, given.triangles());
}

#[test]
fn a_sphere_with_several_holes_is_closed_again() {
    let whole = sphere(24);
    let spots = [
        ([20.0, 0.0, 0.0], 2.0),
        ([0.0, 20.0, 0.0], 6.0),
        ([0.0, 0.0, 20.0], 4.0),
        ([-14.0, -14.0, 0.0], 3.0),
    ];
    let open = without(&whole, |number| {
        spots
            .iter()
            .any(|(spot, radius)| is_near(&whole, number, *spot, *radius))
    });
    let result = filled(&open);
    assert_closed(&open, &result, 4);
    let change = topology(&result.mesh).volume_mm3 / topology(&whole).volume_mm3;
    assert!((0.98..1.0).contains(&change), "{change}");
}

#[test]
fn one_missing_triangle_comes_back_as_it_was() {
    let whole = sphere(12).as_written(&Task::default()).unwrap();
    for gone in [0, 1, 100, 333] {
        let result = filled(&without(&whole, |number| number == gone));
        let back = *result.mesh.triangles().last().unwrap();
        let given = whole.triangles()[gone as usize];
        assert!((0..3).any(|turn| [0, 1, 2].map(|i| given[(i + turn) % 3]) == back));
    }
}

#[test]
fn a_torus_without_a_band_or_a_patch_is_closed_again() {
    let whole = torus(48, 24);
    // Two squares a column and row; a patch over four columns and six rows.
    let patch = without(&whole, |n| n / 2 % 48 < 4 && n / 96 < 6);
    assert_closed(&patch, &filled(&patch), 1);
    // A band all around the tube leaves two rims; lids on both make it a bent cylinder.
    let band = without(&whole, |n| n / 2 % 48 < 8);
    let result = filled(&band);
    assert_closed(&band, &result, 2);
    let share = topology(&result.mesh).volume_mm3 / topology(&whole).volume_mm3;
    assert!((share - 40.0 / 48.0).abs() < 0.01, "{share}");
}

#[test]
fn holes_that_touch_in_a_vertex_are_taken_apart() {
    let whole = sphere(12);
    // Around the pole every other pair of triangles: gaps that have the pole in common.
    let columns = 24;
    let pole = 2 * (12 - 1);
    let is_cap = |number: u32| number.is_multiple_of(pole);
    for share in [12, 6, 3] {
        let open = without(&whole, |n| is_cap(n) && n / pole % share == 0);
        assert_closed(&open, &filled(&open), (columns / share) as usize);
    }
}

#[test]
fn a_box_without_its_lid_gets_a_flat_one() {
    let open = mesh(box_vertices([0.0; 3], [4.0, 3.0, 2.0]), BOX[..10].to_vec());
    let result = filled(&open);
    assert_closed(&open, &result, 1);
    assert!((topology(&result.mesh).volume_mm3 - 24.0).abs() < 1e-6);
    assert_eq!(result.mesh.triangles().len(), 12);
}

/// A half-pipe of length 60 along y, with `columns` strips around and `rows` along.
fn half_pipe(columns: u32, rows: u32) -> TriangleMesh {
    let mut vertices = Vec::new();
    for row in 0..=rows {
        for column in 0..=columns {
            let turn = std::f64::consts::PI * (1.0 + f64::from(column) / f64::from(columns));
            let along = 60.0 * f64::from(row) / f64::from(rows);
            vertices.push([10.0 * turn.cos(), along, 10.0 * turn.sin()]);
        }
    }
    let at = |column: u32, row: u32| row * (columns + 1) + column;
    let squares = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let triangles = squares.flat_map(|(c, r)| {
        let [a, b, d, e] = [at(c, r), at(c + 1, r), at(c, r + 1), at(c + 1, r + 1)];
        [[a, b, e], [a, e, d]]
    });
    mesh(vertices.clone(), triangles.collect())
}

#[test]
fn a_half_pipe_is_closed_whatever_the_length_of_its_rim() {
    for (columns, rows) in [(8, 6), (16, 30), (24, 150), (60, 600)] {
        let open = half_pipe(columns, rows);
        let result = filled(&open);
        assert_closed(&open, &result, 1);
        let volume = topology(&result.mesh).volume_mm3.abs();
        let wanted = std::f64::consts::PI * 50.0 * 60.0;
        assert!(
            (0.6..1.02).contains(&(volume / wanted)),
            "{volume} of {wanted}"
        );
    }
}

#[test]
fn a_flat_rim_with_bays_and_straight_runs_gets_a_flat_lid() {
    // A comb of unit squares, extruded downward by a wall; its rim lies in one plane.
    let teeth = 40;
    let mut outline = vec![[0.0, 0.0]];
    for tooth in 0..teeth {
        let x = 2.0 * f64::from(tooth);
        let corners = [
            [x, 0.0],
            [x + 1.0, 0.0],
            [x + 1.0, 5.0],
            [x + 2.0, 5.0],
            [x + 2.0, 0.0],
        ];
        outline.extend(&corners[1..]);
    }
    let end = 2.0 * f64::from(teeth);
    outline.extend([[end, -3.0], [end / 2.0, -3.0], [0.0, -3.0]]);
    // Counter-clockwise seen from above.
    outline.reverse();
    let count = outline.len() as u32;
    let level = |z: f64| outline.iter().map(move |[x, y]| [*x, *y, z]);
    let vertices = level(0.0).chain(level(2.0)).collect();
    let walls = (0..count).flat_map(|i| {
        let next = (i + 1) % count;
        [[i, next, count + next], [i, count + next, count + i]]
    });
    let open = mesh(vertices, walls.collect());
    let result = filled(&open);
    assert_closed(&open, &result, 2);
    let area = end * 3.0 + 5.0 * f64::from(teeth);
    assert!((topology(&result.mesh).volume_mm3 - 2.0 * area).abs() < 1e-3);
}

#[test]
fn a_moebius_strip_is_left_with_the_reason() {
    let count = 40_u32;
    let vertices = (0..count).flat_map(|i| {
        let turn = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        [-2.0, 2.0].map(|across| {
            let radius = 20.0 + across * (turn / 2.0).cos();
            [
                radius * turn.cos(),
                radius * turn.sin(),
                across * (turn / 2.0).sin(),
            ]
        })
    });
    let triangles = (0..count).flat_map(|i| {
        let [a, b] = [2 * i, 2 * i + 1];
        let [c, d] = if i + 1 == count {
            [1, 0]
        } else {
            [2 * i + 2, 2 * i + 3]
        };
        [[a, b, d], [a, d, c]]
    });
    let given = mesh(vertices.collect(), triangles.collect());
    let result = filled(&given);
    assert_eq!((result.filled, result.left.len()), (0, 1));
    let left = result.left[0];
    assert_eq!((left.reason, left.edges), (HoleReason::NoLoop, 80));
    assert!(left.extent_mm > 38.0 && left.place_mm.iter().all(|v| v.abs() < 3.0));
    assert_eq!(result.mesh.triangles(), given.triangles());
}

#[test]
fn faults_elsewhere_stay_and_do_not_keep_holes_from_being_filled() {
    // Two boxes with an edge in common, one of them without a side; a fin with a loose end.
    let other = box_mesh([4.0, 3.0, 0.0], [8.0, 6.0, 2.0]);
    let open = mesh(box_vertices([0.0; 3], [4.0, 3.0, 2.0]), BOX[2..].to_vec());
    let fin = mesh(
        vec![[4.0, 6.0, 0.0], [4.0, 6.0, 2.0], [3.0, 9.0, 1.0]],
        vec![[0, 1, 2]],
    );
    let both = together(&together(&open, &other), &fin)
        .as_written(&Task::default())
        .unwrap();
    let before = topology(&both);
    assert_eq!((before.non_manifold_edges, before.boundary_edges), (2, 6));
    let result = filled(&both);
    assert_eq!((result.filled, result.left.len()), (1, 1));
    assert_eq!(result.left[0].reason, HoleReason::NoLoop);
    let after = topology(&result.mesh);
    assert_eq!((after.non_manifold_edges, after.boundary_edges), (2, 2));
    assert_eq!(meetings(&result.mesh), meetings(&both));
}

#[test]
fn what_cannot_be_closed_without_meeting_the_surface_is_left() {
    // A lone triangle would be doubled; the lid of the box would cut the pin that sticks out of it.
    let lone = mesh(
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        vec![[0, 1, 2]],
    );
    let open = mesh(box_vertices([0.0; 3], [4.0, 3.0, 2.0]), BOX[..10].to_vec());
    let pin = box_mesh([1.9, 1.4, 1.0], [2.1, 1.6, 3.0]);
    for given in [lone, together(&open, &pin)] {
        let result = filled(&given);
        assert_eq!((result.filled, result.left.len()), (0, 1));
        assert_eq!(result.left[0].reason, HoleReason::Blocked);
        assert_eq!(result.mesh, given.as_written(&Task::default()).unwrap());
    }
    // A pin near a corner lies under one of the two ways to halve the lid alone.
    let aside = box_mesh([0.9, 2.2, 1.0], [1.1, 2.4, 2.0]);
    let free = together(&open, &box_mesh([1.0, 1.0, 0.5], [1.5, 1.5, 1.5]));
    assert_closed(&free, &filled(&free), 1);
    assert_eq!(filled(&together(&open, &aside)).filled, 0);
}

#[test]
fn lids_that_would_cut_one_another_are_not_both_made() {
    // Two open boxes; each lid alone is free, the bent upper rim of one dips into the other's lid.
    let low = mesh(box_vertices([0.0; 3], [4.0, 4.0, 2.0]), BOX[..10].to_vec());
    let turned = |[x, y, z]: [f64; 3]| [x + 1.0, y + 1.0, 4.0 - z];
    let (vertices, triangles) = low.clone().into_parts();
    let upper = mesh(
        vertices.into_iter().map(turned).collect(),
        triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect(),
    );
    let given = together(&low, &upper);
    let result = filled(&given);
    assert_eq!(meetings(&result.mesh), meetings(&given));
    assert_eq!(result.filled + result.left.len(), 2);
}

#[test]
fn limits_leave_large_holes_and_say_so() {
    let whole = sphere(24);
    let open = without(&whole, |number| {
        is_near(&whole, number, [20.0, 0.0, 0.0], 3.0)
            || is_near(&whole, number, [0.0, 20.0, 0.0], 8.0)
    });
    let limited = |at_most_edges, at_most_mm| {
        let limits = HoleLimits {
            at_most_edges,
            at_most_mm,
        };
        fill_holes(&open, limits, &Task::default()).unwrap()
    };
    for result in [limited(None, Some(10.0)), limited(Some(15), None)] {
        assert_eq!((result.filled, result.left.len()), (1, 1));
        let left = result.left[0];
        assert_eq!(left.reason, HoleReason::TooLarge);
        assert!((14.0..20.0).contains(&left.extent_mm), "{left:?}");
        assert!(left.place_mm[1] > 17.0);
    }
    assert_eq!(limited(Some(2), None).filled, 0);
    assert_eq!(limited(Some(1000), Some(100.0)).filled, 2);
    for bad in [-1.0, f64::NAN] {
        let limits = HoleLimits {
            at_most_edges: None,
            at_most_mm: Some(bad),
        };
        let error = fill_holes(&open, limits, &Task::default()).unwrap_err();
        assert!(matches!(error, MeshError::Length { .. }));
    }
}

#[test]
fn closed_tiny_and_empty_meshes_pass() {
    let collapsed = mesh(vec![[1.0; 3]; 3], vec![[0, 1, 2], [0, 0, 1]]);
    let line = mesh(vec![[0.0; 3], [1.0; 3], [2.0; 3]], vec![[0, 1, 2]]);
    for given in [TriangleMesh::default(), collapsed, line, torus(20, 10)] {
        let result = filled(&given);
        assert_eq!(result.filled, 0);
        assert_eq!(result.mesh, given.as_written(&Task::default()).unwrap());
    }
}

#[test]
fn a_cancelled_task_stops_it() {
    let task = Task::default();
    task.cancel().cancel();
    let given = half_pipe(8, 6);
    let stopped = fill_holes(&given, HoleLimits::default(), &task);
    assert!(matches!(stopped, Err(MeshError::Cancelled(_))));
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let whole = torus(120, 60);
    let open = without(&whole, |n| {
        n.wrapping_mul(2_654_435_761) >> 8 & 63 < 16 || n / 2 % 120 < 3
    });
    let all = [1, 2, 5].map(|threads| {
        let threads = pool(NonZeroUsize::new(threads)).unwrap();
        threads.install(|| filled(&open))
    });
    assert!(all.iter().all(|result| *result == all[0]));
    assert!(all[0].filled > 100);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn moth_eaten_bodies_get_no_new_fault(
        gone in prop::collection::vec(prop::bool::weighted(0.3), 24 * 12 * 2),
    ) {
        let open = without(&torus(24, 12), |n| gone[n as usize]);
        let before = topology(&open);
        let result = filled(&open);
        let after = topology(&result.mesh);
        prop_assert_eq!(after.non_manifold_edges, 0);
        prop_assert_eq!(after.inconsistent_edges, 0);
        prop_assert_eq!(after.degenerate_triangles, 0);
        prop_assert!(after.non_manifold_vertices <= before.non_manifold_vertices);
        prop_assert_eq!(meetings(&result.mesh), 0);
        let left: usize = result.left.iter().map(|left| left.edges).sum();
        prop_assert_eq!(after.boundary_edges, left);
    }
}
