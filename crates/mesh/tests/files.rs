//! Files of any format: round trips, targets, what is refused.

#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "tests; what comes back from a file is equal to the bit"
)]

mod shapes;

use std::fs;
use std::path::Path;

use bonemesh_mesh::{
    MeshError, PatientFrame, TriangleMesh, check_target, check_topology, read_mesh, write_mesh,
    write_mesh_in,
};
use bonemesh_task::Task;
use proptest::prelude::*;
use shapes::{box_mesh, mesh, torus};

fn write(path: &Path, mesh: &TriangleMesh) {
    write_mesh(path, mesh, &Task::default()).unwrap();
}

fn read(path: &Path) -> Result<TriangleMesh, MeshError> {
    read_mesh(path, &Task::default())
}

/// Reads `bytes` from a file of this name.
fn read_bytes(name: &str, bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read(&path)
}

#[test]
fn other_files_come_back_with_their_own_vertex_numbers() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["box.ply", "box.OBJ", "box.3mf"] {
        let path = folder.path().join(name);
        let mesh = box_mesh([0.5; 3], [2.0; 3]);
        write(&path, &mesh);
        assert_eq!(read(&path).unwrap(), mesh, "{name}");
    }
}

#[test]
fn every_file_says_its_unit_and_frame() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.stl", "a.ply", "a.obj"] {
        let path = folder.path().join(name);
        write(&path, &torus(9, 9));
        let bytes = fs::read(&path).unwrap();
        let text = String::from_utf8_lossy(&bytes[..200]).into_owned();
        assert!(text.contains("millimetres, patient space LPS"), "{text}");
    }
}

#[test]
fn a_file_without_triangles_is_refused() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
               property float z\nend_header\n0 0 0\n";
    for error in [
        read_bytes("a.stl", &[0; 84]).unwrap_err(),
        read_bytes("a.stl", b"solid nothing\nendsolid\n").unwrap_err(),
        read_bytes("a.ply", ply.as_bytes()).unwrap_err(),
    ] {
        assert!(matches!(error, MeshError::NoTriangles { .. }), "{error}");
    }
}

#[test]
fn an_unknown_extension_is_refused_with_the_known_ones() {
    for name in ["a.off", "a", "stl"] {
        let text = read_bytes(name, b"").unwrap_err().to_string();
        let known = [".stl", ".ply", ".obj", ".3mf"];
        assert!(known.iter().all(|known| text.contains(known)), "{text}");
    }
}

#[test]
fn missing_files_and_folders_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("none.stl");
    assert!(matches!(read(&path), Err(MeshError::NotFound { .. })));
    let path = folder.path().join("folder.stl");
    fs::create_dir(&path).unwrap();
    assert!(matches!(read(&path), Err(MeshError::IsFolder { .. })));
    let mesh = box_mesh([0.0; 3], [1.0; 3]);
    let refused = |path: &Path| write_mesh(path, &mesh, &Task::default()).unwrap_err();
    assert!(matches!(refused(&path), MeshError::IsFolder { .. }));
    let error = refused(&folder.path().join("no/such/a.stl"));
    assert!(matches!(error, MeshError::NoFolder { .. }));
    assert!(error.to_string().contains("no/such"));
}

#[test]
fn a_target_is_checked_without_a_trace() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.stl");
    check_target(&path).unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    fs::write(&path, "old").unwrap();
    check_target(&path).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"old");
    let refused = |name: &str| check_target(folder.path().join(name)).unwrap_err();
    assert!(matches!(refused("no/a.stl"), MeshError::NoFolder { .. }));
    assert!(matches!(
        refused("a.off"),
        MeshError::UnknownExtension { .. }
    ));
}

#[test]
fn a_write_protected_file_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kept.stl");
    fs::write(&path, "kept").unwrap();
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();
    let error = write_mesh(&path, &box_mesh([0.0; 3], [1.0; 3]), &Task::default()).unwrap_err();
    assert!(matches!(error, MeshError::ReadOnly { .. }));
    assert_eq!(fs::read(&path).unwrap(), b"kept");
}

#[test]
fn meshes_that_no_file_can_hold_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.stl");
    let far = mesh(vec![[1e39, 0.0, 0.0], [0.0; 3], [1.0; 3]], vec![[0, 1, 2]]);
    let refused = |mesh| write_mesh(&path, mesh, &Task::default()).unwrap_err();
    assert!(matches!(
        refused(&far),
        MeshError::OutOfFileRange { vertex: 0, .. }
    ));
    let empty = TriangleMesh::default();
    assert!(matches!(refused(&empty), MeshError::NothingToWrite { .. }));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_cancelled_write_leaves_the_old_file_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.stl", "a.ply", "a.obj", "a.3mf"] {
        let path = folder.path().join(name);
        fs::write(&path, "old").unwrap();
        let task = Task::default();
        task.cancel().cancel();
        let error = write_mesh(&path, &torus(9, 9), &task).unwrap_err();
        assert!(matches!(error, MeshError::Cancelled(_)));
        assert_eq!(fs::read(&path).unwrap(), b"old");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
}

#[cfg(unix)]
#[test]
fn a_written_file_has_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (path, plain) = (folder.path().join("a.stl"), folder.path().join("plain"));
    write(&path, &torus(9, 9));
    fs::write(&plain, "").unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&plain));
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_to_the_written_file() {
    let folder = tempfile::tempdir().unwrap();
    let (path, link) = (folder.path().join("a.stl"), folder.path().join("link.stl"));
    fs::write(&path, "old").unwrap();
    std::os::unix::fs::symlink(&path, &link).unwrap();
    write(&link, &torus(9, 9));
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(read(&path).unwrap().triangles().len(), 162);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_mesh_comes_back_rounded_and_merged(
        corners in prop::collection::vec([-3_i32..3, -3_i32..3, -3_i32..3], 3..60),
        scale in prop::sample::select(vec![1.0, 0.1, 123.456, 1e-30]),
        extension in prop::sample::select(vec!["stl", "ply", "obj", "3mf"]),
    ) {
        let vertices: Vec<[f64; 3]> =
            corners.iter().map(|v| v.map(|c| f64::from(c) * scale)).collect();
        let triangles = (0..vertices.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        let mesh = mesh(vertices, triangles.collect()).compacted();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("any").with_extension(extension);
        write(&path, &mesh);
        let rounded = mesh.vertices_mm().iter().map(|v| v.map(|c| f64::from(c as f32))).collect();
        let expected = TriangleMesh::new(rounded, mesh.triangles().to_vec()).unwrap().merged(&Task::default()).unwrap();
        prop_assert_eq!(read(&path).unwrap(), expected);
    }

    #[test]
    fn no_bytes_whatever_make_reading_panic(
        bytes in prop::collection::vec(any::<u8>(), 0..300),
        start in prop::sample::select(vec![
            &b""[..], b"solid ", b"solid\nfacet normal 0 0 0\nouter loop\n",
            b"ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nend_header\n",
            b"ply\nformat binary_little_endian 1.0\nelement face 9\n\
              property list uint int vertex_indices\nend_header\n",
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 ", b"PK\x03\x04",
        ]),
    ) {
        let bytes = [start, &bytes].concat();
        for name in ["a.stl", "a.ply", "a.obj", "a.3mf"] {
            if let Err(error) = read_bytes(name, &bytes) {
                prop_assert!(!error.to_string().contains('\n'));
            }
        }
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_and_stays() {
    use std::os::unix::fs::FileTypeExt;
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.stl");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let refused = write_mesh(&pipe, &torus(8, 8), &Task::default());
    assert!(matches!(refused, Err(MeshError::NotAFile { .. })));
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    let refused = read(&pipe);
    assert!(matches!(refused, Err(MeshError::NotAFile { .. })));
}

#[test]
fn another_frame_turns_the_body_and_mirrors_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let body = box_mesh([0.0, 1.0, -3.0], [2.0, 5.0, 4.0]);
    for name in ["box.stl", "box.ply", "box.obj", "box.3mf"] {
        let path = folder.path().join(name);
        write_mesh_in(&path, &body, PatientFrame::Ras, &Task::default()).unwrap();
        let back = read(&path).unwrap();
        assert_eq!(
            back.bounds_mm(),
            Some([[-2.0, -5.0, -3.0], [0.0, -1.0, 4.0]]),
            "{name}"
        );
        let topology = check_topology(&back, &Task::default()).unwrap();
        assert!((topology.volume_mm3 - 56.0).abs() < 1e-9, "{name}");
        assert_eq!(back.triangles().len(), body.triangles().len());
        if name != "box.3mf" {
            let text = fs::read(&path).unwrap();
            let text = String::from_utf8_lossy(&text);
            assert!(text.contains("patient space RAS"), "{name}");
            assert!(!text.contains("LPS") && !text.contains("-0 "), "{name}");
        }
    }
    assert_eq!("RAS".parse(), Ok(PatientFrame::Ras));
    assert!(
        "xyz"
            .parse::<PatientFrame>()
            .unwrap_err()
            .contains("lps or ras")
    );
}
