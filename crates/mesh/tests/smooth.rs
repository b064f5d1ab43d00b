//! Smoothing: closed, free of meetings, within the tolerance.

#![allow(clippy::unwrap_used, reason = "tests")]

mod bodies;
mod shapes;

use std::num::NonZeroUsize;

use bodies::{assert_sound, bumpy, cubes, meetings, topology};
use bonemesh_mesh::{MeshError, TriangleMesh, smooth};
use bonemesh_task::{Task, pool};
use proptest::prelude::*;
use shapes::{box_mesh, mesh, torus};

#[test]
fn smoothing_takes_steps_away_and_neither_shrinks_nor_leaves_the_tolerance() {
    let ball = |[x, y, z]: [i32; 3]| {
        [x, y, z]
            .iter()
            .map(|v| (f64::from(*v) - 9.5).powi(2))
            .sum::<f64>()
            < 81.0
    };
    let given = cubes(20, ball);
    let before = topology(&given);
    assert!(before.manifold);
    let roughness = |mesh: &TriangleMesh| {
        let topology = topology(mesh);
        topology.area_mm2 / topology.volume_mm3.powf(2.0 / 3.0)
    };
    let mut last = roughness(&given);
    for tolerance_mm in [0.1, 0.5] {
        let smoothed = smooth(&given, tolerance_mm, &Task::default()).unwrap();
        assert_sound(&before, &smoothed.mesh);
        assert!(smoothed.largest_move_mm <= tolerance_mm);
        for (from, to) in given.vertices_mm().iter().zip(smoothed.mesh.vertices_mm()) {
            let squared: f64 = (0..3).map(|i| (to[i] - from[i]).powi(2)).sum();
            assert!(squared.sqrt() <= tolerance_mm);
        }
        let change = topology(&smoothed.mesh).volume_mm3 / before.volume_mm3 - 1.0;
        assert!(change.abs() < 0.02, "{change}");
        assert!(roughness(&smoothed.mesh) < last);
        last = roughness(&smoothed.mesh);
    }
}

#[test]
fn non_manifold_edges_stay_where_they_are() {
    let beams = cubes(6, |[x, y, _]| (x < 3) == (y < 3));
    let before = topology(&beams);
    assert_eq!(before.non_manifold_edges, 6);
    let after = topology(&smooth(&beams, 0.1, &Task::default()).unwrap().mesh);
    assert!(after.watertight && after.non_manifold_edges == before.non_manifold_edges);
}

#[test]
fn tiny_and_empty_meshes_pass_and_bad_numbers_are_refused() {
    let task = Task::default();
    let point = mesh(vec![[1.0; 3]; 3], vec![[0, 1, 2], [0, 0, 1]]);
    for given in [TriangleMesh::default(), mesh(vec![[1.0; 3]], vec![]), point] {
        assert!(smooth(&given, 1.0, &task).is_ok());
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let refused = smooth(&box_mesh([0.0; 3], [1.0; 3]), bad, &task).unwrap_err();
        assert!(matches!(refused, MeshError::Length { .. }));
    }
}

#[test]
fn a_cancelled_task_stops_it() {
    let task = Task::default();
    task.cancel().cancel();
    let result = smooth(&torus(20, 10), 0.1, &task);
    assert!(matches!(result, Err(MeshError::Cancelled(_))));
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let given = bumpy(50, 30, 0.01, 1.0);
    let all = [1, 2, 5].map(|threads| {
        let threads = pool(NonZeroUsize::new(threads)).unwrap();
        threads.install(|| smooth(&given, 0.2, &Task::default()).unwrap())
    });
    assert!(all.iter().all(|result| *result == all[0]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn lattice_bodies_stay_closed_and_within_the_tolerance(
        full in prop::collection::vec(prop::bool::weighted(0.6), 125),
        tolerance_mm in 0.01_f64..0.6,
    ) {
        let given = cubes(5, |[x, y, z]| full[(x + 5 * y + 25 * z) as usize]);
        let before = topology(&given);
        let smoothed = smooth(&given, tolerance_mm, &Task::default()).unwrap();
        let after = topology(&smoothed.mesh);
        prop_assert_eq!(after.watertight, before.watertight);
        prop_assert_eq!(after.non_manifold_edges, before.non_manifold_edges);
        prop_assert_eq!(after.components, before.components);
        prop_assert_eq!(after.degenerate_triangles, 0);
        prop_assert_eq!(meetings(&smoothed.mesh), meetings(&given));
        prop_assert!(smoothed.largest_move_mm <= tolerance_mm);
    }

    #[test]
    fn bumpy_bodies_stay_sound(seed in 0.0_f64..6.0, height in 0.0_f64..0.03) {
        let given = bumpy(48, 24, height, seed).as_written(&Task::default()).unwrap();
        prop_assume!(meetings(&given) == 0);
        let smoothed = smooth(&given, 0.3, &Task::default()).unwrap();
        assert_sound(&topology(&given), &smoothed.mesh);
    }
}
