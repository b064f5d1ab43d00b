//! `bonemesh roi` and `bonemesh mirror` as a user runs them: solids, plates, the other side.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use std::path::Path;

use bonemesh_mesh::read_mesh;
use bonemesh_task::Task;
use common::command::{bone, bonemesh, json, text};
use serde_json::Value;
use tempfile::TempDir;

/// A region under a ball at the left of the vault, its report and its check.
fn region(bone: &Path, options: &[&str]) -> (Value, Value) {
    let out = bone.with_file_name("region.stl");
    let fixed = [
        "roi",
        text(bone),
        "--within=92,-10,30,32",
        "--json",
        "-o",
        text(&out),
    ];
    let report = json(&bonemesh(&[&fixed[..], options].concat()));
    let check = json(&bonemesh(&["check", text(&out), "--json"]));
    assert_eq!(check["watertight"], true);
    assert_eq!(check["manifold"], true);
    assert_eq!(check["self_intersections"], 0);
    (report, check)
}

#[test]
fn each_piece_gets_a_file_of_its_own() {
    let folder = TempDir::new().unwrap();
    let bone = bone(folder.path());
    let mesh = read_mesh(&bone, &Task::default()).unwrap();
    let lines = (0..)
        .zip(mesh.vertices_mm())
        .filter_map(|(number, [x, y, z])| {
            let is_in = x.abs() > 60.0 && (y + 10.0).hypot(z - 30.0) < 12.0;
            is_in.then(|| format!("{number}\n"))
        });
    let selection = folder.path().join("both.txt");
    std::fs::write(&selection, lines.collect::<String>()).unwrap();
    let out = folder.path().join("region.stl");
    let report = json(&bonemesh(&[
        "roi",
        text(&bone),
        "--selection",
        text(&selection),
        "--thickness=3",
        "--hidden",
        "--separate",
        "--json",
        "-o",
        text(&out),
    ]));
    let regions = report["regions"].as_array().unwrap();
    assert!(regions.len() >= 2 && !out.exists());
    let sides = regions.iter().zip(1..).map(|(region, number)| {
        let file = folder.path().join(format!("region-{number}.stl"));
        assert_eq!(region["output"], text(&file));
        assert_eq!(region["watertight"], true);
        let check = json(&bonemesh(&["check", text(&file), "--json"]));
        assert_eq!(check["self_intersections"], 0);
        range_of_x(&check)[0] > 0.0
    });
    let sides: Vec<bool> = sides.collect();
    assert!(sides.contains(&true) && sides.contains(&false));
}

#[test]
fn places_and_planes_may_begin_with_a_minus() {
    let folder = TempDir::new().unwrap();
    let bone = bone(folder.path());
    let out = folder.path().join("right.stl");
    let region = |within: &str, other: [&str; 2]| {
        let fixed = ["roi", text(&bone), "--thickness", "4", "--json"];
        let rest = ["-o", text(&out), "--within", within];
        json(&bonemesh(&[&fixed[..], &rest, &other].concat()));
        range_of_x(&json(&bonemesh(&["check", text(&out), "--json"])))[0] > 0.0
    };
    assert!(region("92,-10,30,25", ["--direction", "-1,0,0"]));
    assert!(!region("-92,-10,30,25", ["--direction", "normal"]));
    assert!(region("-92,-10,30,25", ["--mirror", "-1,0,0,0"]));
}

/// Lowest and highest x (mm): left is positive.
fn range_of_x(check: &Value) -> [f64; 2] {
    [0, 1].map(|end| check["bounds_mm"][end][0].as_f64().unwrap())
}

#[test]
fn solids_plates_and_other_sides_of_a_head() {
    let folder = TempDir::new().unwrap();
    let bone = bone(folder.path());
    let (report, solid) = region(&bone, &["--thickness=8"]);
    assert_eq!(report["method"], "solid");
    assert_eq!(report["direction"], "normal");
    assert!(report["patch_mm2"].as_f64().unwrap() > 500.0);
    let [low, high] = range_of_x(&solid);
    assert!(low > 0.0 && high < 92.0);

    let (_, plate) = region(
        &bone,
        &["--thickness=2", "--direction=outward", "--clearance=1"],
    );
    let outer = range_of_x(&plate)[1];
    assert!((outer - high - 3.0).abs() < 0.3, "{outer} {high}");

    let (report, other) = region(&bone, &["--thickness=8", "--mirror=auto"]);
    assert!(range_of_x(&other)[1] < 0.0);
    let mirror = &report["mirror"];
    assert!(mirror["normal"][0].as_f64().unwrap() > 0.9999, "{mirror}");
    assert!(
        mirror["offset_mm"].as_f64().unwrap().abs() < 0.3,
        "{mirror}"
    );
    let (_, back) = region(&bone, &["--thickness=8", "--mirror=x", "--mirror-back"]);
    assert!(range_of_x(&back)[0] > 0.0);
}

#[test]
fn a_region_is_mirrored_in_the_plane_of_the_whole() {
    let folder = TempDir::new().unwrap();
    let bone = bone(folder.path());
    let (_, solid) = region(&bone, &["--thickness=8"]);
    let out = folder.path().join("mirrored.stl");
    let part = bone.with_file_name("region.stl");
    let report = json(&bonemesh(&[
        "mirror",
        text(&part),
        "--of",
        text(&bone),
        "-o",
        text(&out),
        "--json",
    ]));
    assert!(report["error_mm"].as_f64().unwrap() < 0.2);
    let mirrored = json(&bonemesh(&["check", text(&out), "--json"]));
    let ([low, high], [left, right]) = (range_of_x(&solid), range_of_x(&mirrored));
    assert!((low + right).abs() < 0.6 && (high + left).abs() < 0.6);
    assert_eq!(mirrored["watertight"], true);
    let [a, b] = [&solid, &mirrored].map(|c| c["volume_mm3"].as_f64().unwrap());
    assert!((a / b - 1.0).abs() < 1e-4);
}

#[test]
fn choices_that_cannot_go_together_are_unusable_arguments() {
    let folder = TempDir::new().unwrap();
    let bone = bone(folder.path());
    let out = folder.path().join("none.stl");
    let fixed = [
        "roi",
        text(&bone),
        "--within=92,-10,30,32",
        "-o",
        text(&out),
        "--thickness=8",
    ];
    for (options, says) in [
        (&["--clearance=1"][..], "outward"),
        (&["--method=thesis", "--hidden"], "solid"),
        (&["--method=thesis", "--mirror=x"], "solid"),
        (&["--mirror-back"], "--mirror"),
        (&["--direction=down"], "normal, through, outward"),
        (&["--direction=0,0,0"], "not all 0"),
        (&["--mirror=1,2"], "auto"),
        (&["--clearance=-1", "--direction=outward"], "0 to 20"),
    ] {
        let answer = bonemesh(&[&fixed[..], options].concat());
        let said = String::from_utf8_lossy(&answer.stderr).into_owned();
        assert_eq!(answer.status.code(), Some(2), "{options:?}: {said}");
        assert!(said.contains(says), "{options:?}: {said}");
    }
    assert!(!out.exists());
}
