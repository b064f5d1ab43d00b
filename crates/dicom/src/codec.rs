//! One compressed frame to its uncompressed bytes, little endian.
//!
//! The decoders are dicom-rs's and, for JPEG of 12 bits, libjpeg-turbo. They are written for
//! honest input: what a frame declares is held against the header before a decoder sees it.

use std::borrow::Cow;
use std::io::{Cursor, Read};
use std::panic::{AssertUnwindSafe, catch_unwind};

use dicom_dictionary_std::uids;
use dicom_encoding::adapters::{PixelDataObject, RawPixelData};
use dicom_encoding::transfer_syntax::{Codec, TransferSyntax};

use crate::codestream::{Declared, Process, declared, repair_scan};
use crate::error::FileError;
use crate::file::syntax as find_syntax;
use crate::header::Layout;
use crate::{jpeg_12, jpeg_2000, rle};

/// Largest frame that is decompressed; a small file may declare any size.
const MAX_COMPRESSED_PIXELS: usize = 8192 * 8192;

/// End of a JPEG-LS image.
const EOI: [u8; 2] = [0xff, 0xd9];

/// Decompresses one frame to exactly `layout.frame_bytes()` bytes.
pub(crate) fn decompress(
    frame: Vec<u8>,
    syntax: &TransferSyntax,
    layout: &Layout,
) -> Result<Vec<u8>, FileError> {
    decode(frame, syntax, layout).map_err(|why| {
        let (name, uid) = (syntax.name(), syntax.uid());
        FileError::Codec(format!("{name}, {uid}: {why}"))
    })
}

fn decode(frame: Vec<u8>, syntax: &TransferSyntax, layout: &Layout) -> Result<Vec<u8>, String> {
    let (rows, columns) = (layout.rows, layout.columns);
    if rows * columns > MAX_COMPRESSED_PIXELS {
        return Err(format!("{rows} x {columns} pixels are too many"));
    }
    match syntax.uid() {
        uids::ENCAPSULATED_UNCOMPRESSED_EXPLICIT_VR_LITTLE_ENDIAN => exactly(frame, layout),
        uids::DEFLATED_IMAGE_FRAME_COMPRESSION => inflate(frame, layout),
        uids::RLE_LOSSLESS => {
            rle::check(&frame, layout)?;
            with_reader(frame, syntax, layout, layout.bits_allocated)
        }
        _ => code_stream(frame, syntax, layout),
    }
}

/// The frame without padding at its end.
fn exactly(mut bytes: Vec<u8>, layout: &Layout) -> Result<Vec<u8>, String> {
    if (bytes.len() as u64) < layout.frame_bytes() {
        return Err(format!(
            "{} bytes where {} are needed",
            bytes.len(),
            layout.frame_bytes()
        ));
    }
    bytes.truncate(layout.frame_bytes() as usize);
    Ok(bytes)
}

/// Inflates no further than needed: the decoder of this transfer syntax would go to the end.
fn inflate(frame: Vec<u8>, layout: &Layout) -> Result<Vec<u8>, String> {
    let deflated = find_syntax(uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN).map(TransferSyntax::codec);
    let Ok(Codec::Dataset(Some(adapter))) = deflated else {
        return Err("not supported".to_owned());
    };
    let mut bytes = Vec::new();
    adapter
        .adapt_reader(Box::new(Cursor::new(frame)))
        .take(layout.frame_bytes())
        .read_to_end(&mut bytes)
        .map_err(|e| e.to_string())?;
    exactly(bytes, layout)
}

fn code_stream(
    mut frame: Vec<u8>,
    syntax: &TransferSyntax,
    layout: &Layout,
) -> Result<Vec<u8>, String> {
    let declared = declared(&frame).ok_or("no frame header")?;
    check_declared(declared, layout)?;
    let width = layout.bits_allocated as usize / 8;
    // The decoders of JPEG and JPEG-LS give cells as small as the samples allow.
    let narrow = declared.bits.div_ceil(8) * 8;
    if declared.process == Process::Dct {
        repair_scan(&mut frame);
    }
    let mut cells = match declared.process {
        Process::Dct if declared.bits > 8 => {
            let samples = jpeg_12::decode(&frame, layout.rows, layout.columns)?;
            let bytes = samples.iter().flat_map(|v| v.to_le_bytes()).collect();
            widened(bytes, 2, width)
        }
        Process::Dct | Process::Lossless => {
            let bytes = with_reader(frame, syntax, layout, narrow)?;
            widened(bytes, narrow as usize / 8, width)
        }
        Process::JpegLs => {
            // CharLS waits for ever for the end of a scan that breaks off, unless a marker follows.
            frame.extend(EOI);
            let bytes = with_reader(frame, syntax, layout, narrow)?;
            widened(bytes, narrow as usize / 8, width)
        }
        Process::Jpeg2000 => {
            let frame = jpeg_2000::checked(frame)?;
            with_reader(frame, syntax, layout, layout.bits_allocated)?
        }
    };
    // JPEG-LS knows no sign, and writers of JPEG 2000 forget it.
    let is_sign_lost = matches!(declared.process, Process::JpegLs | Process::Jpeg2000);
    if is_sign_lost && declared.bits < layout.bits_stored {
        settle(&mut cells, width, declared.bits, layout.is_signed);
    }
    Ok(cells)
}

fn check_declared(declared: Declared, layout: &Layout) -> Result<(), String> {
    let (rows, columns) = (layout.rows, layout.columns);
    if (declared.rows as usize, declared.columns as usize) != (rows, columns) {
        return Err(format!(
            "{} x {} pixels where the header says {rows} x {columns}",
            declared.rows, declared.columns
        ));
    }
    if declared.components != 1 || declared.bits > layout.bits_allocated {
        return Err(format!(
            "{} components of {} bits where the header says one of {}",
            declared.components, declared.bits, layout.bits_allocated
        ));
    }
    Ok(())
}

/// Little-endian cells made wider.
fn widened(bytes: Vec<u8>, from: usize, to: usize) -> Vec<u8> {
    if from == to {
        return bytes;
    }
    let zeros = std::iter::repeat_n(0, to - from);
    bytes
        .chunks_exact(from)
        .flat_map(|cell| cell.iter().copied().chain(zeros.clone()))
        .collect()
}

/// Makes samples of fewer bits than the header says fill their cells: with copies of their
/// highest bit if signed, with zeros if not.
fn settle(bytes: &mut [u8], width: usize, bits: u32, is_signed: bool) {
    let above = 64 - bits;
    for cell in bytes.chunks_exact_mut(width) {
        let value = cell.iter().rev().fold(0_u64, |n, b| n << 8 | u64::from(*b)) << above;
        let value = if is_signed {
            (value.cast_signed() >> above).cast_unsigned()
        } else {
            value >> above
        };
        cell.copy_from_slice(&value.to_le_bytes()[..width]);
    }
}

/// The frame through dicom-rs's decoder, in cells of `bits`.
fn with_reader(
    frame: Vec<u8>,
    syntax: &TransferSyntax,
    layout: &Layout,
    bits: u32,
) -> Result<Vec<u8>, String> {
    let reader = syntax.pixel_data_reader().ok_or("not supported")?;
    let single = SingleFrame {
        syntax_uid: syntax.uid(),
        layout,
        bits,
        frame,
    };
    let mut bytes = Vec::new();
    // A panic in a decoder costs this slice, nothing else.
    let decoded = catch_unwind(AssertUnwindSafe(|| {
        reader.decode_frame(&single, 0, &mut bytes)
    }));
    let expected = layout.rows * layout.columns * (bits as usize / 8);
    match decoded {
        Ok(Ok(())) if bytes.len() == expected => Ok(bytes),
        Ok(Ok(())) => Err("another size than the header says".to_owned()),
        Ok(Err(error)) => Err(reason(&error)),
        Err(_) => Err("damaged".to_owned()),
    }
}

/// The innermost cause, which says most.
fn reason(error: &dyn std::error::Error) -> String {
    let mut innermost = error;
    while let Some(source) = innermost.source() {
        innermost = source;
    }
    innermost.to_string()
}

/// One compressed frame as the decoders want to see it.
struct SingleFrame<'a> {
    syntax_uid: &'a str,
    layout: &'a Layout,
    /// Of a cell that the decoder writes.
    bits: u32,
    frame: Vec<u8>,
}

impl PixelDataObject for SingleFrame<'_> {
    fn transfer_syntax_uid(&self) -> &str {
        self.syntax_uid
    }

    fn rows(&self) -> Option<u16> {
        u16::try_from(self.layout.rows).ok()
    }

    fn cols(&self) -> Option<u16> {
        u16::try_from(self.layout.columns).ok()
    }

    fn samples_per_pixel(&self) -> Option<u16> {
        Some(1)
    }

    fn bits_allocated(&self) -> Option<u16> {
        u16::try_from(self.bits).ok()
    }

    fn bits_stored(&self) -> Option<u16> {
        u16::try_from(self.layout.bits_stored.min(self.bits)).ok()
    }

    fn photometric_interpretation(&self) -> Option<&str> {
        Some("MONOCHROME2")
    }

    fn number_of_frames(&self) -> Option<u32> {
        Some(1)
    }

    fn number_of_fragments(&self) -> Option<u32> {
        Some(1)
    }

    fn fragment(&self, fragment: usize) -> Option<Cow<'_, [u8]>> {
        (fragment == 0).then_some(Cow::Borrowed(&self.frame))
    }

    fn offset_table(&self) -> Option<Cow<'_, [u32]>> {
        None
    }

    fn raw_pixel_data(&self) -> Option<RawPixelData> {
        Some(RawPixelData {
            fragments: [self.frame.clone()].into_iter().collect(),
            offset_table: std::iter::empty().collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_fill_their_cells_by_their_sign() {
        let cells = [0x30, 0x18, 0xff, 0x0f, 0x01, 0xf0];
        let mut signed = cells;
        settle(&mut signed, 2, 13, true);
        let values = signed
            .as_chunks::<2>()
            .0
            .iter()
            .map(|c| i16::from_le_bytes(*c));
        assert_eq!(values.collect::<Vec<_>>(), [-2000, 4095, -4095]);
        let mut unsigned = cells;
        settle(&mut unsigned, 2, 13, false);
        assert_eq!(unsigned, [0x30, 0x18, 0xff, 0x0f, 0x01, 0x10]);
    }

    #[test]
    fn wider_cells_hold_the_same_numbers() {
        assert_eq!(widened(vec![1, 0xff], 1, 2), [1, 0, 0xff, 0]);
        assert_eq!(widened(vec![1, 2, 3, 4], 2, 4), [1, 2, 0, 0, 3, 4, 0, 0]);
    }
}
