//! Wavefront OBJ: vertices and faces; groups, materials, normals, curves are passed over.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use bonemesh_task::Task;

use super::malformed;
use crate::{MeshError, TriangleMesh};

/// A longer line belongs to no OBJ; without a limit one line could fill the memory.
const LONGEST_LINE: u64 = 1 << 20;

/// Reads vertices and faces and merges equal vertices.
///
/// A face with more than three corners becomes a fan from its first corner, which is right for
/// convex faces; one with fewer is passed over.
pub(super) fn read(path: &Path, task: &Task) -> Result<TriangleMesh, MeshError> {
    let unreadable = |e| MeshError::reading(path, &e);
    let file = File::open(path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    if metadata.is_dir() {
        return Err(MeshError::IsFolder {
            path: path.to_path_buf(),
        });
    }
    task.begin("read mesh", metadata.len() as usize);
    let mut file = BufReader::new(file);
    let mut body = Body::default();
    let mut line = Vec::new();
    for number in 1_usize.. {
        line.clear();
        let fault = |what: String| malformed(path, "OBJ", format!("line {number} {what}"));
        let length = read_line(&mut file, &mut line).map_err(unreadable)?;
        if length == 0 {
            break;
        }
        if length as u64 >= LONGEST_LINE {
            return Err(fault("is too long for text".into()));
        }
        let text = std::str::from_utf8(&line).unwrap_or("");
        if line.contains(&0) {
            return Err(fault("is no text".into()));
        }
        body.add(text).map_err(fault)?;
        task.advance(length)?;
    }
    let mesh = TriangleMesh::new(body.vertices_mm, body.triangles)
        .map_err(|e| malformed(path, "OBJ", in_its_numbers(&e)))?;
    Ok(mesh.merged(task)?)
}

/// An error in the numbers of the file, which begin with 1.
fn in_its_numbers(error: &MeshError) -> String {
    match error {
        MeshError::Index {
            vertex, vertices, ..
        } => format!(
            "a face names vertex {}, but there are {vertices}",
            u64::from(*vertex) + 1
        ),
        _ => error.to_string(),
    }
}

/// Reads a line, and the next too where a backslash joins them; gives the number of bytes.
fn read_line(file: &mut impl BufRead, line: &mut Vec<u8>) -> std::io::Result<usize> {
    let mut total = 0;
    loop {
        let room = LONGEST_LINE.saturating_sub(total as u64);
        let length = file.by_ref().take(room).read_until(b'\n', line)?;
        total += length;
        let ending = line.trim_ascii_end().len();
        if length == 0 || line[..ending].last() != Some(&b'\\') {
            return Ok(total);
        }
        line.truncate(ending - 1);
        line.push(b' ');
    }
}

/// The vertices and triangles read so far.
#[derive(Default)]
struct Body {
    vertices_mm: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Body {
    /// Takes a line, or says what is wrong with it.
    fn add(&mut self, line: &str) -> Result<(), String> {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let mut coordinate = || {
                    let word = words.next().ok_or("lacks a coordinate")?;
                    coordinate(word).ok_or_else(|| format!("has \"{word}\" for a coordinate"))
                };
                let vertex = [coordinate()?, coordinate()?, coordinate()?];
                self.vertices_mm.push(vertex);
            }
            Some("f") => {
                let corners = words
                    .map(|word| self.corner(word))
                    .collect::<Result<Vec<u32>, String>>()?;
                let fan = corners.windows(2).skip(1);
                self.triangles
                    .extend(fan.map(|pair| [corners[0], pair[0], pair[1]]));
            }
            _ => {}
        }
        Ok(())
    }

    /// The vertex of a face's corner: `7`, `7/1`, `7//3` or `7/1/3`; -1 is the last one so far.
    fn corner(&self, word: &str) -> Result<u32, String> {
        let number = word.split('/').next().unwrap_or("");
        let wrong = || format!("has \"{word}\" for a vertex number");
        let vertex = match number.parse::<i64>().map_err(|_| wrong())? {
            0 => None,
            from_first @ 1.. => Some(from_first - 1),
            from_last => (self.vertices_mm.len() as i64).checked_add(from_last),
        };
        vertex.and_then(|v| u32::try_from(v).ok()).ok_or_else(wrong)
    }
}

/// A coordinate in single precision, as the programs that write these files mean it.
pub(super) fn coordinate(word: &str) -> Option<f64> {
    let value: f32 = word.parse().ok()?;
    value.is_finite().then_some(f64::from(value))
}
