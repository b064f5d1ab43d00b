//! NRRD headers.

mod fields;
mod place;

use std::path::{Component, Path, PathBuf};

use crate::data::{Data, Encoding, regular_file_size};
use crate::error::VolumeFileError;
use crate::header::{Header, geometry, printable};
use crate::sample::{Conversion, Element};
use fields::Fields;

/// What helps with a file that is stored in an unusual way.
const EXPORT: &str = "save it as one .nrrd file with raw or gzip encoding";

/// Reads and checks the header of an NRRD file.
pub(crate) fn header(path: &Path) -> Result<Header, VolumeFileError> {
    let fields = Fields::read(path)?;
    if let Some(size) = fields.get("block size") {
        let what = format!("voxels that are blocks of {size} bytes");
        return Err(VolumeFileError::unsupported(path, what, EXPORT));
    }
    let element = element(path, &fields)?;
    let axes = place::axes(path, &fields)?;
    let mut warnings = Vec::new();
    let affine = place::patient_from_voxel(path, &fields, axes, &mut warnings)?;
    let sides = axes.map(|axis| axis.map_or(1, |axis| axis.size));
    let geometry = geometry(path, sides, affine)?;
    let voxels: u64 = geometry.shape().iter().map(|n| *n as u64).product();
    let encoding = encoding(path, &fields)?;
    let is_text = encoding == Encoding::Text;
    let is_big_endian = !is_text && is_big_endian(path, &fields, element)?;
    // Written numbers are read as such, whatever type they are meant for.
    let element = if is_text { Element::F64 } else { element };
    let data = data(path, &fields, encoding, voxels * element.size() as u64)?;
    Ok(Header {
        format: "NRRD",
        geometry,
        conversion: Conversion {
            element,
            is_big_endian,
            slope: 1.0,
            intercept: 0.0,
        },
        data,
        description: printable(fields.get("content").unwrap_or_default().as_bytes()),
        warnings,
    })
}

/// The type of a voxel by any of its names.
fn element(path: &Path, fields: &Fields) -> Result<Element, VolumeFileError> {
    Ok(
        match fields.required(path, "type")?.to_lowercase().as_str() {
            "signed char" | "int8" | "int8_t" => Element::I8,
            "uchar" | "unsigned char" | "uint8" | "uint8_t" => Element::U8,
            "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
                Element::I16
            }
            "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => {
                Element::U16
            }
            "int" | "signed int" | "int32" | "int32_t" => Element::I32,
            "uint" | "unsigned int" | "uint32" | "uint32_t" => Element::U32,
            "longlong"
            | "long long"
            | "long long int"
            | "signed long long"
            | "signed long long int"
            | "int64"
            | "int64_t" => Element::I64,
            "ulonglong"
            | "unsigned long long"
            | "unsigned long long int"
            | "uint64"
            | "uint64_t" => Element::U64,
            "float" => Element::F32,
            "double" => Element::F64,
            other => {
                let what = format!("voxels of type `{}`", other.escape_debug());
                return Err(VolumeFileError::unsupported(path, what, EXPORT));
            }
        },
    )
}

fn encoding(path: &Path, fields: &Fields) -> Result<Encoding, VolumeFileError> {
    match fields.required(path, "encoding")?.to_lowercase().as_str() {
        "raw" => Ok(Encoding::Raw),
        "gzip" | "gz" => Ok(Encoding::Gzip),
        "txt" | "text" | "ascii" => Ok(Encoding::Text),
        other => {
            let what = format!("data with the encoding `{}`", other.escape_debug());
            Err(VolumeFileError::unsupported(path, what, EXPORT))
        }
    }
}

fn is_big_endian(path: &Path, fields: &Fields, element: Element) -> Result<bool, VolumeFileError> {
    match fields.get("endian").map(str::to_lowercase).as_deref() {
        Some("little") => Ok(false),
        Some("big") => Ok(true),
        None if element.size() == 1 => Ok(false),
        None => Err(VolumeFileError::header(
            path,
            "the field `endian` is missing",
        )),
        Some(other) => {
            let reason = format!("`{}` is no byte order", other.escape_debug());
            Err(VolumeFileError::header(path, reason))
        }
    }
}

/// Where the voxels are.
fn data(
    path: &Path,
    fields: &Fields,
    encoding: Encoding,
    bytes: u64,
) -> Result<Data, VolumeFileError> {
    let (data_path, start) = match fields.get("data file") {
        Some(name) => (data_file(path, name)?, 0),
        None => (path.to_owned(), fields.length),
    };
    let lines: u64 = fields.number(path, "line skip")?.unwrap_or(0);
    let start = fields::after_lines(&data_path, start, lines)?;
    let skip: i64 = fields.number(path, "byte skip")?.unwrap_or(0);
    let mut data = Data {
        path: data_path,
        encoding,
        start,
        skip: 0,
        bytes,
    };
    match (u64::try_from(skip), encoding) {
        // Written numbers have no bytes of their own to skip: those of the file are.
        (Ok(skip), Encoding::Text) => data.start = data.start.saturating_add(skip),
        (Ok(skip), _) => data.skip = skip,
        (Err(_), Encoding::Raw) if skip == -1 => {
            // The voxels are the last bytes of the file.
            data.start = regular_file_size(&data.path)?
                .saturating_sub(bytes)
                .max(data.start);
        }
        (Err(_), _) => {
            let reason =
                format!("a byte skip of {skip}; -1 with raw data is the only negative one");
            return Err(VolumeFileError::header(path, reason));
        }
    }
    Ok(data)
}

/// The data file that a header names: one regular file in the header's folder or below.
fn data_file(path: &Path, name: &str) -> Result<PathBuf, VolumeFileError> {
    let is_list = name.split_whitespace().next().is_some_and(|w| w == "LIST");
    if is_list || name.contains('%') {
        let what = "data in several files";
        return Err(VolumeFileError::unsupported(path, what, EXPORT));
    }
    let refused = |reason: &str| VolumeFileError::DataFile {
        path: path.to_owned(),
        data: name.escape_debug().to_string(),
        reason: reason.to_owned(),
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let named = Path::new(name);
    // A header from a stranger has no business with the rest of the disk.
    let inside = named.strip_prefix(folder).unwrap_or(named);
    if !inside
        .components()
        .all(|c| matches!(c, Component::Normal(_) | Component::CurDir))
    {
        return Err(refused("which is outside the header's folder"));
    }
    let data = folder.join(inside);
    if data.is_file() {
        Ok(data)
    } else {
        Err(refused("which is not there"))
    }
}
