//! STL, PLY, OBJ and 3MF files: round trips, foreign dialects, files that are none.

#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "tests; what comes back from a file is equal to the bit"
)]

mod shapes;

use std::fs;
use std::path::Path;

use bonemesh_mesh::{MeshError, TriangleMesh, check_target, read_mesh, write_mesh};
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

/// A binary STL with any header and claimed count.
fn binary_stl(header: &[u8], count: u32, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes[..header.len()].copy_from_slice(header);
    bytes.extend(count.to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

const TWO: [[[f32; 3]; 3]; 2] = [
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
    [[1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [-0.0, 0.0, 0.0]],
];

#[test]
fn an_stl_comes_back_merged_in_file_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("box.STL");
    let mesh = box_mesh([0.5; 3], [2.0; 3]);
    write(&path, &mesh);
    let back = read(&path).unwrap();
    assert_eq!(back.triangles()[..2], [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(back.vertices_mm().len(), 8);
    for (t, u) in mesh.triangles().iter().zip(back.triangles()) {
        assert_eq!(mesh.corners_mm(*t), back.corners_mm(*u));
    }
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
fn a_written_stl_is_binary_by_every_sign() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("torus.stl");
    let torus = torus(50, 30);
    write(&path, &torus);
    let bytes = fs::read(&path).unwrap();
    assert_eq!(bytes.len(), 84 + 50 * torus.triangles().len());
    assert!(!bytes.starts_with(b"solid"));
    let outward = f32::from_le_bytes(bytes[84..88].try_into().unwrap());
    assert!(outward > 0.9, "the first triangle faces +x");
}

#[test]
fn more_triangles_than_one_block_are_written_completely() {
    let folder = tempfile::tempdir().unwrap();
    let torus = torus(300, 250);
    for name in ["torus.stl", "torus.ply", "torus.obj", "torus.3mf"] {
        let path = folder.path().join(name);
        write(&path, &torus);
        let back = read(&path).unwrap();
        assert_eq!(back.vertices_mm().len(), torus.vertices_mm().len());
        let last = torus.triangles().len() - 1;
        let expected = torus.corners_mm(torus.triangles()[last]);
        let rounded = expected.map(|v| v.map(|c| f64::from(c as f32)));
        assert_eq!(back.corners_mm(back.triangles()[last]), rounded, "{name}");
    }
}

#[test]
fn a_binary_stl_that_begins_with_solid_is_read() {
    for header in [
        &b"solid exported by a CAD program"[..],
        b"solid",
        b"solid \n facet",
    ] {
        let mesh = read_bytes("a.stl", &binary_stl(header, 2, &TWO)).unwrap();
        assert_eq!(mesh.triangles(), [[0, 1, 2], [2, 3, 0]]);
    }
}

#[test]
fn a_wrong_triangle_count_is_refused_with_both_counts() {
    for count in [1, 3, u32::MAX] {
        for header in [&b"x"[..], b"solid"] {
            let error = read_bytes("a.stl", &binary_stl(header, count, &TWO)).unwrap_err();
            let text = error.to_string();
            assert!(text.contains("hold 2 triangles"), "{text}");
            assert!(text.contains(&format!("says {count}")), "{text}");
        }
    }
}

#[test]
fn a_coordinate_that_is_no_number_is_refused() {
    let mut triangles = TWO;
    triangles[1][2][0] = f32::NAN;
    let error = read_bytes("a.stl", &binary_stl(b"", 2, &triangles)).unwrap_err();
    assert!(matches!(error, MeshError::Malformed { .. }));
    assert!(error.to_string().contains("a.stl"));
}

const FACET: &str = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1e0 0\n\
                     endloop\nendfacet\n";

#[test]
fn ascii_dialects_are_read() {
    let dialects = [
        format!("solid a b\n{FACET}endsolid a b\n"),
        format!("solid\n{FACET}endsolid"),
        format!(
            "  SOLID X\r\n{}ENDSOLID\r\n",
            FACET.to_uppercase().replace('\n', "\r\n")
        ),
        format!(
            "solid n\n{}endsolid\n\n",
            FACET.replace("0 0 1", "nan nan -nan(ind)")
        ),
        format!("solid n\n\n{}\n\nendsolid\n", FACET.replace('\n', "\n\n  ")),
    ];
    for text in dialects {
        let mesh = read_bytes("a.stl", text.as_bytes()).unwrap();
        assert_eq!(
            mesh.vertices_mm(),
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
            "{text}"
        );
        assert_eq!(mesh.triangles(), [[0, 1, 2]]);
    }
}

#[test]
fn every_solid_of_an_ascii_stl_is_read() {
    let solid = format!("solid part\n{FACET}{FACET}endsolid part\n");
    let mesh = read_bytes("a.stl", solid.repeat(3).as_bytes()).unwrap();
    assert_eq!(mesh.triangles(), [[0, 1, 2]; 6]);
}

#[test]
fn a_long_ascii_stl_is_read_in_pieces() {
    let text = format!("solid long\n{}endsolid\n", FACET.repeat(40_000));
    let mesh = read_bytes("a.stl", text.as_bytes()).unwrap();
    assert_eq!(mesh.triangles().len(), 40_000);
}

#[test]
fn a_broken_ascii_stl_is_refused() {
    let broken = [
        format!("solid a\n{FACET}"),
        format!("solid a\n{}endsolid", FACET.replace("endloop", "")),
        format!("solid a\n{}endsolid", FACET.replace("1e0", "one")),
        format!("solid a\n{}endsolid", FACET.replace("1e0", "inf")),
        format!("solid a\n{FACET}endsolid\nrubbish\n"),
        "solid as a rock, says this letter\nand more lines follow\n".into(),
        format!("solid {}", "x".repeat(100_000)),
    ];
    for text in broken {
        let error = read_bytes("a.stl", text.as_bytes()).unwrap_err();
        assert!(matches!(error, MeshError::Malformed { .. }), "{error}");
        assert!(!error.to_string().contains('\n'));
    }
}

#[test]
fn files_that_are_no_stl_are_refused() {
    let mut dicom = vec![0; 128];
    dicom.extend(b"DICM and so on");
    let others = [
        Vec::new(),
        b"solid"[..3].to_vec(),
        b"\x89PNG\r\n\x1a\n".repeat(100),
        b"Dear colleague, please find enclosed. ".repeat(10),
        dicom,
    ];
    for bytes in others {
        let error = read_bytes("a.stl", &bytes).unwrap_err();
        assert!(matches!(error, MeshError::Malformed { .. }), "{error}");
    }
}

#[test]
fn a_file_without_triangles_is_refused() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
               property float z\nend_header\n0 0 0\n";
    for error in [
        read_bytes("a.stl", &binary_stl(b"", 0, &[])).unwrap_err(),
        read_bytes("a.stl", b"solid nothing\nendsolid\n").unwrap_err(),
        read_bytes("a.ply", ply.as_bytes()).unwrap_err(),
    ] {
        assert!(matches!(error, MeshError::NoTriangles { .. }), "{error}");
    }
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
        let expected = TriangleMesh::new(rounded, mesh.triangles().to_vec()).unwrap().merged();
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
}
