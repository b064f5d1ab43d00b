//! OBJ and 3MF files as others write them, and as hostile hands do.

#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "tests; coordinates in these files are whole numbers"
)]

mod shapes;

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

use bonemesh_mesh::{MeshError, TriangleMesh, check_topology, read_mesh, write_mesh};
use bonemesh_task::Task;
use shapes::{box_mesh, mesh, torus};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// Reads `bytes` from a file of this name.
fn read_bytes(name: &str, bytes: &[u8]) -> Result<TriangleMesh, MeshError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read_mesh(&path, &Task::default())
}

fn refusal(name: &str, bytes: &[u8]) -> String {
    let error = read_bytes(name, bytes).unwrap_err();
    assert!(matches!(error, MeshError::Malformed { .. }), "{error}");
    let text = error.to_string();
    assert!(text.contains(name) && !text.contains('\n'), "{text}");
    text
}

#[test]
fn obj_dialects_are_read() {
    let dialects = [
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
        "# made elsewhere\r\no part\r\nv 0 0 0 0.5 0.5 0.5\r\nv 1e0 0 0\r\nvn 0 0 1\r\nv 1 1 0\r\n\
         v 0 1 0\r\nusemtl x\r\nf 1//1 2//1 3//1 4//1\r\n",
        "  v 0 0 0\n\tv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf -4/1 -3/1 -2/1\nf 1/1/1 3/1/1 4/1/1",
        "f 1 2 3\nf 1 3 4\nl 1 2\np 1\nf 1 2\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n",
        "v 0 0 0\nv 1 \\\n0 0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\r\n3 4\n",
    ];
    for text in dialects {
        let mesh = read_bytes("a.obj", text.as_bytes()).unwrap();
        assert_eq!(
            mesh.vertices_mm(),
            [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
        );
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]], "{text}");
    }
}

#[test]
fn a_broken_obj_is_refused_with_its_line() {
    let good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(
        read_bytes("a.obj", good.as_bytes())
            .unwrap()
            .triangles()
            .len(),
        1
    );
    for (from, to, line) in [
        ("v 1 0 0", "v 1 0", "line 2"),
        ("v 1 0 0", "v 1 0 zero", "line 2"),
        ("v 1 0 0", "v 1 nan 0", "line 2"),
        ("v 1 0 0", "v 1 1e39 0", "line 2"),
        ("f 1 2 3", "f 1 2 0", "line 4"),
        ("f 1 2 3", "f 1 2 -4", "line 4"),
        ("f 1 2 3", "f 1 2 x", "line 4"),
        ("f 1 2 3", "f 1 2 99999999999999999999", "line 4"),
        ("f 1 2 3", "f 1 2 5000000000", "line 4"),
        ("f 1 2 3", "f 1 2 4", "vertex 4, but there are 3"),
        ("v 1 0 0", "v 1 0 0\0", "line 2"),
    ] {
        let text = refusal("a.obj", good.replace(from, to).as_bytes());
        assert!(text.contains(line), "{text}");
    }
    assert!(refusal("a.obj", "v ".repeat(1 << 20).as_bytes()).contains("too long"));
    assert!(refusal("a.obj", "v 0 \\\n".repeat(1 << 19).as_bytes()).contains("too long"));
    let nothing = read_bytes("a.obj", b"Dear colleague,\nplease find enclosed\n");
    assert!(matches!(nothing, Err(MeshError::NoTriangles { .. })));
}

/// A zip archive of texts.
fn archive(path: &Path, parts: &[(&str, &str)]) {
    let mut zip = ZipWriter::new(File::create(path).unwrap());
    for (name, text) in parts {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap();
}

fn read_parts(parts: &[(&str, &str)]) -> Result<TriangleMesh, MeshError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.3mf");
    archive(&path, parts);
    read_mesh(&path, &Task::default())
}

fn read_model(model: &str) -> Result<TriangleMesh, MeshError> {
    read_parts(&[("3D/3dmodel.model", model)])
}

/// One tetrahedron with its corner at the origin, edges of 1 unit.
const OBJECT: &str = r#"<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/>
    <vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices>
    <triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/>
    <triangle v1="0" v2="3" v3="2"/><triangle v1="1" v2="2" v3="3"/></triangles></mesh></object>"#;

fn model(attributes: &str, resources: &str, build: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><model {attributes}><resources>{resources}</resources>\
         <build>{build}</build></model>"
    )
}

fn volume(mesh: &TriangleMesh) -> f64 {
    let topology = check_topology(mesh, &Task::default()).unwrap();
    assert!(topology.watertight && topology.manifold);
    topology.volume_mm3
}

#[test]
fn units_of_a_3mf_become_millimetres() {
    for (unit, mm) in [
        ("", 1.0_f64),
        ("unit=\"millimeter\"", 1.0),
        ("unit='micron'", 0.001),
        ("unit = \"centimeter\"", 10.0),
        ("unit=\"meter\"", 1000.0),
        ("unit=\"inch\"", 25.4),
        ("unit=\"foot\"", 304.8),
    ] {
        let mesh = read_model(&model(unit, OBJECT, "<item objectid=\"1\"/>")).unwrap();
        let expected = mm.powi(3) / 6.0;
        assert!((volume(&mesh) / expected - 1.0).abs() < 1e-12, "{unit}");
    }
}

#[test]
fn items_and_components_are_put_to_their_places() {
    let assembly = format!(
        "{OBJECT}<object id=\"2\"><components>\
         <component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 10 0 0\"/>\
         <component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 5 0\"/>\
         </components></object>"
    );
    let items = "<item objectid=\"2\" transform=\"0 2 0 -2 0 0 0 0 2 0 0 100\"/>";
    let mesh = read_model(&model("", &assembly, items)).unwrap();
    assert_eq!(mesh.triangles().len(), 8);
    // The mirrored copy must not be inside out, or the volumes would cancel.
    assert!((volume(&mesh) - 2.0 * 8.0 / 6.0).abs() < 1e-12);
    // (10, 0, 0) + (1, 0, 0), turned by 90 degrees about z, doubled, lifted by 100.
    assert!(mesh.vertices_mm().contains(&[0.0, 22.0, 100.0]));
    assert_eq!(
        mesh.bounds_mm(),
        Some([[-12.0, -2.0, 100.0], [0.0, 22.0, 102.0]])
    );
}

#[test]
fn parts_elsewhere_and_odd_names_are_found() {
    let relationships = r#"<Relationships><Relationship Target="/Metadata/thumbnail.png" Id="a"
        Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>
        <Relationship Target="/Other/Main.Model" Id="b"
        Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#;
    let main = model(
        "xmlns:p=\"production\"",
        "<object id=\"7\"><components><component p:path=\"/3D/Objects/part.model\" objectid=\"1\"/>\
         </components></object><p:object id=\"7\"/><!-- <object id=\"7\"/> -->",
        "<item objectid=\"7\"/>",
    );
    let parts = [
        ("_rels/.rels", relationships),
        ("other/main.model", &main),
        ("3D/Objects/part.model", &model("", OBJECT, "")),
    ];
    assert!((volume(&read_parts(&parts).unwrap()) - 1.0 / 6.0).abs() < 1e-12);
    let prefixed = "<m:model xmlns:m='core'><m:resources><m:object id='1'><m:mesh><m:vertices>\
        <m:vertex x='0' y='0' z='0'/><m:vertex x='1' y='0' z='0'/><m:vertex x='0' y='1' z='0'/>\
        </m:vertices><m:triangles><m:triangle v1='0' v2='1' v3='2'/></m:triangles></m:mesh>\
        </m:object></m:resources></m:model>";
    assert_eq!(read_model(prefixed).unwrap().triangles(), [[0, 1, 2]]);
}

#[test]
fn a_broken_3mf_is_refused_with_what_is_wrong() {
    let good = model("", OBJECT, "<item objectid=\"1\"/>");
    assert!(read_model(&good).is_ok());
    let circle = "<object id=\"1\"><components><component objectid=\"1\"/></components></object>";
    for (from, to, reason) in [
        ("v1=\"0\"", "v1=\"9\"", "names vertex 9"),
        ("v1=\"0\"", "v1=\"-1\"", "triangle 0 lacks"),
        ("v1=\"0\"", "", "triangle 0 lacks"),
        ("x=\"1\"", "x=\"one\"", "vertex 1 lacks"),
        ("x=\"1\"", "x=\"inf\"", "vertex 1 lacks"),
        ("x=\"1\"", "w=\"1\"", "vertex 1 lacks"),
        ("<model ", "<model unit=\"mile\" ", "unit \"mile\""),
        ("<model ", "<models ", "begins with <models>"),
        (
            "<?xml",
            "<!DOCTYPE x [<!ENTITY a \"b\">]><?xml",
            "document type",
        ),
        ("</model>", "", "ends before </model>"),
        ("</model>", "<tag", "ends inside a tag"),
        ("object id=\"1\"", "object", "lacks its id"),
        ("objectid=\"1\"", "objectid=\"2\"", "no object 2"),
        (
            "objectid=\"1\"",
            "objectid=\"1\" transform=\"1 2 3\"",
            "12 numbers",
        ),
        (
            "objectid=\"1\"",
            "objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 nan 0 0\"",
            "NaN",
        ),
        (
            "objectid=\"1\"",
            "objectid=\"1\" path=\"/no.model\"",
            "no part /no.model",
        ),
        (OBJECT, &format!("{OBJECT}{OBJECT}"), "two objects 1"),
        (OBJECT, circle, "without end"),
        (
            OBJECT,
            "<vertex x=\"0\" y=\"0\" z=\"0\"/>",
            "outside of an object",
        ),
    ] {
        let error = read_model(&good.replace(from, to)).unwrap_err();
        let text = error.to_string();
        assert!(matches!(error, MeshError::Malformed { .. }), "{text}");
        assert!(text.contains(reason) && !text.contains('\n'), "{text}");
    }
    let empty = read_model(&model("", "", ""));
    assert!(matches!(empty, Err(MeshError::NoTriangles { .. })));
    let lost = read_parts(&[("readme.txt", "hello")]).unwrap_err();
    assert!(
        lost.to_string().contains("no part 3D/3dmodel.model"),
        "{lost}"
    );
}

#[test]
fn a_file_that_is_no_zip_archive_is_refused() {
    for bytes in [&b""[..], b"solid", b"PK\x05\x06", &[0; 1000]] {
        assert!(refusal("a.3mf", bytes).contains("zip archive"));
    }
}

#[test]
fn a_damaged_archive_never_gives_a_mesh_in_silence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.3mf");
    write_mesh(&path, &torus(12, 9), &Task::default()).unwrap();
    let whole = fs::read(&path).unwrap();
    let good = read_mesh(&path, &Task::default()).unwrap();
    for cut in (0..whole.len()).step_by(37) {
        assert!(read_bytes("a.3mf", &whole[..cut]).is_err(), "cut at {cut}");
    }
    for at in (0..whole.len()).step_by(5) {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x55;
        if let Ok(mesh) = read_bytes("a.3mf", &bytes) {
            assert_eq!(mesh, good, "byte {at} changed");
        }
    }
}

#[test]
fn what_would_fill_the_memory_is_refused() {
    // Text of one letter shrinks a thousandfold.
    let long = format!("<model>{}</model>", " ".repeat(1 << 24));
    assert!(
        read_model(&long)
            .unwrap_err()
            .to_string()
            .contains("200 times")
    );
    // Thirty objects, each twice in the next: a billion copies.
    let doubles = (2..32).map(|id| {
        let component = format!("<component objectid=\"{}\"/>", id - 1);
        format!("<object id=\"{id}\"><components>{component}{component}</components></object>")
    });
    let doubling: String = std::iter::once(OBJECT.to_owned()).chain(doubles).collect();
    let error = read_model(&model("", &doubling, "<item objectid=\"31\"/>")).unwrap_err();
    assert!(matches!(error, MeshError::Malformed { .. }), "{error}");
}

#[test]
fn equal_meshes_give_equal_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.obj", "a.3mf"] {
        let path = folder.path().join(name);
        let bytes: Vec<Vec<u8>> = [1, 3]
            .into_iter()
            .map(|threads| {
                let workers = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
                workers
                    .install(|| write_mesh(&path, &torus(300, 90), &Task::default()))
                    .unwrap();
                fs::read(&path).unwrap()
            })
            .collect();
        assert!(bytes[0] == bytes[1], "{name}");
    }
}

#[test]
fn a_triangle_with_two_equal_vertices_is_left_out_of_a_3mf() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.3mf");
    let whole = box_mesh([0.0; 3], [1.0; 3]);
    let triangles = [&[[3, 3, 4]], whole.triangles()].concat();
    let collapsed = mesh(whole.vertices_mm().to_vec(), triangles);
    write_mesh(&path, &collapsed, &Task::default()).unwrap();
    assert_eq!(read_mesh(&path, &Task::default()).unwrap(), whole);
}
