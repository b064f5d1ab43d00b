//! Solids cut out of bodies whose walls are known.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::HashSet;
use std::f64::consts::PI;
use std::num::NonZeroUsize;

use bonemesh_mesh::{TriangleMesh, TriangleTree, check_topology, find_intersections};
use bonemesh_roi::{RoiError, Solid, ThicknessMm, select_solid};
use bonemesh_surface::level_surface;
use bonemesh_task::{Task, pool};
use bonemesh_volume::Affine;

const STEP_MM: f64 = 0.25;

/// The surface of a body given by how far (mm) places are inside of it, in a box around the origin.
fn body(half_mm: [f64; 3], inside: impl Fn([f64; 3]) -> f64) -> TriangleMesh {
    let shape = half_mm.map(|half| (2.0 * half / STEP_MM) as usize + 3);
    let first = half_mm.map(|half| -half - STEP_MM * 0.73);
    let [i, j, k] = shape;
    let mut values = Vec::new();
    for node in 0..i * j * k {
        let at = [node % i, node / i % j, node / i / j];
        let place = [0, 1, 2].map(|axis| first[axis] + STEP_MM * at[axis] as f64);
        values.push(inside(place) as f32);
    }
    let affine = Affine::from_axes(
        [STEP_MM, 0.0, 0.0],
        [0.0, STEP_MM, 0.0],
        [0.0, 0.0, STEP_MM],
        first,
    );
    let task = Task::default();
    let mesh = level_surface(&values, shape, &affine, &task)
        .unwrap()
        .unwrap();
    mesh.as_written(&task).unwrap()
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// A ball of 20 mm with a hollow of 14 mm.
fn shell() -> TriangleMesh {
    body([21.0; 3], |p| (20.0 - length(p)).min(length(p) - 14.0))
}

fn selected(mesh: &TriangleMesh, is_in: impl Fn([f64; 3]) -> bool) -> Vec<u32> {
    let vertices = (0..).zip(mesh.vertices_mm());
    vertices
        .filter(|(_, v)| is_in(**v))
        .map(|(n, _)| n)
        .collect()
}

fn solid(mesh: &TriangleMesh, selected: &[u32], thickness_mm: f64) -> Solid {
    let thickness = ThicknessMm::new(thickness_mm).unwrap();
    let solid = select_solid(mesh, selected, thickness, &Task::default()).unwrap();
    let task = Task::default();
    let topology = check_topology(&solid.mesh, &task).unwrap();
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    assert_eq!(
        topology.inconsistent_edges + topology.degenerate_triangles,
        0
    );
    assert!(topology.volume_mm3 > 0.0);
    let tree = TriangleTree::new(&solid.mesh, &task).unwrap();
    assert_eq!(find_intersections(&tree, 1, &task).unwrap().count, 0);
    solid
}

fn volume_mm3(solid: &Solid) -> f64 {
    check_topology(&solid.mesh, &Task::default())
        .unwrap()
        .volume_mm3
}

#[test]
fn a_cap_of_a_shell_has_the_volume_of_the_cone_for_any_thickness() {
    let shell = shell();
    let half_angle = 0.5_f64;
    // Across the lattice: along it, a whole ring of vertices would lie just inside or outside.
    let along = |[x, y, z]: [f64; 3]| (2.0 * x - y + 3.0 * z) / 14.0_f64.sqrt();
    let is_in = |p: [f64; 3]| length(p) > 17.0 && along(p) > length(p) * half_angle.cos();
    let patch = selected(&shell, is_in);
    for thickness in [1.5, 3.0, 6.0, 9.0] {
        let solid = solid(&shell, &patch, thickness);
        let inner = 20.0_f64 - thickness.min(6.0);
        let cone = 2.0 * PI * (1.0 - half_angle.cos()) / 3.0;
        let expected = cone * (20.0_f64.powi(3) - inner.powi(3));
        let part = volume_mm3(&solid) / expected;
        assert!((part - 1.0).abs() < 0.01, "{thickness} mm: {part}");
        for place in solid.mesh.vertices_mm() {
            let radius = length(*place);
            assert!(
                (inner - 0.1..20.1).contains(&radius),
                "{thickness} mm: {radius}"
            );
            let angle = (along(*place) / radius).acos();
            let beyond_mm = (angle - half_angle) * radius;
            // At the front about half an edge, which is as near as selected vertices say it.
            let most_mm = if radius > 19.95 { 0.6 } else { 0.8 } * STEP_MM;
            assert!(
                beyond_mm < most_mm,
                "{thickness} mm: {beyond_mm} at {radius}"
            );
        }
    }
}

#[test]
fn the_front_is_the_patch_to_the_last_bit() {
    let shell = shell();
    let is_in = |p: [f64; 3]| length(p) > 17.0 && p[0] > 15.0;
    let patch = selected(&shell, is_in);
    let solid = solid(&shell, &patch, 4.0);
    let corners = |mesh: &TriangleMesh, t: &[u32; 3]| {
        let mut corners = mesh.corners_mm(*t).map(|c| c.map(f64::to_bits));
        corners.sort_unstable();
        corners
    };
    let triangles = solid.mesh.triangles().iter();
    let cut: HashSet<_> = triangles.map(|t| corners(&solid.mesh, t)).collect();
    let well_inside = |t: &&[u32; 3]| {
        let places = shell.corners_mm(**t);
        places.iter().all(|p| length(*p) > 17.0 && p[0] > 15.6)
    };
    let front: Vec<_> = shell.triangles().iter().filter(well_inside).collect();
    assert!(front.len() > 500);
    let kept = front.iter().filter(|t| cut.contains(&corners(&shell, t)));
    assert_eq!(kept.count(), front.len());
}

#[test]
fn walls_of_a_tube_are_cut_upright_around_its_curl() {
    let tube = body([16.0, 16.0, 20.0], |[x, y, z]| {
        let radius = x.hypot(y);
        (15.0 - radius).min(radius - 9.0).min(18.0 - z.abs())
    });
    // Almost half around, 20 mm high, from between two layers of the lattice to between two others.
    let is_in = |[x, y, z]: [f64; 3]| {
        x.hypot(y) > 12.0 && y.atan2(x).abs() < 1.4 && (z + 0.0575).abs() < 10.0
    };
    let patch = selected(&tube, is_in);
    for thickness in [2.0, 6.0, 8.0] {
        let solid = solid(&tube, &patch, thickness);
        let inner = 15.0_f64 - thickness.min(6.0);
        let expected = 1.4 * (15.0_f64.powi(2) - inner.powi(2)) * 20.0;
        let part = volume_mm3(&solid) / expected;
        assert!((part - 1.0).abs() < 0.01, "{thickness} mm: {part}");
    }
}

#[test]
fn a_plate_is_cut_straight_through_or_part_of_the_way() {
    let plate = body([25.0, 25.0, 3.0], |[x, y, z]| {
        (24.0 - x.abs()).min(24.0 - y.abs()).min(2.0 - z.abs())
    });
    let is_in = |[x, y, z]: [f64; 3]| z > 1.5 && x.hypot(y) < 10.0;
    let patch = selected(&plate, is_in);
    for thickness in [1.0, 4.0, 5.0] {
        let solid = solid(&plate, &patch, thickness);
        let expected = PI * 100.0 * thickness.min(4.0);
        let part = volume_mm3(&solid) / expected;
        assert!((part - 1.0).abs() < 0.01, "{thickness} mm: {part}");
    }
}

#[test]
fn the_solid_does_not_depend_on_threads_or_on_the_order_of_the_selection() {
    let shell = shell();
    let mut patch = selected(&shell, |p| length(p) > 17.0 && p[1] > 16.0);
    let cut = |patch: &[u32], threads| {
        let pool = pool(NonZeroUsize::new(threads)).unwrap();
        pool.install(|| solid(&shell, patch, 3.0))
    };
    let one = cut(&patch, 1);
    assert_eq!(one, cut(&patch, 5));
    patch.reverse();
    patch.push(patch[0]);
    assert_eq!(one, cut(&patch, 2));
}

#[test]
fn what_cannot_be_cut_is_refused() {
    let shell = shell();
    let thickness = ThicknessMm::new(3.0).unwrap();
    let cut = |mesh: &TriangleMesh, selected: &[u32]| {
        select_solid(mesh, selected, thickness, &Task::default()).unwrap_err()
    };
    assert!(matches!(cut(&shell, &[]), RoiError::NoSelection));
    assert!(matches!(cut(&shell, &[u32::MAX]), RoiError::Index { .. }));
    let far = selected(&shell, |p| length(p) > 17.0 && p[0].abs() > 19.9);
    let [first, last] = [far[0], far[far.len() - 1]];
    assert!(matches!(
        cut(&shell, &[first, last]),
        RoiError::NoFace { selected: 2 }
    ));
    let patch = selected(&shell, |p| length(p) > 17.0 && p[2] > 17.0);
    let lid = |t: &&[u32; 3]| !t.contains(&patch[patch.len() / 2]);
    let open: Vec<[u32; 3]> = shell.triangles().iter().filter(lid).copied().collect();
    let open = TriangleMesh::new(shell.vertices_mm().to_vec(), open).unwrap();
    assert!(matches!(cut(&open, &patch), RoiError::Open));
    let task = Task::default();
    task.cancel().cancel();
    let cancelled = select_solid(&shell, &patch, thickness, &task).unwrap_err();
    assert!(matches!(cancelled, RoiError::Cancelled(_)));
}
