//! The `bonemesh` command as a user runs it: files in, files out, exit codes, one line on failure.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use serde_json::Value;
use tempfile::TempDir;

/// A phantom head, coarse enough for a quick test, made once.
static HEAD: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = TempDir::new().unwrap();
    let series = folder.path().join("head");
    let made = bonemesh(&["phantom", "head", text(&series), "--coarser", "2"]);
    assert!(made.status.success(), "{}", message(&made));
    folder
});

fn bonemesh(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bonemesh"))
        .args(arguments)
        .output()
        .unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn message(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", message(output));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn head() -> PathBuf {
    HEAD.path().join("head")
}

/// One line on stderr that begins with the program's name, exit code 1, nothing on stdout.
fn assert_refused(output: &Output, word: &str) {
    let said = message(output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("bonemesh: "), "{said}");
    assert_eq!(said.trim_end().lines().count(), 1, "{said}");
    assert!(said.contains(word), "{said} has no {word}");
    assert!(output.stdout.is_empty());
}

#[test]
fn a_folder_becomes_a_mesh_with_a_full_report() {
    let folder = TempDir::new().unwrap();
    let stl = folder.path().join("bone.stl");
    let report = json(&bonemesh(&[
        "render",
        text(&head()),
        "--method=alpha",
        "-o",
        text(&stl),
        "--json",
    ]));
    for key in [
        "points",
        "tetrahedra",
        "vertices",
        "triangles",
        "components",
    ] {
        assert!(report[key].as_u64().unwrap() > 0, "{key}");
    }
    assert_eq!(report["watertight"], true);
    assert!(report["manifold"].is_boolean());
    assert!(report["alpha_mm"].as_f64().unwrap() > 0.0);
    assert!(report["volume_mm3"].as_f64().unwrap() > 100_000.0);
    assert_eq!(report["threshold_hu"], 350.0);
    let steps = [
        "read",
        "edges",
        "cloud",
        "neighbours",
        "tetrahedra",
        "surface",
        "write",
    ];
    let sum: f64 = steps
        .iter()
        .map(|s| report["seconds"][s].as_f64().unwrap())
        .sum();
    assert!((sum - report["seconds"]["total"].as_f64().unwrap()).abs() < 1e-6);
    if cfg!(target_os = "linux") {
        assert!(report["peak_mib"].as_f64().unwrap() > 1.0);
    }

    let check = json(&bonemesh(&["check", text(&stl), "--json"]));
    assert_eq!(check["triangles"], report["triangles"]);
    assert_eq!(check["vertices"], report["vertices"]);
    assert_eq!(check["boundary_edges"], 0);
    assert_eq!(check["consistent_winding"], true);
    let (a, b) = (&check["volume_mm3"], &report["volume_mm3"]);
    let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
    assert!((a / b - 1.0).abs() < 1e-4, "outward and complete: {a} {b}");
}

#[test]
fn without_a_method_the_surface_is_ready_to_print() {
    let folder = TempDir::new().unwrap();
    let stl = folder.path().join("bone.stl");
    let (scan, out) = (head(), text(&stl));
    let report = json(&bonemesh(&["render", text(&scan), "-o", out, "--json"]));
    assert_eq!(report["method"], "isosurface");
    assert!(report["points"].is_null() && report["alpha_mm"].is_null());
    assert_eq!(report["manifold"], true);
    let check = json(&bonemesh(&["check", out, "--json"]));
    assert_eq!(check["printable"], true, "{check}");
    assert_eq!(check["components"], report["components"]);
}

#[test]
fn choices_of_edge_points_speak_of_the_published_method() {
    let folder = TempDir::new().unwrap();
    let stl = folder.path().join("bone.stl");
    let scan = head();
    let render = |choice: &str| {
        let arguments = ["render", text(&scan), "-o", text(&stl), choice, "--json"];
        json(&bonemesh(&arguments))["method"].clone()
    };
    assert_eq!(render("--alpha=3"), "alpha");
    assert_eq!(render("--sample=50"), "alpha");
    assert_eq!(render("--smooth=0.1"), "isosurface");
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let folder = TempDir::new().unwrap();
    let made: Vec<Vec<u8>> = ["1", "2", "3", "8"]
        .iter()
        .map(|threads| {
            let stl = folder.path().join(format!("{threads}.stl"));
            json(&bonemesh(&[
                "render",
                text(&head()),
                "-o",
                text(&stl),
                "--threads",
                threads,
                "--json",
            ]));
            fs::read(stl).unwrap()
        })
        .collect();
    assert!(made.iter().all(|bytes| *bytes == made[0]));
}

#[test]
fn a_cloud_that_is_meshed_later_gives_the_same_surface_up_to_ties() {
    let folder = TempDir::new().unwrap();
    let (cloud, stl) = (folder.path().join("c.npy"), folder.path().join("m.stl"));
    let made = json(&bonemesh(&[
        "cloud",
        text(&head()),
        "-o",
        text(&cloud),
        "--json",
    ]));
    let meshed = json(&bonemesh(&[
        "mesh",
        text(&cloud),
        "-o",
        text(&stl),
        "--json",
    ]));
    let direct = folder.path().join("d.stl");
    let direct = json(&bonemesh(&[
        "render",
        text(&head()),
        "--method=alpha",
        "-o",
        text(&direct),
        "--json",
    ]));
    assert_eq!(made["points"], meshed["points"]);
    assert_eq!(made["points"], direct["points"]);
    let ratio = meshed["volume_mm3"].as_f64().unwrap() / direct["volume_mm3"].as_f64().unwrap();
    assert!((ratio - 1.0).abs() < 1e-2, "{ratio}");
}

#[test]
fn a_region_is_taken_out_by_a_ball_or_by_its_vertices() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (bone, region, again) = (at("bone.stl"), at("region.stl"), at("again.stl"));
    json(&bonemesh(&[
        "render",
        text(&head()),
        "--method=alpha",
        "-o",
        text(&bone),
        "--json",
    ]));
    let cut = |selection: &str, out: &Path| {
        bonemesh(&[
            "roi",
            text(&bone),
            selection,
            "--thickness",
            "9",
            "-o",
            text(out),
            "--json",
        ])
    };
    let report = json(&cut("--within=92,10,30,32", &region));
    assert!(report["kept_points"].as_u64().unwrap() > 0);
    assert_eq!(report["watertight"], true);

    let mesh = bonemesh::read_mesh(&bone, &bonemesh::Task::default()).unwrap();
    let inside = |v: &[f64; 3]| {
        let [x, y, z] = [v[0] - 92.0, v[1] - 10.0, v[2] - 30.0];
        x * x + y * y + z * z <= 32.0 * 32.0
    };
    let chosen = mesh
        .vertices_mm()
        .iter()
        .enumerate()
        .filter(|(_, v)| inside(v));
    let lines: Vec<String> = chosen.map(|(i, _)| i.to_string()).collect();
    fs::write(at("selection.txt"), lines.join("\n")).unwrap();
    json(&cut(
        &format!("--selection={}", text(&at("selection.txt"))),
        &again,
    ));
    assert_eq!(fs::read(region).unwrap(), fs::read(again).unwrap());
}

#[test]
fn a_crop_box_keeps_its_place_in_the_patient() {
    let folder = TempDir::new().unwrap();
    let (whole, part) = (folder.path().join("w.stl"), folder.path().join("p.stl"));
    json(&bonemesh(&[
        "render",
        text(&head()),
        "-o",
        text(&whole),
        "--json",
    ]));
    let crop = "--crop=0:160,0:160,40:73";
    json(&bonemesh(&[
        "render",
        text(&head()),
        "-o",
        text(&part),
        crop,
        "--json",
    ]));
    let bounds = |f: &Path| json(&bonemesh(&["check", text(f), "--json"]))["bounds_mm"].clone();
    let (whole, part) = (bounds(&whole), bounds(&part));
    let top = |bounds: &Value| bounds[1][2].as_f64().unwrap();
    assert!(
        (top(&whole) - top(&part)).abs() < 0.05,
        "the vertex of the skull stays where it is"
    );
    assert!(part[0][2].as_f64() > whole[0][2].as_f64());
}

#[test]
fn unusable_arguments_end_with_2() {
    let bone = ["render", "x", "-o", "y.stl"];
    for extra in [
        ["--hu", "bone"],
        ["--hu", "nan"],
        ["--sigma", "-1"],
        ["--method", "magic"],
        ["--alpha", "0"],
        ["--sample", "101"],
        ["--sample", "0"],
        ["--sampler", "best"],
        ["--crop", "1:2"],
        ["--crop", "5:2,0:1,0:1"],
        ["--threads", "0"],
        ["--series", "first"],
    ] {
        let output = bonemesh(&[&bone[..], &extra[..]].concat());
        assert_eq!(
            output.status.code(),
            Some(2),
            "{extra:?}: {}",
            message(&output)
        );
    }
    let roi = ["roi", "x.stl", "-o", "y.stl", "--selection", "s.txt"];
    for thickness in ["0", "-1", "nan", "thick"] {
        let option = format!("--thickness={thickness}");
        let output = bonemesh(&[&roi[..], &[option.as_str()]].concat());
        assert_eq!(output.status.code(), Some(2), "{thickness}");
    }
    for command in ["cloud", "render"] {
        let output = bonemesh(&[command, "x", "-o", "out.doc"]);
        assert_eq!(output.status.code(), Some(2), "{command}");
        assert!(message(&output).contains("out.doc"), "{command}");
    }
    assert_eq!(
        bonemesh(&["phantom", "unicorn", "x"]).status.code(),
        Some(2)
    );
    assert_eq!(bonemesh(&[]).status.code(), Some(2));
    assert_eq!(bonemesh(&["--help"]).status.code(), Some(0));
}

#[test]
fn folders_without_a_series_are_refused_in_one_line() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("bone.stl");
    let render = |from: &Path| bonemesh(&["render", text(from), "-o", text(&out)]);
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    assert_refused(&render(&empty), "empty");
    assert_refused(&render(&folder.path().join("missing")), "missing");
    let file = folder.path().join("notes.txt");
    fs::write(&file, "no image").unwrap();
    assert_refused(&render(&file), "notes.txt");
    fs::write(empty.join("scan.dcm"), "no image either").unwrap();
    assert_refused(&render(&empty), "empty");
    assert!(!out.exists());
}

#[test]
fn thresholds_that_leave_nothing_are_refused_with_the_range_of_the_scan() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("bone.stl");
    for hu in ["--hu=3071", "--hu=-2000"] {
        assert_refused(
            &bonemesh(&["render", text(&head()), "-o", text(&out), hu]),
            "HU",
        );
    }
    assert!(!out.exists());
}

#[test]
fn too_few_points_are_refused_with_what_made_them_few() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("bone.stl");
    let render = |option: &str| {
        let method = "--method=alpha";
        bonemesh(&["render", text(&head()), "-o", text(&out), method, option])
    };
    assert_refused(&render("--sample=0.0001"), "percentage");
    assert_refused(&render("--sigma=100"), "sigma");
    let cloud = folder.path().join("c.xyz");
    fs::write(&cloud, "1 2 3\n".repeat(200)).unwrap();
    let output = bonemesh(&["mesh", text(&cloud), "-o", text(&out)]);
    assert_refused(&output, "its own place");
    assert!(!out.exists());
}

#[cfg(unix)]
#[test]
fn folders_whose_names_are_no_unicode_are_reported() {
    use std::os::unix::ffi::OsStrExt;
    let folder = TempDir::new().unwrap();
    let odd = folder
        .path()
        .join(std::ffi::OsStr::from_bytes(b"\xff\xfe head"));
    fs::create_dir(&odd).unwrap();
    for file in fs::read_dir(head().join("dicom")).unwrap() {
        let file = file.unwrap();
        fs::copy(file.path(), odd.join(file.file_name())).unwrap();
    }
    let report = json(&bonemesh(&["info", text(folder.path()), "--json"]));
    assert_eq!(report["series"][0]["slices"], 73);
}

#[test]
fn clouds_that_enclose_no_space_are_refused() {
    let folder = TempDir::new().unwrap();
    let (cloud, out) = (folder.path().join("c.xyz"), folder.path().join("m.stl"));
    for points in [
        "0 0 0\n1 0 0\n0 1 0\n",
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 5 0\n",
        "0 0 0\n1 1 1\n2 2 2\n3 3 3\n",
        "",
        "0 0 zero\n",
        "0 0 nan\n",
    ] {
        fs::write(&cloud, points).unwrap();
        let output = bonemesh(&["mesh", text(&cloud), "-o", text(&out)]);
        assert_refused(&output, "");
    }
    assert!(!out.exists());
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_work() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    let render = |out: &Path| bonemesh(&["render", text(&head()), "-o", text(out)]);
    assert_refused(&render(&at("none/bone.stl")), "none");
    assert_eq!(render(&at("bone.docx")).status.code(), Some(2));
    fs::create_dir(at("folder.stl")).unwrap();
    assert_refused(&render(&at("folder.stl")), "folder.stl");
    fs::remove_dir(at("folder.stl")).unwrap();
    fs::write(at("kept.stl"), "mine").unwrap();
    let mut permissions = fs::metadata(at("kept.stl")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(at("kept.stl"), permissions).unwrap();
    assert_refused(&render(&at("kept.stl")), "kept.stl");
    assert_eq!(fs::read(at("kept.stl")).unwrap(), b"mine");
    assert_eq!(
        fs::read_dir(folder.path()).unwrap().count(),
        1,
        "nothing is left behind"
    );
}

#[test]
fn files_that_are_no_mesh_and_no_selection_are_refused() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("bad.stl"), "this is no mesh").unwrap();
    fs::write(at("sel.txt"), "0\n1\ntwo\n").unwrap();
    assert_refused(&bonemesh(&["check", text(&at("bad.stl"))]), "bad.stl");
    assert_refused(&bonemesh(&["check", text(&at("none.stl"))]), "none.stl");
    let bone = at("bone.stl");
    json(&bonemesh(&[
        "render",
        text(&head()),
        "-o",
        text(&bone),
        "--json",
    ]));
    let out = at("region.stl");
    let cut = |selection: &str| {
        bonemesh(&[
            "roi",
            text(&bone),
            selection,
            "--thickness",
            "5",
            "-o",
            text(&out),
        ])
    };
    assert_refused(
        &cut(&format!("--selection={}", text(&at("sel.txt")))),
        "sel.txt",
    );
    for (lines, word) in [("", "sel.txt"), ("7\n", ""), ("4000000000\n", "4000000000")] {
        fs::write(at("sel.txt"), lines).unwrap();
        assert_refused(&cut(&format!("--selection={}", text(&at("sel.txt")))), word);
    }
    assert_refused(&cut("--within=5000,0,0,1"), "select");
    assert!(!out.exists());
}

#[test]
fn info_lists_the_series_before_any_pixel_is_decoded() {
    let report = json(&bonemesh(&["info", text(&head()), "--json"]));
    let series = &report["series"][0];
    assert_eq!(series["slices"], 73);
    assert_eq!(series["modality"], "CT");
    assert_eq!(
        report["left_out"].as_array().unwrap().len(),
        1,
        "truth.json is no image"
    );
    let said = String::from_utf8(bonemesh(&["info", text(&head())]).stdout).unwrap();
    assert!(
        said.contains("73 slices") && said.contains("left out: 1"),
        "{said}"
    );
}
