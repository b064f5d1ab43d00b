//! Promises of isosurfaces, on volumes whose truth is a formula.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use bonemesh_mesh::{TriangleMesh, check_topology};
use bonemesh_surface::{IsosurfaceSettings, SurfaceError, isosurface};
use bonemesh_task::{Task, pool};
use bonemesh_volume::{Affine, Volume};
use common::{BONE_HU, PIXEL_MM, assert_is_closed, at, blurred, length, mean, mirrored};
use ndarray::Array3;
use proptest::prelude::*;

const SLICE_MM: f64 = 1.0;

fn volume(shape: [usize; 3], hu: impl Fn([f64; 3]) -> f64) -> Volume {
    common::volume(shape, SLICE_MM, hu)
}

fn surface(volume: &Volume, settings: IsosurfaceSettings<'_>) -> TriangleMesh {
    let mesh = isosurface(volume, settings, &Task::default()).unwrap();
    assert_is_closed(&mesh);
    mesh
}

#[test]
fn a_blurred_ball_has_its_true_radius_at_any_threshold() {
    let radius = 9.3;
    let ball = volume([27, 52, 50], |p| blurred(radius - length(p)));
    for threshold_hu in [200.0, 350.0, 640.0, 800.0, 1000.0] {
        let mesh = surface(&ball, at(threshold_hu, true));
        let error = |v: &[f64; 3]| length(*v) - radius;
        let signed = mean(mesh.vertices_mm().iter().map(error));
        let size = mean(mesh.vertices_mm().iter().map(|v| error(v).abs()));
        assert!(signed.abs() < 0.02, "{threshold_hu} HU: {signed} mm");
        assert!(size < 0.03, "{threshold_hu} HU: {size} mm");
    }
    let plain = surface(&ball, at(200.0, false));
    let is_outside = |v: &[f64; 3]| length(*v) > radius + 0.2;
    assert!(plain.vertices_mm().iter().all(is_outside));
}

/// Mean thickness of a blurred upright wall around the axis.
fn wall_thickness(width_mm: f64, threshold_hu: f64) -> f64 {
    let middle = 12.0;
    let wall = volume([9, 64, 64], |[x, y, _]| {
        let from_middle = (x * x + y * y).sqrt() - middle;
        let within = |side: f64| blurred(width_mm / 2.0 + side * from_middle);
        within(1.0) + within(-1.0) - BONE_HU
    });
    let mesh = surface(&wall, at(threshold_hu, true));
    let topology = check_topology(&mesh, &Task::default()).unwrap();
    // A ring without holes: as many vertices and triangles as edges.
    assert_eq!(topology.components, 1);
    assert_eq!(2 * topology.vertices, topology.triangles);
    let radius = |outer: bool| {
        let radii = mesh.vertices_mm().iter().filter(|v| v[2].abs() < 3.0);
        let radii = radii.map(|v| (v[0] * v[0] + v[1] * v[1]).sqrt());
        mean(radii.filter(|r| (*r > middle) == outer))
    };
    radius(true) - radius(false)
}

#[test]
fn thin_walls_keep_their_thickness() {
    // Two pixels, whose blurred peak is 986 HU.
    for threshold_hu in [200.0, 350.0, 490.0] {
        let thickness = wall_thickness(1.0, threshold_hu);
        assert!(
            (thickness - 1.0).abs() < 0.15,
            "{threshold_hu} HU: {thickness}"
        );
    }
    let thickness = wall_thickness(3.0, 350.0);
    assert!((thickness - 3.0).abs() < 0.03, "{thickness}");
}

#[test]
fn whole_units_at_the_threshold_are_outside() {
    let mut voxels = Array3::from_elem((3, 3, 3), 0i16);
    voxels[[1, 1, 1]] = 350;
    let map = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
    let volume = common::of_voxels(voxels, map);
    let at_350 = isosurface(&volume, at(350.0, false), &Task::default());
    assert!(matches!(at_350, Err(SurfaceError::NothingAbove { .. })));
    assert_eq!(surface(&volume, at(349.0, false)).triangles().len(), 8);
}

#[test]
fn bone_that_the_scan_cuts_off_is_closed_at_the_border() {
    for shape in [[1, 1, 1], [1, 4, 5], [3, 1, 2], [4, 4, 4]] {
        for true_edges in [false, true] {
            let all = volume(shape, |_| BONE_HU);
            let mesh = surface(&all, at(350.0, true_edges));
            let topology = check_topology(&mesh, &Task::default()).unwrap();
            assert_eq!(topology.components, 1);
            let voxel = PIXEL_MM * PIXEL_MM * SLICE_MM;
            let whole = shape.iter().product::<usize>() as f64 * voxel;
            // Edges and corners are cut off by half a voxel at most.
            assert!((whole / 8.0..whole).contains(&topology.volume_mm3));
        }
    }
}

#[test]
fn left_handed_grids_face_outward_too() {
    let ball = volume([19, 30, 30], |p| blurred(5.0 - length(p)));
    surface(&mirrored(ball), at(350.0, true));
}

#[test]
fn any_number_of_threads_gives_the_same_mesh() {
    let ball = volume([31, 60, 60], |p| {
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
fn an_edge_may_lie_beyond_the_border() {
    // Voxels without meaning, in which an edge is followed more than three voxels out of them.
    let voxels = common::random_voxels([3, 6, 5], 5_726_877_477_950_558_085, 3);
    let map = Affine::from_axes([0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.1, 5.0], [5.0; 3]);
    surface(&common::of_voxels(voxels, map), at(350.0, true));
}

#[test]
fn each_case_of_a_cube_is_sound_wherever_its_edges_are_cut() {
    // Cuts next to either end, in the middle and between.
    let above = [351, 352, 400, 1000, 30_000];
    let below = [350, 349, 300, -300, -30_000];
    let map = Affine::from_axes([0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.1, 1.3], [5.0; 3]);
    for inside in 1..=255_usize {
        for draw in 0..20_usize {
            let voxels = Array3::from_shape_fn((2, 2, 2), |(k, j, i)| {
                let corner = i + 2 * j + 4 * k;
                let of = if inside >> corner & 1 == 1 {
                    above
                } else {
                    below
                };
                // Another mixture for each draw; the first five are the same at all corners.
                let level = if draw < 5 {
                    draw
                } else {
                    (draw * (3 * corner + 7) + inside) / 4
                };
                of[level % 5]
            });
            surface(&common::of_voxels(voxels, map), at(350.0, false));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_voxels_have_a_closed_manifold_surface(
        shape in [1..7usize, 1..7usize, 1..70usize],
        seed in any::<u64>(),
        eighths in 1..8u64,
        true_edges in any::<bool>(),
    ) {
        let voxels = common::random_voxels(shape, seed, eighths);
        prop_assume!(voxels.iter().any(|hu| *hu > 350));
        let map = Affine::from_axes([0.4, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.1, 1.3], [5.0; 3]);
        let volume = common::of_voxels(voxels, map);
        match isosurface(&volume, at(350.0, true_edges), &Task::default()) {
            Ok(mesh) => assert_is_closed(&mesh),
            // The grey halfway up can lie above every voxel of such noise.
            Err(error) => prop_assert!(
                true_edges && matches!(error, SurfaceError::TooSmall { .. }),
                "{error}"
            ),
        }
    }
}
