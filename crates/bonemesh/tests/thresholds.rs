//! `bonemesh histogram`, and thresholds that are not typed as numbers.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use serde_json::Value;
use tempfile::TempDir;

/// A tube of bone (1240 HU) in soft tissue (40 HU), made once.
static TUBE: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = TempDir::new().unwrap();
    let series = folder.path().join("tube");
    let made = bonemesh(&["phantom", "tube", text(&series), "--coarser", "1.5"]);
    assert!(made.status.success());
    folder
});

fn tube() -> PathBuf {
    TUBE.path().join("tube")
}

fn bonemesh(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bonemesh"))
        .args(arguments)
        .output()
        .unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn json(output: &Output) -> Value {
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    let numbers = value.as_array().unwrap().iter();
    numbers.map(|n| n.as_f64().unwrap()).collect()
}

#[test]
fn a_histogram_counts_every_voxel_and_names_thresholds() {
    let report = json(&bonemesh(&[
        "histogram",
        text(&tube()),
        "--json",
        "--bin",
        "20",
    ]));
    let (edges, counts) = (numbers(&report["edges_hu"]), numbers(&report["counts"]));
    assert_eq!(edges.len(), counts.len() + 1);
    assert!(edges.windows(2).all(|e| (e[1] - e[0] - 20.0).abs() < 1e-9));
    assert!((counts.iter().sum::<f64>() - report["voxels"].as_f64().unwrap()).abs() < 0.5);
    let suggestions = report["suggestions"].as_array().unwrap();
    let names: Vec<&str> = suggestions
        .iter()
        .map(|s| s["name"].as_str().unwrap())
        .collect();
    for name in ["edges", "multi-otsu", "otsu", "skull", "cortical"] {
        assert!(names.contains(&name), "{names:?}");
    }
    for suggestion in suggestions {
        assert!(suggestion["threshold_hu"].is_number());
        assert!(!suggestion["source"].as_str().unwrap().is_empty());
    }
    assert!(report.get("output").is_none());
}

#[test]
fn its_words_name_every_suggestion() {
    let answer = bonemesh(&["histogram", text(&tube())]);
    let words = String::from_utf8(answer.stdout).unwrap();
    for word in ["voxels", "auto", "skull", "Tilotta", "Otsu", "cm3"] {
        assert!(words.contains(word), "{words}");
    }
}

#[test]
fn its_picture_appears_whole_or_not_at_all() {
    let folder = TempDir::new().unwrap();
    let picture = folder.path().join("histogram.png");
    let report = json(&bonemesh(&[
        "histogram",
        text(&tube()),
        "-o",
        text(&picture),
        "--json",
    ]));
    assert_eq!(report["output"], text(&picture));
    assert!(std::fs::read(&picture).unwrap().starts_with(b"\x89PNG\r\n"));
    for bad in ["picture.jpg", "missing/picture.png"] {
        let bad = folder.path().join(bad);
        let refused = bonemesh(&["histogram", text(&tube()), "-o", text(&bad)]);
        assert_eq!(refused.status.code(), Some(1));
        assert!(String::from_utf8_lossy(&refused.stderr).contains("histogram.png"));
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn auto_is_the_recommended_threshold_of_the_part_that_is_used() {
    let folder = TempDir::new().unwrap();
    let (tube, stl) = (tube(), folder.path().join("bone.stl"));
    for crop in ["0:64,0:64,0:35", "0:64,0:40,3:30"] {
        let found = json(&bonemesh(&[
            "histogram",
            text(&tube),
            "--crop",
            crop,
            "--json",
        ]));
        let suggestions = found["suggestions"].as_array().unwrap();
        let best = suggestions
            .iter()
            .find(|s| s["recommended"] == true)
            .unwrap();
        let arguments = ["--hu", "auto", "--crop", crop, "--json"];
        let render = ["render", text(&tube), "-o", text(&stl)];
        let report = json(&bonemesh(&[&render[..], &arguments].concat()));
        assert_eq!(report["threshold_hu"], best["threshold_hu"]);
        let reason = report["threshold_reason"].as_str().unwrap();
        assert!(reason.starts_with("auto, edges: "), "{reason}");
        let npy = folder.path().join("bone.npy");
        let cloud = ["cloud", text(&tube), "-o", text(&npy)];
        let report = json(&bonemesh(&[&cloud[..], &arguments].concat()));
        assert_eq!(report["threshold_hu"], best["threshold_hu"]);
    }
}

#[test]
fn every_suggestion_can_be_taken_by_its_name() {
    let folder = TempDir::new().unwrap();
    let (tube, stl) = (tube(), folder.path().join("bone.stl"));
    let found = json(&bonemesh(&["histogram", text(&tube), "--json"]));
    let suggestions = found["suggestions"].as_array().unwrap();
    assert!(suggestions.len() > 4);
    for suggestion in suggestions {
        let name = suggestion["name"].as_str().unwrap();
        let render = ["render", text(&tube), "-o", text(&stl), "--json", "--hu"];
        let rendered = bonemesh(&[&render[..], &[name]].concat());
        if name == "teeth" {
            // Nothing is that dense in this phantom.
            assert_eq!(rendered.status.code(), Some(1));
            continue;
        }
        let report = json(&rendered);
        assert_eq!(report["threshold_hu"], suggestion["threshold_hu"], "{name}");
        let reason = report["threshold_reason"].as_str().unwrap();
        assert!(reason.starts_with(&format!("{name}: ")), "{reason}");
    }
}

#[test]
fn a_local_threshold_keeps_what_the_global_one_loses() {
    let folder = TempDir::new().unwrap();
    let tube = tube();
    let volume_mm3 = |extra: &[&str]| {
        let stl = folder.path().join("bone.stl");
        let render = ["render", text(&tube), "-o", text(&stl), "--json"];
        let points = ["--method", "alpha", "--hu", "900"];
        let report = json(&bonemesh(&[&render[..], &points, extra].concat()));
        report["volume_mm3"].as_f64().unwrap()
    };
    let (global, none) = (volume_mm3(&[]), volume_mm3(&["--local", "0"]));
    assert!((global - none).abs() < 1e-9);
    assert!(volume_mm3(&["--local", "400"]) > 1.05 * global);
    let render = ["render", text(&tube), "-o", "x.stl", "--local", "-3"];
    let refused = bonemesh(&render);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("leeway of -3 HU"));
}

#[test]
fn a_name_from_the_literature_stands_for_its_number() {
    let folder = TempDir::new().unwrap();
    let render = |hu: &str, file: &str| {
        let file = folder.path().join(file);
        let answer = bonemesh(&[
            "render",
            text(&tube()),
            "-o",
            text(&file),
            "--hu",
            hu,
            "--json",
        ]);
        (json(&answer), std::fs::read(file).unwrap())
    };
    let (named, by_name) = render("cortical", "name.stl");
    let (_, by_number) = render("600", "number.stl");
    assert_eq!(by_name, by_number);
    assert_eq!(named["threshold_hu"], 600.0);
    assert!(
        named["threshold_reason"]
            .as_str()
            .unwrap()
            .contains("Aamodt")
    );
    assert!(render("611", "other.stl").0["threshold_reason"].is_null());
}

#[test]
fn other_words_are_answered_with_the_known_ones() {
    let refused = bonemesh(&["render", "folder", "-o", "x.stl", "--hu", "bone"]);
    assert_eq!(refused.status.code(), Some(2));
    let said = String::from_utf8_lossy(&refused.stderr);
    assert!(
        said.contains("skull, cortical") && said.contains("auto"),
        "{said}"
    );
}
