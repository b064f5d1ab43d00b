//! `NIfTI` headers of both versions.

mod fields;
mod place;

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use crate::data::{Data, Encoding};
use crate::error::VolumeFileError;
use crate::header::{Header, geometry, printable};
use crate::sample::{Conversion, Element};
use crate::sniff::{Format, Head, NIFTI_1, NIFTI_2, sniff};
use fields::Fields;

/// Bytes that say which extensions follow the header of a single file.
const EXTENDER: u64 = 4;

/// A `NIfTI-1` header.
pub(crate) fn version_1(
    path: &Path,
    head: &Head,
    has_pair: bool,
) -> Result<Header, VolumeFileError> {
    let bytes = head.bytes.first_chunk::<NIFTI_1>();
    let bytes = bytes.expect("a header sniffed without its bytes is a bug");
    let fields = Fields::version_1(bytes).map_err(|e| VolumeFileError::header(path, e))?;
    header(path, "NIfTI-1", head.is_gzip, has_pair, &fields)
}

/// A `NIfTI-2` header.
pub(crate) fn version_2(
    path: &Path,
    head: &Head,
    has_pair: bool,
) -> Result<Header, VolumeFileError> {
    let bytes = head.bytes.first_chunk::<NIFTI_2>();
    let bytes = bytes.expect("a header sniffed without its bytes is a bug");
    header(
        path,
        "NIfTI-2",
        head.is_gzip,
        has_pair,
        &Fields::version_2(bytes),
    )
}

fn header(
    path: &Path,
    format: &'static str,
    is_gzip: bool,
    has_pair: bool,
    fields: &Fields,
) -> Result<Header, VolumeFileError> {
    let sides = sides(path, fields)?;
    let element = element(path, fields.datatype)?;
    let mut warnings = Vec::new();
    let affine = place::patient_from_voxel(fields, &mut warnings);
    let geometry = geometry(path, sides, affine)?;
    let (slope, intercept) = rescale(fields, &mut warnings);
    let voxels: u64 = geometry.shape().iter().map(|n| *n as u64).product();
    let (data_path, is_gzip) = if has_pair {
        image_of_header(path)?
    } else {
        (path.to_owned(), is_gzip)
    };
    let data = Data {
        path: data_path,
        encoding: if is_gzip {
            Encoding::Gzip
        } else {
            Encoding::Raw
        },
        start: 0,
        skip: offset(path, fields, has_pair, &mut warnings)?,
        bytes: voxels * element.size() as u64,
    };
    Ok(Header {
        format,
        geometry,
        conversion: Conversion {
            element,
            is_big_endian: fields.is_big_endian,
            slope,
            intercept,
        },
        data,
        description: printable(&fields.description),
        warnings,
    })
}

/// Columns, rows and slices of the one volume.
fn sides(path: &Path, fields: &Fields) -> Result<[u64; 3], VolumeFileError> {
    let damaged = |reason: String| VolumeFileError::header(path, reason);
    let dimensions = fields.dim[0];
    if !(1..=7).contains(&dimensions) {
        return Err(damaged(format!("{dimensions} dimensions, not 1 to 7")));
    }
    let used = &fields.dim[1..=dimensions as usize];
    let mut sides = [1; 3];
    for (side, size) in sides.iter_mut().zip(used) {
        *side = u64::try_from(*size).map_err(|_| damaged(format!("a side of {size} voxels")))?;
    }
    // Writers leave the sizes that nobody uses at 0.
    let product = |sizes: &[i64]| {
        sizes.iter().fold(1, |n: u64, size| {
            n.saturating_mul(u64::try_from(*size).unwrap_or(0).max(1))
        })
    };
    let values = product(used.get(4..).unwrap_or(&[]));
    if values > 1 {
        return Err(VolumeFileError::unsupported(
            path,
            format!("{values} values a voxel"),
            "save the one that is meant as a file of its own",
        ));
    }
    let volumes = product(used.get(3..4).unwrap_or(&[]));
    if volumes > 1 {
        return Err(VolumeFileError::SeveralVolumes {
            path: path.to_owned(),
            volumes,
        });
    }
    Ok(sides)
}

/// The type of a voxel by its code in the standard.
fn element(path: &Path, code: i16) -> Result<Element, VolumeFileError> {
    let what = match code {
        2 => return Ok(Element::U8),
        4 => return Ok(Element::I16),
        8 => return Ok(Element::I32),
        16 => return Ok(Element::F32),
        64 => return Ok(Element::F64),
        256 => return Ok(Element::I8),
        512 => return Ok(Element::U16),
        768 => return Ok(Element::U32),
        1024 => return Ok(Element::I64),
        1280 => return Ok(Element::U64),
        1 => "binary voxels (1 bit)".to_owned(),
        32 | 1792 | 2048 => "complex voxels".to_owned(),
        128 => "colour voxels (RGB)".to_owned(),
        2304 => "colour voxels (RGBA)".to_owned(),
        1536 => "128-bit floating-point voxels".to_owned(),
        _ => format!("voxels of unknown type (code {code})"),
    };
    Err(VolumeFileError::unsupported(
        path,
        what,
        "export it as 16-bit whole or 32-bit floating-point numbers",
    ))
}

/// Slope and intercept; the standard's slope of 0 means that there are none.
fn rescale(fields: &Fields, warnings: &mut Vec<String>) -> (f64, f64) {
    let (slope, intercept) = (fields.slope, fields.intercept);
    if slope == 0.0 {
        return (1.0, 0.0);
    }
    if !slope.is_finite() || !intercept.is_finite() {
        warnings.push(format!(
            "slope {slope} and intercept {intercept} make no sense; the stored values are taken as they are"
        ));
        return (1.0, 0.0);
    }
    (slope, intercept)
}

/// Bytes before the voxels.
fn offset(
    path: &Path,
    fields: &Fields,
    has_pair: bool,
    warnings: &mut Vec<String>,
) -> Result<u64, VolumeFileError> {
    let least = if has_pair { 0 } else { fields.size + EXTENDER };
    let offset = fields.offset;
    if !offset.is_finite() || offset < 0.0 {
        return Err(VolumeFileError::header(
            path,
            format!("voxels at byte {offset}"),
        ));
    }
    // The cast saturates; the file's size is compared next.
    let offset = offset as u64;
    if offset < least {
        if offset != 0 {
            warnings.push(format!(
                "the voxels are said to begin at byte {offset}, inside the header; {least} is taken"
            ));
        }
        return Ok(least);
    }
    Ok(offset)
}

/// The file with the voxels of a header, and whether it is compressed.
fn image_of_header(path: &Path) -> Result<(PathBuf, bool), VolumeFileError> {
    let candidates = beside(path, [("img", false), ("img.gz", true), ("IMG", false)]);
    candidates
        .into_iter()
        .find(|(image, _)| image.is_file())
        .ok_or_else(|| VolumeFileError::DataFile {
            path: path.to_owned(),
            data: beside(path, [("img", ())])[0].0.display().to_string(),
            reason: "which is not there".to_owned(),
        })
}

/// The header beside an `.img` file, if there is one.
pub(crate) fn header_of_image(path: &Path) -> Option<PathBuf> {
    let is_image = stem(path).1.is_some_and(|e| e.eq_ignore_ascii_case("img"));
    if !is_image {
        return None;
    }
    let candidates = beside(path, [("hdr", ()), ("hdr.gz", ()), ("HDR", ())]);
    candidates
        .into_iter()
        .map(|(header, ())| header)
        .find(|header| {
            let format = sniff(header).ok().flatten().map(|head| head.format);
            matches!(
                format,
                Some(
                    Format::Nifti1 { has_pair: true }
                        | Format::Nifti2 { has_pair: true }
                        | Format::Analyze
                )
            )
        })
}

/// The same name with other endings.
fn beside<T, const N: usize>(path: &Path, endings: [(&str, T); N]) -> [(PathBuf, T); N] {
    let stem = stem(path).0;
    endings.map(|(ending, mark)| {
        let mut name = stem.clone().into_os_string();
        name.push(".");
        name.push(ending);
        (name.into(), mark)
    })
}

/// The path without its ending, and the ending, both without `.gz`.
fn stem(path: &Path) -> (PathBuf, Option<OsString>) {
    let is_gzip = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("gz"));
    let plain = if is_gzip {
        path.with_extension("")
    } else {
        path.to_owned()
    };
    (
        plain.with_extension(""),
        plain.extension().map(OsStr::to_owned),
    )
}
