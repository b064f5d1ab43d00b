//! What is kept beside a mesh file: how its mesh was made, as JSON.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

use bonemesh_mesh::PatientFrame;
use serde_json::{Map, Value};

use crate::Error;
use crate::whole_file::{probe, write_whole};

/// What says nothing of the mesh; and warnings, which may name files, whose names may be a patient's.
const LEFT_OUT: [&str; 4] = ["seconds", "peak_mib", "warnings", "output"];

/// The file beside `mesh_file`: its name with `.json` added.
pub fn sidecar_path(mesh_file: &Path) -> PathBuf {
    let mut name: OsString = mesh_file.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

/// Tells now whether [`write_sidecar`] could write the file beside `mesh_file`.
///
/// # Errors
/// [`Error::Sidecar`].
pub fn check_sidecar_target(mesh_file: &Path) -> Result<(), Error> {
    let path = sidecar_path(mesh_file);
    probe(&path).map_err(|source| failed(path, source))
}

/// Writes `report`, a JSON object, beside `mesh_file` with the file's name, unit and frame; it appears
/// complete or not at all.
///
/// Times, memory and warnings are left out: the same mesh has the same file, and nothing in it names a
/// patient, a folder or a machine.
///
/// # Errors
/// [`Error::Sidecar`].
pub fn write_sidecar(mesh_file: &Path, frame: PatientFrame, report: &Value) -> Result<(), Error> {
    let mut all = Map::new();
    let name = mesh_file.file_name().unwrap_or_default().to_string_lossy();
    all.insert("file".to_owned(), name.into());
    all.insert("unit".to_owned(), "mm".into());
    all.insert("frame".to_owned(), frame.name().to_uppercase().into());
    for (key, value) in report.as_object().into_iter().flatten() {
        if !LEFT_OUT.contains(&key.as_str()) {
            all.insert(key.clone(), value.clone());
        }
    }
    let path = sidecar_path(mesh_file);
    let text = format!("{:#}\n", Value::Object(all));
    write_whole(&path, |file| {
        use io::Write;
        file.write_all(text.as_bytes())
    })
    .map_err(|source| failed(path, source))
}

fn failed(path: PathBuf, source: io::Error) -> Error {
    Error::Sidecar { path, source }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sidecar_says_what_is_known_and_nothing_of_the_moment() {
        let folder = tempfile::tempdir().unwrap();
        let mesh = folder.path().join("bone.stl");
        let report = serde_json::json!({
            "method": "isosurface",
            "seconds": {"total": 1.0},
            "warnings": ["Meier/IM1: left out"],
            "options": {"crop": null},
        });
        check_sidecar_target(&mesh).unwrap();
        write_sidecar(&mesh, PatientFrame::Ras, &report).unwrap();
        let names: Vec<_> = std::fs::read_dir(&folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        assert_eq!(names, ["bone.stl.json"]);
        let text = std::fs::read_to_string(sidecar_path(&mesh)).unwrap();
        let read: Value = serde_json::from_str(&text).unwrap();
        let expected = serde_json::json!({
            "file": "bone.stl", "unit": "mm", "frame": "RAS",
            "method": "isosurface", "options": {"crop": null},
        });
        assert_eq!(read, expected);
    }

    #[test]
    fn a_place_that_cannot_be_written_is_named_and_stays_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let mesh = folder.path().join("no").join("bone.stl");
        let refused = check_sidecar_target(&mesh).unwrap_err().to_string();
        assert!(
            refused.contains("bone.stl.json") && refused.contains("no folder"),
            "{refused}"
        );
        let taken = folder.path().join("bone.stl");
        std::fs::create_dir(sidecar_path(&taken)).unwrap();
        assert!(write_sidecar(&taken, PatientFrame::Lps, &serde_json::json!({})).is_err());
    }
}
