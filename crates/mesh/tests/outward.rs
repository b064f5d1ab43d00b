//! Triangles that face the wrong way, turned over.

mod shapes;

use bonemesh_mesh::{TriangleMesh, check_nesting, check_topology, face_outward};
use bonemesh_task::Task;
use proptest::prelude::*;

use shapes::{box_mesh, mesh, together, torus};

fn faced(mesh: &TriangleMesh) -> (TriangleMesh, usize) {
    let faced = face_outward(mesh, &Task::default()).expect("nobody cancels");
    (faced.mesh, faced.turned)
}

/// The mesh with some triangles turned over.
fn with_turned(of: &TriangleMesh, is_turned: impl Fn(usize) -> bool) -> TriangleMesh {
    let numbered = of.triangles().iter().enumerate();
    let triangles = numbered.map(|(number, &[a, b, c])| {
        if is_turned(number) {
            [a, c, b]
        } else {
            [a, b, c]
        }
    });
    mesh(of.vertices_mm().to_vec(), triangles.collect())
}

/// A box with a cavity, in which a smaller box floats.
fn nested() -> TriangleMesh {
    let wall = with_turned(&box_mesh([2.0; 3], [18.0; 3]), |_| true);
    let inner = box_mesh([6.0; 3], [9.0; 3]);
    together(&together(&box_mesh([0.0; 3], [20.0; 3]), &wall), &inner)
}

#[test]
fn what_is_sound_stays() {
    for sound in [torus(20, 12), nested(), box_mesh([0.0; 3], [1.0; 3])] {
        assert_eq!(faced(&sound).1, 0);
    }
}

#[test]
fn a_triangle_among_many_is_turned_back() {
    let sound = torus(20, 12);
    for wrong in [0, 7, 479] {
        let (mended, turned) = faced(&with_turned(&sound, |t| t == wrong));
        assert_eq!(turned, 1);
        assert_eq!(mended.triangles(), sound.triangles());
    }
}

#[test]
fn a_body_inside_out_is_turned_with_its_cavity() {
    let sound = nested();
    let (mended, turned) = faced(&with_turned(&sound, |_| true));
    assert_eq!(turned, sound.triangles().len());
    assert_eq!(mended.triangles(), sound.triangles());
}

#[test]
fn a_cavity_keeps_facing_inward_when_only_the_outside_was_wrong() {
    let (mended, turned) = faced(&with_turned(&nested(), |t| t < 12));
    assert_eq!(turned, 12);
    let nesting = check_nesting(&mended, &Task::default()).expect("nobody cancels");
    assert_eq!(
        (nesting.inside_out, nesting.doubled, nesting.cavities),
        (0, 0, 1)
    );
}

#[test]
fn bodies_that_touch_are_turned_one_by_one() {
    let small = box_mesh([0.0; 3], [2.0; 3]);
    for touching in [
        // Along an edge, in a corner, in the corner where all coordinates are highest.
        box_mesh([2.0, 2.0, 0.0], [9.0, 9.0, 2.0]),
        box_mesh([2.0, 2.0, 2.0], [9.0; 3]),
        box_mesh([-9.0, -9.0, -9.0], [0.0; 3]),
    ] {
        let sound = together(&small, &touching);
        for wrong in [0..12, 12..24, 0..24] {
            let (mended, turned) = faced(&with_turned(&sound, |t| wrong.contains(&t)));
            assert_eq!(turned, wrong.len());
            let topology = check_topology(&mended, &Task::default()).expect("nobody cancels");
            let volume = check_topology(&sound, &Task::default()).expect("nobody cancels");
            assert!((topology.volume_mm3 - volume.volume_mm3).abs() < 1e-9);
        }
    }
}

#[test]
fn a_cavity_that_touches_its_body_faces_inward() {
    let mut sound = box_mesh([0.0; 3], [9.0; 3]);
    let cavity = mesh(
        vec![[9.0; 3], [5.0, 6.0, 6.0], [6.0, 5.0, 6.0], [6.0, 6.0, 5.0]],
        vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
    );
    let volume = |of: &TriangleMesh| {
        check_topology(of, &Task::default())
            .expect("nobody cancels")
            .volume_mm3
    };
    let cavity = with_turned(&cavity, |_| volume(&cavity) > 0.0);
    sound = together(&sound, &cavity);
    for wrong in [0..12, 0..16] {
        let (mended, turned) = faced(&with_turned(&sound, |t| wrong.contains(&t)));
        assert_eq!(turned, wrong.len());
        assert!((volume(&mended) - volume(&sound)).abs() < 1e-9);
    }
}

#[test]
fn a_cavity_whose_corners_are_all_its_bodys_stays() {
    // A box whose sides have a corner in the middle each, and an octahedron between these.
    let centre = |axis: usize, side: f64| {
        let mut place = [10.0; 3];
        place[axis] = side;
        place
    };
    let mut vertices = shapes::box_vertices([0.0; 3], [20.0; 3]);
    vertices.extend((0..3).flat_map(|axis| [centre(axis, 0.0), centre(axis, 20.0)]));
    let mut triangles = Vec::new();
    for (side, pair) in shapes::BOX.chunks(2).enumerate() {
        let middle = 8 + side as u32;
        let edges = pair.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let edges: Vec<[u32; 2]> = edges.collect();
        let rim = edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a]));
        triangles.extend(rim.map(|&[a, b]| [a, b, middle]));
    }
    for [x, y, z] in [[8, 10, 12], [9, 10, 13], [9, 11, 12], [8, 11, 13]] {
        triangles.push([x, y, z]);
    }
    for [x, y, z] in [[9, 10, 12], [8, 11, 12], [8, 10, 13], [9, 11, 13]] {
        triangles.push([x, z, y]);
    }
    let mut sound = mesh(vertices, triangles);
    let volume = |of: &TriangleMesh| {
        let topology = check_topology(of, &Task::default()).expect("nobody cancels");
        topology.volume_mm3
    };
    // The octahedron is a sixth of the box.
    if volume(&sound) > 8000.0 {
        sound = with_turned(&sound, |t| t >= 24);
    }
    assert!((volume(&sound) - 8000.0 * 5.0 / 6.0).abs() < 1e-6);
    assert_eq!(faced(&sound).1, 0);
    for wrong in [0..24, 0..32] {
        let (mended, turned) = faced(&with_turned(&sound, |t| wrong.contains(&t)));
        assert_eq!(turned, wrong.len());
        assert!((volume(&mended) - volume(&sound)).abs() < 1e-6);
    }
}

#[test]
fn corners_need_not_be_shared() {
    let sound = with_turned(&box_mesh([0.0; 3], [1.0; 3]), |t| t == 3);
    let corners = sound.triangles().iter().flat_map(|t| sound.corners_mm(*t));
    let apart = (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    assert_eq!(faced(&mesh(corners.collect(), apart.collect())).1, 1);
}

#[test]
fn a_strip_with_one_side_only_stays_as_it_is() {
    // Seven squares around, the last joined to the first upside down.
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / 7.0;
    let rim = |i: u32, side: f64| {
        let (turn, half) = (angle(i), angle(i) / 2.0);
        let radius = 10.0 + side * half.cos();
        [radius * turn.cos(), radius * turn.sin(), side * half.sin()]
    };
    let vertices = (0..7).flat_map(|i| [rim(i, -1.0), rim(i, 1.0)]).collect();
    let triangles = (0..7_u32).flat_map(|i| {
        let [a, b] = [2 * i, 2 * i + 1];
        let [c, d] = if i < 6 { [a + 2, b + 2] } else { [1, 0] };
        [[a, c, d], [a, d, b]]
    });
    let strip = mesh(vertices, triangles.collect());
    assert_eq!(faced(&strip).0.triangles(), strip.triangles());
}

#[test]
fn meshes_without_triangles_or_with_collapsed_ones_do_no_harm() {
    assert_eq!(faced(&TriangleMesh::default()).1, 0);
    let collapsed = mesh(vec![[0.0; 3], [1.0, 0.0, 0.0]], vec![[0, 1, 1], [0, 0, 0]]);
    assert_eq!(faced(&collapsed).1, 0);
}

proptest! {
    #[test]
    fn whatever_is_turned_of_a_closed_body_it_comes_back(wrong in prop::collection::vec(any::<bool>(), 480)) {
        let sound = torus(20, 12);
        let (mended, _) = faced(&with_turned(&sound, |t| wrong[t]));
        prop_assert_eq!(mended.triangles().len(), sound.triangles().len());
        let topology = check_topology(&mended, &Task::default()).expect("nobody cancels");
        prop_assert_eq!(topology.inconsistent_edges, 0);
        prop_assert!(topology.watertight && topology.volume_mm3 > 0.0);
    }
}
