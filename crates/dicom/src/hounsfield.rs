//! Stored values to Hounsfield units.
//!
//! A stored value is `bits_stored` bits of its cell, ending at `high_bit`; what lies above or
//! below is somebody else's (overlays, leftovers) and is masked off. Padding is recognised as
//! stored value, before the rescale, and becomes air. MONOCHROME1 says how to show an image,
//! not what its values mean, and changes nothing.

use crate::header::{Frame, Layout};

/// What padding becomes (HU).
pub(crate) const AIR_HU: i16 = -1000;

/// Largest rescale slope and intercept for which 16-bit values stay within 32-bit arithmetic.
const MAX_WHOLE_SLOPE: f64 = 8192.0;
const MAX_WHOLE_INTERCEPT: f64 = 1e9;

/// Whether a frame's Hounsfield units are whole numbers whatever its pixels are.
pub(crate) fn is_whole(layout: &Layout, frame: &Frame) -> bool {
    layout.bits_allocated <= 16
        && frame.slope.fract() == 0.0
        && frame.intercept.fract() == 0.0
        && frame.slope.abs() <= MAX_WHOLE_SLOPE
        && frame.intercept.abs() <= MAX_WHOLE_INTERCEPT
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
        let (slope, intercept) = (frame.slope as i32, frame.intercept as i32);
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
            *hu = cells.stored(cell).map_or(f32::from(AIR_HU), |v| {
                (v as f64 * frame.slope + frame.intercept) as f32
            });
        }
        true
    }

    fn between(a: Self, b: Self, t: f64) -> Self {
        let (a, b) = (f64::from(a), f64::from(b));
        (a + (b - a) * t) as Self
    }
}
