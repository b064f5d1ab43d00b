//! The bytes of one frame, uncompressed and little endian.

use std::borrow::Cow;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use dicom_dictionary_std::uids;
use dicom_encoding::adapters::{PixelDataObject, RawPixelData};
use dicom_encoding::transfer_syntax::{Codec, Endianness, TransferSyntax};

use crate::codestream::declared;
use crate::error::FileError;
use crate::file::{inflated_part, syntax};
use crate::header::{Layout, Storage};
use crate::jpeg_ls;

/// Largest frame that is decompressed; a small file may declare any size.
const MAX_COMPRESSED_PIXELS: usize = 8192 * 8192;

/// Most fragments that the frames of one file may be cut into.
const MAX_FRAGMENTS: usize = 1 << 20;

const ITEM: [u8; 4] = [0xfe, 0xff, 0x00, 0xe0];

/// Whether pixels stored in this transfer syntax can be decoded.
pub(crate) fn is_readable(syntax_uid: &str) -> bool {
    is_jpeg_ls(syntax_uid) || syntax(syntax_uid).is_ok_and(TransferSyntax::can_decode_all)
}

fn is_jpeg_ls(syntax_uid: &str) -> bool {
    matches!(
        syntax_uid,
        uids::JPEGLS_LOSSLESS | uids::JPEGLS_NEAR_LOSSLESS
    )
}

/// Reads and, where needed, decompresses frame `index` (from 0) of a file.
///
/// Gives exactly `layout.frame_bytes()` bytes.
pub(crate) fn read_frame(
    path: &Path,
    storage: &Storage,
    layout: &Layout,
    index: usize,
) -> Result<Vec<u8>, FileError> {
    let syntax = syntax(storage.syntax_uid)?;
    let mut file = File::open(path)?;
    match syntax.codec() {
        Codec::Dataset(_) if storage.pixels.length.is_some() => {
            let length = layout.frame_bytes();
            let begin = storage.pixels.offset + length * index as u64;
            inflated_part(file, syntax, storage.start, begin, length)
        }
        Codec::EncapsulatedPixelData(..) if storage.pixels.length.is_none() => {
            let mut file = BufReader::new(file);
            let frame = encapsulated(&mut file, storage, index)?;
            decompress(frame, syntax, layout)
        }
        _ => native(&mut file, syntax, storage, layout, index),
    }
}

fn native<S: Read + Seek>(
    source: &mut S,
    syntax: &TransferSyntax,
    storage: &Storage,
    layout: &Layout,
    index: usize,
) -> Result<Vec<u8>, FileError> {
    if storage.pixels.length.is_none() {
        return Err(FileError::Header("the pixels have no length"));
    }
    let size = source.seek(SeekFrom::End(0))?;
    let begin = storage.pixels.offset + layout.frame_bytes() * index as u64;
    let needed = begin + layout.frame_bytes();
    if size < needed {
        return Err(FileError::CutOff {
            needed,
            found: size,
        });
    }
    source.seek(SeekFrom::Start(begin))?;
    let mut bytes = vec![0; layout.frame_bytes() as usize];
    source.read_exact(&mut bytes)?;
    if syntax.endianness() == Endianness::Big {
        let width = layout.bits_allocated as usize / 8;
        bytes.chunks_exact_mut(width).for_each(<[u8]>::reverse);
    }
    Ok(bytes)
}

/// The compressed bytes of one frame: its fragments put together.
fn encapsulated<S: Read + Seek>(
    source: &mut S,
    storage: &Storage,
    index: usize,
) -> Result<Vec<u8>, FileError> {
    let size = source.seek(SeekFrom::End(0))?;
    source.seek(SeekFrom::Start(storage.pixels.offset))?;
    let table = items(source, size, 1)?;
    let (at, length) = *table
        .first()
        .ok_or(FileError::Header("no offset table before the pixels"))?;
    let offsets = offset_table(source, at, length)?;
    source.seek(SeekFrom::Start(at + length))?;
    let first = at + length;
    let fragments = items(source, size, MAX_FRAGMENTS)?;
    let chosen: Vec<(u64, u64)> = if storage.frames == 1 {
        fragments
    } else if fragments.len() == storage.frames {
        vec![fragments[index]]
    } else if offsets.len() == storage.frames {
        let from = first + u64::from(offsets[index]);
        let to = offsets
            .get(index + 1)
            .map_or(u64::MAX, |o| first + u64::from(*o));
        // Offsets point at an item's header, eight bytes before its content.
        let is_ours = |at: u64| (from..to).contains(&(at - 8));
        fragments
            .into_iter()
            .filter(|(at, _)| is_ours(*at))
            .collect()
    } else {
        return Err(FileError::Header("the frames cannot be told apart"));
    };
    let mut frame = Vec::new();
    for (at, length) in chosen {
        source.seek(SeekFrom::Start(at))?;
        source.by_ref().take(length).read_to_end(&mut frame)?;
    }
    Ok(frame)
}

/// Places and lengths of the next items' contents, `limit` at most.
fn items<S: Read + Seek>(
    source: &mut S,
    size: u64,
    limit: usize,
) -> Result<Vec<(u64, u64)>, FileError> {
    let mut found = Vec::new();
    let mut at = source.stream_position()?;
    while found.len() < limit {
        let mut header = [0; 8];
        at += 8;
        if at > size {
            // The closing delimiter is missing: what is there may still be whole.
            break;
        }
        source.read_exact(&mut header)?;
        let [tag @ .., a, b, c, d] = header;
        if tag != ITEM {
            break;
        }
        let length = u64::from(u32::from_le_bytes([a, b, c, d]));
        let needed = at + length;
        if needed > size {
            let found = size;
            return Err(FileError::CutOff { needed, found });
        }
        found.push((at, length));
        source.seek_relative(length as i64)?;
        at += length;
    }
    Ok(found)
}

fn offset_table<S: Read + Seek>(
    source: &mut S,
    at: u64,
    length: u64,
) -> Result<Vec<u32>, FileError> {
    source.seek(SeekFrom::Start(at))?;
    let mut bytes = Vec::new();
    source.by_ref().take(length).read_to_end(&mut bytes)?;
    let (offsets, _) = bytes.as_chunks::<4>();
    Ok(offsets.iter().map(|o| u32::from_le_bytes(*o)).collect())
}

fn decompress(
    frame: Vec<u8>,
    syntax: &TransferSyntax,
    layout: &Layout,
) -> Result<Vec<u8>, FileError> {
    let named = |why: &str| {
        let (name, uid) = (syntax.name(), syntax.uid());
        FileError::Codec(format!("{name}, {uid}: {why}"))
    };
    check_size(&frame, syntax, layout).map_err(|why| named(&why))?;
    if is_jpeg_ls(syntax.uid()) {
        let samples = jpeg_ls::decode(&frame, layout.rows, layout.columns).map_err(named)?;
        let width = layout.bits_allocated as usize / 8;
        return Ok(samples
            .iter()
            .flat_map(|v| v.to_le_bytes().into_iter().take(width))
            .collect());
    }
    let reader = syntax
        .pixel_data_reader()
        .ok_or_else(|| named("not supported"))?;
    let single = SingleFrame {
        syntax_uid: syntax.uid(),
        layout,
        frame,
    };
    let mut bytes = Vec::new();
    // The decoders are written for honest input; a panic in one costs this slice, nothing else.
    let decoded = catch_unwind(AssertUnwindSafe(|| {
        reader.decode_frame(&single, 0, &mut bytes)
    }));
    match decoded {
        Ok(Ok(())) if bytes.len() as u64 == layout.frame_bytes() => Ok(bytes),
        Ok(Ok(())) => Err(named("another size than the header says")),
        Ok(Err(error)) => Err(named(&error.to_string())),
        Err(_) => Err(named("damaged")),
    }
}

fn check_size(frame: &[u8], syntax: &TransferSyntax, layout: &Layout) -> Result<(), String> {
    let (rows, columns) = (layout.rows, layout.columns);
    if rows * columns > MAX_COMPRESSED_PIXELS {
        return Err(format!("{rows} x {columns} pixels are too many"));
    }
    if syntax.uid() == uids::RLE_LOSSLESS {
        return Ok(());
    }
    let declared = declared(frame).ok_or("no frame header")?;
    if (declared.rows as usize, declared.columns as usize) != (rows, columns) {
        return Err(format!(
            "{} x {} pixels where the header says {rows} x {columns}",
            declared.rows, declared.columns
        ));
    }
    let bytes = declared.bits.div_ceil(8);
    if declared.components != 1 || bytes != layout.bits_allocated / 8 {
        return Err(format!(
            "{} components of {} bits where the header says one of {}",
            declared.components, declared.bits, layout.bits_allocated
        ));
    }
    Ok(())
}

/// One compressed frame as the decoders want to see it.
struct SingleFrame<'a> {
    syntax_uid: &'a str,
    layout: &'a Layout,
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
        u16::try_from(self.layout.bits_allocated).ok()
    }

    fn bits_stored(&self) -> Option<u16> {
        u16::try_from(self.layout.bits_stored).ok()
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
