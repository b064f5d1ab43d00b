//! Fewer triangles: closed, free of meetings, within the error bound.

#![allow(clippy::unwrap_used, reason = "tests")]

mod bodies;
mod shapes;

use std::num::NonZeroUsize;

use bodies::{assert_sound, bumpy, cubes, meetings, topology};
use bonemesh_mesh::{Decimation, MeshError, TriangleMesh, decimate};
use bonemesh_task::{Task, pool};
use proptest::prelude::*;
use shapes::{box_mesh, mesh, together, torus};

fn to_triangles(triangles: usize) -> Decimation {
    Decimation {
        triangles: Some(triangles),
        error_mm: None,
    }
}

fn within_error(error_mm: f64) -> Decimation {
    Decimation {
        triangles: None,
        error_mm: Some(error_mm),
    }
}

fn decimated(mesh: &TriangleMesh, goal: Decimation) -> TriangleMesh {
    decimate(mesh, goal, &Task::default()).unwrap().mesh
}

/// Largest distance from corners, edge middles and centres of `from` to the nearest triangle of
/// `to`, by trying them all.
fn largest_distance(from: &TriangleMesh, to: &TriangleMesh) -> f64 {
    let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let squared = |p: [f64; 3], corners: [[f64; 3]; 3]| {
        // The nearest place has the coordinates (s, t) along two edges, inside or on the rim.
        let [a, b, c] = corners;
        let (ab, ac, ap) = (minus(b, a), minus(c, a), minus(p, a));
        let (bb, bc, cc) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
        let (pb, pc) = (dot(ap, ab), dot(ap, ac));
        let determinant = bb * cc - bc * bc;
        let free = (
            (cc * pb - bc * pc) / determinant,
            (bb * pc - bc * pb) / determinant,
        );
        let along = (
            ((pb - pc - bc + cc) / (bb - 2.0 * bc + cc)).clamp(0.0, 1.0),
            (),
        );
        let rim = [
            ((pb / bb).clamp(0.0, 1.0), 0.0),
            (0.0, (pc / cc).clamp(0.0, 1.0)),
            (along.0, 1.0 - along.0),
        ];
        let distance = |(s, t): (f64, f64)| {
            let away: [f64; 3] = std::array::from_fn(|i| ap[i] - s * ab[i] - t * ac[i]);
            dot(away, away)
        };
        if free.0 >= 0.0 && free.1 >= 0.0 && free.0 + free.1 <= 1.0 {
            return distance(free);
        }
        rim.map(distance).into_iter().fold(f64::INFINITY, f64::min)
    };
    let mut largest = 0.0_f64;
    for &triangle in from.triangles() {
        let [a, b, c] = from.corners_mm(triangle);
        let mean = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|i| f64::midpoint(p[i], q[i]));
        let centre = [0, 1, 2].map(|i| (a[i] + b[i] + c[i]) / 3.0);
        for point in [a, b, c, mean(a, b), mean(b, c), mean(c, a), centre] {
            let all = to
                .triangles()
                .iter()
                .map(|t| squared(point, to.corners_mm(*t)));
            largest = largest.max(all.fold(f64::INFINITY, f64::min));
        }
    }
    largest.sqrt()
}

#[test]
fn a_torus_keeps_its_hole_its_volume_and_the_number_asked_for() {
    let given = torus(120, 60);
    let before = topology(&given);
    for (triangles, bound) in [(7000, 0.005), (2000, 0.01), (500, 0.04)] {
        let result = decimated(&given, to_triangles(triangles));
        assert_eq!(result.triangles().len(), triangles);
        assert_sound(&before, &result);
        let change = topology(&result).volume_mm3 / before.volume_mm3 - 1.0;
        assert!(change.abs() < bound, "{triangles}: {change}");
    }
}

#[test]
fn a_large_mesh_is_done_in_blocks_with_the_same_promises_for_any_number_of_threads() {
    let given = bumpy(300, 200, 0.003, 0.7)
        .as_written(&Task::default())
        .unwrap();
    let before = topology(&given);
    let goals = [to_triangles(20_000), to_triangles(3000), within_error(0.02)];
    for goal in goals {
        let all = [1, 3].map(|threads| {
            let threads = pool(NonZeroUsize::new(threads)).unwrap();
            threads.install(|| decimated(&given, goal))
        });
        assert_eq!(all[0], all[1]);
        assert_sound(&before, &all[0]);
        let triangles = all[0].triangles().len();
        assert!(triangles <= goal.triangles.unwrap_or(60_000), "{triangles}");
        let change = topology(&all[0]).volume_mm3 / before.volume_mm3 - 1.0;
        assert!(change.abs() < 0.004, "{triangles}: {change}");
    }
}

#[test]
fn a_box_of_many_triangles_becomes_one_of_twelve_with_the_same_corners() {
    let given = cubes(8, |_| true);
    let result = decimated(&given, within_error(1e-3));
    assert_eq!(result.triangles().len(), 12);
    assert!((topology(&result).volume_mm3 - 512.0).abs() < 1e-2);
}

#[test]
fn no_number_goes_below_the_simplest_body_of_the_kind() {
    assert_eq!(
        decimated(&cubes(4, |_| true), to_triangles(4))
            .triangles()
            .len(),
        4
    );
    assert!(decimated(&torus(12, 8), to_triangles(4)).triangles().len() >= 14);
}

#[test]
fn sheets_that_lie_close_together_do_not_pass_through_one_another() {
    let shell = |radius: f64, facing: bool| {
        let (vertices, triangles) = torus(90, 45).into_parts();
        let pull = |[x, y, z]: [f64; 3]| {
            let ring = (x * x + y * y).sqrt();
            let (across, up) = (ring - 40.0, z);
            let part = (40.0 + across * radius) / ring;
            [x * part, y * part, up * radius]
        };
        let turn = |[a, b, c]: [u32; 3]| if facing { [a, b, c] } else { [a, c, b] };
        mesh(
            vertices.into_iter().map(pull).collect(),
            triangles.into_iter().map(turn).collect(),
        )
    };
    let given = together(&shell(1.0, true), &shell(0.97, false));
    let before = topology(&given);
    for triangles in [4000, 800, 200, 20] {
        let result = decimated(&given, to_triangles(triangles));
        assert_sound(&before, &result);
        // Where the sheets would meet, some more triangles stay, not all that there were.
        let left = result.triangles().len();
        assert!(left <= triangles.max(given.triangles().len() / 3), "{left}");
    }
}

#[test]
fn the_error_bound_holds_both_ways_and_less_of_it_leaves_more_triangles() {
    let given = bumpy(60, 30, 0.01, 0.3)
        .as_written(&Task::default())
        .unwrap();
    let before = topology(&given);
    let mut last = usize::MAX;
    for error_mm in [0.02, 0.2, 1.0] {
        let result = decimated(&given, within_error(error_mm));
        assert_sound(&before, &result);
        assert!(largest_distance(&given, &result) <= error_mm);
        assert!(largest_distance(&result, &given) <= error_mm);
        assert!(result.triangles().len() < last);
        last = result.triangles().len();
    }
    assert!(last < given.triangles().len() / 4, "{last}");
}

#[test]
fn rims_and_non_manifold_edges_stay_where_they_are() {
    let open = {
        let (vertices, mut triangles) = torus(40, 20).into_parts();
        triangles.truncate(1200);
        mesh(vertices, triangles)
    };
    let before = topology(&open);
    let result = decimated(&open, to_triangles(200));
    let after = topology(&result);
    assert_eq!(after.boundary_edges, before.boundary_edges);
    assert!(after.manifold && after.triangles < before.triangles);

    let beams = cubes(6, |[x, y, _]| (x < 3) == (y < 3));
    let before = topology(&beams);
    assert_eq!(before.non_manifold_edges, 6);
    let after = topology(&decimated(&beams, within_error(0.01)));
    assert!(after.watertight && after.non_manifold_edges == before.non_manifold_edges);
}

#[test]
fn an_error_bound_leaves_few_triangles_on_a_smooth_body() {
    let given = bumpy(200, 100, 0.004, 2.0)
        .as_written(&Task::default())
        .unwrap();
    let result = decimate(&given, within_error(0.1), &Task::default()).unwrap();
    assert_sound(&topology(&given), &result.mesh);
    let triangles = result.mesh.triangles().len();
    assert!(triangles < given.triangles().len() / 6, "{triangles}");
    assert_eq!(result.held_vertices, 0);
}

#[test]
fn tiny_and_empty_meshes_pass_and_bad_numbers_are_refused() {
    let task = Task::default();
    let point = mesh(vec![[1.0; 3]; 3], vec![[0, 1, 2], [0, 0, 1]]);
    for given in [TriangleMesh::default(), mesh(vec![[1.0; 3]], vec![]), point] {
        for goal in [to_triangles(4), within_error(1.0)] {
            assert!(decimate(&given, goal, &task).is_ok());
        }
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let given = box_mesh([0.0; 3], [1.0; 3]);
        let refused = decimate(&given, within_error(bad), &task).unwrap_err();
        assert!(matches!(refused, MeshError::Length { .. }));
    }
    for few in 0..4 {
        let refused = decimate(&box_mesh([0.0; 3], [1.0; 3]), to_triangles(few), &task);
        assert!(
            matches!(refused, Err(MeshError::TooFewTriangles { triangles }) if triangles == few)
        );
    }
}

/// A ring of quads with a lid at either end, every corner shaken.
fn crumb(around: u32, shaken: &[f64]) -> TriangleMesh {
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(around);
    let ring = |z: f64| (0..around).map(move |i| [angle(i).cos(), angle(i).sin(), z]);
    let mut vertices: Vec<[f64; 3]> = ring(-0.5).chain(ring(0.5)).collect();
    vertices.extend([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]);
    for (value, shake) in vertices.as_flattened_mut().iter_mut().zip(shaken) {
        *value += shake;
    }
    let (bottom, top) = (2 * around, 2 * around + 1);
    let triangles = (0..around).flat_map(|a| {
        let b = (a + 1) % around;
        let (c, d) = (a + around, b + around);
        [[a, b, d], [a, d, c], [b, a, bottom], [c, d, top]]
    });
    mesh(vertices, triangles.collect())
}

proptest! {
    #[test]
    fn no_crumb_is_turned_inside_out(around in 3_u32..7, shaken in prop::collection::vec(-0.6..0.6, 42)) {
        let given = crumb(around, &shaken);
        prop_assume!(topology(&given).volume_mm3 > 0.0);
        for count in [4, 8, 12] {
            prop_assert!(topology(&decimated(&given, to_triangles(count))).volume_mm3 > 0.0);
        }
    }
}

#[test]
fn a_cancelled_task_stops_it() {
    let task = Task::default();
    task.cancel().cancel();
    let result = decimate(&torus(20, 10), to_triangles(50), &task);
    assert!(matches!(result, Err(MeshError::Cancelled(_))));
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let given = bumpy(150, 70, 0.01, 1.0);
    let all = [1, 2, 5].map(|threads| {
        pool(NonZeroUsize::new(threads))
            .unwrap()
            .install(|| [to_triangles(3000), within_error(0.1)].map(|goal| decimated(&given, goal)))
    });
    assert!(all.iter().all(|result| *result == all[0]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn lattice_bodies_stay_closed_and_within_every_promise(
        full in prop::collection::vec(prop::bool::weighted(0.6), 125),
        triangles in 4_usize..300,
        error_mm in 0.01_f64..0.6,
    ) {
        let given = cubes(5, |[x, y, z]| full[(x + 5 * y + 25 * z) as usize]);
        let before = topology(&given);
        let fewer = decimated(&given, to_triangles(triangles));
        let near = decimated(&given, within_error(error_mm));
        for result in [&fewer, &near] {
            let after = topology(result);
            prop_assert_eq!(after.watertight, before.watertight);
            prop_assert_eq!(after.non_manifold_edges, before.non_manifold_edges);
            prop_assert_eq!(after.components, before.components);
            prop_assert_eq!(after.degenerate_triangles, 0);
            prop_assert_eq!(meetings(result), meetings(&given));
        }
        prop_assert!(largest_distance(&given, &near) <= error_mm);
        prop_assert!(largest_distance(&near, &given) <= error_mm);
    }

    #[test]
    fn bumpy_bodies_stay_sound(seed in 0.0_f64..6.0, height in 0.0_f64..0.03, part in 3_usize..20) {
        let given = bumpy(48, 24, height, seed).as_written(&Task::default()).unwrap();
        prop_assume!(meetings(&given) == 0);
        let fewer = decimated(&given, to_triangles(given.triangles().len() / part));
        assert_sound(&topology(&given), &fewer);
    }
}
