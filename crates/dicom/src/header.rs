//! What the header of one image says, checked: a [`Header`] has everything a slice needs.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use dicom_core::Tag;
use dicom_dictionary_std::{tags, uids};

use crate::elements::{Elements, PixelPlace, Values, numbers, text};
use crate::error::FileError;
use crate::file::{self, Parsed};
use crate::fragments::Index;
use crate::hounsfield::{self, Rescale};
use crate::moment::{Moment, moments};
use crate::plausible;
use crate::vector::{cross, dot, length, scaled};

/// Cosine of row against column direction from which they no longer count as perpendicular.
const MAX_SKEW: f64 = 1e-2;

/// Spacings of pixels (mm) that a scan can have: from a micrometre to a metre.
const SPACING_MM: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// Characters of a wrong value that are quoted.
const MAX_QUOTED: usize = 80;

/// Most directions, to a hundredth, in which the frames of one image may lie: stacks of a scan
/// with its localizers take a dozen.
const MAX_PLANES: usize = 256;

/// Farthest place from the scanner's origin (mm), a kilometre.
const MAX_PLACE_MM: f64 = 1e6;

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
    pub(crate) rescale: Rescale,
    pub(crate) slice_location: Option<f64>,
}

/// What a frame's place was taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Placing {
    /// Slice location, with an assumed orientation.
    Location,
    /// Orientation and slice location.
    OrientationAndLocation,
    /// Orientation and position.
    Position,
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
    /// What the rescaled values are if not HU: `US` (unspecified) or others.
    pub(crate) foreign_type: Option<String>,
    /// Whether the file says that its pixels are signed or unsigned.
    pub(crate) is_sign_known: bool,
    /// The padding range has its limit on the side of the image's values.
    pub(crate) is_padding_limit_wrong: bool,
    pub(crate) placing: Placing,
    /// What is to be said of other files of the series, which were left out.
    pub(crate) notes: Vec<String>,
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
        let mut layout = layout(e)?;
        let image_type = image_type(e);
        if image_type.split('\\').any(|t| t == "LOCALIZER") {
            return Err(FileError::Localizer);
        }
        let (frames, placing) = frames(e)?;
        let is_padding_limit_wrong = hounsfield::read_padding(e, &mut layout, &frames);
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
            foreign_type: foreign_type(e),
            is_sign_known: matches!(e.u16(tags::PIXEL_REPRESENTATION), Some(0 | 1)),
            is_padding_limit_wrong,
            placing,
            notes: Vec::new(),
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

/// The first rescale type of the image or one of its frames that is not HU.
fn foreign_type(e: &Elements) -> Option<String> {
    let groups = [&e.values, &e.shared].into_iter().chain(&e.frames);
    let mut kinds = groups.filter_map(|values| text(values, tags::RESCALE_TYPE));
    kinds.find(|kind| kind != "HU")
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
    Ok(Layout {
        rows,
        columns,
        bits_allocated,
        bits_stored,
        high_bit,
        is_signed,
        padding: None,
    })
}

/// Refuses images whose frames lie in no common planes: sorting them would take its time and give
/// no volume.
fn check_planes(frames: &[Frame]) -> Result<(), FileError> {
    let plane = |f: &Frame| {
        let axes = f.orientation.as_flattened().iter();
        axes.map(|c| (c * 100.0).round() as i32)
            .collect::<Vec<i32>>()
    };
    let mut planes = BTreeSet::new();
    for frame in frames {
        planes.insert(plane(frame));
        if planes.len() > MAX_PLANES {
            return Err(FileError::Geometry(format!(
                "its frames lie in more than {MAX_PLANES} directions"
            )));
        }
    }
    Ok(())
}

/// The frames of an image, and what they are placed by.
fn frames(e: &Elements) -> Result<(Vec<Frame>, Placing), FileError> {
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
        let all = all?;
        check_planes(&all)?;
        return Ok((all, Placing::Position));
    }
    if count != 1 {
        return Err(FileError::Geometry(format!(
            "{count} frames without a position for each"
        )));
    }
    let location = e.numbers::<1>(tags::SLICE_LOCATION).map(|[l]| l);
    let placing = if e.text(tags::IMAGE_POSITION_PATIENT).is_some() {
        Placing::Position
    } else if e.text(tags::IMAGE_ORIENTATION_PATIENT).is_some() {
        Placing::OrientationAndLocation
    } else {
        Placing::Location
    };
    let frame = frame([&e.values, &e.shared, &e.values], location)?;
    Ok((vec![frame], placing))
}

/// One frame from the values that are its own, then the shared ones, then the image's.
fn frame(values: [&Values; 3], location: Option<f64>) -> Result<Frame, FileError> {
    let geometry = |text: &str| FileError::Geometry(text.to_owned());
    let position = given::<3>(values, tags::IMAGE_POSITION_PATIENT, "position")?;
    let orientation = given::<6>(values, tags::IMAGE_ORIENTATION_PATIENT, "orientation")?;
    let orientation = match (orientation, position, location) {
        (Some(o), ..) => unit_axes(o)?,
        // Nothing but the location is known: axial, head first, supine; the series says so.
        (None, None, Some(_)) => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        _ => return Err(geometry("no orientation (Image Orientation Patient)")),
    };
    let normal = cross(orientation[0], orientation[1]);
    let position = position
        .or_else(|| location.map(|l| scaled(normal, l)))
        .ok_or_else(|| geometry("no position (Image Position Patient)"))?;
    // The standard writes the distance between rows first.
    let spacing = given::<2>(values, tags::PIXEL_SPACING, "pixel spacing")?;
    let [between_rows, between_columns] = spacing.ok_or_else(|| geometry("no pixel spacing"))?;
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
    Ok(Frame {
        position,
        orientation,
        spacing: [between_columns, between_rows],
        rescale: Rescale::read(values)?,
        slice_location: location,
    })
}

/// The numbers of an element in the first of `values` that has it; an error if they are none.
pub(crate) fn given<const N: usize>(
    values: [&Values; 3],
    tag: Tag,
    name: &str,
) -> Result<Option<[f64; N]>, FileError> {
    let written = |v: &Values| text(v, tag).map(|text| (text, numbers::<N>(v, tag)));
    match values.into_iter().find_map(written) {
        None => Ok(None),
        Some((_, Some(numbers))) => Ok(Some(numbers)),
        Some((text, None)) => Err(FileError::Geometry(format!(
            "no {name}: `{}` is not {N} {} with a decimal point",
            text.chars().take(MAX_QUOTED).collect::<String>(),
            if N == 1 { "number" } else { "numbers" },
        ))),
    }
}

/// A number without hundreds of zeros.
pub(crate) fn short(number: f64) -> String {
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
