//! PLY meshes: vertices and faces; everything else in the file is passed over.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use bonemesh_task::Task;

use super::malformed;
use super::ply_header::{self, Element, Encoding, Property, Scalar};
use crate::{MeshError, TriangleMesh};

/// Rows read between two looks at the cancel switch.
const STRIDE: u64 = 1 << 12;
/// A longer number is no number.
const LONGEST_TOKEN: usize = 512;

/// Reads vertices and faces and merges equal vertices.
///
/// A face with more than three corners becomes a fan from its first corner, which is right for
/// convex faces; one with fewer is passed over.
pub(super) fn read(path: &Path, task: &Task) -> Result<TriangleMesh, MeshError> {
    let file = File::open(path).map_err(|e| MeshError::reading(path, &e))?;
    if file.metadata().is_ok_and(|m| m.is_dir()) {
        return Err(MeshError::IsFolder {
            path: path.to_path_buf(),
        });
    }
    let mut file = BufReader::new(file);
    let header = ply_header::read(&mut file, path)?;
    let mut body = Body {
        values: Values {
            file,
            encoding: header.encoding,
        },
        path,
        task,
        vertices_mm: Vec::new(),
        triangles: Vec::new(),
    };
    let rows: u64 = header
        .elements
        .iter()
        .fold(0, |sum, element| sum.saturating_add(element.count));
    task.begin("read mesh", rows as usize);
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => body.read_vertices(element)?,
            "face" => body.read_faces(element)?,
            _ => body.read_rows(element, |_, _| Ok(()))?,
        }
    }
    let mesh = TriangleMesh::new(body.vertices_mm, body.triangles)
        .map_err(|e| malformed(path, "PLY", e.to_string()))?;
    Ok(mesh.merged(task)?)
}

/// The part below the header.
struct Body<'a> {
    values: Values<BufReader<File>>,
    path: &'a Path,
    task: &'a Task,
    vertices_mm: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

/// The values of a row: one for a plain property, all entries for a list.
type Row = [Vec<f64>];

impl Body<'_> {
    fn read_vertices(&mut self, element: &Element) -> Result<(), MeshError> {
        let places = ["x", "y", "z"].map(|axis| element.place_of(&[axis]));
        let [Some(x), Some(y), Some(z)] = places else {
            return Err(malformed(self.path, "PLY", "its vertices lack x, y or z"));
        };
        self.read_rows(element, |body, row| {
            let vertex = [x, y, z].map(|place| row[place].first().copied());
            let [Some(x), Some(y), Some(z)] = vertex else {
                return Err("a coordinate is missing".into());
            };
            body.vertices_mm.push([x, y, z]);
            Ok(())
        })
    }

    fn read_faces(&mut self, element: &Element) -> Result<(), MeshError> {
        let Some(place) = element.place_of(&["vertex_indices", "vertex_index"]) else {
            return Err(malformed(self.path, "PLY", "its faces lack vertex_indices"));
        };
        self.read_rows(element, |body, row| {
            let corners = row[place]
                .iter()
                .map(|&corner| index(corner))
                .collect::<Result<Vec<u32>, String>>()?;
            let fan = corners.windows(2).skip(1);
            body.triangles
                .extend(fan.map(|pair| [corners[0], pair[0], pair[1]]));
            Ok(())
        })
    }

    /// Reads every row of an element and hands its values on.
    fn read_rows(
        &mut self,
        element: &Element,
        take: impl Fn(&mut Self, &Row) -> Result<(), String>,
    ) -> Result<(), MeshError> {
        // Rows of nothing would be counted, not read, however many the header claims.
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut row = vec![Vec::new(); element.properties.len()];
        for number in 0..element.count {
            for (values, property) in row.iter_mut().zip(&element.properties) {
                self.values
                    .read_property(property, values)
                    .map_err(|e| self.broken(element, number, &e))?;
            }
            take(self, &row).map_err(|reason| {
                let reason = format!("{} {number}: {reason}", element.name);
                malformed(self.path, "PLY", reason)
            })?;
            if number % STRIDE == STRIDE - 1 {
                self.task.advance(STRIDE as usize)?;
            }
        }
        Ok(())
    }

    /// The error for a row that could not be read.
    fn broken(&self, element: &Element, number: u64, error: &io::Error) -> MeshError {
        let Element { name, count, .. } = element;
        match error.kind() {
            io::ErrorKind::UnexpectedEof => malformed(
                self.path,
                "PLY",
                format!("it ends at {name} {number} where its header says {count}"),
            ),
            io::ErrorKind::InvalidData => {
                malformed(self.path, "PLY", format!("{name} {number}: {error}"))
            }
            _ => MeshError::reading(self.path, error),
        }
    }
}

/// A vertex number, if `value` is one.
fn index(value: f64) -> Result<u32, String> {
    if value.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(&value) {
        Ok(value as u32)
    } else {
        Err(format!("{value} is no vertex number"))
    }
}

/// Numbers one after the other; f64 holds every PLY type exactly.
struct Values<R> {
    file: R,
    encoding: Encoding,
}

impl<R: BufRead> Values<R> {
    /// Replaces `values` by those of the property.
    fn read_property(&mut self, property: &Property, values: &mut Vec<f64>) -> io::Result<()> {
        values.clear();
        let count = match property.length {
            None => 1,
            Some(length) => {
                let count = self.read_scalar(length)?;
                index(count)
                    .map_err(|_| invalid(format!("{count} is no number of list entries")))?
            }
        };
        for _ in 0..count {
            values.push(self.read_scalar(property.value)?);
        }
        Ok(())
    }

    fn read_scalar(&mut self, scalar: Scalar) -> io::Result<f64> {
        match self.encoding {
            Encoding::Ascii => self.read_token(),
            Encoding::LittleEndian => self.read_binary(scalar),
        }
    }

    fn read_binary(&mut self, scalar: Scalar) -> io::Result<f64> {
        let mut bytes = [0; 8];
        self.file.read_exact(&mut bytes[..scalar.size()])?;
        let [a, b, c, d, ..] = bytes;
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes([a])),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(bytes),
        })
    }

    /// The next number of a text; line ends are white space like any other.
    fn read_token(&mut self) -> io::Result<f64> {
        let mut token = Vec::new();
        while let Some(&byte) = self.file.fill_buf()?.first() {
            let is_space = byte.is_ascii_whitespace();
            if is_space && !token.is_empty() || token.len() > LONGEST_TOKEN {
                break;
            }
            if !is_space {
                token.push(byte);
            }
            self.file.consume(1);
        }
        if token.is_empty() {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let text = String::from_utf8_lossy(&token);
        text.parse()
            .map_err(|_| invalid(format!("\"{text}\" is no number")))
    }
}

fn invalid(reason: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, reason)
}
