//! Binary little-endian PLY.

use std::fs::File;
use std::io::Write;

use bonemesh_task::Task;

use super::atomic::Fault;
use super::{BLOCK, FRAME};
use crate::TriangleMesh;

/// Writes the header, all vertices and all triangles.
pub(super) fn write(file: &mut File, mesh: &TriangleMesh, task: &Task) -> Result<(), Fault> {
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment {FRAME}\ncomment made by Bonemesh\n\
         element vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.vertices_mm().len(),
        mesh.triangles().len(),
    );
    file.write_all(header.as_bytes())?;
    let mut bytes = Vec::new();
    for block in mesh.vertices_mm().chunks(BLOCK) {
        bytes.clear();
        for value in block.as_flattened() {
            bytes.extend_from_slice(&(*value as f32).to_le_bytes());
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
