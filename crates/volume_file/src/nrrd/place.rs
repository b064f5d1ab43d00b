//! Where in the patient the voxels lie.

use std::path::Path;

use bonemesh_volume::Affine;

use super::fields::Fields;
use crate::error::VolumeFileError;
use crate::header::{lps_from_ras, scaled};

/// Most dimensions that the definition allows.
const MAX_DIMENSIONS: usize = 16;

/// A spatial axis: its place in the file's fields, and its voxels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    number: usize,
    pub(super) size: u64,
}

/// A place or a direction in the file's space.
type Vector = [f64; 3];

/// The spatial axes, columns first; a plane has two.
pub(super) fn axes(path: &Path, fields: &Fields) -> Result<[Option<Axis>; 3], VolumeFileError> {
    let damaged = |reason: String| VolumeFileError::header(path, reason);
    fields.required(path, "dimension")?;
    let dimensions: usize = fields.number(path, "dimension")?.unwrap_or(0);
    if !(1..=MAX_DIMENSIONS).contains(&dimensions) {
        return Err(damaged(format!("{dimensions} dimensions")));
    }
    fields.required(path, "sizes")?;
    let sizes = fields.words(path, "sizes", dimensions)?.unwrap_or_default();
    let kinds = fields.words(path, "kinds", dimensions)?.unwrap_or_default();
    let directions = fields.words(path, "space directions", dimensions)?;
    let (mut spatial, mut others) = (Vec::new(), Vec::new());
    for (number, size) in sizes.into_iter().enumerate() {
        let Some(size) = size.parse().ok().filter(|n: &u64| *n > 0) else {
            return Err(damaged(format!("`{}` is no size", size.escape_debug())));
        };
        let kind = kinds.get(number).copied().unwrap_or("???");
        let has_direction = directions.as_ref().is_none_or(|d| d[number] != "none");
        if has_direction
            && matches!(
                kind.to_lowercase().as_str(),
                "domain" | "space" | "none" | "???"
            )
        {
            spatial.push(Axis { number, size });
        } else if size > 1 {
            others.push(format!(
                "{size} values a voxel (axis {}, {kind})",
                number + 1
            ));
        }
    }
    if let Some(what) = others.into_iter().next() {
        let remedy = "save the one that is meant as a file of its own";
        return Err(VolumeFileError::unsupported(path, what, remedy));
    }
    // A fourth axis without a kind is what writers of time series leave.
    if let Some(extra) = spatial.get(3..)
        && let volumes = extra.iter().fold(1, |n: u64, a| n.saturating_mul(a.size))
        && volumes > 1
    {
        return Err(VolumeFileError::SeveralVolumes {
            path: path.to_owned(),
            volumes,
        });
    }
    Ok(std::array::from_fn(|n| spatial.get(n).copied()))
}

/// The map of the header in LPS millimetres.
pub(super) fn patient_from_voxel(
    path: &Path,
    fields: &Fields,
    axes: [Option<Axis>; 3],
    warnings: &mut Vec<String>,
) -> Result<Affine, VolumeFileError> {
    let [Some(_), Some(_), Some(third)] = axes else {
        return Err(VolumeFileError::TooFewSlices {
            path: path.to_owned(),
            slices: 1,
        });
    };
    let axes = [axes[0].unwrap_or(third), axes[1].unwrap_or(third), third];
    let dimensions = fields.number(path, "dimension")?.unwrap_or(0);
    let unit_mm = unit_mm(path, fields, dimensions, warnings)?;
    let Some(directions) = fields.words(path, "space directions", dimensions)? else {
        let rows = by_spacings(path, fields, axes, dimensions, warnings)?;
        return Ok(Affine::from_rows(scaled(rows, unit_mm)));
    };
    let mut columns = [[0.0; 3]; 4];
    for (column, axis) in columns.iter_mut().zip(axes) {
        *column = vector(path, directions[axis.number])?;
    }
    columns[3] = match fields.get("space origin") {
        Some(origin) => vector(path, origin)?,
        None => [0.0; 3],
    };
    let rows = std::array::from_fn(|r| columns.map(|c| c[r]));
    Ok(Affine::from_rows(scaled(
        in_lps(fields, rows, warnings),
        unit_mm,
    )))
}

/// Turns the axes of the file's space into those of the patient.
fn in_lps(fields: &Fields, mut rows: [[f64; 4]; 3], warnings: &mut Vec<String>) -> [[f64; 4]; 3] {
    let space = fields.get("space").unwrap_or_default();
    match space.to_lowercase().as_str() {
        "left-posterior-superior" | "lps" => rows,
        "right-anterior-superior" | "ras" => lps_from_ras(rows),
        "left-anterior-superior" | "las" => {
            rows[1] = rows[1].map(|v| 0.0 - v);
            rows
        }
        _ => {
            let space = match space {
                "" => "no space".to_owned(),
                space => format!("the space `{}`", space.escape_debug()),
            };
            warnings.push(format!(
                "the file gives {space}, which says nothing of the patient: left-posterior-superior is taken, so left and right may be swapped"
            ));
            rows
        }
    }
}

/// Spacings alone, for files without directions.
fn by_spacings(
    path: &Path,
    fields: &Fields,
    axes: [Axis; 3],
    dimensions: usize,
    warnings: &mut Vec<String>,
) -> Result<[[f64; 4]; 3], VolumeFileError> {
    warnings.push(
        "the file gives no orientation: columns are taken to run to the left, rows to the back and slices to the head, so left and right may be swapped"
            .to_owned(),
    );
    let mut rows = [[0.0; 4]; 3];
    let Some(spacings) = fields.words(path, "spacings", dimensions)? else {
        warnings.push("the file gives no voxel size; 1 mm is taken".to_owned());
        (0..3).for_each(|n| rows[n][n] = 1.0);
        return Ok(rows);
    };
    for (n, axis) in axes.into_iter().enumerate() {
        rows[n][n] = number(path, spacings[axis.number])?;
        if rows[n][n].is_nan() {
            warnings.push(format!("axis {} has no voxel size; 1 mm is taken", n + 1));
            rows[n][n] = 1.0;
        }
    }
    Ok(rows)
}

/// Millimetres of the file's unit of length.
fn unit_mm(
    path: &Path,
    fields: &Fields,
    dimensions: usize,
    warnings: &mut Vec<String>,
) -> Result<f64, VolumeFileError> {
    let units = match fields.get("space units") {
        Some(_) => fields.words(path, "space units", 3)?,
        None if fields.get("space directions").is_none() => {
            fields.words(path, "units", dimensions)?
        }
        None => None,
    };
    let mut units = units.unwrap_or_default();
    units.retain(|unit| !matches!(unit.trim_matches('"'), "" | "none" | "???"));
    units.dedup();
    let (mm, unit) = match units[..] {
        [] => return Ok(1.0),
        [unit] => match unit.trim_matches('"').to_lowercase().as_str() {
            "mm" | "millimeter" | "millimetre" | "millimeters" | "millimetres" => return Ok(1.0),
            "cm" => (10.0, "centimetres"),
            "m" => (1000.0, "metres"),
            "um" | "µm" | "μm" | "micron" | "microns" => (0.001, "micrometres"),
            _ => (1.0, ""),
        },
        _ => (1.0, ""),
    };
    warnings.push(if unit.is_empty() {
        "the units of length are unknown; millimetres are taken".to_owned()
    } else {
        format!("lengths are given in {unit} and turned into millimetres")
    });
    Ok(mm)
}

/// A vector, written `(x,y,z)`.
fn vector(path: &Path, text: &str) -> Result<Vector, VolumeFileError> {
    let damaged = || {
        let reason = format!("`{}` is no vector of 3 numbers", text.escape_debug());
        VolumeFileError::header(path, reason)
    };
    let inner = text.strip_prefix('(').and_then(|t| t.strip_suffix(')'));
    let numbers: Vec<f64> = inner
        .ok_or_else(damaged)?
        .split(',')
        .map(|n| number(path, n))
        .collect::<Result<_, _>>()?;
    numbers.try_into().map_err(|_| damaged())
}

fn number(path: &Path, text: &str) -> Result<f64, VolumeFileError> {
    text.trim().parse().map_err(|_| {
        let reason = format!("`{}` is no number", text.escape_debug());
        VolumeFileError::header(path, reason)
    })
}
