//! Triangles that meet where they should not: counted by hand, and by an oracle in whole numbers.

#![allow(clippy::unwrap_used, reason = "tests")]

mod oracle;
mod shapes;

use std::num::NonZeroUsize;

use bonemesh_mesh::{Intersections, MeshError, TriangleMesh, TriangleTree, find_intersections};
use bonemesh_task::{Task, pool};
use proptest::prelude::*;
use shapes::{box_mesh, mesh, together, torus};

fn find(mesh: &TriangleMesh) -> Intersections {
    let task = Task::default();
    let tree = TriangleTree::new(mesh, &task).unwrap();
    find_intersections(&tree, usize::MAX, &task).unwrap()
}

/// Two triangles, each with its own corners.
fn pair(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> TriangleMesh {
    mesh([a, b].concat(), vec![[0, 1, 2], [3, 4, 5]])
}

const FLOOR: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

#[test]
fn a_closed_surface_meets_itself_nowhere() {
    for mesh in [box_mesh([0.0; 3], [1.0; 3]), torus(60, 40)] {
        assert_eq!(find(&mesh), Intersections::default());
    }
    assert_eq!(find(&TriangleMesh::default()), Intersections::default());
}

#[test]
fn boxes_that_share_nothing_or_only_corners_and_whole_edges_do_not_meet() {
    let low = box_mesh([0.0; 3], [1.0; 3]);
    for (corner, far) in [([2.0; 3], [3.0; 3]), ([1.0; 3], [2.0; 3])] {
        assert_eq!(find(&together(&low, &box_mesh(corner, far))).count, 0);
    }
    let along_an_edge = box_mesh([1.0, 1.0, 0.0], [2.0, 2.0, 1.0]);
    assert_eq!(find(&together(&low, &along_an_edge)).count, 0);
    let inside = box_mesh([0.25; 3], [0.75; 3]);
    assert_eq!(find(&together(&low, &inside)).count, 0);
}

#[test]
fn each_way_of_meeting_counts() {
    let through = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 0.0]];
    let corner_on_face = [[1.0, 1.0, 0.0], [1.0, 2.0, 1.0], [2.0, 1.0, 1.0]];
    let corner_on_edge = [[2.0, 0.0, 0.0], [2.0, -1.0, 1.0], [3.0, -1.0, 1.0]];
    let edge_on_face = [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
    let edges_cross = [[2.0, -1.0, -1.0], [2.0, 1.0, 1.0], [2.0, -1.0, 1.0]];
    let inside_in_plane = [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 0.0]];
    let across_in_plane = [[-1.0, 1.0, 0.0], [5.0, 1.0, 0.0], [-1.0, 2.0, 0.0]];
    let around_in_plane = [[-1.0, -1.0, 0.0], [9.0, -1.0, 0.0], [-1.0, 9.0, 0.0]];
    let part_of_an_edge = [[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, -1.0, 0.0]];
    let same = FLOOR;
    let turned_over = [FLOOR[0], FLOOR[2], FLOOR[1]];
    let folded = [FLOOR[0], FLOOR[1], [1.0, 1.0, 0.0]];
    let fan_overlap = [FLOOR[0], [4.0, 4.0, 0.0], [-1.0, 4.0, 0.0]];
    let through_from_corner = [FLOOR[0], [4.0, 4.0, 1.0], [4.0, 4.0, -1.0]];
    let longer_edge = [FLOOR[0], [8.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let cases = [
        through,
        corner_on_face,
        corner_on_edge,
        edge_on_face,
        edges_cross,
        inside_in_plane,
        across_in_plane,
        around_in_plane,
        part_of_an_edge,
        same,
        turned_over,
        folded,
        fan_overlap,
        through_from_corner,
        longer_edge,
    ];
    for other in cases {
        let found = find(&pair(FLOOR, other));
        assert_eq!((found.count, found.triangles), (1, 2), "{other:?}");
        assert_eq!(found.pairs[0].triangles, [0, 1]);
        let [x, y, z] = found.pairs[0].place_mm;
        assert!(
            x >= 0.0 && y >= 0.0 && x + y <= 4.0 && z == 0.0,
            "{other:?}: {:?}",
            [x, y, z]
        );
        let back = find(&pair(other, FLOOR));
        assert_eq!(
            (back.count, back.triangles),
            (1, 2),
            "{other:?}, the other way round"
        );
    }
}

#[test]
fn neighbours_and_triangles_that_miss_do_not_count() {
    let cases = [
        // A common edge, flat and upright.
        [FLOOR[0], FLOOR[1], [1.0, -1.0, 0.0]],
        [FLOOR[0], FLOOR[1], [1.0, 1.0, 1e-300]],
        // A common corner, in the plane and out of it.
        [FLOOR[0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
        [FLOOR[1], [9.0, 0.0, 1.0], [9.0, 1.0, -1.0]],
        // None.
        [[1.0, 1.0, 1e-30], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0]],
        [[5.0, 0.0, 0.0], [9.0, 0.0, 0.0], [5.0, 1.0, 0.0]],
        [[4.0, 4.0, -1.0], [4.0, 4.0, 1.0], [2.1, 2.1, 0.0]],
    ];
    for other in cases {
        assert_eq!(find(&pair(FLOOR, other)).count, 0, "{other:?}");
        assert_eq!(
            find(&pair(other, FLOOR)).count,
            0,
            "{other:?}, the other way round"
        );
    }
}

#[test]
fn a_place_is_where_the_triangles_cross() {
    let wall = [[1.0, 1.0, -1.0], [1.0, 1.0, 3.0], [1.0, 9.0, -1.0]];
    let place = find(&pair(FLOOR, wall)).pairs[0].place_mm;
    assert!((place[0] - 1.0).abs() < 1e-12 && place[1] > 1.0 && place[1] < 3.0);
    assert!(place[2].abs() < 1e-12);
}

#[test]
fn boxes_that_pass_through_one_another_are_counted_to_the_pair() {
    // The side x = 1 is split along y = z, and the small box goes through the half with y > z:
    // each of its four long sides crosses that one triangle with both of its own.
    let large = box_mesh([0.0; 3], [1.0; 3]);
    let low_part = box_mesh([0.5, 0.7, 0.2], [1.5, 0.8, 0.3]);
    let found = find(&together(&large, &low_part));
    assert_eq!(found.count, 8);
    assert_eq!(found.triangles, 9);
    assert!(
        found
            .pairs
            .iter()
            .all(|pair| (pair.place_mm[0] - 1.0).abs() < 1e-12)
    );
}

#[test]
fn triangles_without_area_are_left_out() {
    let collapsed = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 1.0]];
    let on_a_line = [[1.0, 1.0, -1.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
    let point = [[1.0, 1.0, 0.0]; 3];
    for other in [collapsed, on_a_line, point] {
        assert_eq!(find(&pair(FLOOR, other)).count, 0);
        assert_eq!(find(&pair(other, other)).count, 0);
    }
    let sliver = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0 + 1e-12, 0.0]];
    assert_eq!(find(&pair(FLOOR, sliver)).count, 1);
}

#[test]
fn all_pairs_are_counted_and_the_first_kept() {
    let sheets = 50;
    let corners = (0..sheets).flat_map(|_| FLOOR).collect();
    let triangles = (0..sheets).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let (mesh, task) = (mesh(corners, triangles), Task::default());
    let tree = TriangleTree::new(&mesh, &task).unwrap();
    let found = find_intersections(&tree, 60, &task).unwrap();
    assert_eq!((found.count, found.triangles), (50 * 49 / 2, 50));
    let pairs: Vec<[u32; 2]> = found.pairs.iter().map(|pair| pair.triangles).collect();
    let expected = (0..2)
        .flat_map(|a| (a + 1..50).map(move |b| [a, b]))
        .take(60);
    assert_eq!(pairs, expected.collect::<Vec<_>>());
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let shifted = {
        let torus = torus(90, 60);
        let vertices = torus
            .vertices_mm()
            .iter()
            .map(|v| [v[0] + 7.3, v[1], v[2] + 3.1]);
        mesh(vertices.collect(), torus.triangles().to_vec())
    };
    let both = together(&torus(90, 60), &shifted);
    let results: Vec<Intersections> = [1, 2, 3, 8]
        .into_iter()
        .map(|n| pool(NonZeroUsize::new(n)).unwrap().install(|| find(&both)))
        .collect();
    assert!(results[0].count > 100);
    assert!(results.iter().all(|result| *result == results[0]));
}

#[test]
fn a_cancelled_search_ends() {
    let (mesh, task) = (torus(60, 40), Task::default());
    let tree = TriangleTree::new(&mesh, &task).unwrap();
    task.cancel().cancel();
    let found = find_intersections(&tree, 1, &task);
    assert!(matches!(found, Err(MeshError::Cancelled(_))));
    assert!(matches!(
        TriangleTree::new(&mesh, &task),
        Err(MeshError::Cancelled(_))
    ));
}

/// Triangles with corners on a small lattice, so that everything touches, overlaps and repeats.
fn soup(side: i32) -> impl Strategy<Value = Vec<[[i32; 3]; 3]>> {
    let corner = || [0..side, 0..side, 0..side];
    prop::collection::vec([corner(), corner(), corner()], 2..24)
}

/// Triangles of one plane.
fn sheet() -> impl Strategy<Value = Vec<[[i32; 3]; 3]>> {
    let corner = || [0..5, 0..5].prop_map(|[x, y]| [x, y, x + 2 * y]);
    prop::collection::vec([corner(), corner(), corner()], 2..16)
}

fn agrees_with_the_oracle(triangles: &[[[i32; 3]; 3]], step: f64) -> Result<(), TestCaseError> {
    let corners = triangles.as_flattened().iter();
    let corners = corners.map(|v| v.map(|c| step * f64::from(c))).collect();
    let numbers = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    let mut expected = Vec::new();
    for (i, a) in triangles.iter().enumerate() {
        for (j, b) in triangles.iter().enumerate().skip(i + 1) {
            if !oracle::is_flat(*a) && !oracle::is_flat(*b) && oracle::meet(*a, *b) {
                expected.push([i as u32, j as u32]);
            }
        }
    }
    let found = find(&mesh(corners, numbers.collect()));
    let pairs: Vec<[u32; 2]> = found.pairs.iter().map(|pair| pair.triangles).collect();
    prop_assert_eq!(pairs, expected);
    prop_assert_eq!(found.count, found.pairs.len());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn triangles_on_a_lattice_meet_where_whole_numbers_say(
        triangles in prop_oneof![soup(2), soup(3), soup(5), soup(9)],
        step in prop::sample::select(vec![1.0, 0.25, 1024.0]),
    ) {
        agrees_with_the_oracle(&triangles, step)?;
    }

    #[test]
    fn triangles_in_one_plane_meet_where_whole_numbers_say(triangles in sheet()) {
        agrees_with_the_oracle(&triangles, 1.0)?;
    }

    #[test]
    fn triangles_far_from_the_origin_meet_where_whole_numbers_say(
        mut triangles in soup(4),
        shift in prop::array::uniform3(-100_000_000..100_000_000),
    ) {
        for corner in triangles.as_flattened_mut() {
            *corner = [0, 1, 2].map(|axis| corner[axis] + shift[axis]);
        }
        agrees_with_the_oracle(&triangles, 1.0)?;
    }
}
