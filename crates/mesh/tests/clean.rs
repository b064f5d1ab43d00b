//! Triangles without area and triangles given twice, taken out.

mod shapes;

use bonemesh_mesh::{TriangleMesh, check_topology, clean};
use bonemesh_task::Task;
use proptest::prelude::*;

use shapes::{BOX, box_mesh, box_vertices, mesh, together, torus};

fn cleaned(mesh: &TriangleMesh) -> (TriangleMesh, [usize; 2]) {
    let cleaned = clean(mesh, &Task::default()).expect("nobody cancels");
    (cleaned.mesh, [cleaned.degenerate, cleaned.doubled])
}

/// Asserts that a mesh is closed, manifold and encloses this.
fn assert_sound(mesh: &TriangleMesh, volume_mm3: f64) {
    let topology = check_topology(mesh, &Task::default()).expect("nobody cancels");
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    assert_eq!(topology.degenerate_triangles, 0);
    assert!(
        (topology.volume_mm3 - volume_mm3).abs() < 1e-9,
        "{topology:?}"
    );
}

/// A box whose edge from corner 0 to corner 1 has places on it at these x, all in triangles without area on one
/// side, while the other side runs from end to end.
fn box_with_needles(on_edge: &[f64]) -> TriangleMesh {
    let mut vertices = box_vertices([0.0; 3], [8.0; 3]);
    let mut triangles = BOX.to_vec();
    // The bottom's triangle at that edge is [0, 3, 1]: its edge runs from 1 to 0.
    let bottom = triangles
        .iter()
        .position(|t| *t == [0, 3, 1])
        .expect("it is one of the box");
    triangles.remove(bottom);
    let mut from = 0;
    for x in on_edge {
        let next = vertices.len() as u32;
        vertices.push([*x, 0.0, 0.0]);
        triangles.push([from, 3, next]);
        // Between the edge as the front has it and the places on it.
        triangles.push([from, next, 1]);
        from = next;
    }
    triangles.push([from, 3, 1]);
    mesh(vertices, triangles)
}

#[test]
fn what_is_sound_stays() {
    for sound in [torus(20, 12), box_mesh([0.0; 3], [1.0; 3])] {
        let written = sound.as_written(&Task::default()).expect("nobody cancels");
        assert_eq!(cleaned(&sound), (written, [0, 0]));
    }
}

#[test]
fn triangles_with_equal_corners_go() {
    let mut triangles = BOX.to_vec();
    triangles.insert(3, [2, 2, 6]);
    triangles.push([5, 5, 5]);
    let (mended, gone) = cleaned(&mesh(box_vertices([0.0; 3], [2.0; 3]), triangles));
    assert_eq!((mended, gone), (box_mesh([0.0; 3], [2.0; 3]), [2, 0]));
}

#[test]
fn needles_go_and_their_neighbours_are_divided() {
    for on_edge in [&[4.0][..], &[2.0, 5.0], &[1.0, 2.0, 3.0, 7.0]] {
        let (mended, gone) = cleaned(&box_with_needles(on_edge));
        assert_eq!(gone, [on_edge.len(), 0]);
        assert_sound(&mended, 512.0);
        assert_eq!(mended.vertices_mm().len(), 8 + on_edge.len());
    }
}

#[test]
fn a_needle_at_a_rim_leaves_the_rim_where_it_is() {
    let corners = vec![[0.0; 3], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0], [1.0, 0.0, 0.0]];
    let sheet = mesh(corners, vec![[0, 3, 2], [3, 1, 2], [0, 1, 3]]);
    let (mended, gone) = cleaned(&sheet);
    assert_eq!(gone, [1, 0]);
    assert_eq!(mended.triangles(), [[0, 3, 2], [3, 1, 2]]);
}

#[test]
fn of_triangles_given_twice_one_stays() {
    let mut triangles = BOX.to_vec();
    triangles.extend([BOX[4], BOX[7], BOX[7]]);
    // Turned over, but outvoted.
    triangles.push([BOX[7][0], BOX[7][2], BOX[7][1]]);
    let (mended, gone) = cleaned(&mesh(box_vertices([0.0; 3], [2.0; 3]), triangles));
    assert_eq!((mended, gone), (box_mesh([0.0; 3], [2.0; 3]), [0, 4]));
}

#[test]
fn needles_given_twice_go_too() {
    for doubled in [12, 13, 14] {
        let broken = box_with_needles(&[4.0]);
        let mut triangles = broken.triangles().to_vec();
        triangles.push(triangles[doubled - 2]);
        let (mended, gone) = cleaned(&mesh(broken.vertices_mm().to_vec(), triangles));
        assert_eq!(gone, [1, 1]);
        assert_sound(&mended, 512.0);
    }
}

#[test]
fn a_surface_given_for_both_sides_keeps_one() {
    // The whole box, and the box without its top.
    for count in [12, 10] {
        let front = BOX[..count].to_vec();
        let back = front.iter().map(|&[a, b, c]| [a, c, b]);
        let both = [front.clone(), back.collect()].concat();
        let (mended, gone) = cleaned(&mesh(box_vertices([0.0; 3], [2.0; 3]), both));
        assert_eq!(gone, [0, count]);
        assert_eq!(mended.triangles(), front);
    }
}

#[test]
fn a_wall_between_two_bodies_goes() {
    let pair = together(
        &box_mesh([0.0; 3], [2.0; 3]),
        &box_mesh([2.0, 0.0, 0.0], [5.0, 2.0, 2.0]),
    );
    let (mended, gone) = cleaned(&pair);
    assert_eq!(gone, [0, 4]);
    assert_sound(&mended, 20.0);
    // Where the two sides are divided along different diagonals, nothing is equal.
    let mut triangles = pair.triangles().to_vec();
    triangles[2..4].copy_from_slice(&[[1, 3, 5], [3, 7, 5]]);
    assert_eq!(
        cleaned(&mesh(pair.vertices_mm().to_vec(), triangles)).1,
        [0, 0]
    );
}

proptest! {
    #[test]
    fn no_triangle_is_left_twice_or_with_equal_corners(triangles in prop::collection::vec(prop::array::uniform3(0_u32..9), 0..40)) {
        // A grid of three by three places, so that lines of three and equal triangles abound.
        let vertices = (0..9).map(|i| [f64::from(i % 3), f64::from(i / 3), 0.0]).collect();
        let given = mesh(vertices, triangles);
        let (mended, gone) = cleaned(&given);
        prop_assert!(mended.triangles().len() + gone[1] <= given.triangles().len());
        let mut sets: Vec<[u32; 3]> = mended.triangles().to_vec();
        for corners in &mut sets {
            corners.sort_unstable();
        }
        sets.sort_unstable();
        prop_assert!(sets.iter().all(|[a, b, c]| a < b && b < c));
        prop_assert!(sets.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
