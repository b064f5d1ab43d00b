//! From the bytes of one file to its elements: preamble, file meta information, deflation.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use dicom_dictionary_std::{tags, uids};
use dicom_encoding::transfer_syntax::{Codec, Endianness, TransferSyntax, TransferSyntaxIndex};
use dicom_transfer_syntax_registry::TransferSyntaxRegistry;

use crate::elements::Elements;
use crate::error::FileError;
use crate::inflated::Inflated;

/// Bytes fetched at once: most CT headers fit, so that a header costs one system call.
const BUFFER: usize = 16 * 1024;

static REGISTRY: TransferSyntaxRegistry = TransferSyntaxRegistry;

/// A file's elements and the form they are in.
pub(crate) struct Parsed {
    pub(crate) elements: Elements,
    pub(crate) syntax: &'static TransferSyntax,
    /// Where the data set begins in the file.
    pub(crate) start: u64,
    /// Where the data set ends: the file's size, or how far it inflates.
    pub(crate) size: u64,
    /// Bytes that the data set takes in the file.
    pub(crate) stored: u64,
}

/// The transfer syntax of a UID.
pub(crate) fn syntax(uid: &str) -> Result<&'static TransferSyntax, FileError> {
    REGISTRY
        .get(uid)
        .ok_or_else(|| FileError::UnknownSyntax(uid.to_owned()))
}

/// Reads the header of one file: everything before its pixels.
pub(crate) fn parse(path: &Path) -> Result<Parsed, FileError> {
    // Opening a pipe would wait for somebody to write into it.
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(FileError::Special);
    }
    let size = metadata.len();
    if size == 0 {
        return Err(FileError::Empty);
    }
    let mut file = BufReader::with_capacity(BUFFER, File::open(path)?);
    let (syntax, start) = beginning(&mut file, size)?;
    if let Codec::Dataset(_) = syntax.codec() {
        let mut source = inflated(file, syntax, start)?;
        let limit = source.limit();
        let (elements, at) = Elements::read(&mut source, syntax, 0, limit, None)?;
        let pixels = elements.pixels.and_then(|p| p.length).unwrap_or(0);
        let (stored, size) = (size, at + source.count(pixels));
        return Ok(Parsed {
            elements,
            syntax,
            start,
            size,
            stored: stored - start,
        });
    }
    let form = form(&mut file, syntax, start)?;
    let (elements, _) = Elements::read(&mut file, form, start, size, None)?;
    Ok(Parsed {
        elements,
        syntax,
        start,
        size,
        stored: size - start,
    })
}

/// The form in which the elements are really written, and the file back at `start`.
///
/// Some writers copy elements of implicit VR under a transfer syntax that says explicit, or the
/// other way round: what stands behind the first tag, a VR or a length, does not lie.
fn form(
    file: &mut BufReader<File>,
    syntax: &'static TransferSyntax,
    start: u64,
) -> Result<&'static TransferSyntax, FileError> {
    let mut first = Vec::with_capacity(8);
    file.by_ref().take(8).read_to_end(&mut first)?;
    file.seek(SeekFrom::Start(start))?;
    let is_little = syntax.endianness() == Endianness::Little;
    let written = bare_syntax(&first).filter(|_| is_little);
    let said = if syntax.uid() == uids::IMPLICIT_VR_LITTLE_ENDIAN {
        uids::IMPLICIT_VR_LITTLE_ENDIAN
    } else {
        uids::EXPLICIT_VR_LITTLE_ENDIAN
    };
    match written {
        Some(uid) if uid != said => self::syntax(uid),
        _ => Ok(syntax),
    }
}

/// `length` bytes from `begin` of the data set of a deflated file, which begins at `start`.
pub(crate) fn inflated_part(
    file: File,
    syntax: &TransferSyntax,
    start: u64,
    begin: u64,
    length: u64,
) -> Result<Vec<u8>, FileError> {
    inflated(BufReader::new(file), syntax, start)?.part(begin, length)
}

fn inflated(
    mut file: BufReader<File>,
    syntax: &TransferSyntax,
    start: u64,
) -> Result<Inflated, FileError> {
    let Codec::Dataset(Some(adapter)) = syntax.codec() else {
        return Err(FileError::Codec(format!(
            "{} ({})",
            syntax.name(),
            syntax.uid()
        )));
    };
    let deflated = file.seek(SeekFrom::End(0))?.saturating_sub(start);
    file.seek(SeekFrom::Start(start))?;
    Ok(Inflated::new(
        adapter.adapt_reader(Box::new(file)),
        deflated,
    ))
}

/// Finds the transfer syntax and the place where the data set begins, and goes there.
fn beginning(
    file: &mut BufReader<File>,
    size: u64,
) -> Result<(&'static TransferSyntax, u64), FileError> {
    let mut head = Vec::with_capacity(132);
    file.by_ref().take(132).read_to_end(&mut head)?;
    let meta_at = if head.len() == 132 && head.ends_with(b"DICM") {
        132
    } else if head.starts_with(b"DICM") {
        4
    } else if head.starts_with(&[2, 0]) {
        0
    } else {
        let uid = bare_syntax(&head).ok_or(FileError::NotDicom)?;
        file.seek(SeekFrom::Start(0))?;
        return Ok((syntax(uid)?, 0));
    };
    file.seek(SeekFrom::Start(meta_at))?;
    let explicit = syntax(uids::EXPLICIT_VR_LITTLE_ENDIAN)?;
    let (meta, start) = Elements::read(file, explicit, meta_at, size, Some(2))
        .map_err(|_| FileError::Header("file meta information"))?;
    let uid = meta
        .text(tags::TRANSFER_SYNTAX_UID)
        .ok_or(FileError::Header("no transfer syntax"))?;
    Ok((syntax(&uid)?, start))
}

/// The transfer syntax of a data set without preamble and file meta information.
///
/// Such a data set begins with a short element of group 0008, which is all that tells it from
/// any other file; a VR of two capitals after the tag makes it explicit.
fn bare_syntax(head: &[u8]) -> Option<&'static str> {
    let (tag, rest) = head.split_at_checked(4)?;
    let length: [u8; 4] = rest.get(..4)?.try_into().ok()?;
    if tag[..2] != [8, 0] || tag[3] != 0 {
        return None;
    }
    if length[..2].iter().all(u8::is_ascii_uppercase) {
        return Some(uids::EXPLICIT_VR_LITTLE_ENDIAN);
    }
    (u32::from_le_bytes(length) < 1024).then_some(uids::IMPLICIT_VR_LITTLE_ENDIAN)
}
