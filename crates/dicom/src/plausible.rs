//! Whether compressed pixels can be what their header says, before memory is asked for.
//!
//! Uncompressed pixels are held against the size of the file. Compressed ones have no such
//! measure: an empty slice shrinks to a few bytes. So a frame of ordinary size is believed as long
//! as the file has bytes for a frame at all, and a large one has to be paid for.

use dicom_encoding::transfer_syntax::Codec;

use crate::error::FileError;
use crate::file::syntax;
use crate::header::{Layout, Storage};

/// Bytes of a frame that need no proof: 2048 x 2048 pixels of 32 bits.
const ORDINARY: u64 = 16 << 20;

/// Most bytes of a larger frame for each compressed one; real slices reach 10, and masked ones
/// with noiseless air 30.
const MAX_RATIO: u64 = 64;

/// Fewest bytes of a frame in pieces: the header of a piece, and less than the headers of any
/// code stream take.
const MIN_FRAME: u64 = 8 + 24;

/// Most bytes that are inflated for all frames of a deflated file, each of which begins anew:
/// a minute or two.
const MAX_INFLATED: u64 = 1 << 36;

/// Refuses compressed pixels that `available` bytes of the file cannot hold.
///
/// Of a deflated file, `available` is what it inflates to at most.
pub(crate) fn check(layout: &Layout, storage: &Storage, available: u64) -> Result<(), FileError> {
    let (frames, frame) = (storage.frames as u64, layout.frame_bytes());
    let impossible = |why: &str| {
        let (rows, columns) = (layout.rows, layout.columns);
        FileError::NoImage(format!("{frames} x {rows} x {columns} pixels {why}"))
    };
    let is_deflated = matches!(syntax(storage.syntax_uid)?.codec(), Codec::Dataset(_));
    if is_deflated {
        if frames * frames / 2 * frame > MAX_INFLATED {
            return Err(impossible("deflated would take hours"));
        }
        return Ok(());
    }
    if storage.pixels.length.is_some() {
        return Ok(());
    }
    let least = if frame > ORDINARY {
        frame / MAX_RATIO
    } else {
        MIN_FRAME
    };
    if least * frames > available {
        return Err(impossible(&format!("cannot be in {available} bytes")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use dicom_dictionary_std::uids;

    use super::*;
    use crate::elements::PixelPlace;

    fn is_plausible(uid: &'static str, side: usize, frames: usize, available: u64) -> bool {
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
                length: (uid == uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN).then_some(4),
            },
            frames,
        };
        check(&layout, &storage, available).is_ok()
    }

    #[test]
    fn an_empty_slice_may_be_tiny_and_a_huge_one_not() {
        for uid in [uids::RLE_LOSSLESS, uids::JPEG2000_LOSSLESS] {
            assert!(is_plausible(uid, 512, 1, 100));
            assert!(is_plausible(uid, 512, 1000, 100_000));
            assert!(!is_plausible(uid, 512, 1000, 10_000));
            assert!(is_plausible(uid, 8192, 1, 8 << 20));
            assert!(!is_plausible(uid, 8192, 1, 1 << 20));
            assert!(!is_plausible(uid, 65_535, 10_000, 1 << 30));
        }
    }

    #[test]
    fn a_deflated_file_of_many_frames_is_not_inflated_again_and_again() {
        let uid = uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN;
        assert!(is_plausible(uid, 512, 300, 1 << 30));
        assert!(!is_plausible(uid, 512, 30_000, 1 << 40));
    }
}
