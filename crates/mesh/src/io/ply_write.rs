//! Binary little-endian PLY.

use std::fs::File;
use std::io::Write;

use bonemesh_task::Task;

use super::atomic::Fault;
use super::{BLOCK, PatientFrame};
use crate::TriangleMesh;

/// A number for each vertex.
#[derive(Clone, Copy)]
pub(super) struct Values<'a> {
    /// The name of its property.
    pub(super) name: &'a str,
    pub(super) of_vertices: &'a [f64],
    /// A colour for each vertex, if it has one.
    pub(super) colours: Option<&'a [[u8; 3]]>,
}

/// The properties of colours, by the names that viewers know.
const COLOURS: &str = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

/// Writes the header, all vertices, with their values if there are any, and all triangles.
pub(super) fn write(
    file: &mut File,
    mesh: &TriangleMesh,
    frame: PatientFrame,
    values: Option<Values<'_>>,
    task: &Task,
) -> Result<(), Fault> {
    let colours = values.and_then(|values| values.colours);
    let property = values.map(|values| {
        let of_colours = colours.map_or("", |_| COLOURS);
        format!("property float {}\n{of_colours}", values.name)
    });
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment {}\ncomment made by Bonemesh\n\
         element vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        frame.in_words(),
        mesh.vertices_mm().len(),
        property.unwrap_or_default(),
        mesh.triangles().len(),
    );
    file.write_all(header.as_bytes())?;
    let mut bytes = Vec::new();
    for (number, block) in mesh.vertices_mm().chunks(BLOCK).enumerate() {
        bytes.clear();
        for (vertex, place_mm) in (number * BLOCK..).zip(block) {
            let value = values.map(|values| values.of_vertices[vertex]);
            for value in place_mm.iter().copied().chain(value) {
                bytes.extend_from_slice(&(value as f32).to_le_bytes());
            }
            bytes.extend(colours.iter().flat_map(|colours| colours[vertex]));
        }
        file.write_all(&bytes)?;
        task.check()?;
    }
    for block in mesh.triangles().chunks(BLOCK) {
        bytes.clear();
        for triangle in block {
            bytes.push(3);
            for vertex in triangle {
                bytes.extend_from_slice(&vertex.to_le_bytes());
            }
        }
        file.write_all(&bytes)?;
        task.advance(block.len())?;
    }
    Ok(())
}
