//! What is done to finished meshes: fewer triangles, smoother, without islands or cavities.

#![allow(clippy::unwrap_used, reason = "tests")]
#![allow(clippy::float_cmp, reason = "rounded volumes and equal bytes")]

mod shapes;

use std::num::NonZeroUsize;

use bonemesh_mesh::{
    Decimation, Islands, MeshError, Topology, TriangleMesh, TriangleTree, check_topology, decimate,
    fill_cavities, find_intersections, keep_islands, smooth,
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

/// A box that faces inward.
fn hollow(low: [f64; 3], high: [f64; 3]) -> TriangleMesh {
    mesh(
        box_vertices(low, high),
        BOX.map(|[a, b, c]| [a, c, b]).to_vec(),
    )
}

/// A torus with bumps, which differ from seed to seed.
fn bumpy(columns: u32, rows: u32, height: f64, seed: f64) -> TriangleMesh {
    let (vertices, triangles) = torus(columns, rows).into_parts();
    let bump = |[x, y, z]: [f64; 3]| {
        let lift =
            1.0 + height * ((x * 0.9 + seed).sin() + (y * 1.1 - seed).cos() + (z * 1.3).sin());
        [x * lift, y * lift, z * lift]
    };
    mesh(vertices.into_iter().map(bump).collect(), triangles)
}

/// The surface of unit cubes on a lattice, `is_full` ones, with vertices shared.
fn cubes(size: i32, is_full: impl Fn([i32; 3]) -> bool) -> TriangleMesh {
    let mut all = TriangleMesh::default();
    for i in 0..size.pow(3) {
        let at = [i % size, i / size % size, i / size / size];
        if !is_full(at) {
            continue;
        }
        let low = at.map(f64::from);
        let cube = box_vertices(low, low.map(|v| v + 1.0));
        let steps = [
            [-1, 0, 0],
            [1, 0, 0],
            [0, -1, 0],
            [0, 1, 0],
            [0, 0, -1],
            [0, 0, 1],
        ];
        let sides = steps.iter().zip(BOX.chunks(2)).filter(|(step, _)| {
            let beside = [0, 1, 2].map(|axis| at[axis] + step[axis]);
            !(beside.iter().all(|v| (0..size).contains(v)) && is_full(beside))
        });
        let triangles = sides.flat_map(|(_, side)| side.iter().copied()).collect();
        all = together(&all, &mesh(cube, triangles));
    }
    all.merged().compacted()
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

fn assert_sound(before: &Topology, after: &TriangleMesh) {
    let topology = topology(after);
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    assert_eq!(topology.degenerate_triangles, 0);
    assert_eq!(topology.components, before.components);
    let handles =
        |t: &Topology| t.vertices as i64 - t.unused_vertices as i64 - t.triangles as i64 / 2;
    assert_eq!(handles(&topology), handles(before));
    assert_eq!(meetings(after), 0);
    assert_eq!(&after.as_written().unwrap(), after);
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
    let given = bumpy(300, 200, 0.003, 0.7).as_written().unwrap();
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
        decimated(&cubes(4, |_| true), to_triangles(0))
            .triangles()
            .len(),
        4
    );
    assert!(decimated(&torus(12, 8), to_triangles(0)).triangles().len() >= 14);
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
    for triangles in [4000, 800] {
        assert_sound(&before, &decimated(&given, to_triangles(triangles)));
    }
}

#[test]
fn the_error_bound_holds_both_ways_and_less_of_it_leaves_more_triangles() {
    let given = bumpy(60, 30, 0.01, 0.3).as_written().unwrap();
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
    for result in [
        decimated(&beams, within_error(0.01)),
        smooth(&beams, 0.1, &Task::default()).unwrap().mesh,
    ] {
        let after = topology(&result);
        assert!(after.watertight && after.non_manifold_edges == before.non_manifold_edges);
    }
}

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
fn islands_go_by_their_volume_and_take_their_cavities_along() {
    let big = together(&box_mesh([0.0; 3], [10.0; 3]), &hollow([1.0; 3], [9.0; 3]));
    let small = together(
        &box_mesh([20.0; 3], [25.0; 3]),
        &hollow([21.0; 3], [24.0; 3]),
    );
    let floating = box_mesh([4.0; 3], [6.0; 3]);
    let all = together(&together(&small, &big), &floating);
    let kept = |keep| keep_islands(&all, keep, &Task::default()).unwrap();
    let volume = |mesh: &TriangleMesh| topology(mesh).volume_mm3.round();

    let largest = kept(Islands::Largest);
    assert_eq!(
        (volume(&largest.mesh), largest.removed.len()),
        (1000.0 - 512.0, 3)
    );
    let removed: Vec<(f64, bool)> = largest
        .removed
        .iter()
        .map(|r| (r.volume_mm3.round(), r.is_cavity))
        .collect();
    assert_eq!(removed, [(125.0, false), (27.0, true), (8.0, false)]);
    assert_eq!(kept(Islands::AtLeastMm3(8.5)).removed.len(), 1);
    assert_eq!(kept(Islands::AtLeastMm3(7.5)).mesh, all);
    assert!(kept(Islands::AtLeastMm3(1e6)).mesh.triangles().is_empty());
}

#[test]
fn filled_cavities_take_along_what_floats_in_them() {
    let body = together(&box_mesh([0.0; 3], [10.0; 3]), &hollow([1.0; 3], [8.0; 3]));
    let inner = together(&box_mesh([2.0; 3], [7.0; 3]), &hollow([3.0; 3], [5.0; 3]));
    let pore = hollow([8.5; 3], [9.5; 3]);
    let all = together(&together(&body, &inner), &pore);
    let filled = |most| fill_cavities(&all, most, &Task::default()).unwrap();
    let volume = |mesh: &TriangleMesh| topology(mesh).volume_mm3.round();
    assert_eq!(volume(&filled(None).mesh), 1000.0);
    assert_eq!(filled(None).removed.len(), 4);
    assert_eq!(filled(Some(8.5)).removed.len(), 2);
    assert_eq!(
        volume(&filled(Some(1.5)).mesh),
        1000.0 - 343.0 + 125.0 - 8.0
    );
    // Nothing encloses an inverted body, so it is none.
    let inverted = hollow([0.0; 3], [1.0; 3]);
    assert_eq!(
        fill_cavities(&inverted, None, &Task::default())
            .unwrap()
            .mesh,
        inverted
    );
}

#[test]
fn a_body_in_a_bend_of_another_is_not_in_it() {
    let bar = box_mesh([-3.0; 3], [3.0; 3]);
    let both = together(&torus(60, 40), &bar);
    let kept = keep_islands(&both, Islands::AtLeastMm3(1000.0), &Task::default()).unwrap();
    assert_eq!(kept.mesh.triangles().len(), 60 * 40 * 2);
    let turned = together(&torus(60, 40), &hollow([-3.0; 3], [3.0; 3]));
    assert!(
        fill_cavities(&turned, None, &Task::default())
            .unwrap()
            .removed
            .is_empty()
    );
}

#[test]
fn tiny_and_empty_meshes_pass_and_bad_numbers_are_refused() {
    let task = Task::default();
    let point = mesh(vec![[1.0; 3]; 3], vec![[0, 1, 2], [0, 0, 1]]);
    for given in [TriangleMesh::default(), mesh(vec![[1.0; 3]], vec![]), point] {
        assert!(decimate(&given, to_triangles(1), &task).is_ok());
        assert!(smooth(&given, 1.0, &task).is_ok());
        assert!(keep_islands(&given, Islands::Largest, &task).is_ok());
        assert!(fill_cavities(&given, None, &task).is_ok());
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let given = box_mesh([0.0; 3], [1.0; 3]);
        let refused = [
            decimate(&given, within_error(bad), &task).unwrap_err(),
            smooth(&given, bad, &task).unwrap_err(),
        ];
        assert!(
            refused
                .iter()
                .all(|e| matches!(e, MeshError::Length { .. }))
        );
        let refused = [
            keep_islands(&given, Islands::AtLeastMm3(bad), &task).unwrap_err(),
            fill_cavities(&given, Some(bad), &task).unwrap_err(),
        ];
        assert!(
            refused
                .iter()
                .all(|e| matches!(e, MeshError::Volume { .. }))
        );
    }
}

#[test]
fn a_cancelled_task_stops_each_of_them() {
    let task = Task::default();
    task.cancel().cancel();
    let given = torus(20, 10);
    assert!(matches!(
        decimate(&given, to_triangles(50), &task),
        Err(MeshError::Cancelled(_))
    ));
    assert!(matches!(
        smooth(&given, 0.1, &task),
        Err(MeshError::Cancelled(_))
    ));
    assert!(matches!(
        keep_islands(&given, Islands::Largest, &task),
        Err(MeshError::Cancelled(_))
    ));
    assert!(matches!(
        fill_cavities(&given, None, &task),
        Err(MeshError::Cancelled(_))
    ));
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let given = bumpy(150, 70, 0.01, 1.0);
    let all = [1, 2, 5].map(|threads| {
        pool(NonZeroUsize::new(threads)).unwrap().install(|| {
            let fewer = decimated(&given, to_triangles(3000));
            (
                smooth(&fewer, 0.2, &Task::default()).unwrap(),
                decimated(&given, within_error(0.1)),
            )
        })
    });
    assert!(all.iter().all(|result| *result == all[0]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn lattice_bodies_stay_closed_and_within_every_promise(
        full in prop::collection::vec(prop::bool::weighted(0.6), 125),
        triangles in 4_usize..300,
        tolerance_mm in 0.01_f64..0.6,
    ) {
        let given = cubes(5, |[x, y, z]| full[(x + 5 * y + 25 * z) as usize]);
        let before = topology(&given);
        let fewer = decimated(&given, to_triangles(triangles));
        let smoothed = smooth(&given, tolerance_mm, &Task::default()).unwrap();
        let near = decimated(&given, within_error(tolerance_mm));
        for result in [&fewer, &smoothed.mesh, &near] {
            let after = topology(result);
            prop_assert_eq!(after.watertight, before.watertight);
            prop_assert_eq!(after.non_manifold_edges, before.non_manifold_edges);
            prop_assert_eq!(after.components, before.components);
            prop_assert_eq!(after.degenerate_triangles, 0);
            prop_assert_eq!(meetings(result), meetings(&given));
        }
        prop_assert!(smoothed.largest_move_mm <= tolerance_mm);
        prop_assert!(largest_distance(&given, &near) <= tolerance_mm);
        prop_assert!(largest_distance(&near, &given) <= tolerance_mm);
    }

    #[test]
    fn bumpy_bodies_stay_sound(seed in 0.0_f64..6.0, height in 0.0_f64..0.03, part in 3_usize..20) {
        let given = bumpy(48, 24, height, seed).as_written().unwrap();
        prop_assume!(meetings(&given) == 0);
        let before = topology(&given);
        let result = decimated(&given, to_triangles(given.triangles().len() / part));
        assert_sound(&before, &result);
        let smoothed = smooth(&given, 0.3, &Task::default()).unwrap();
        assert_sound(&before, &smoothed.mesh);
    }
}
