//! The vertices of a PLY file (Stanford polygon format).

use std::io::{self, Write};

use super::scalar::Scalar;

/// What one property of an element holds.
enum Property {
    Single(Scalar),
    List { count: Scalar, item: Scalar },
}

/// A header's element.
struct Element {
    name: String,
    count: usize,
    properties: Vec<(String, Property)>,
}

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The points, or what is wrong with the file.
pub(super) fn parse(bytes: &[u8]) -> Result<Vec<[f64; 3]>, String> {
    let (header, body) = split_header(bytes)?;
    let (encoding, elements) = parse_header(header)?;
    let mut reader = Reader {
        rest: body,
        encoding,
    };
    for element in &elements {
        if element.name == "vertex" {
            let columns = coordinate_columns(element)?;
            return reader.points(element, columns).ok_or_else(|| {
                format!(
                    "it ends before its {} vertices do or has a vertex that is no number; it was cut off or damaged, save it again",
                    element.count
                )
            });
        }
        reader
            .skip(element)
            .ok_or_else(|| format!("its element `{}` is damaged; save it again", element.name))?;
    }
    Err("it has no vertices; save it with an element `vertex`".to_owned())
}

/// Binary little-endian vertices in double precision.
pub(super) fn write(points: &[[f64; 3]], out: &mut dyn Write) -> io::Result<()> {
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment point cloud in mm\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\nend_header\n",
        points.len()
    )?;
    for point in points {
        out.write_all(point.map(f64::to_le_bytes).as_flattened())?;
    }
    Ok(())
}

/// The header's text and the bytes after it.
fn split_header(bytes: &[u8]) -> Result<(&str, &[u8]), String> {
    if !bytes.starts_with(b"ply") {
        return Err("it is no PLY file; the first line must be `ply`".to_owned());
    }
    let end = b"end_header";
    let at = bytes
        .windows(end.len())
        .position(|window| window == end)
        .ok_or("its header has no end; save it again")?;
    let after = at + end.len();
    let newline = bytes[after..]
        .iter()
        .position(|byte| *byte == b'\n')
        .map_or(bytes.len(), |n| after + n + 1);
    let header = std::str::from_utf8(&bytes[..at])
        .map_err(|_| "its header is no text; save it again".to_owned())?;
    Ok((header, &bytes[newline..]))
}

fn parse_header(header: &str) -> Result<(Encoding, Vec<Element>), String> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    for line in header.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let understood = match words[..] {
            ["format", name, _] => {
                encoding = match name {
                    "ascii" => Some(Encoding::Ascii),
                    "binary_little_endian" => Some(Encoding::Little),
                    "binary_big_endian" => Some(Encoding::Big),
                    _ => None,
                };
                encoding.is_some()
            }
            ["element", name, count] => count.parse().is_ok_and(|count| {
                elements.push(Element {
                    name: name.to_owned(),
                    count,
                    properties: Vec::new(),
                });
                true
            }),
            ["property", ..] => parse_property(&words[1..])
                .zip(elements.last_mut())
                .map(|(property, element)| element.properties.push(property))
                .is_some(),
            _ => true,
        };
        if !understood {
            return Err(format!("its header line `{line}` is not understood"));
        }
    }
    let encoding = encoding.ok_or("its header names no format; save it again")?;
    Ok((encoding, elements))
}

fn parse_property(words: &[&str]) -> Option<(String, Property)> {
    match *words {
        ["list", count, item, name] => {
            let (count, item) = (scalar(count)?, scalar(item)?);
            Some((name.to_owned(), Property::List { count, item }))
        }
        [kind, name] => Some((name.to_owned(), Property::Single(scalar(kind)?))),
        _ => None,
    }
}

fn scalar(name: &str) -> Option<Scalar> {
    Some(match name {
        "char" | "int8" => Scalar::I8,
        "uchar" | "uint8" => Scalar::U8,
        "short" | "int16" => Scalar::I16,
        "ushort" | "uint16" => Scalar::U16,
        "int" | "int32" => Scalar::I32,
        "uint" | "uint32" => Scalar::U32,
        "float" | "float32" => Scalar::F32,
        "double" | "float64" => Scalar::F64,
        _ => return None,
    })
}

/// Which of a vertex's properties are x, y and z.
fn coordinate_columns(vertex: &Element) -> Result<[usize; 3], String> {
    let mut columns = [0; 3];
    for (column, wanted) in columns.iter_mut().zip(["x", "y", "z"]) {
        *column = vertex
            .properties
            .iter()
            .position(|(name, kind)| name == wanted && matches!(kind, Property::Single(_)))
            .ok_or_else(|| format!("its vertices have no {wanted}; save x, y and z"))?;
    }
    Ok(columns)
}

/// Walks through the bytes after the header; `None` means that they do not fit it.
struct Reader<'a> {
    rest: &'a [u8],
    encoding: Encoding,
}

impl Reader<'_> {
    fn points(&mut self, vertex: &Element, columns: [usize; 3]) -> Option<Vec<[f64; 3]>> {
        let mut points = Vec::new();
        let mut values = vec![0.0; vertex.properties.len()];
        for _ in 0..vertex.count {
            for (value, (_, property)) in values.iter_mut().zip(&vertex.properties) {
                *value = self.property(property)?;
            }
            points.push(columns.map(|column| values[column]));
        }
        Some(points)
    }

    fn skip(&mut self, element: &Element) -> Option<()> {
        if element.properties.is_empty() {
            // Such an element takes no bytes, whatever its count says.
            return Some(());
        }
        for _ in 0..element.count {
            for (_, property) in &element.properties {
                self.property(property)?;
            }
        }
        Some(())
    }

    /// The property's value; a list's items are passed over.
    fn property(&mut self, property: &Property) -> Option<f64> {
        match *property {
            Property::Single(kind) => self.number(kind),
            Property::List { count, item } => {
                let count = self.number(count)?;
                for _ in 0..count as u64 {
                    self.number(item)?;
                }
                Some(count)
            }
        }
    }

    fn number(&mut self, kind: Scalar) -> Option<f64> {
        if self.encoding == Encoding::Ascii {
            let blanks = self
                .rest
                .iter()
                .take_while(|b| b.is_ascii_whitespace())
                .count();
            let rest = &self.rest[blanks..];
            let length = rest.iter().take_while(|b| !b.is_ascii_whitespace()).count();
            let (word, rest) = rest.split_at(length);
            self.rest = rest;
            return std::str::from_utf8(word).ok()?.parse().ok();
        }
        let value = kind.read(self.rest, self.encoding == Encoding::Big)?;
        self.rest = &self.rest[kind.size()..];
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: [[f64; 3]; 2] = [[1.0, 2.0, 3.0], [-4.0, 5.5, 6.0]];

    #[test]
    fn text_files_with_other_elements_and_properties_are_read() {
        let text = b"ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement face 2\r\n\
            property list uchar int vertex_indices\r\nelement vertex 2\r\nproperty uchar red\r\n\
            property float x\r\nproperty float y\r\nproperty float z\r\nend_header\r\n\
            3 0 1 1\r\n4 0 1 1 0\r\n255 1 2 3\r\n0 -4 5.5 6\r\n";
        assert_eq!(parse(text).unwrap(), TWO);
    }

    #[test]
    fn both_binary_orders_are_read() {
        for (name, is_big) in [("binary_big_endian", true), ("binary_little_endian", false)] {
            let mut bytes = format!(
                "ply\nformat {name} 1.0\nelement vertex 2\nproperty float z\nproperty short y\n\
                 property double x\nend_header\n"
            )
            .into_bytes();
            for [x, y, z] in [[1.0, 2.0, 3.0], [-4.0, 5.0, 6.5]] {
                let (z, y) = (z as f32, y as i16);
                if is_big {
                    bytes.extend(z.to_be_bytes());
                    bytes.extend(y.to_be_bytes());
                    bytes.extend(f64::to_be_bytes(x));
                } else {
                    bytes.extend(z.to_le_bytes());
                    bytes.extend(y.to_le_bytes());
                    bytes.extend(f64::to_le_bytes(x));
                }
            }
            assert_eq!(parse(&bytes).unwrap(), [[1.0, 2.0, 3.0], [-4.0, 5.0, 6.5]]);
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        let header = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n\
                      property float y\nproperty float z\nend_header\n";
        for (text, word) in [
            ("solid".to_owned(), "no PLY"),
            ("ply\nformat ascii 1.0\n".to_owned(), "no end"),
            ("ply\nend_header\n".to_owned(), "no format"),
            (
                "ply\nformat ascii 1.0\nend_header\n".to_owned(),
                "no vertices",
            ),
            (header.replace("float z", "float w"), "no z"),
            (header.replace("float z", "real z"), "real z"),
            (header.replace("vertex 2", "vertex many"), "vertex many"),
            (format!("{header}1 2 3\n4 5\n"), "cut off"),
            (format!("{header}1 2 3\n4 five 6\n"), "no number"),
            (
                header.replace("vertex 2", "vertex 18446744073709551615"),
                "cut off",
            ),
        ] {
            let reason = parse(text.as_bytes()).unwrap_err();
            assert!(reason.contains(word), "{reason}");
        }
    }
}
