//! What the command can be given: folders, single files, odd paths; and what it says of them.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use bonemesh::{Source, Task, Voxels};
use serde_json::Value;
use tempfile::TempDir;

/// A small series of a sphere, made once.
static SPHERE: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = TempDir::new().unwrap();
    write(&folder.path().join("made"), &["--coarser", "3"]);
    folder
});

fn write(folder: &Path, options: &[&str]) {
    let folder = folder.to_str().unwrap();
    let made = bonemesh(&[&["phantom", "sphere-shell", folder], options].concat());
    assert!(made.status.success(), "{}", message(&made));
}

fn series() -> PathBuf {
    SPHERE.path().join("made").join("dicom")
}

fn bonemesh(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bonemesh"))
        .args(arguments)
        .output()
        .unwrap()
}

fn message(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", message(output));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn info(path: &Path, options: &[&str]) -> Value {
    let path = path.to_str().unwrap();
    json(&bonemesh(&[&["info", path, "--json"], options].concat()))
}

fn copy(to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(series()).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
    }
}

#[test]
fn the_range_of_the_values_is_said_where_pixels_are_asked_for() {
    let headers = info(&series(), &[]);
    assert_eq!(headers["series"][0]["hu_range"], Value::Null);
    let decoded = info(&series(), &["--pixels"]);
    let volume = Source::open(&series(), false, &Task::default())
        .unwrap()
        .read(None, &Task::default())
        .unwrap()
        .volume;
    let (low, high) = volume.hu_range();
    assert_eq!(
        decoded["series"][0]["hu_range"],
        serde_json::json!([low, high])
    );
    let said = bonemesh(&["info", series().to_str().unwrap(), "--pixels"]).stdout;
    let expected = format!("values from {low} to {high} HU");
    assert!(String::from_utf8(said).unwrap().contains(&expected));
}

#[test]
fn another_series_is_rendered_when_it_is_chosen() {
    let folder = TempDir::new().unwrap();
    copy(&folder.path().join("first"));
    write(&folder.path().join("second"), &["--coarser", "4"]);
    let found = info(folder.path(), &[]);
    assert_eq!(found["recommended"], 1);
    assert_eq!(found["alternatives"], serde_json::json!([2]));
    let stl = folder.path().join("bone.stl");
    let (path, stl) = (folder.path().to_str().unwrap(), stl.to_str().unwrap());
    let refused = bonemesh(&["render", path, "-o", stl]);
    assert!(
        message(&refused).contains("several series"),
        "{}",
        message(&refused)
    );
    for (number, index) in [("1", 0), ("2", 1)] {
        let options = ["render", path, "-o", stl, "--series", number, "--json"];
        let report = json(&bonemesh(&options));
        assert_eq!(report["series_uid"], found["series"][index]["uid"]);
        assert_eq!(report["spacing_mm"], found["series"][index]["spacing_mm"]);
    }
}

#[test]
fn a_nifti_file_renders_to_the_same_mesh_as_its_series() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("head.nii");
    fs::write(&file, nifti()).unwrap();
    let found = info(&file, &["--pixels"]);
    let original = info(&series(), &["--pixels"]);
    for key in ["slices", "rows", "columns", "hu_range"] {
        assert_eq!(found["series"][0][key], original["series"][0][key], "{key}");
    }
    let render = |path: &Path, name: &str| {
        let out = folder.path().join(name);
        let (path, out_text) = (path.to_str().unwrap(), out.to_str().unwrap());
        json(&bonemesh(&["render", path, "-o", out_text, "--json"]));
        fs::read(out).unwrap()
    };
    assert_eq!(render(&file, "a.stl"), render(&series(), "b.stl"));
    let path = file.to_str().unwrap();
    let refused = bonemesh(&["render", path, "-o", "never.stl", "--series", "2"]);
    assert!(
        message(&refused).contains("no series 2"),
        "{}",
        message(&refused)
    );
}

/// The sphere as NIfTI: 16-bit, with the map to right-anterior-superior in its header.
fn nifti() -> Vec<u8> {
    let volume = Source::open(&series(), false, &Task::default())
        .unwrap()
        .read(None, &Task::default())
        .unwrap()
        .volume;
    let [slices, rows, columns] = volume.geometry().shape();
    let mut header = vec![0_u8; 352];
    let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, &348_i32.to_le_bytes());
    for (n, side) in [3, columns, rows, slices, 1, 1, 1, 1]
        .into_iter()
        .enumerate()
    {
        put(40 + 2 * n, &(side as i16).to_le_bytes());
    }
    put(70, &4_i16.to_le_bytes());
    put(72, &16_i16.to_le_bytes());
    let [dx, dy, dz] = volume.geometry().spacing_mm();
    for (n, spacing) in [1.0, dx, dy, dz].into_iter().enumerate() {
        put(76 + 4 * n, &(spacing as f32).to_le_bytes());
    }
    put(108, &352_f32.to_le_bytes());
    put(123, &[2]);
    put(254, &1_i16.to_le_bytes());
    let matrix = volume.geometry().patient_from_voxel().matrix();
    // Right, anterior, superior against DICOM's left, posterior, superior.
    let rows = matrix.iter().zip([-1.0, -1.0, 1.0]);
    let values = rows.flat_map(|(row, sign)| row.iter().map(move |v| (sign * v) as f32));
    for (n, value) in values.enumerate() {
        put(280 + 4 * n, &value.to_le_bytes());
    }
    put(344, b"n+1\0");
    let Voxels::I16(hu) = volume.voxels() else {
        unreachable!("phantoms are written in 16 bits")
    };
    header.extend(hu.iter().flat_map(|v| v.to_le_bytes()));
    header
}

#[test]
fn names_of_any_language_and_length_are_paths_like_others() {
    let root = TempDir::new().unwrap();
    let mut deep = root.path().join("Schädel Ωμέγα 頭蓋骨 – “CT”");
    for n in 0..6 {
        deep.push(format!("{n}{}", "x".repeat(100)));
    }
    copy(&deep);
    let found = info(root.path(), &[]);
    assert_eq!(
        found["series"][0]["slices"],
        info(&series(), &[])["series"][0]["slices"]
    );
    let stl = deep.join("Knochen – 骨.stl");
    let (folder, out) = (deep.to_str().unwrap(), stl.to_str().unwrap());
    let report = json(&bonemesh(&["render", folder, "-o", out, "--json"]));
    assert_eq!(report["output"], out);
    assert!(stl.exists());
}

#[cfg(unix)]
#[test]
fn a_folder_that_nobody_may_write_into_is_read() {
    use std::os::unix::fs::PermissionsExt;
    let root = TempDir::new().unwrap();
    let disc = root.path().join("disc");
    copy(&disc);
    for entry in fs::read_dir(&disc).unwrap() {
        let path = entry.unwrap().path();
        fs::set_permissions(path, fs::Permissions::from_mode(0o444)).unwrap();
    }
    fs::set_permissions(&disc, fs::Permissions::from_mode(0o555)).unwrap();
    let stl = root.path().join("bone.stl");
    let (folder, out) = (disc.to_str().unwrap(), stl.to_str().unwrap());
    json(&bonemesh(&["render", folder, "-o", out, "--json"]));
    fs::set_permissions(&disc, fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn broken_uids_are_healed_on_request() {
    let folder = TempDir::new().unwrap();
    copy(folder.path());
    let files: Vec<PathBuf> = fs::read_dir(folder.path())
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    let uid = info(&series(), &[])["series"][0]["uid"]
        .as_str()
        .unwrap()
        .to_owned();
    for (n, file) in files.iter().enumerate() {
        let mut bytes = fs::read(file).unwrap();
        let at = bytes
            .windows(uid.len())
            .position(|w| w == uid.as_bytes())
            .unwrap();
        let own = format!("1.2.{n:0>width$}", width = uid.len() - 4);
        bytes[at..at + uid.len()].copy_from_slice(own.as_bytes());
        fs::write(file, bytes).unwrap();
    }
    let path = folder.path().to_str().unwrap();
    let refused = bonemesh(&["info", path]);
    assert_eq!(refused.status.code(), Some(1));
    let healed = info(folder.path(), &["--one-series"]);
    assert_eq!(healed["series"][0]["slices"], files.len());
    let out = folder.path().join("bone.stl");
    let options = [
        "render",
        path,
        "-o",
        out.to_str().unwrap(),
        "--one-series",
        "--json",
    ];
    json(&bonemesh(&options));
}

#[cfg(unix)]
#[test]
fn names_of_files_cannot_drive_the_terminal() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("two\nlines \u{1b}[31m"), "no scan").unwrap();
    let refused = bonemesh(&["info", folder.path().join("not\nthere").to_str().unwrap()]);
    assert_eq!(message(&refused).trim_end().lines().count(), 1);
    copy(folder.path());
    let said = bonemesh(&["info", folder.path().to_str().unwrap()]).stdout;
    let said = String::from_utf8(said).unwrap();
    assert!(
        !said.contains('\u{1b}') && said.contains("two\u{fffd}lines"),
        "{said}"
    );
}

#[test]
fn a_damaged_volume_file_is_told_to_be_damaged() {
    let folder = TempDir::new().unwrap();
    let damaged_gzip: &[u8] = &[0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 3, 0xff, 0xff, 0xff];
    for (name, bytes, says) in [
        ("head.nii.gz", damaged_gzip, "cannot be inflated"),
        ("head.NII", &[0; 400], "its first bytes are not those of"),
        ("head.nii", &[], "it is empty"),
        ("head.nrrd", b"NRR", "its first bytes are not those of"),
    ] {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let refused = message(&bonemesh(&["info", path.to_str().unwrap()]));
        assert!(
            refused.contains(name) && refused.contains(says),
            "{refused}"
        );
        assert!(
            refused.contains("copy or export the file again"),
            "{refused}"
        );
        assert!(!refused.contains("DICOM"), "{refused}");
    }
    // A series in a folder of such a name is one all the same.
    let series = folder.path().join("series.nii");
    copy(&series);
    assert_eq!(info(&series, &[])["recommended"], 1);
}
