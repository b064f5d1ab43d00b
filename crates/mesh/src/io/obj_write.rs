//! Wavefront OBJ: vertices and triangles, nothing else.

use std::fs::File;
use std::io::Write;

use bonemesh_task::Task;

use super::atomic::Fault;
use super::{PatientFrame, text_blocks};
use crate::TriangleMesh;

/// Writes a comment, all vertices and all triangles, whose vertex numbers begin at 1.
///
/// Coordinates are the shortest decimals that give back their 32-bit floats.
pub(super) fn write(
    file: &mut File,
    mesh: &TriangleMesh,
    frame: PatientFrame,
    task: &Task,
) -> Result<(), Fault> {
    task.begin("write", mesh.vertices_mm().len() + mesh.triangles().len());
    writeln!(file, "# {}; made by Bonemesh", frame.in_words())?;
    text_blocks::write(file, mesh.vertices_mm(), task, |vertex, text| {
        let [x, y, z] = vertex.map(|c| c as f32);
        writeln!(text, "v {x} {y} {z}")
    })?;
    text_blocks::write(file, mesh.triangles(), task, |triangle, text| {
        let [a, b, c] = triangle.map(|v| u64::from(v) + 1);
        writeln!(text, "f {a} {b} {c}")
    })
}
