//! Coarse surfaces show what a rendering will show.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::num::NonZeroUsize;

use bonemesh::{
    Affine, CropBox, Error, Geometry, HuThreshold, Phantom, Preview, PreviewSurface, Settings,
    Task, Volume, Voxels, check_topology, render_volume, scan_phantom,
};
use ndarray::Array3;

/// Cubes of voxels with these values, oblique in the patient.
fn volume(sides: usize, hu: impl Fn([usize; 3]) -> i16) -> Volume {
    let (sin, cos) = 0.3_f64.sin_cos();
    let affine = Affine::from_axes(
        [0.5 * cos, 0.5 * sin, 0.0],
        [-0.5 * sin, 0.5 * cos, 0.0],
        [0.0, 0.0, 0.5],
        [-40.0, 11.0, 300.0],
    );
    let geometry = Geometry::new([sides; 3], affine).unwrap();
    let voxels = Array3::from_shape_fn([sides; 3], |(k, j, i)| hu([i, j, k]));
    Volume::new(Voxels::I16(voxels), geometry).unwrap()
}

fn hu(hu: f64) -> HuThreshold {
    HuThreshold::new(hu).unwrap()
}

fn preview(volume: &Volume) -> Preview {
    Preview::of(volume, None, &Task::default()).unwrap()
}

fn surface(preview: &Preview, threshold_hu: f64, crop: Option<&CropBox>) -> PreviewSurface {
    preview
        .surface(hu(threshold_hu), crop, None, &Task::default())
        .unwrap()
}

#[test]
fn a_wall_of_one_voxel_is_not_lost_between_coarse_ones() {
    // A hollow box with walls of one voxel in a scan that is coarsened to a half.
    let wall = |v: usize| v == 60 || v == 170;
    let inside = |v: usize| (60..=170).contains(&v);
    let scan = volume(230, |at| {
        let is_bone = at.into_iter().any(wall) && at.into_iter().all(inside);
        if is_bone { 700 } else { -1000 }
    });
    let shown = surface(&preview(&scan), 350.0, None);
    assert!(shown.report.spacing_mm[0] > 0.9, "{:?}", shown.report);
    let topology = check_topology(&shown.mesh, &Task::default()).unwrap();
    // The outside and the inside, each in one piece: the wall has no hole.
    assert_eq!(topology.components, 2);
    assert!(topology.watertight);
}

#[test]
fn it_lies_within_a_coarse_voxel_of_what_is_rendered() {
    let task = Task::default();
    let shell = Phantom::SphereShell;
    let scan = scan_phantom(shell, &shell.settings().coarser(2.0), &task).unwrap();
    let rendered = render_volume(&scan, &Settings::default(), &task).unwrap();
    let shown = surface(&preview(&scan), 350.0, None);
    let side_mm = shown.report.spacing_mm.into_iter().fold(0.0, f64::max);
    let bounds = [shown.mesh.bounds_mm(), rendered.mesh.bounds_mm()].map(Option::unwrap);
    for (shown, rendered) in bounds[0].iter().flatten().zip(bounds[1].iter().flatten()) {
        assert!((shown - rendered).abs() < side_mm, "{bounds:?}");
    }
}

#[test]
fn what_would_be_too_much_to_show_is_shown_in_larger_voxels() {
    let noise = volume(90, |[i, j, k]| {
        (((i * 7_919 + j * 104_729 + k * 1_299_709) % 2_003) as i16) - 1_000
    });
    let noise = preview(&noise);
    let many = surface(&noise, 350.0, None);
    assert!(many.report.triangles <= 200_000, "{:?}", many.report);
    assert!(many.report.spacing_mm[0] > 0.9, "{:?}", many.report);
    let few = surface(&noise, 1_000.0, None);
    assert!(few.report.spacing_mm[0] < 0.6, "{:?}", few.report);
}

#[test]
fn a_crop_box_in_voxels_of_the_scan_leaves_what_is_in_it() {
    let scan = volume(230, |[i, ..]| if i % 100 == 50 { 700 } else { -1000 });
    let preview = preview(&scan);
    let crop: CropBox = "101:230,0:230,0:230".parse().unwrap();
    let topology = |crop| {
        let shown = surface(&preview, 350.0, crop);
        check_topology(&shown.mesh, &Task::default()).unwrap()
    };
    assert_eq!(topology(None).components, 2);
    assert_eq!(topology(Some(&crop)).components, 1);
    let outside: CropBox = "0:231,0:1,0:1".parse().unwrap();
    let refused = preview.surface(hu(350.0), Some(&outside), None, &Task::default());
    assert!(matches!(refused, Err(Error::Volume(_))));
}

#[test]
fn thresholds_that_leave_nothing_or_everything_are_refused_as_by_a_rendering() {
    let scan = volume(230, |at| if at == [100; 3] { 3_000 } else { -1_000 });
    let preview = preview(&scan);
    for (threshold_hu, words) in [
        (3_000.0, "3000"),
        (-1_001.0, "-1001"),
        (2_900.0, "too small"),
    ] {
        let refused = preview.surface(hu(threshold_hu), None, None, &Task::default());
        let message = refused.unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn it_does_not_depend_on_threads_and_can_be_stopped() {
    let scan = volume(120, |[i, j, k]| ((i * i + j * k) % 1_500) as i16 - 500);
    let threads = NonZeroUsize::new;
    let one = Preview::of(&scan, threads(1), &Task::default()).unwrap();
    let many = Preview::of(&scan, threads(5), &Task::default()).unwrap();
    let surface = |preview: &Preview, n| {
        let shown = preview.surface(hu(350.0), None, threads(n), &Task::default());
        shown.unwrap().mesh
    };
    assert_eq!(surface(&one, 1), surface(&many, 5));
    let task = Task::default();
    task.cancel().cancel();
    assert!(Preview::of(&scan, None, &task).unwrap_err().is_cancelled());
    let stopped = one.surface(hu(350.0), None, None, &task);
    assert!(stopped.unwrap_err().is_cancelled());
}
