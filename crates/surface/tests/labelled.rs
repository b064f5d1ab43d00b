//! Promises of surfaces by labelled tetrahedra, on volumes whose truth is a formula.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use bonemesh_mesh::{TriangleMesh, check_topology};
use bonemesh_surface::{IsosurfaceSettings, SurfaceError, isosurface, labelled_surface};
use bonemesh_task::{Cancel, Task, pool};
use bonemesh_volume::{Affine, Volume};
use common::{BONE_HU, PIXEL_MM, SOFT_HU, at, blurred, length, mean, mirrored, volume};
use proptest::prelude::*;

fn surface(volume: &Volume, settings: IsosurfaceSettings<'_>) -> TriangleMesh {
    let surface = labelled_surface(volume, settings, &Task::default()).unwrap();
    assert_is_closed(&surface.mesh);
    surface.mesh
}

fn assert_is_closed(mesh: &TriangleMesh) {
    // 32-bit coordinates hold its vertices exactly.
    let written = mesh.as_written(&Task::default()).unwrap();
    assert_eq!(written.vertices_mm(), mesh.vertices_mm());
    common::assert_is_closed(mesh);
}

#[test]
fn a_blurred_ball_has_its_true_radius_at_any_threshold() {
    let radius = 9.3;
    let ball = volume([27, 52, 50], 1.0, |p| blurred(radius - length(p)));
    for threshold_hu in [200.0, 350.0, 640.0, 800.0, 1000.0] {
        let mesh = surface(&ball, at(threshold_hu, true));
        let error = |v: &[f64; 3]| length(*v) - radius;
        let signed = mean(mesh.vertices_mm().iter().map(error));
        let size = mean(mesh.vertices_mm().iter().map(|v| error(v).abs()));
        assert!(signed.abs() < 0.02, "{threshold_hu} HU: {signed} mm");
        assert!(size < 0.03, "{threshold_hu} HU: {size} mm");
        let topology = check_topology(&mesh, &Task::default()).unwrap();
        assert_eq!(2 * topology.vertices, topology.triangles + 4, "a sphere");
    }
    let plain = surface(&ball, at(200.0, false));
    let is_outside = |v: &[f64; 3]| length(*v) > radius + 0.1;
    assert!(plain.vertices_mm().iter().all(is_outside));
}

/// Depth in a cone of 45 degrees that is cut off at both ends of the scan.
fn in_cone([x, y, z]: [f64; 3]) -> f64 {
    (14.0 + 0.7 * z - x.hypot(y)) / 1.49f64.sqrt()
}

/// Mean over the slices' thickness.
fn through_slice(p: [f64; 3], slice_mm: f64, hu: impl Fn([f64; 3]) -> f64) -> f64 {
    mean((0..20).map(|i| {
        let z = p[2] + slice_mm * ((f64::from(i) + 0.5) / 20.0 - 0.5);
        hu([p[0], p[1], z])
    }))
}

/// Mean angle in degrees between triangles and the cone, and mean distance of their middles.
fn against_cone(mesh: &TriangleMesh) -> (f64, f64) {
    let (mut angles, mut distances, mut area) = (0.0, 0.0, 0.0);
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|v| mesh.vertices_mm()[v as usize]);
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let middle = [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0);
        if middle[2].abs() > 10.0 {
            continue;
        }
        let around = middle[0].hypot(middle[1]);
        let outward = [middle[0] / around, middle[1] / around, -0.7];
        let dot: f64 = (0..3).map(|k| normal[k] * outward[k]).sum();
        let cosine = dot / length(normal) / length(outward);
        angles += length(normal) * cosine.clamp(-1.0, 1.0).acos().to_degrees();
        distances += length(normal) * in_cone(middle).abs();
        area += length(normal);
    }
    (angles / area, distances / area)
}

#[test]
fn slices_of_five_mm_make_no_stairs() {
    let cone = volume([7, 110, 110], 5.0, |p| {
        through_slice(p, 5.0, |p| blurred(in_cone(p)))
    });
    let settings = at(350.0, true);
    let (angle, distance) = against_cone(&surface(&cone, settings));
    let with_stairs = isosurface(&cone, settings, &Task::default()).unwrap();
    let (stairs_angle, stairs_distance) = against_cone(&with_stairs);
    assert!(2.0 * angle < stairs_angle, "{angle} {stairs_angle} degrees");
    assert!(
        2.0 * distance < stairs_distance,
        "{distance} {stairs_distance} mm"
    );
}

#[test]
fn nothing_above_the_threshold_is_said() {
    let soft = volume([3, 5, 5], 1.0, |_| SOFT_HU);
    for true_edges in [false, true] {
        let error = labelled_surface(&soft, at(350.0, true_edges), &Task::default()).unwrap_err();
        assert!(
            matches!(error, SurfaceError::NothingAbove { .. }),
            "{error}"
        );
    }
}

#[test]
fn a_speck_of_less_than_a_voxel_is_said_to_be_too_small() {
    let speck = volume(
        [3, 3, 3],
        1.0,
        |p| if length(p) < 0.1 { 351.0 } else { 0.0 },
    );
    let error = labelled_surface(&speck, at(350.0, false), &Task::default()).unwrap_err();
    assert!(matches!(error, SurfaceError::TooSmall { .. }), "{error}");
}

#[test]
fn bone_that_the_scan_cuts_off_is_closed_at_the_border() {
    for shape in [[1, 1, 1], [1, 4, 5], [3, 1, 2], [4, 4, 4], [1, 1, 9]] {
        for true_edges in [false, true] {
            let all = volume(shape, 1.0, |_| BONE_HU);
            let mesh = surface(&all, at(350.0, true_edges));
            let topology = check_topology(&mesh, &Task::default()).unwrap();
            assert_eq!(topology.components, 1);
            let voxel = PIXEL_MM * PIXEL_MM;
            let whole = shape.iter().product::<usize>() as f64 * voxel;
            // Edges and corners are cut off by half a voxel at most.
            assert!((whole / 8.0..whole).contains(&topology.volume_mm3));
        }
    }
}

#[test]
fn one_slice_of_a_disc_is_a_closed_plate() {
    let disc = volume([1, 40, 40], 5.0, |[x, y, _]| blurred(6.0 - x.hypot(y)));
    let mesh = surface(&disc, at(350.0, true));
    let topology = check_topology(&mesh, &Task::default()).unwrap();
    assert_eq!(topology.components, 1);
    let [low, high] = topology.bounds_mm.unwrap();
    assert!(high[2] - low[2] <= 5.0 && high[0] - low[0] > 11.5);
}

#[test]
fn left_handed_grids_face_outward_too() {
    let ball = volume([19, 30, 30], 1.0, |p| blurred(5.0 - length(p)));
    surface(&mirrored(ball), at(350.0, true));
}

#[test]
fn any_number_of_threads_gives_the_same_mesh() {
    let ball = volume([31, 60, 60], 1.0, |p| {
        blurred(11.0 - length(p)) + 30.0 * (9.0 * p[0]).sin()
    });
    let with = |threads| {
        let pool = pool(std::num::NonZeroUsize::new(threads)).unwrap();
        pool.install(|| surface(&ball, at(350.0, true)))
    };
    let one = with(1);
    assert!([2, 3, 8].into_iter().all(|threads| with(threads) == one));
}

#[test]
fn a_cancel_stops_it() {
    let ball = volume([19, 30, 30], 1.0, |p| blurred(5.0 - length(p)));
    let cancel = Cancel::default();
    cancel.cancel();
    let error = labelled_surface(&ball, at(350.0, true), &Task::new(cancel)).unwrap_err();
    assert!(matches!(error, SurfaceError::Cancelled(_)), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_voxels_have_a_closed_manifold_surface(
        shape in [1..7usize, 1..7usize, 1..30usize],
        seed in any::<u64>(),
        eighths in 1..8u64,
        slice_mm in prop_oneof![Just(0.4), Just(1.3), Just(5.0)],
        true_edges in any::<bool>(),
    ) {
        let voxels = common::random_voxels(shape, seed, eighths);
        prop_assume!(voxels.iter().any(|hu| *hu > 350));
        let map = Affine::from_axes([0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.1, slice_mm], [5.0; 3]);
        let volume = common::of_voxels(voxels, map);
        match labelled_surface(&volume, at(350.0, true_edges), &Task::default()) {
            Ok(surface) => assert_is_closed(&surface.mesh),
            // The grey halfway up can lie above every voxel of such noise, and specks can be less
            // than a tetrahedron.
            Err(error) => prop_assert!(matches!(error, SurfaceError::TooSmall { .. }), "{error}"),
        }
    }
}
