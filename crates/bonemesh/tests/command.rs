//! The `bonemesh` command as a user runs it: files in, files out, what it says.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use std::fs;
use std::path::Path;

use common::command::{assert_refused, bonemesh, head, json, text};
use serde_json::Value;
use tempfile::TempDir;

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
fn walls_are_written_for_every_vertex_of_a_closed_mesh() {
    let folder = TempDir::new().unwrap();
    let (stl, ply) = (folder.path().join("tube.stl"), folder.path().join("w.ply"));
    let series = folder.path().join("tube");
    bonemesh(&["phantom", "tube", text(&series), "--coarser", "1.5"]);
    bonemesh(&["render", text(&series), "-o", text(&stl)]);
    let report = json(&bonemesh(&[
        "check",
        text(&stl),
        "--walls",
        text(&ply),
        "--json",
        "--threads",
        "2",
    ]));
    let bytes = fs::read(&ply).unwrap();
    let end = b"end_header\n";
    let head = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
    let header = std::str::from_utf8(&bytes[..head]).unwrap();
    assert!(header.contains("property float wall_mm"), "{header}");
    let vertices = report["vertices"].as_u64().unwrap() as usize;
    let walls = bytes[head..].chunks(16).take(vertices);
    let walls = walls.map(|v| f64::from(f32::from_le_bytes([v[12], v[13], v[14], v[15]])));
    let thinnest = walls.clone().fold(f64::INFINITY, f64::min);
    assert!((thinnest - report["thinnest_wall_mm"].as_f64().unwrap()).abs() < 1e-4);
    let mut walls: Vec<f64> = walls.collect();
    walls.sort_by(f64::total_cmp);
    // Between radii of 9 and 15 mm, at most of the surface.
    assert!(
        (walls[vertices / 2] - 6.0).abs() < 0.5,
        "{}",
        walls[vertices / 2]
    );
    let again = json(&bonemesh(&["check", text(&ply), "--json"]));
    assert_eq!(again["printable"], true);
}

#[test]
fn walls_of_an_open_mesh_or_for_another_format_are_refused() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    let open = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    fs::write(at("open.obj"), open).unwrap();
    for (walls, word) in [("w.ply", "encloses no volume"), ("w.stl", ".ply")] {
        let walls = at(walls);
        let output = bonemesh(&["check", text(&at("open.obj")), "--walls", text(&walls)]);
        assert_refused(&output, word);
        assert!(!walls.exists());
    }
    fs::write(at("bad.obj"), open.replace("1 2 3", "1 2 4")).unwrap();
    let bad = bonemesh(&["check", text(&at("bad.obj"))]);
    assert_refused(&bad, "names vertex 4, but there are 3");
}

#[test]
fn the_threshold_goes_by_three_names() {
    let folder = TempDir::new().unwrap();
    let stl = folder.path().join("bone.stl");
    let scan = head();
    let threshold = |option: &[&str]| {
        let arguments = ["render", text(&scan), "-o", text(&stl), "--json"];
        json(&bonemesh(&[&arguments, option].concat()))["threshold_hu"].clone()
    };
    for option in [["--hu", "500"], ["--threshold", "500"], ["-t", "500"]] {
        assert_eq!(threshold(&option), 500.0, "{option:?}");
    }
    assert_eq!(
        threshold(&["-t", "cortical"]),
        threshold(&["--hu=cortical"])
    );
    let below_air = bonemesh(&["render", text(&scan), "-o", text(&stl), "-t", "-2000"]);
    assert_refused(&below_air, "HU");
    let help = bonemesh(&["render", "--help"]).stdout;
    let help = String::from_utf8(help).unwrap();
    assert!(
        help.contains("-t, --hu <HU>") && help.contains("--threshold"),
        "{help}"
    );
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
            "--thickness=9",
            "--method=thesis",
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
