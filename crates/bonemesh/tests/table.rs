//! The scanner's table and headrest, and specks, are left out, and nothing else.

#![allow(clippy::unwrap_used, reason = "tests")]

use bonemesh::{Islands, Rendered, Settings, Task, Volume, Voxels, render_volume};
use bonemesh_volume::{Affine, Geometry};
use ndarray::Array3;

const AIR: i16 = -1000;
const SOFT: i16 = 40;
const BONE: i16 = 1200;
const PLASTIC: i16 = 500;

/// What is at a place in mm: x to the left, y to the back, z to the head.
type Scene = fn([f64; 3]) -> i16;

/// A head of bone under `skin_mm` of soft tissue, and a smaller bone beside it.
fn head([x, y, z]: [f64; 3], skin_mm: f64) -> i16 {
    let from = |centre: [f64; 3]| {
        let [a, b, c] = [x - centre[0], y - centre[1], z - centre[2]];
        (a * a + b * b + c * c).sqrt()
    };
    let (skull, jaw) = (from([0.0, 0.0, 35.0]), from([0.0, -30.0, 20.0]));
    if (16.0..21.0).contains(&skull) || jaw < 4.0 {
        BONE
    } else if skull < 16.0 || skull < 21.0 + skin_mm || jaw < 4.0 + skin_mm {
        if skin_mm > 0.0 { SOFT } else { AIR }
    } else {
        AIR
    }
}

/// A hollow board behind the head.
fn table([x, y, _]: [f64; 3]) -> bool {
    let (across, deep) = (x.abs(), (y - 42.0).abs());
    across < 30.0 && deep < 6.0 && !(across < 27.0 && deep < 3.0)
}

fn patient(at: [f64; 3]) -> i16 {
    if table(at) { PLASTIC } else { head(at, 9.0) }
}

fn dry_bone(at: [f64; 3]) -> i16 {
    if table(at) { PLASTIC } else { head(at, 0.0) }
}

fn dry_bone_on_its_table([x, y, z]: [f64; 3]) -> i16 {
    if table([x, y, z]) {
        PLASTIC
    } else {
        head([x, y - 17.0, z], 0.0)
    }
}

fn rendered(scene: Scene, settings: &Settings) -> Rendered {
    let shape = [36, 60, 50];
    let origin = [-37.0, -38.0, 0.0];
    let affine = Affine::from_axes([1.5, 0.0, 0.0], [0.0, 1.5, 0.0], [0.0, 0.0, 2.0], origin);
    let hu = Array3::from_shape_fn(shape, |(k, j, i)| {
        scene(affine.apply([i as f64, j as f64, k as f64]))
    });
    let geometry = Geometry::new(shape, affine).unwrap();
    let volume = Volume::new(Voxels::I16(hu), geometry).unwrap();
    render_volume(&volume, settings, &Task::default()).unwrap()
}

#[test]
fn a_patient_is_left_with_all_of_his_bones() {
    let without = rendered(patient, &Settings::default());
    let table = without.report.left_out_table.unwrap();
    assert_eq!(table.islands, 1);
    assert_eq!(without.report.components, 3, "skull, its inside and jaw");
    assert!(without.report.manifold && without.report.watertight);
    let [_, high] = without.mesh.bounds_mm().unwrap();
    assert!(high[1] < 30.0, "no table behind: {high:?}");

    let keep = Settings {
        leave_out_table: false,
        ..Settings::default()
    };
    let with = rendered(patient, &keep);
    assert_eq!(with.report.left_out_table, None);
    assert_eq!(with.report.components, 4);
    let both = without.report.volume_mm3 + table.volume_mm3;
    assert!((both - with.report.volume_mm3).abs() < 1e-6 * both);
}

#[test]
fn dry_bone_keeps_its_loose_parts() {
    let report = rendered(dry_bone, &Settings::default()).report;
    assert_eq!(report.left_out_table.unwrap().islands, 1);
    assert_eq!(report.components, 3, "skull, its inside and jaw");
}

#[test]
fn what_hangs_together_with_bone_stays() {
    let report = rendered(dry_bone_on_its_table, &Settings::default()).report;
    assert_eq!(report.left_out_table, None);
    assert!(report.volume_mm3 > 40_000.0, "skull and board");
}

/// A voxel of bone in air, and a bone as small as an ossicle.
fn specks(at: [f64; 3]) -> i16 {
    let is_near = |centre: [f64; 3], mm: f64| (0..3).all(|k| (at[k] - centre[k]).abs() < mm);
    if is_near([0.0, 0.0, 20.0], 0.3) || is_near([10.0, 0.0, 20.0], 1.1) {
        BONE
    } else {
        SOFT
    }
}

#[test]
fn specks_go_unless_islands_are_chosen() {
    let volume = |pixel_mm: f64| {
        let shape = [40, 60, 60];
        let origin = [-10.0, -10.0, 10.0];
        let axes = [
            [pixel_mm, 0.0, 0.0],
            [0.0, pixel_mm, 0.0],
            [0.0, 0.0, pixel_mm],
        ];
        let affine = Affine::from_axes(axes[0], axes[1], axes[2], origin);
        let hu = Array3::from_shape_fn(shape, |(k, j, i)| {
            specks(affine.apply([i as f64, j as f64, k as f64]))
        });
        let geometry = Geometry::new(shape, affine).unwrap();
        Volume::new(Voxels::I16(hu), geometry).unwrap()
    };
    let report = |islands| {
        let mut settings = Settings::default();
        settings.after_care.islands = islands;
        let rendered = render_volume(&volume(0.5), &settings, &Task::default());
        rendered.unwrap().report
    };
    let usual = report(None);
    assert_eq!(usual.left_out_specks.unwrap().islands, 1);
    assert_eq!(usual.components, 1);
    let all = report(Some(Islands::AtLeastMm3(0.0)));
    assert_eq!(all.left_out_specks, None);
    assert_eq!(all.components, 2);
}

#[test]
fn a_scan_of_one_speck_shows_it() {
    let shape = [9, 9, 9];
    let affine = Affine::from_axes([0.2, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.2], [0.0; 3]);
    let hu = Array3::from_shape_fn(shape, |at| if at == (4, 4, 4) { BONE } else { SOFT });
    let volume = Volume::new(Voxels::I16(hu), Geometry::new(shape, affine).unwrap()).unwrap();
    let rendered = render_volume(&volume, &Settings::default(), &Task::default()).unwrap();
    assert_eq!(rendered.report.components, 1);
}

#[test]
fn a_dry_long_bone_is_no_table_whatever_lies_beside_it() {
    fn shaft([x, y, _]: [f64; 3]) -> bool {
        (6.0..12.0).contains(&x.hypot(y))
    }
    let beside = |[x, y, z]: [f64; 3], mm: f64| {
        (x - 24.0).abs() < mm && y.abs() < mm && (z - 30.0).abs() < mm
    };
    for piece_mm in [0.0, 1.0, 3.0, 5.0] {
        let shape = [36, 60, 50];
        let affine = Affine::from_axes(
            [1.5, 0.0, 0.0],
            [0.0, 1.5, 0.0],
            [0.0, 0.0, 2.0],
            [-37.0, -38.0, 0.0],
        );
        let hu = Array3::from_shape_fn(shape, |(k, j, i)| {
            let at = affine.apply([i as f64, j as f64, k as f64]);
            if shaft(at) || beside(at, piece_mm) {
                BONE
            } else {
                AIR
            }
        });
        let volume = Volume::new(Voxels::I16(hu), Geometry::new(shape, affine).unwrap()).unwrap();
        let rendered = render_volume(&volume, &Settings::default(), &Task::default()).unwrap();
        assert_eq!(rendered.report.left_out_table, None);
        assert!(rendered.report.volume_mm3 > 15_000.0);
    }
}
