//! The format of a file by its first bytes.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use crate::data::regular_file_size;
use crate::error::VolumeFileError;
use crate::gzip::{MAGIC, Members};

/// Bytes of the longest header of fixed size (`NIfTI-2`).
const HEAD: u64 = 540;

/// Compressed bytes that may come before the head: a gzip header's comment has no limit.
const MAX_COMPRESSED: u64 = 1 << 16;

/// Bytes of a `NIfTI-1` header, also ANALYZE's.
pub(crate) const NIFTI_1: usize = 348;
/// Bytes of a `NIfTI-2` header.
pub(crate) const NIFTI_2: usize = 540;

/// What the first bytes say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Nifti1 { has_pair: bool },
    Nifti2 { has_pair: bool },
    Analyze,
    Nrrd,
}

/// The first bytes of a file, decompressed.
pub(crate) struct Head {
    pub(crate) format: Format,
    pub(crate) is_gzip: bool,
    pub(crate) bytes: Vec<u8>,
}

/// Looks at the first bytes; `None` where they are of no known format.
pub(crate) fn sniff(path: &Path) -> Result<Option<Head>, VolumeFileError> {
    regular_file_size(path)?;
    let io = |e: io::Error| VolumeFileError::io(path, &e);
    let mut file = BufReader::new(File::open(path).map_err(io)?.take(MAX_COMPRESSED));
    let is_gzip = io::BufRead::fill_buf(&mut file)
        .map_err(io)?
        .starts_with(&MAGIC);
    let mut bytes = Vec::new();
    if is_gzip {
        // What cannot be inflated is no header; what came before the damage may be one.
        let _ = Members::new(file).take(HEAD).read_to_end(&mut bytes);
    } else {
        file.take(HEAD).read_to_end(&mut bytes).map_err(io)?;
    }
    Ok(format(&bytes, is_gzip).map(|format| Head {
        format,
        is_gzip,
        bytes,
    }))
}

/// What keeps a file of no known format from having a header at all.
pub(crate) fn damage(path: &Path) -> Option<&'static str> {
    let mut file = BufReader::new(File::open(path).ok()?.take(MAX_COMPRESSED));
    let begin = io::BufRead::fill_buf(&mut file).ok()?;
    if begin.is_empty() {
        return Some("it is empty");
    }
    if !begin.starts_with(&MAGIC) {
        return None;
    }
    let inflated = Members::new(file).take(HEAD).read_to_end(&mut Vec::new());
    inflated.err().map(|_| "its gzip data cannot be inflated")
}

fn format(bytes: &[u8], is_gzip: bool) -> Option<Format> {
    if !is_gzip && bytes.starts_with(b"NRRD000") {
        return Some(Format::Nrrd);
    }
    let size: [u8; 4] = bytes.first_chunk().copied()?;
    let sizes = [u32::from_le_bytes(size), u32::from_be_bytes(size)];
    let is = |size: usize| sizes.contains(&(size as u32)) && bytes.len() >= size;
    if is(NIFTI_2) {
        return match &bytes[4..12] {
            b"n+2\0\r\n\x1a\n" => Some(Format::Nifti2 { has_pair: false }),
            b"ni2\0\r\n\x1a\n" => Some(Format::Nifti2 { has_pair: true }),
            _ => None,
        };
    }
    if is(NIFTI_1) {
        return match &bytes[344..348] {
            b"n+1\0" => Some(Format::Nifti1 { has_pair: false }),
            b"ni1\0" => Some(Format::Nifti1 { has_pair: true }),
            // The predecessor has no magic, but this letter in every file.
            _ if bytes[38] == b'r' => Some(Format::Analyze),
            _ => None,
        };
    }
    None
}
