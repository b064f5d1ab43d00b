//! What the header of one image says, checked: a [`Header`] has everything a slice needs.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use dicom_core::Tag;
use dicom_dictionary_std::{tags, uids};

use crate::elements::{Elements, PixelPlace, Values, numbers, text};
use crate::error::FileError;
use crate::file::{self, Parsed};
use crate::fragments::Index;
use crate::moment::{Moment, moments};
use crate::plausible;
use crate::vector::{cross, dot, length, scaled};

/// Cosine of row against column direction from which they no longer count as perpendicular.
const MAX_SKEW: f64 = 1e-2;

/// Spacings of pixels (mm) that a scan can have: from a micrometre to a metre.
const SPACING_MM: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// Farthest place from the scanner's origin (mm), a kilometre.
const MAX_PLACE_MM: f64 = 1e6;

/// Largest rescale slope and intercept; with 32-bit pixels the values stay within 32-bit floats.
const MAX_RESCALE: f64 = 1e12;

/// How stored values are laid out in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    /// 8, 16 or 32.
    pub(crate) bits_allocated: u32,
    pub(crate) bits_stored: u32,
    pub(crate) high_bit: u32,
    pub(crate) is_signed: bool,
    /// Lowest and highest stored value that mean "no measurement here".
    pub(crate) padding: Option<(i64, i64)>,
}

impl Layout {
    /// Bytes of one frame, uncompressed.
    pub(crate) fn frame_bytes(&self) -> u64 {
        self.rows as u64 * self.columns as u64 * u64::from(self.bits_allocated / 8)
    }
}

/// Where a file's pixels are and in what form.
#[derive(Clone, Debug)]
pub(crate) struct Storage {
    pub(crate) syntax_uid: &'static str,
    pub(crate) syntax_name: &'static str,
    /// Where the data set begins in the file.
    pub(crate) start: u64,
    pub(crate) pixels: PixelPlace,
    /// Frames in the file.
    pub(crate) frames: usize,
    /// Where the fragments of compressed frames lie, or why nobody knows, once one was asked for.
    pub(crate) fragments: OnceLock<Result<Index, String>>,
    /// All frames of a deflated file, once one was asked for.
    pub(crate) inflated: OnceLock<Result<Vec<u8>, String>>,
}

/// One frame's place, and the way from stored values to Hounsfield units.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub(crate) position: [f64; 3],
    /// Unit vectors: in which direction columns, then rows, are counted.
    pub(crate) orientation: [[f64; 3]; 2],
    /// Between columns, between rows (mm).
    pub(crate) spacing: [f64; 2],
    pub(crate) slope: f64,
    pub(crate) intercept: f64,
    pub(crate) slice_location: Option<f64>,
}

/// The header of one image file.
#[derive(Clone, Debug)]
pub(crate) struct Header {
    pub(crate) path: PathBuf,
    pub(crate) study_uid: String,
    pub(crate) series_uid: String,
    /// Names the coordinate system of the positions.
    pub(crate) reference_uid: String,
    pub(crate) description: String,
    pub(crate) modality: String,
    pub(crate) image_type: String,
    pub(crate) acquisition: Option<i64>,
    pub(crate) instance: Option<i64>,
    pub(crate) layout: Layout,
    pub(crate) storage: Storage,
    /// Bytes that the data set takes in the file.
    pub(crate) stored: u64,
    /// What the rescaled values are, where the file says: `HU`, `US` (unspecified) or others.
    pub(crate) rescale_type: Option<String>,
    /// Positions had to be taken from the slice location.
    pub(crate) is_placed_by_location: bool,
    pub(crate) is_cut_off: bool,
    pub(crate) frames: Vec<Frame>,
    /// When each frame was taken.
    pub(crate) moments: Vec<Moment>,
}

impl Header {
    /// Reads and checks the header of one file.
    pub(crate) fn read(path: &Path) -> Result<Self, FileError> {
        let parsed = file::parse(path)?;
        let e = &parsed.elements;
        if e.is_directory || e.text(tags::MEDIA_STORAGE_SOP_CLASS_UID).as_deref() == Some(DIRECTORY)
        {
            return Err(FileError::Directory);
        }
        let modality = e.text(tags::MODALITY).unwrap_or_default();
        if !matches!(modality.as_str(), "CT" | "") {
            return Err(FileError::Modality(modality));
        }
        let pixels = e
            .pixels
            .ok_or_else(|| FileError::NoImage("no pixels".to_owned()))?;
        let layout = layout(e)?;
        let image_type = image_type(e);
        if image_type.split('\\').any(|t| t == "LOCALIZER") {
            return Err(FileError::Localizer);
        }
        let (frames, is_placed_by_location) = frames(e)?;
        let needed = layout.frame_bytes() * frames.len() as u64;
        let available = parsed.size.saturating_sub(pixels.offset);
        let native = pixels.length;
        if native.is_some_and(|length| length < needed) {
            return Err(FileError::Header("fewer pixels than rows and columns say"));
        }
        let storage = storage(&parsed, pixels, frames.len());
        plausible::check(&layout, &storage, parsed.stored)?;
        Ok(Self {
            path: path.to_owned(),
            study_uid: e.text(tags::STUDY_INSTANCE_UID).unwrap_or_default(),
            reference_uid: e.text(tags::FRAME_OF_REFERENCE_UID).unwrap_or_default(),
            series_uid: e.text(tags::SERIES_INSTANCE_UID).unwrap_or_default(),
            description: e.described(tags::SERIES_DESCRIPTION),
            modality,
            image_type,
            acquisition: whole(e, tags::ACQUISITION_NUMBER),
            instance: whole(e, tags::INSTANCE_NUMBER),
            layout,
            storage,
            stored: parsed.stored,
            rescale_type: rescale_type(e),
            is_placed_by_location,
            is_cut_off: native.is_some() && available < needed,
            frames,
            moments: moments(e),
        })
    }
}

/// Class of a DICOMDIR.
const DIRECTORY: &str = uids::MEDIA_STORAGE_DIRECTORY_STORAGE;

fn storage(parsed: &Parsed, pixels: PixelPlace, frames: usize) -> Storage {
    Storage {
        syntax_uid: parsed.syntax.uid(),
        syntax_name: parsed.syntax.name(),
        start: parsed.start,
        pixels,
        frames,
        fragments: OnceLock::new(),
        inflated: OnceLock::new(),
    }
}

fn whole(e: &Elements, tag: Tag) -> Option<i64> {
    e.text(tag)?.parse().ok()
}

/// The image type without the padding that some writers add to every part.
fn image_type(e: &Elements) -> String {
    let text = e.text(tags::IMAGE_TYPE).unwrap_or_default();
    let parts: Vec<&str> = text.split('\\').map(str::trim).collect();
    parts.join("\\")
}

/// The rescale type of the image, or of its first frame.
fn rescale_type(e: &Elements) -> Option<String> {
    let mut groups = [&e.values, &e.shared].into_iter().chain(e.frames.first());
    groups.find_map(|values| text(values, tags::RESCALE_TYPE))
}

fn layout(e: &Elements) -> Result<Layout, FileError> {
    let no_image = |why: &str| FileError::NoImage(why.to_owned());
    let number = |tag, name| e.u16(tag).ok_or_else(|| no_image(name));
    let rows = usize::from(number(tags::ROWS, "no rows")?);
    let columns = usize::from(number(tags::COLUMNS, "no columns")?);
    if rows == 0 || columns == 0 {
        return Err(no_image("no rows or no columns"));
    }
    if e.u16(tags::SAMPLES_PER_PIXEL).unwrap_or(1) != 1 {
        return Err(no_image("a colour picture"));
    }
    // Numbers of colours are no measurements.
    if e.text(tags::PHOTOMETRIC_INTERPRETATION).as_deref() == Some("PALETTE COLOR") {
        return Err(no_image("a colour picture"));
    }
    let bits_allocated = u32::from(number(tags::BITS_ALLOCATED, "no bits allocated")?);
    let bits_stored = e.u16(tags::BITS_STORED).map_or(bits_allocated, u32::from);
    let high_bit = e
        .u16(tags::HIGH_BIT)
        .map_or(bits_stored.saturating_sub(1), u32::from);
    let fits = bits_stored > 0 && high_bit < bits_allocated && bits_stored <= high_bit + 1;
    if !matches!(bits_allocated, 8 | 16 | 32) || !fits {
        return Err(FileError::NoImage(format!(
            "{bits_stored} bits stored, high bit {high_bit} of {bits_allocated} allocated make no sense"
        )));
    }
    let is_signed = e.u16(tags::PIXEL_REPRESENTATION) == Some(1);
    let value = |tag| {
        e.u16(tag).map(|v| {
            if is_signed {
                i64::from(v.cast_signed())
            } else {
                i64::from(v)
            }
        })
    };
    let padding = value(tags::PIXEL_PADDING_VALUE).map(|a| {
        let b = value(tags::PIXEL_PADDING_RANGE_LIMIT).unwrap_or(a);
        (a.min(b), a.max(b))
    });
    Ok(Layout {
        rows,
        columns,
        bits_allocated,
        bits_stored,
        high_bit,
        is_signed,
        padding,
    })
}

/// The frames of an image, and whether they had to be placed by their slice location.
fn frames(e: &Elements) -> Result<(Vec<Frame>, bool), FileError> {
    let count = e
        .text(tags::NUMBER_OF_FRAMES)
        .and_then(|n| n.parse::<usize>().ok())
        .unwrap_or(1);
    if !e.frames.is_empty() {
        if count != e.frames.len() {
            return Err(FileError::Geometry(format!(
                "{count} frames, but positions for {}",
                e.frames.len()
            )));
        }
        let all: Result<Vec<Frame>, FileError> = e
            .frames
            .iter()
            .map(|own| frame([own, &e.shared, &e.values], None))
            .collect();
        return Ok((all?, false));
    }
    if count != 1 {
        return Err(FileError::Geometry(format!(
            "{count} frames without a position for each"
        )));
    }
    let location = e.numbers::<1>(tags::SLICE_LOCATION).map(|[l]| l);
    let is_placed_by_location = e.numbers::<3>(tags::IMAGE_POSITION_PATIENT).is_none();
    Ok((
        vec![frame([&e.values, &e.shared, &e.values], location)?],
        is_placed_by_location,
    ))
}

/// One frame from the values that are its own, then the shared ones, then the image's.
fn frame(values: [&Values; 3], location: Option<f64>) -> Result<Frame, FileError> {
    fn first<const N: usize>(values: [&Values; 3], tag: Tag) -> Option<[f64; N]> {
        values.into_iter().find_map(|v| numbers::<N>(v, tag))
    }
    let geometry = |text: &str| FileError::Geometry(text.to_owned());
    let orientation = first::<6>(values, tags::IMAGE_ORIENTATION_PATIENT);
    let orientation = match orientation {
        Some(o) => unit_axes(o)?,
        None if location.is_some() => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        None => return Err(geometry("no orientation (Image Orientation Patient)")),
    };
    let normal = cross(orientation[0], orientation[1]);
    let position = first::<3>(values, tags::IMAGE_POSITION_PATIENT)
        .or_else(|| location.map(|l| scaled(normal, l)))
        .ok_or_else(|| geometry("no position (Image Position Patient)"))?;
    // The standard writes the distance between rows first.
    let [between_rows, between_columns] =
        first::<2>(values, tags::PIXEL_SPACING).ok_or_else(|| geometry("no pixel spacing"))?;
    if !SPACING_MM.contains(&between_rows) || !SPACING_MM.contains(&between_columns) {
        return Err(FileError::Geometry(format!(
            "pixel spacing {} x {} mm; both must be from 0.001 to 1000",
            short(between_rows),
            short(between_columns)
        )));
    }
    if let Some(place) = position.iter().find(|p| p.abs() > MAX_PLACE_MM) {
        return Err(FileError::Geometry(format!(
            "a position {} mm away, more than a kilometre",
            short(*place)
        )));
    }
    let [slope] = first::<1>(values, tags::RESCALE_SLOPE).unwrap_or([1.0]);
    let [intercept] = first::<1>(values, tags::RESCALE_INTERCEPT).unwrap_or([0.0]);
    if slope == 0.0 {
        return Err(geometry("rescale slope 0: all pixels would be equal"));
    }
    if slope.abs() > MAX_RESCALE || intercept.abs() > MAX_RESCALE {
        return Err(FileError::Geometry(format!(
            "rescale slope {} and intercept {}; both must be below {MAX_RESCALE:e}",
            short(slope),
            short(intercept)
        )));
    }
    Ok(Frame {
        position,
        orientation,
        spacing: [between_columns, between_rows],
        slope,
        intercept,
        slice_location: location,
    })
}

/// A number without hundreds of zeros.
fn short(number: f64) -> String {
    if number == 0.0 || (1e-4..1e9).contains(&number.abs()) {
        number.to_string()
    } else {
        format!("{number:e}")
    }
}

fn unit_axes(o: [f64; 6]) -> Result<[[f64; 3]; 2], FileError> {
    let axes = [[o[0], o[1], o[2]], [o[3], o[4], o[5]]];
    let lengths = axes.map(length);
    let is_unit = |l: f64| (0.9..1.1).contains(&l);
    if !lengths.into_iter().all(is_unit) || dot(axes[0], axes[1]).abs() > MAX_SKEW {
        return Err(FileError::Geometry(format!(
            "orientation {o:?} is not two perpendicular directions"
        )));
    }
    Ok([
        scaled(axes[0], 1.0 / lengths[0]),
        scaled(axes[1], 1.0 / lengths[1]),
    ])
}
