//! The text at the top of a PLY file, which describes everything below it.

use std::io::{BufRead, Read};
use std::path::Path;

use super::malformed;
use crate::MeshError;

/// Longest header line; more is no PLY.
const LONGEST_LINE: u64 = 1 << 16;
/// Most header lines; more is no PLY.
const MOST_LINES: usize = 1 << 12;

/// How the values below the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    /// Either of the two spellings in use.
    fn of(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of the binary form.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// One property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    /// The type of the number of entries, for a list.
    pub(super) length: Option<Scalar>,
    pub(super) value: Scalar,
}

/// One kind of row: its name, how many there are, what each holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// The place of the first property that is called one of `names`.
    pub(super) fn place_of(&self, names: &[&str]) -> Option<usize> {
        self.properties
            .iter()
            .position(|p| names.contains(&p.name.as_str()))
    }
}

/// A whole header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

/// Reads up to and including the line `end_header`.
pub(super) fn read(file: &mut impl BufRead, path: &Path) -> Result<Header, MeshError> {
    let fault = |reason: String| malformed(path, "PLY", reason);
    if line(file, path)?.as_deref() != Some("ply") {
        return Err(fault("its first line is not ply".into()));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    for _ in 0..MOST_LINES {
        let Some(text) = line(file, path)? else {
            return Err(fault("it ends inside the header".into()));
        };
        let words: Vec<&str> = text.split_whitespace().collect();
        match words[..] {
            [] | ["comment" | "obj_info", ..] => {}
            ["format", "ascii", _] => encoding = Some(Encoding::Ascii),
            ["format", "binary_little_endian", _] => encoding = Some(Encoding::LittleEndian),
            ["format", other, ..] => {
                return Err(fault(format!(
                    "its encoding {other} is not read, only ascii and binary_little_endian are"
                )));
            }
            ["element", name, count] => elements.push(Element {
                name: name.into(),
                count: count
                    .parse()
                    .map_err(|_| fault(format!("{count} is no number of {name} rows")))?,
                properties: Vec::new(),
            }),
            ["property", ..] => {
                let property = property(&words);
                let element = elements.last_mut();
                let (Some(property), Some(element)) = (property, element) else {
                    return Err(fault(format!(
                        "the header line \"{text}\" is not understood"
                    )));
                };
                element.properties.push(property);
            }
            ["end_header"] => {
                return Ok(Header {
                    encoding: encoding
                        .ok_or_else(|| fault("its header names no encoding".into()))?,
                    elements,
                });
            }
            _ => {
                return Err(fault(format!(
                    "the header line \"{text}\" is not understood"
                )));
            }
        }
    }
    Err(fault("its header does not end".into()))
}

/// A property line's meaning.
fn property(words: &[&str]) -> Option<Property> {
    let (length, value, name) = match *words {
        ["property", "list", length, value, name] => (Some(Scalar::of(length)?), value, name),
        ["property", value, name] => (None, value, name),
        _ => return None,
    };
    Some(Property {
        name: name.into(),
        length,
        value: Scalar::of(value)?,
    })
}

/// The next line without its end; `None` at the end of the file.
fn line(file: &mut impl BufRead, path: &Path) -> Result<Option<String>, MeshError> {
    let mut bytes = Vec::new();
    let length = file
        .take(LONGEST_LINE)
        .read_until(b'\n', &mut bytes)
        .map_err(|e| MeshError::reading(path, &e))?;
    let text = String::from_utf8_lossy(&bytes).trim().to_owned();
    Ok((length > 0).then_some(text))
}
