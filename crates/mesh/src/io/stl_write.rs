//! Binary STL.
//!
//! Reading goes through `stl_io`. Writing does not: its writer wants an iterator of its own triangle
//! type and writes field by field, which takes about four times as long as encoding blocks on all
//! cores, and it can neither be cancelled nor report progress.

use std::fs::File;
use std::io::Write;

use bonemesh_task::Task;
use rayon::prelude::*;

use super::atomic::Fault;
use super::{BLOCK, PatientFrame};
use crate::TriangleMesh;

/// Bytes of a triangle: normal, three corners, attribute.
const RECORD: usize = 50;

/// Says what made the file, in the 80 bytes that there are. Must not begin with `solid`, by which readers
/// know ASCII.
fn header(frame: PatientFrame) -> &'static [u8] {
    match frame {
        PatientFrame::Lps => b"binary STL, millimetres, patient space LPS, made by Bonemesh",
        PatientFrame::Ras => b"binary STL, millimetres, patient space RAS, made by Bonemesh",
    }
}

/// Writes the header, the count and all triangles; a block is encoded while the one before it is
/// written.
pub(super) fn write(
    file: &mut File,
    mesh: &TriangleMesh,
    frame: PatientFrame,
    task: &Task,
) -> Result<(), Fault> {
    let mut head = vec![0; 84];
    let header = header(frame);
    head[..header.len()].copy_from_slice(header);
    head[80..].copy_from_slice(&(mesh.triangles().len() as u32).to_le_bytes());
    let (mut ready, mut next) = (head, Vec::new());
    for block in mesh.triangles().chunks(BLOCK) {
        let (written, ()) = rayon::join(
            || file.write_all(&ready),
            || encode_block(block, mesh, &mut next),
        );
        written?;
        std::mem::swap(&mut ready, &mut next);
        task.advance(block.len())?;
    }
    file.write_all(&ready)?;
    Ok(())
}

/// Fills `bytes` with the records of a block.
fn encode_block(block: &[[u32; 3]], mesh: &TriangleMesh, bytes: &mut Vec<u8>) {
    bytes.resize(RECORD * block.len(), 0);
    let (records, _) = bytes.as_chunks_mut::<RECORD>();
    records
        .par_iter_mut()
        .zip(block)
        .with_min_len(1 << 12)
        .for_each(|(record, &triangle)| encode(record, mesh.corners_mm(triangle)));
}

/// Fills one record; the attribute stays 0.
fn encode(record: &mut [u8; RECORD], corners_mm: [[f64; 3]; 3]) {
    // The normal of the corners as they are written, which readers compare it with.
    let corners = corners_mm.map(|corner| corner.map(|value| f64::from(value as f32)));
    let [a, b, c] = corners;
    let vectors = [unit_normal(corners), a, b, c];
    let (fields, _attribute) = record.as_chunks_mut::<4>();
    for (field, value) in fields.iter_mut().zip(vectors.as_flattened()) {
        *field = (*value as f32).to_le_bytes();
    }
}

/// The outward unit normal; zeros for a triangle without area.
fn unit_normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let n = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    if length > 0.0 && length.is_finite() {
        n.map(|component| component / length)
    } else {
        [0.0; 3]
    }
}
