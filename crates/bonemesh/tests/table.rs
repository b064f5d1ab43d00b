//! The scanner's table and headrest are left out, and nothing else.

#![allow(clippy::unwrap_used, reason = "tests")]

use bonemesh::{Rendered, Settings, Task, Volume, Voxels, render_volume};
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
    assert_eq!(table.parts, 1);
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
    assert_eq!(report.left_out_table.unwrap().parts, 1);
    assert_eq!(report.components, 3, "skull, its inside and jaw");
}

#[test]
fn what_hangs_together_with_bone_stays() {
    let report = rendered(dry_bone_on_its_table, &Settings::default()).report;
    assert_eq!(report.left_out_table, None);
    assert!(report.volume_mm3 > 40_000.0, "skull and board");
}
