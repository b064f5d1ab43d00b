//! Where the voxels lie in which file, and the stream of their bytes.

use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use bonemesh_task::Task;

use crate::error::VolumeFileError;
use crate::gzip::{MAX_RATIO, Members};
use crate::text::Numbers;

/// Bytes skipped between two looks at the task.
const SKIP_AT_ONCE: usize = 1 << 18;

/// Times that no scan can be compressed: noise alone keeps them below 50, label maps mostly below this.
const MAX_SCAN_RATIO: u64 = 200;

/// Bytes of voxels that do no harm even where nothing but zeros was compressed.
const HARMLESS: u64 = 1 << 28;

/// How the bytes of the voxels are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    Raw,
    Gzip,
    /// Written numbers, read as little-endian `f64`s.
    Text,
}

/// The place of the voxels.
#[derive(Clone, Debug)]
pub(crate) struct Data {
    pub(crate) path: PathBuf,
    pub(crate) encoding: Encoding,
    /// Bytes of the file before the stored data.
    pub(crate) start: u64,
    /// Bytes of the decoded data before the voxels.
    pub(crate) skip: u64,
    /// Decoded bytes of all voxels.
    pub(crate) bytes: u64,
}

impl Data {
    /// Compares what the header claims with what a file of this size can hold.
    pub(crate) fn check(&self) -> Result<(), VolumeFileError> {
        let stored = regular_file_size(&self.path)?.saturating_sub(self.start);
        let held = match self.encoding {
            Encoding::Raw => stored,
            Encoding::Gzip => stored.saturating_mul(MAX_RATIO),
            // A number takes a digit and, but for the last, a separator.
            Encoding::Text => stored.div_ceil(2).saturating_mul(8),
        };
        let found = held.saturating_sub(self.skip);
        if found < self.bytes {
            return Err(self.cut_off(found));
        }
        if self.encoding == Encoding::Gzip
            && self.bytes > HARMLESS
            && self.bytes / MAX_SCAN_RATIO > stored
        {
            return Err(VolumeFileError::Inflated {
                path: self.path.clone(),
                needed: self.bytes,
                stored,
            });
        }
        Ok(())
    }

    /// The bytes of the voxels, from the first on.
    pub(crate) fn open(&self, task: &Task) -> Result<Stream<'_>, VolumeFileError> {
        let io = |e: io::Error| VolumeFileError::io(&self.path, &e);
        let mut file = File::open(&self.path).map_err(io)?;
        let is_raw = self.encoding == Encoding::Raw;
        let start = self.start + if is_raw { self.skip } else { 0 };
        file.seek(SeekFrom::Start(start)).map_err(io)?;
        let mut stream = Stream {
            reader: match self.encoding {
                Encoding::Raw => Box::new(file),
                Encoding::Gzip => Box::new(Members::new(BufReader::with_capacity(1 << 16, file))),
                Encoding::Text => Box::new(Numbers::new(BufReader::with_capacity(1 << 16, file))),
            },
            data: self,
            given: 0,
        };
        if !is_raw {
            stream.skip(self.skip, task)?;
        }
        Ok(stream)
    }

    fn cut_off(&self, found: u64) -> VolumeFileError {
        VolumeFileError::CutOff {
            path: self.path.clone(),
            needed: self.bytes,
            found,
        }
    }
}

/// Size of a file that is no folder, pipe or device.
pub(crate) fn regular_file_size(path: &Path) -> Result<u64, VolumeFileError> {
    let metadata = fs::metadata(path).map_err(|e| VolumeFileError::io(path, &e))?;
    if metadata.is_file() {
        Ok(metadata.len())
    } else {
        Err(VolumeFileError::NotAFile(path.to_owned()))
    }
}

/// Decoded bytes of the voxels.
pub(crate) struct Stream<'a> {
    reader: Box<dyn Read + Send>,
    data: &'a Data,
    /// Bytes of voxels given so far.
    given: u64,
}

impl Stream<'_> {
    /// The next bytes: the whole buffer, or less at the end of the voxels; then nothing.
    pub(crate) fn fill(
        &mut self,
        buffer: &mut Vec<u8>,
        at_once: usize,
    ) -> Result<(), VolumeFileError> {
        let left = self.data.bytes - self.given;
        buffer.resize(
            usize::try_from(left).map_or(at_once, |left| left.min(at_once)),
            0,
        );
        let mut filled = 0;
        while filled < buffer.len() {
            let count = self.read(&mut buffer[filled..])?;
            if count == 0 {
                return Err(self.data.cut_off(self.given));
            }
            filled += count;
            self.given += count as u64;
        }
        if filled > 0 && self.given == self.data.bytes && self.data.encoding == Encoding::Gzip {
            // Only who reads beyond the last byte has the checksum compared.
            self.read(&mut [0])?;
        }
        Ok(())
    }

    fn skip(&mut self, mut count: u64, task: &Task) -> Result<(), VolumeFileError> {
        let mut buffer = vec![0; SKIP_AT_ONCE];
        while count > 0 {
            task.check()?;
            let next = usize::try_from(count).map_or(SKIP_AT_ONCE, |n| n.min(SKIP_AT_ONCE));
            let read = self.read(&mut buffer[..next])?;
            if read == 0 {
                return Err(self.data.cut_off(0));
            }
            count -= read as u64;
        }
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, VolumeFileError> {
        loop {
            let error = match self.reader.read(buffer) {
                Ok(count) => return Ok(count),
                Err(error) => error,
            };
            return Err(match error.kind() {
                io::ErrorKind::Interrupted => continue,
                io::ErrorKind::UnexpectedEof => self.data.cut_off(self.given),
                io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput => VolumeFileError::Data {
                    path: self.data.path.clone(),
                    reason: error.to_string(),
                },
                _ => VolumeFileError::io(&self.data.path, &error),
            });
        }
    }
}
