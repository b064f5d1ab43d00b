//! Slices that make one volume: what is said of them, and what reading them needs.

use std::collections::BTreeSet;
use std::ops::Deref;
use std::path::PathBuf;

use bonemesh_volume::{Affine, Geometry};
use serde::Serialize;

use crate::error::DicomError;
use crate::frame::is_readable;
use crate::group::Stack;
use crate::header::{Header, Placing};
use crate::hounsfield::Known;
use crate::line::Line;
use crate::plausible;
use crate::report::SeriesReport;
use crate::slice::Slice;
use crate::stack::{Evenness, Grid};
use crate::vector::scaled;

/// Deviation of slice locations from positions (mm) that is rounding.
const LOCATION_MM: f64 = 0.02;

/// Slices that make one volume: their [`SeriesReport`], and what reading them needs.
#[derive(Clone, Debug, Serialize)]
pub struct Series {
    #[serde(flatten)]
    pub(crate) report: SeriesReport,
    #[serde(skip)]
    pub(crate) stack: Vec<Slice>,
    #[serde(skip)]
    pub(crate) grid: Grid,
    #[serde(skip)]
    pub(crate) line: Line,
}

impl Deref for Series {
    type Target = SeriesReport;

    fn deref(&self) -> &SeriesReport {
        &self.report
    }
}

impl Series {
    /// A series from a stack of at least two slices.
    pub(crate) fn new(stack: Stack) -> Result<Self, DicomError> {
        let Stack {
            slices,
            notes: mut warnings,
            copies,
            ..
        } = stack;
        let along: Vec<f64> = slices.iter().map(|s| s.along_mm).collect();
        let (grid, evenness) = Grid::new(&along);
        if evenness != Evenness::Even {
            warnings.push(evenness.to_string());
        }
        warnings.extend(grid.note(slices.len()));
        let line = Line::of(&slices);
        warnings.extend(observations(&slices, &line));
        warnings.extend(doubts(&slices));
        let header = &slices[0].header;
        let (rows, columns) = (header.layout.rows, header.layout.columns);
        let affine = affine(&slices, &line, &grid, 0);
        let geometry = Geometry::new([grid.count, rows, columns], affine)?;
        let report = SeriesReport {
            number: 0,
            uid: header.series_uid.clone(),
            description: header.description.clone(),
            modality: header.modality.clone(),
            slices: grid.count,
            slices_found: slices.len(),
            rows,
            columns,
            spacing_mm: geometry.spacing_mm(),
            patient_from_voxel: affine.matrix(),
            orientation: geometry.orientation_in_words(),
            tilt_degrees: geometry.tilt_degrees(),
            slice_positions_mm: along,
            is_resampled: matches!(evenness, Evenness::Uneven { .. }),
            gaps: evenness.into_gaps(),
            duplicates: copies.iter().map(Slice::name).collect(),
            transfer_syntax: syntaxes(&slices),
            estimated_memory_bytes: memory_bytes(&slices, &grid),
            hu_range: None,
            warnings,
            files: files(&slices),
        };
        Ok(Self {
            report,
            stack: slices,
            grid,
            line,
        })
    }

    /// Whether the files can hold the slices at all.
    pub(crate) fn is_plausible(&self) -> bool {
        let mut headers: Vec<_> = self.stack.iter().map(|s| &s.header).collect();
        headers.dedup_by(|a, b| a.path == b.path);
        let bytes = |h: &Header| h.layout.frame_bytes() * h.frames.len() as u64;
        let pixels = headers.iter().map(|h| bytes(h)).sum();
        plausible::fits(pixels, headers.iter().map(|h| h.stored).sum())
    }

    /// The geometry of `count` slices from place `begin` of the grid.
    pub(crate) fn geometry(&self, begin: usize, count: usize) -> Result<Geometry, DicomError> {
        let affine = affine(&self.stack, &self.line, &self.grid, begin);
        let geometry = Geometry::new([count, self.rows, self.columns], affine)?;
        Ok(match locations(&self.stack) {
            Some(locations) => {
                let from_first_mm = self.grid.at(begin) - self.stack[0].along_mm;
                geometry.with_slice_locations_mm(
                    locations.first_mm + from_first_mm * locations.per_mm,
                    self.grid.step_mm * locations.per_mm,
                )
            }
            None => geometry,
        })
    }
}

/// Memory of the volume: 16-bit where all values are whole.
fn memory_bytes(slices: &[Slice], grid: &Grid) -> u64 {
    let layout = &slices[0].header.layout;
    let bytes = if slices.iter().all(Slice::is_whole) {
        2
    } else {
        4
    };
    (grid.count * layout.rows * layout.columns) as u64 * bytes
}

fn files(slices: &[Slice]) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = slices.iter().map(|s| s.header.path.clone()).collect();
    files.dedup();
    files
}

/// The affine map of a stack: in-plane axes from the orientation, the step between slices from
/// the positions themselves, so that a tilted gantry's shear is in it.
fn affine(slices: &[Slice], line: &Line, grid: &Grid, begin: usize) -> Affine {
    let place = slices[0].place();
    let [dx, dy] = place.spacing;
    let [x, y] = place.orientation;
    let step = scaled(line.per_mm(), grid.step_mm);
    Affine::from_axes(scaled(x, dx), scaled(y, dy), step, line.at(grid.at(begin)))
}

/// Slice locations that run evenly along the normal, upwards or downwards.
struct Locations {
    /// Location of the first slice.
    first_mm: f64,
    /// Location gained for each mm along the normal: 1 or -1, other values where the scanner
    /// counts along a tilted bed.
    per_mm: f64,
}

/// The slice locations, if all slices have one and they run evenly with the positions.
fn locations(slices: &[Slice]) -> Option<Locations> {
    let (first, last) = (slices.first()?, slices.last()?);
    let first_mm = first.place().slice_location?;
    let per_mm = (last.place().slice_location? - first_mm) / (last.along_mm - first.along_mm);
    let agrees = |s: &Slice| {
        let expected = first_mm + (s.along_mm - first.along_mm) * per_mm;
        let off = s.place().slice_location? - expected;
        (off.abs() <= LOCATION_MM).then_some(())
    };
    let even = slices.iter().try_for_each(agrees);
    even.map(|()| Locations { first_mm, per_mm })
}

fn syntaxes(slices: &[Slice]) -> String {
    let names: BTreeSet<&str> = slices
        .iter()
        .map(|s| s.header.storage.syntax_name)
        .collect();
    names.into_iter().collect::<Vec<_>>().join(" and ")
}

/// What a user should know about the slices themselves.
fn observations(slices: &[Slice], line: &Line) -> Vec<String> {
    let mut found = Vec::new();
    let uids: BTreeSet<&str> = slices
        .iter()
        .map(|s| s.header.series_uid.as_str())
        .collect();
    if uids.len() > 1 {
        found.push(format!(
            "slices of {} series are taken as one, as was asked for",
            uids.len()
        ));
    }
    let notes: BTreeSet<&String> = slices.iter().flat_map(|s| &s.header.notes).collect();
    found.extend(notes.into_iter().cloned());
    let any = |placing: Placing| slices.iter().any(|s| s.header.placing == placing);
    if any(Placing::Location) {
        found.push(
            "no Image Position Patient and no Image Orientation Patient: slices are placed by Slice Location and taken as axial, head first and supine; left and right may be swapped, check them against the images"
                .to_owned(),
        );
    }
    if any(Placing::OrientationAndLocation) {
        found.push(
            "no Image Position Patient: slices are placed by Slice Location, sideways place unknown; where the scanner counts the other way the body is mirrored, check left and right against the images"
                .to_owned(),
        );
    }
    found.extend(line.note(slices));
    let unreadable: BTreeSet<(&str, &str)> = slices
        .iter()
        .map(|s| (s.header.storage.syntax_name, s.header.storage.syntax_uid))
        .filter(|(_, uid)| !is_readable(uid))
        .collect();
    for (name, uid) in unreadable {
        found.push(format!("pixels stored as {name} ({uid}) cannot be read"));
    }
    found
}

/// What makes it doubtful that the values are Hounsfield units.
fn doubts(slices: &[Slice]) -> Vec<String> {
    let some = |is_doubtful: &dyn Fn(&Header) -> bool| {
        let count = slices.iter().filter(|s| is_doubtful(&s.header)).count();
        match count {
            0 => None,
            _ if count == slices.len() => Some("the files".to_owned()),
            _ => Some(format!("the files of {count} of {} slices", slices.len())),
        }
    };
    let mut found = Vec::new();
    if let Some(files) = some(&|h| h.modality.is_empty()) {
        found.push(format!(
            "{files} do not say that they are CT; values may not be HU"
        ));
    }
    let kinds: BTreeSet<&String> = slices
        .iter()
        .filter_map(|s| s.header.foreign_type.as_ref())
        .collect();
    for kind in kinds {
        if let Some(files) = some(&|h| h.foreign_type.as_ref() == Some(kind)) {
            found.push(format!(
                "{files} give their values as `{kind}`, not as HU; choose the threshold by hand"
            ));
        }
    }
    let missing = match slices.iter().map(|s| s.place().rescale.known).min() {
        Some(Known::Nothing) => Some("no rescale (Rescale Slope, Rescale Intercept)"),
        Some(Known::Slope) => Some("no Rescale Intercept"),
        Some(Known::Intercept) => Some("no Rescale Slope"),
        Some(Known::Both) | None => None,
    };
    found.extend(missing.map(|what| {
        format!("{what} in the files: values are taken as they are and may not be HU")
    }));
    if let Some(files) = some(&|h| !h.is_sign_known) {
        found.push(format!(
            "{files} do not say whether pixels are signed (Pixel Representation); taken as unsigned"
        ));
    }
    if let Some(files) = some(&|h| h.is_padding_limit_wrong) {
        found.push(format!(
            "{files} would count 0 HU as padding; Pixel Padding Range Limit is not used"
        ));
    }
    found
}
