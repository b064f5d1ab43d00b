//! Stored values to Hounsfield units.
//!
//! A stored value is `bits_stored` bits of its cell, ending at `high_bit`; what lies above or
//! below is somebody else's (overlays, leftovers) and is masked off. Padding is recognised as
//! stored value, before the rescale, and becomes air. MONOCHROME1 says how to show an image,
//! not what its values mean, and changes nothing.

use dicom_dictionary_std::tags;

use crate::elements::{Elements, Values};
use crate::error::FileError;
use crate::header::{Frame, Layout, given, short};

/// Largest rescale slope and intercept; with 32-bit pixels the values stay within 32-bit floats.
const MAX_RESCALE: f64 = 1e12;

/// What padding becomes (HU).
pub(crate) const AIR_HU: i16 = -1000;

/// Largest rescale slope and intercept for which 16-bit values stay within 32-bit arithmetic.
const MAX_WHOLE_SLOPE: f64 = 8192.0;
const MAX_WHOLE_INTERCEPT: f64 = 1e9;

/// The straight line from stored values to Hounsfield units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rescale {
    pub(crate) slope: f64,
    pub(crate) intercept: f64,
    pub(crate) known: Known,
}

/// How much of a rescale the file gives; what it does not is slope 1 and intercept 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Known {
    Nothing,
    Slope,
    Intercept,
    Both,
}

impl Rescale {
    /// From the values that are a frame's own, then the shared ones, then the image's.
    pub(crate) fn read(values: [&Values; 3]) -> Result<Self, FileError> {
        let slope = given::<1>(values, tags::RESCALE_SLOPE, "rescale slope")?;
        let intercept = given::<1>(values, tags::RESCALE_INTERCEPT, "rescale intercept")?;
        let known = match (slope, intercept) {
            (Some(_), Some(_)) => Known::Both,
            (None, Some(_)) => Known::Intercept,
            (Some(_), None) => Known::Slope,
            (None, None) => Known::Nothing,
        };
        let ([slope], [intercept]) = (slope.unwrap_or([1.0]), intercept.unwrap_or([0.0]));
        if slope == 0.0 {
            let reason = "rescale slope 0: all pixels would be equal";
            return Err(FileError::Geometry(reason.to_owned()));
        }
        if slope.abs() > MAX_RESCALE || intercept.abs() > MAX_RESCALE {
            return Err(FileError::Geometry(format!(
                "rescale slope {} and intercept {}; both must be below {MAX_RESCALE:e}",
                short(slope),
                short(intercept)
            )));
        }
        Ok(Self {
            slope,
            intercept,
            known,
        })
    }

    fn hu(self, stored: i64) -> f64 {
        stored as f64 * self.slope + self.intercept
    }
}

/// Reads a file's padding into its layout; true if the range's limit was wrong and is not used.
///
/// The limit lies beyond the padding value, away from the image's values (PS3.3 C.7.5.1.1.2). A
/// range that runs across water (0 HU) would take the patient for padding.
pub(crate) fn read_padding(e: &Elements, layout: &mut Layout, frames: &[Frame]) -> bool {
    let is_signed = layout.is_signed;
    let value = |tag| {
        e.u16(tag).map(|v| {
            if is_signed {
                i64::from(v.cast_signed())
            } else {
                i64::from(v)
            }
        })
    };
    let Some(padding) = value(tags::PIXEL_PADDING_VALUE) else {
        return false;
    };
    let limit = value(tags::PIXEL_PADDING_RANGE_LIMIT).unwrap_or(padding);
    let crosses_water = |f: &Frame| {
        let (padding, limit) = (f.rescale.hu(padding), f.rescale.hu(limit));
        padding.min(limit) < 0.0 && padding.max(limit) > 0.0
    };
    let is_wrong = frames.iter().any(crosses_water);
    let limit = if is_wrong { padding } else { limit };
    layout.padding = Some((padding.min(limit), padding.max(limit)));
    is_wrong
}

/// Whether a frame's Hounsfield units are whole numbers whatever its pixels are.
pub(crate) fn is_whole(layout: &Layout, frame: &Frame) -> bool {
    layout.bits_allocated <= 16
        && frame.rescale.slope.fract() == 0.0
        && frame.rescale.intercept.fract() == 0.0
        && frame.rescale.slope.abs() <= MAX_WHOLE_SLOPE
        && frame.rescale.intercept.abs() <= MAX_WHOLE_INTERCEPT
}

/// Takes stored values out of their cells.
#[derive(Clone, Copy)]
struct Cells {
    above: u32,
    below: u32,
    is_signed: bool,
    /// Stored values that are padding.
    padding: (i64, i64),
    /// Cells that are padding although no stored value is: some scanners write a 16-bit
    /// padding value into images of 12 bits.
    whole_padding: (i64, i64),
    above_whole: u32,
}

/// No value lies between these.
const NOTHING: (i64, i64) = (1, 0);

impl Cells {
    fn new(layout: &Layout) -> Self {
        let above = 31 - layout.high_bit;
        let below = 32 - layout.bits_stored;
        let padding = layout.padding.unwrap_or(NOTHING);
        let bits = layout.bits_stored.min(31);
        let (low, high) = if layout.is_signed {
            (-(1_i64 << (bits - 1)), (1_i64 << (bits - 1)) - 1)
        } else {
            (0, (1_i64 << bits) - 1)
        };
        let is_representable = padding.0 >= low && padding.1 <= high;
        Self {
            above,
            below,
            is_signed: layout.is_signed,
            padding,
            whole_padding: if is_representable { NOTHING } else { padding },
            above_whole: 32 - layout.bits_allocated,
        }
    }

    /// `above` bits are shifted out to the left, then `below` in from the left.
    fn extract(self, cell: u32, above: u32, below: u32) -> i64 {
        let left = cell << above;
        if self.is_signed {
            i64::from(left.cast_signed() >> below)
        } else {
            i64::from(left >> below)
        }
    }

    /// The stored value, or `None` for padding.
    #[inline]
    fn stored(self, cell: u32) -> Option<i64> {
        let value = self.extract(cell, self.above, self.below);
        let within = |v: i64, (low, high): (i64, i64)| low <= v && v <= high;
        let whole = self.extract(cell, self.above_whole, self.above_whole);
        let is_padding = within(value, self.padding) | within(whole, self.whole_padding);
        (!is_padding).then_some(value)
    }
}

/// A voxel type that Hounsfield units are written as.
pub(crate) trait Voxel: Copy + Default + Send + Sync + PartialEq {
    /// Nothing but air.
    const AIR: Self;

    /// Writes a frame's Hounsfield units; false if one does not fit this type.
    fn convert(bytes: &[u8], layout: &Layout, frame: &Frame, hu: &mut [Self]) -> bool;

    /// The value a fraction `t` of the way from `a` to `b`.
    fn between(a: Self, b: Self, t: f64) -> Self;
}

impl Voxel for i16 {
    const AIR: Self = AIR_HU;

    /// Only for frames that are [`is_whole`].
    fn convert(bytes: &[u8], layout: &Layout, frame: &Frame, hu: &mut [Self]) -> bool {
        let rescale = frame.rescale;
        let (slope, intercept) = (rescale.slope as i32, rescale.intercept as i32);
        let (mut low, mut high) = (i32::MAX, i32::MIN);
        let cells = Cells::new(layout);
        let mut write = |cell: u32, hu: &mut i16| {
            let value = cells
                .stored(cell)
                .map_or(i32::from(AIR_HU), |v| v as i32 * slope + intercept);
            low = low.min(value);
            high = high.max(value);
            *hu = value as i16;
        };
        if layout.bits_allocated == 8 {
            for (cell, hu) in bytes.iter().zip(hu) {
                write(u32::from(*cell), hu);
            }
        } else {
            let (pairs, _) = bytes.as_chunks::<2>();
            for (cell, hu) in pairs.iter().zip(hu) {
                write(u32::from(u16::from_le_bytes(*cell)), hu);
            }
        }
        low >= i32::from(i16::MIN) && high <= i32::from(i16::MAX)
    }

    fn between(a: Self, b: Self, t: f64) -> Self {
        let (a, b) = (f64::from(a), f64::from(b));
        (a + (b - a) * t).round() as Self
    }
}

impl Voxel for f32 {
    const AIR: Self = AIR_HU as Self;

    fn convert(bytes: &[u8], layout: &Layout, frame: &Frame, hu: &mut [Self]) -> bool {
        let cells = Cells::new(layout);
        let width = layout.bits_allocated as usize / 8;
        for (cell, hu) in bytes.chunks_exact(width).zip(hu) {
            let cell = cell.iter().rev().fold(0, |n, b| n << 8 | u32::from(*b));
            *hu = cells
                .stored(cell)
                .map_or(f32::from(AIR_HU), |v| frame.rescale.hu(v) as f32);
        }
        true
    }

    fn between(a: Self, b: Self, t: f64) -> Self {
        let (a, b) = (f64::from(a), f64::from(b));
        (a + (b - a) * t) as Self
    }
}
