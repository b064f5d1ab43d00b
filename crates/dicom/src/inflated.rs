//! A deflated data set, inflated as it is read: nothing is kept that nobody asked for.
//!
//! A few bytes may inflate to a thousand times as many, so neither time nor memory may depend on
//! what comes out of them, only on what is wanted of it.

use std::io::{self, Read, Seek, SeekFrom};

use crate::error::FileError;

/// Most bytes that a byte inflates to: the longest match of deflate, 258 bytes, in 2 bits.
const MAX_RATIO: u64 = 1032;

/// Bytes that are inflated only to be passed over: 65,535 frames with a kilobyte of header each.
const MAX_PASSED: u64 = 64 << 20;

/// Reads forward through what a deflated data set inflates to.
pub(crate) struct Inflated {
    reader: Box<dyn Read>,
    position: u64,
    /// Bytes that the data set cannot inflate beyond.
    limit: u64,
}

impl Inflated {
    /// What `reader` inflates from `deflated` bytes.
    pub(crate) fn new(reader: Box<dyn Read>, deflated: u64) -> Self {
        Self {
            reader,
            position: 0,
            limit: deflated.saturating_mul(MAX_RATIO),
        }
    }

    pub(crate) fn limit(&self) -> u64 {
        self.limit
    }

    /// How many of the next `length` bytes are there; beyond [`MAX_PASSED`] as many as can be.
    pub(crate) fn count(&mut self, length: u64) -> u64 {
        let passed = self.pass(length.min(MAX_PASSED)).unwrap_or(0);
        if passed < MAX_PASSED {
            passed
        } else {
            passed + (length - passed).min(self.limit.saturating_sub(self.position))
        }
    }

    /// `length` bytes from `begin`; memory is asked for as they come.
    pub(crate) fn part(&mut self, begin: u64, length: u64) -> Result<Vec<u8>, FileError> {
        let cut_off = |found| FileError::CutOff {
            needed: begin + length,
            found,
        };
        if self.limit < begin + length {
            return Err(cut_off(self.limit));
        }
        let passed = self.pass(begin).map_err(damaged)?;
        let mut part = Vec::new();
        let read = self.reader.by_ref().take(length).read_to_end(&mut part);
        read.map_err(damaged)?;
        let found = passed + part.len() as u64;
        if found < begin + length {
            return Err(cut_off(found));
        }
        Ok(part)
    }

    fn pass(&mut self, length: u64) -> io::Result<u64> {
        let passed = io::copy(&mut self.reader.by_ref().take(length), &mut io::sink())?;
        self.position += passed;
        Ok(passed)
    }
}

fn damaged(_: io::Error) -> FileError {
    FileError::Header("the deflated data are damaged")
}

impl Read for Inflated {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let read = self.reader.read(into)?;
        self.position += read as u64;
        if self.position > MAX_PASSED {
            return Err(too_much());
        }
        Ok(read)
    }
}

/// Only forward from the current place, which is all that walking over elements needs.
impl Seek for Inflated {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let SeekFrom::Current(length @ 0..) = to else {
            return Err(io::ErrorKind::Unsupported.into());
        };
        if self.position.saturating_add(length as u64) > MAX_PASSED {
            return Err(too_much());
        }
        if self.pass(length as u64)? < length as u64 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Ok(self.position)
    }
}

fn too_much() -> io::Error {
    io::Error::other("its header inflates to more than 64 MiB")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inflated(bytes: &[u8], deflated: u64) -> Inflated {
        Inflated::new(Box::new(io::Cursor::new(bytes.to_vec())), deflated)
    }

    #[test]
    fn a_part_is_what_lies_there() {
        let bytes: Vec<u8> = (0..100).collect();
        assert_eq!(inflated(&bytes, 9).part(10, 3).unwrap(), [10, 11, 12]);
        assert!(matches!(
            inflated(&bytes, 9).part(90, 11),
            Err(FileError::CutOff {
                needed: 101,
                found: 100
            })
        ));
    }

    #[test]
    fn more_than_the_bytes_can_hold_is_not_looked_for() {
        let endless = Inflated::new(Box::new(io::repeat(7)), 10);
        assert_eq!(endless.limit(), 10_320);
        let mut endless = endless;
        assert!(endless.part(0, 10_321).is_err());
        assert_eq!(endless.count(1 << 40), 64 << 20);
    }

    #[test]
    fn passing_over_a_bomb_ends() {
        let mut endless = Inflated::new(Box::new(io::repeat(7)), u64::MAX);
        assert!(endless.seek(SeekFrom::Current(1 << 40)).is_err());
        assert!(io::copy(&mut endless, &mut io::sink()).is_err());
        assert!(endless.position <= MAX_PASSED + (1 << 20));
    }
}
