//! The bytes of one frame, uncompressed and little endian.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::OnceLock;

use dicom_encoding::transfer_syntax::{Codec, Endianness, TransferSyntax};

use crate::codec::decompress;
use crate::error::FileError;
use crate::file::{inflated_part, syntax};
use crate::fragments::Index;
use crate::header::{Layout, Storage};

/// Bytes fetched at once between the pieces of compressed pixels: their headers are far apart.
const BUFFER: usize = 512;

/// Compressed bytes of a frame for each of its uncompressed ones: noise grows by an eighth when it
/// is compressed, and 8 bits are sometimes compressed as 16.
const MAX_GROWTH: u64 = 4;

/// Most bytes of a frame beside its pixels: tables, comments, colour profiles.
const MAX_HEADERS: u64 = 1 << 20;

/// Whether pixels stored in this transfer syntax can be decoded.
pub(crate) fn is_readable(syntax_uid: &str) -> bool {
    syntax(syntax_uid).is_ok_and(TransferSyntax::can_decode_all)
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
    match (syntax.codec(), storage.pixels.length) {
        (Codec::Dataset(_), Some(_)) => {
            let length = layout.frame_bytes() as usize;
            let all = inflated(file, syntax, storage, layout)?;
            Ok(all[length * index..][..length].to_vec())
        }
        (Codec::EncapsulatedPixelData(..), None) => {
            let mut file = BufReader::with_capacity(BUFFER, file);
            let most = MAX_GROWTH * layout.frame_bytes() + MAX_HEADERS;
            let frame = indexed(&mut file, storage)?.frame(&mut file, index, most)?;
            decompress(frame, syntax, layout)
        }
        (Codec::EncapsulatedPixelData(..), Some(_)) => {
            Err(FileError::Header("compressed pixels that are not in items"))
        }
        (_, None) => Err(FileError::Header("the pixels have no length")),
        (_, Some(_)) => native(&mut file, syntax, storage, layout, index),
    }
}

/// Where the frames' fragments lie: looked up once a file, not once a frame.
fn indexed<'s, S: Read + Seek>(
    source: &mut S,
    storage: &'s Storage,
) -> Result<&'s Index, FileError> {
    let look = || Index::read(source, storage.pixels.offset, storage.frames);
    once(&storage.fragments, look)
}

/// All frames of a deflated file, which can only be read from its beginning: once a file too.
fn inflated<'s>(
    file: File,
    syntax: &TransferSyntax,
    storage: &'s Storage,
    layout: &Layout,
) -> Result<&'s [u8], FileError> {
    let (begin, length) = (
        storage.pixels.offset,
        layout.frame_bytes() * storage.frames as u64,
    );
    let inflate = || inflated_part(file, syntax, storage.start, begin, length);
    once(&storage.inflated, inflate).map(Vec::as_slice)
}

/// What `make` gives, or why not, made by the first who asks.
fn once<T>(
    place: &OnceLock<Result<T, String>>,
    make: impl FnOnce() -> Result<T, FileError>,
) -> Result<&T, FileError> {
    let made = place.get_or_init(|| make().map_err(|e| e.to_string()));
    made.as_ref().map_err(|why| FileError::Codec(why.clone()))
}

fn native<S: Read + Seek>(
    source: &mut S,
    syntax: &TransferSyntax,
    storage: &Storage,
    layout: &Layout,
    index: usize,
) -> Result<Vec<u8>, FileError> {
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
