//! STL files: round trips, foreign dialects, files that are none.

#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "tests; what comes back from a file is equal to the bit"
)]

mod shapes;

use std::fs;
use std::path::Path;

use bonemesh_mesh::{MeshError, TriangleMesh, read_mesh, write_mesh};
use bonemesh_task::Task;
use shapes::{box_mesh, torus};

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

const FACET: &str = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1e0 0\n\
                     endloop\nendfacet\n";

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
