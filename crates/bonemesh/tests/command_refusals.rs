//! What the `bonemesh` command refuses: exit codes, one line, no file.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use std::fs;
use std::path::Path;

use common::command::{assert_refused, bone, bonemesh, head, message, text};
use tempfile::TempDir;

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
fn choices_that_the_method_has_not_end_with_2_before_anything_is_read() {
    for (choices, known) in [
        (&["--method", "isosurface", "--alpha", "2"][..], "`alpha`"),
        (&["--method", "labelled", "--sample", "10"], "`tetrahedra`"),
        (&["--sigma", "2"], "`planar`"),
        (&["--radii", "1,2"], "`ball-pivoting`"),
        (&["--depth", "5"], "`poisson`"),
        (&["--method", "alpha", "--scale", "2"], "`poisson`"),
        (&["--method", "alpha", "--at-threshold"], "`labelled`"),
        (&["--method", "poisson", "--keep-table"], "`isosurface`"),
    ] {
        let render = ["render", "missing", "-o", "y.stl"];
        let output = bonemesh(&[&render[..], choices].concat());
        let said = message(&output);
        assert_eq!(output.status.code(), Some(2), "{choices:?}: {said}");
        assert!(said.contains(known), "{choices:?}: {said}");
    }
    let folder = TempDir::new().unwrap();
    let cloud = folder.path().join("cloud.xyz");
    fs::write(&cloud, "0 0 0\n1 0 0\n0 1 0\n0 0 1\n").unwrap();
    for choices in [["--alpha", "auto"], ["--method", "isosurface"]] {
        let mesh = ["mesh", text(&cloud), "-o", "y.stl"];
        let output = bonemesh(&[&mesh[..], &choices].concat());
        assert_eq!(output.status.code(), Some(2), "{}", message(&output));
    }
    let voxels = bonemesh(&["mesh", text(&cloud), "-o", "y.stl", "--keep-table"]);
    assert_eq!(voxels.status.code(), Some(2));
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
    let bone = bone(folder.path());
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
