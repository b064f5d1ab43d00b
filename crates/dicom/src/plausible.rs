//! Whether compressed pixels can be what their header says, before memory is asked for.
//!
//! Uncompressed pixels are held against the size of the file. Compressed ones have no such
//! measure: an empty slice shrinks to a few bytes. So frames of ordinary size are believed, as
//! long as not all of them can be empty, and a large one has to be paid for.

use dicom_encoding::transfer_syntax::Codec;

use crate::error::FileError;
use crate::file::syntax;
use crate::header::{Layout, Storage};

/// Bytes of pixels that need no proof: 2048 x 2048 of 32 bits.
const ORDINARY: u64 = 16 << 20;

/// Most bytes of a larger frame for each compressed one; real slices reach 10, and masked ones
/// with noiseless air 30.
const MAX_FRAME_RATIO: u64 = 64;

/// Most bytes of many frames or slices for each compressed one. Slices of a phantom without noise
/// reach 500, as their headers alone have a kilobyte.
const MAX_RATIO: u64 = 1024;

/// Least compressed bytes of one of many frames: its place among the functional groups, the header
/// of its item and of its code stream take more.
const MIN_FRAME: u64 = 16;

/// Most bytes of all frames of a deflated file: they are held together, as none can be reached but
/// through those before it.
const MAX_INFLATED: u64 = 1 << 30;

/// Whether slices of `bytes` in all can be in `stored` compressed bytes.
pub(crate) fn fits(bytes: u64, stored: u64) -> bool {
    bytes <= ORDINARY || bytes / MAX_RATIO <= stored
}

/// Refuses compressed pixels that a file with a data set of `stored` bytes cannot hold.
pub(crate) fn check(layout: &Layout, storage: &Storage, stored: u64) -> Result<(), FileError> {
    let (frames, frame) = (storage.frames as u64, layout.frame_bytes());
    let impossible = |why: &str| {
        let (rows, columns) = (layout.rows, layout.columns);
        FileError::NoImage(format!("{frames} x {rows} x {columns} pixels {why}"))
    };
    let is_deflated = matches!(syntax(storage.syntax_uid)?.codec(), Codec::Dataset(_));
    if !is_deflated && storage.pixels.length.is_some() {
        return Ok(());
    }
    let is_paid = frame <= ORDINARY || frame / MAX_FRAME_RATIO * frames <= stored;
    let is_enough = frames == 1 || frames * MIN_FRAME <= stored;
    if !is_enough || !is_paid || !fits(frame * frames, stored) {
        return Err(impossible(&format!("cannot be in {stored} bytes")));
    }
    if is_deflated && frames > 1 {
        let all = frames * frame;
        if all > MAX_INFLATED {
            return Err(impossible("deflated in one file are too many"));
        }
        if all > ORDINARY && all / MAX_FRAME_RATIO > stored {
            return Err(impossible(&format!("cannot be in {stored} bytes")));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use dicom_dictionary_std::uids;

    use std::sync::OnceLock;

    use super::*;
    use crate::elements::PixelPlace;

    const DEFLATED: &str = uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN;

    fn is_plausible(uid: &'static str, side: usize, frames: usize, stored: u64) -> bool {
        let layout = Layout {
            rows: side,
            columns: side,
            bits_allocated: 16,
            bits_stored: 16,
            high_bit: 15,
            is_signed: false,
            padding: None,
        };
        let storage = Storage {
            syntax_uid: uid,
            syntax_name: "",
            start: 0,
            pixels: PixelPlace {
                offset: 0,
                length: (uid == DEFLATED).then_some(4),
            },
            frames,
            fragments: OnceLock::new(),
            inflated: OnceLock::new(),
        };
        check(&layout, &storage, stored).is_ok()
    }

    #[test]
    fn an_empty_slice_may_be_tiny_and_a_huge_one_not() {
        for uid in [uids::RLE_LOSSLESS, uids::JPEG2000_LOSSLESS, DEFLATED] {
            let frames = if uid == DEFLATED { 30 } else { 300 };
            assert!(is_plausible(uid, 512, 1, 100));
            assert!(is_plausible(uid, 512, frames, 300_000));
            assert!(!is_plausible(uid, 512, 300, 30_000));
            assert!(is_plausible(uid, 8192, 1, 8 << 20));
            assert!(!is_plausible(uid, 8192, 1, 1 << 20));
            assert!(!is_plausible(uid, 65_535, 10_000, 1 << 30));
        }
    }

    #[test]
    fn deflated_frames_that_are_held_together_are_paid_for() {
        assert!(is_plausible(DEFLATED, 512, 300, 40 << 20));
        assert!(!is_plausible(DEFLATED, 512, 300, 1 << 20));
        assert!(!is_plausible(DEFLATED, 512, 30_000, 1 << 40));
    }
}
