//! PLY files as others write them, and broken ones.

#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "tests; what comes back from a file is equal to the bit"
)]

use std::fs;

use bonemesh_mesh::{MeshError, TriangleMesh, read_mesh};
use bonemesh_task::Task;

/// Reads `bytes` from a file of this name.
fn read_bytes(name: &str, bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read_mesh(&path, &Task::default())
}

#[test]
fn an_ascii_ply_with_quads_extras_and_equal_vertices_is_read() {
    let ply = "ply\r\nformat ascii 1.0\r\ncomment made elsewhere\r\nelement material 1\r\n\
               property int id\r\nelement vertex 6\r\nproperty double x\r\nproperty double y\r\n\
               property double z\r\nproperty uchar red\r\nelement face 3\r\n\
               property uchar flag\r\nproperty list uint8 int32 vertex_index\r\nend_header\r\n\
               7\r\n0 0 0 255\r\n1 0 0 255\r\n1 1 0 255\r\n0 1 0 255\r\n0 0 0 9\r\n5 5 5 9\r\n\
               0 4 0 1 2 3\r\n0 3 4 1 5\r\n0 2 0 1\r\n";
    let mesh = read_bytes("a.ply", ply.as_bytes()).unwrap();
    assert_eq!(mesh.vertices_mm().len(), 5);
    assert_eq!(mesh.vertices_mm()[4], [5.0; 3]);
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3], [0, 1, 4]]);
}

#[test]
fn broken_ply_files_are_refused() {
    let head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                property float z\nelement face 1\nproperty list uchar int vertex_indices\n";
    let body = "end_header\n0 0 0 1 0 0 0 1 0 3 0 1 2\n";
    assert_eq!(
        read_bytes("a.ply", format!("{head}{body}").as_bytes())
            .unwrap()
            .triangles(),
        [[0, 1, 2]]
    );
    let whole = format!("{head}{body}");
    let broken = [
        String::new(),
        "solid\n".into(),
        head.into(),
        whole.replace("ascii", "binary_big_endian"),
        whole.replace("element face 1", "element face 4000000000"),
        whole.replace("element face 1", "element face many"),
        whole.replace("3 0 1 2", "3 0 1 3"),
        whole.replace("3 0 1 2", "3 0 1 -1"),
        whole.replace("3 0 1 2", "4000000000 0 1 2"),
        whole.replace("3 0 1 2", "-3 0 1 2"),
        whole.replace("0 0 0 1", "0 0 nan 1"),
        whole.replace("0 0 0 1", "0 0 zero 1"),
        whole.replace("float z", "float w"),
        whole.replace("vertex_indices", "corners"),
        whole.replace("uchar int", "uchar quaternion"),
        whole.replace("element vertex 3\n", ""),
    ];
    for text in broken {
        let error = read_bytes("a.ply", text.as_bytes()).unwrap_err();
        assert!(
            matches!(error, MeshError::Malformed { .. }),
            "{text}: {error}"
        );
        assert!(!error.to_string().contains('\n'));
    }
    // An element without properties takes no bytes, so its count costs nothing.
    let empty = whole.replace(
        "element face 1",
        "element void 18446744073709551615\nelement face 1",
    );
    assert_eq!(
        read_bytes("a.ply", empty.as_bytes())
            .unwrap()
            .triangles()
            .len(),
        1
    );
}
