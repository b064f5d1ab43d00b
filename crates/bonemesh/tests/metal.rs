//! Metal is told of every rendering, and damped when asked for.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::process::Command;

use bonemesh::{CropBox, Method, Rendered, Settings, Task, Volume, Voxels, render_volume};
use bonemesh_volume::{Affine, Geometry};
use ndarray::Array3;

const SHAPE: [usize; 3] = [24, 80, 80];
/// Slices with the crown.
const CROWNED: std::ops::Range<usize> = 10..14;

/// A jaw of bone in soft tissue with a crown on it, around which weak streaks fan out, and one that is
/// as bright as bone and as thin as a web.
fn volume(with_metal: bool) -> Volume {
    let from = |j: usize, i: usize, [a, b]: [f64; 2]| (i as f64 - a).hypot(j as f64 - b);
    let hu = |(k, j, i): (usize, usize, usize)| {
        let is_metal_slice = with_metal && CROWNED.contains(&k);
        if is_metal_slice && from(j, i, [28.0, 24.0]) < 4.0 {
            return 3071;
        }
        let tissue = if (15.0..20.0).contains(&from(j, i, [40.0, 40.0])) {
            1200
        } else if from(j, i, [40.0, 40.0]) < 36.0 {
            40
        } else {
            -1000
        };
        let noise = ((5 * i + 3 * j + 7 * k) % 13) as i16;
        if !is_metal_slice || tissue < 0 {
            return tissue + noise;
        }
        let is_web = j.abs_diff(24) < 2;
        let angle = (j as f64 - 24.0).atan2(i as f64 - 28.0);
        let fan = if (18.0 * angle).sin() > 0.0 { 60 } else { -60 };
        tissue + noise + fan + if is_web { 420 } else { 0 }
    };
    let affine = Affine::from_axes([0.6, 0.0, 0.0], [0.0, 0.6, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
    let geometry = Geometry::new(SHAPE, affine).unwrap();
    Volume::new(Voxels::I16(Array3::from_shape_fn(SHAPE, hu)), geometry).unwrap()
}

fn rendered(with_metal: bool, settings: &Settings) -> Rendered {
    render_volume(&volume(with_metal), settings, &Task::default()).unwrap()
}

#[test]
fn a_report_tells_of_metal_and_where_it_is() {
    let report = rendered(true, &Settings::default()).report;
    let metal = report.metal.unwrap();
    assert_eq!((metal.pieces, metal.slices), (1, [10, 13]));
    assert!((metal.z_mm[0] - 10.0).abs() < 1e-9 && (metal.z_mm[1] - 13.0).abs() < 1e-9);
    assert!(
        (50.0..90.0).contains(&metal.volume_mm3),
        "{}",
        metal.volume_mm3
    );
    assert!(!metal.damped && metal.spread_damped_hu.is_none());
    assert!(metal.spread_hu.unwrap() > 1.5 * metal.spread_without_hu.unwrap());
    let [note] = &report.warnings[..] else {
        panic!("one note: {:?}", report.warnings)
    };
    assert!(
        note.contains("slices 10 to 13") && note.contains("--damp-metal"),
        "{note}"
    );
}

#[test]
fn without_metal_nothing_is_said_and_nothing_changes() {
    let usual = rendered(false, &Settings::default());
    assert_eq!(usual.report.metal, None);
    assert!(usual.report.warnings.is_empty());
    let damp = Settings {
        damp_metal: true,
        ..Settings::default()
    };
    assert_eq!(rendered(false, &damp).mesh, usual.mesh);
}

#[test]
fn damping_takes_the_web_away_and_says_so() {
    let damp = Settings {
        damp_metal: true,
        ..Settings::default()
    };
    let (streaked, damped) = (rendered(true, &Settings::default()), rendered(true, &damp));
    let metal = damped.report.metal.unwrap();
    assert!(metal.damped);
    assert!(metal.spread_damped_hu.unwrap() < metal.spread_hu.unwrap());
    assert!(
        damped.report.warnings[0].contains("after damping"),
        "{:?}",
        damped.report.warnings
    );
    // Beside the bone, where the web runs.
    let in_web = |[x, y, _]: &[f64; 3]| *x > 35.0 && (12.0..17.0).contains(y);
    let web = |r: &Rendered| r.mesh.vertices_mm().iter().filter(|v| in_web(v)).count();
    assert!(web(&streaked) > 50, "{}", web(&streaked));
    assert!(
        2 * web(&damped) < web(&streaked),
        "{} {}",
        web(&damped),
        web(&streaked)
    );
}

#[test]
fn metal_outside_of_what_is_used_is_not_told() {
    let crop = |slices| Settings {
        crop: Some(CropBox {
            columns: 0..SHAPE[2],
            rows: 0..SHAPE[1],
            slices,
        }),
        ..Settings::default()
    };
    assert!(rendered(true, &crop(0..10)).report.metal.is_none());
    assert!(rendered(true, &crop(0..11)).report.metal.is_some());
}

#[test]
fn surfaces_of_points_are_damped_too() {
    let alpha = |damp_metal| Settings {
        method: Method::Alpha,
        damp_metal,
        ..Settings::default()
    };
    let (streaked, damped) = (rendered(true, &alpha(false)), rendered(true, &alpha(true)));
    assert!(damped.report.metal.unwrap().damped);
    assert!(damped.report.points < streaked.report.points);
}

#[test]
fn the_command_damps_metal_and_tells_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let (scan, stl) = (
        folder.path().join("jaw.nrrd"),
        folder.path().join("jaw.stl"),
    );
    let [slices, rows, columns] = SHAPE;
    let mut file = format!(
        "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: {columns} {rows} {slices}\nspace directions: (0.6,0,0) (0,0.6,0) (0,0,1)\nspace origin: (0,0,0)\nendian: little\nencoding: raw\n\n"
    )
    .into_bytes();
    let volume = volume(true);
    let Voxels::I16(hu) = volume.voxels() else {
        unreachable!("made of whole numbers")
    };
    file.extend(hu.iter().flat_map(|v| v.to_le_bytes()));
    fs::write(&scan, file).unwrap();
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bonemesh"));
        command.arg("render").arg(&scan).arg("-o").arg(&stl);
        let output = command.args(more).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
        String::from_utf8(output.stdout).unwrap()
    };
    let json = |text: String| serde_json::from_str::<serde_json::Value>(&text).unwrap();
    let usual = json(run(&["--json"]));
    assert_eq!(usual["metal"]["slices"], serde_json::json!([10, 13]));
    assert_eq!(usual["metal"]["damped"], false);
    let damped = json(run(&["--json", "--damp-metal"]));
    assert_eq!(damped["metal"]["damped"], true);
    assert!(damped["volume_mm3"].as_f64() < usual["volume_mm3"].as_f64());
    assert!(run(&[]).contains("note: metal: 0.0"));
}
