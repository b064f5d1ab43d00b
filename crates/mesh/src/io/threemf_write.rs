//! 3MF: a zip archive with a model in XML, one object with one mesh.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::mem::ManuallyDrop;

use bonemesh_task::Task;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::atomic::Fault;
use super::{PatientFrame, text_blocks};
use crate::TriangleMesh;

/// Where the model is in the archive, by custom and by our own relationship.
const MODEL: &str = "3D/3dmodel.model";

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;

const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="model" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// Rather fast than small: the texts are long and shrink well at any level.
const LEVEL: i64 = 3;

/// A model of this many triangles may pass the 4 GiB that zip's first form can say.
const MANY: usize = 20_000_000;

/// Writes the three parts of the archive; dates in it are zip's first day, so equal meshes give
/// equal bytes.
///
/// Triangles with two equal vertices, which the format forbids, are left out.
pub(super) fn write(
    file: &mut File,
    mesh: &TriangleMesh,
    frame: PatientFrame,
    task: &Task,
) -> Result<(), Fault> {
    task.begin("write", mesh.vertices_mm().len() + mesh.triangles().len());
    // An archive that is dropped before its end tries to finish, and says on the terminal what came of that:
    // after a fault its few buffers are rather lost.
    let mut archive = ManuallyDrop::new(ZipWriter::new(BufWriter::new(file)));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(LEVEL))
        .last_modified_time(zip::DateTime::default());
    for (name, text) in [
        ("[Content_Types].xml", CONTENT_TYPES),
        ("_rels/.rels", RELATIONSHIPS),
    ] {
        archive.start_file(name, options).map_err(io::Error::from)?;
        archive.write_all(text.as_bytes())?;
    }
    let options = options.large_file(mesh.triangles().len() > MANY);
    archive
        .start_file(MODEL, options)
        .map_err(io::Error::from)?;
    write_model(&mut *archive, mesh, frame, task)?;
    let archive = ManuallyDrop::into_inner(archive);
    archive.finish().map_err(io::Error::from)?.flush()?;
    Ok(())
}

fn write_model(
    file: &mut impl Write,
    mesh: &TriangleMesh,
    frame: PatientFrame,
    task: &Task,
) -> Result<(), Fault> {
    file.write_all(
        concat!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
            "<model unit=\"millimeter\" xml:lang=\"en-US\" ",
            "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n",
            "<metadata name=\"Application\">Bonemesh</metadata>\n",
        )
        .as_bytes(),
    )?;
    let words = frame.in_words();
    writeln!(file, "<metadata name=\"Description\">{words}</metadata>")?;
    file.write_all(b"<resources>\n<object id=\"1\" type=\"model\">\n<mesh>\n<vertices>\n")?;
    text_blocks::write(file, mesh.vertices_mm(), task, |vertex, text| {
        let [x, y, z] = vertex.map(|c| c as f32);
        writeln!(text, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")
    })?;
    file.write_all(b"</vertices>\n<triangles>\n")?;
    text_blocks::write(file, mesh.triangles(), task, |&[a, b, c], text| {
        if a == b || b == c || c == a {
            return Ok(());
        }
        writeln!(text, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>")
    })?;
    file.write_all(
        b"</triangles>\n</mesh>\n</object>\n</resources>\n<build><item objectid=\"1\"/></build>\n</model>\n",
    )?;
    Ok(())
}
