//! What every format's header says, in one form.

use std::path::Path;

use bonemesh_volume::{Affine, Geometry};

use crate::data::Data;
use crate::error::VolumeFileError;
use crate::sample::Conversion;

/// A header that was checked: where the voxels are and what they mean.
#[derive(Clone, Debug)]
pub(crate) struct Header {
    /// `NIfTI-1`, `NRRD`, ...
    pub(crate) format: &'static str,
    pub(crate) geometry: Geometry,
    pub(crate) conversion: Conversion,
    pub(crate) data: Data,
    /// Printable text only.
    pub(crate) description: String,
    pub(crate) warnings: Vec<String>,
}

/// Columns, rows, slices to a geometry; at least 2 slices, and a map that does not flatten space.
pub(crate) fn geometry(
    path: &Path,
    [columns, rows, slices]: [u64; 3],
    affine: Affine,
) -> Result<Geometry, VolumeFileError> {
    if slices < 2 {
        return Err(VolumeFileError::TooFewSlices {
            path: path.to_owned(),
            slices,
        });
    }
    // More than an index can count is too large for a volume in any case.
    let shape = [slices, rows, columns].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    Geometry::new(shape, affine).map_err(|source| VolumeFileError::Volume {
        path: path.to_owned(),
        source,
    })
}

/// Patient coordinates with x to the right and y to the front, turned to left and back (a zero
/// stays without a sign).
pub(crate) fn lps_from_ras(mut rows: [[f64; 4]; 3]) -> [[f64; 4]; 3] {
    for row in &mut rows[..2] {
        *row = row.map(|v| 0.0 - v);
    }
    rows
}

/// Coordinates in other units, turned to millimetres.
pub(crate) fn scaled(rows: [[f64; 4]; 3], mm: f64) -> [[f64; 4]; 3] {
    rows.map(|row| row.map(|v| v * mm))
}

/// The text up to its first NUL, without what a terminal would act on.
pub(crate) fn printable(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end])
        .chars()
        .filter(|c| !c.is_control() && *c != char::REPLACEMENT_CHARACTER)
        .collect::<String>()
        .trim()
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_description_cannot_drive_the_terminal() {
        assert_eq!(printable(b" head\x1b[2J\n\xff CT\0rest"), "head[2J CT");
    }
}
