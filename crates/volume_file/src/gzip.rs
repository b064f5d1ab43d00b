//! Gzip files of one or several members.

use std::io::{self, BufRead, Read};

use flate2::bufread::GzDecoder;

/// First bytes of a gzip member.
pub(crate) const MAGIC: [u8; 2] = [0x1f, 0x8b];

/// The most bytes that one byte of gzip can hold.
pub(crate) const MAX_RATIO: u64 = 1032;

/// The content of all members, one after the other.
///
/// Bytes after the last member that start no further one are ignored: some writers pad.
pub(crate) struct Members<R> {
    /// `None` after the last member.
    current: Option<GzDecoder<R>>,
}

impl<R: BufRead> Members<R> {
    pub(crate) fn new(file: R) -> Self {
        Self {
            current: Some(GzDecoder::new(file)),
        }
    }
}

impl<R: BufRead> Read for Members<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if buffer.is_empty() {
            return Ok(0);
        }
        while let Some(member) = &mut self.current {
            let count = member.read(buffer)?;
            if count > 0 {
                return Ok(count);
            }
            let next = self.current.take().map(GzDecoder::into_inner);
            if let Some(mut file) = next
                && file.fill_buf()?.starts_with(&MAGIC)
            {
                self.current = Some(GzDecoder::new(file));
            }
        }
        Ok(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::io::Write;

    fn member(text: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(text).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn all_members_are_read_and_padding_is_not() {
        let file = [member(b"left"), member(b""), member(b"right"), vec![0; 600]].concat();
        let mut text = String::new();
        Members::new(&file[..]).read_to_string(&mut text).unwrap();
        assert_eq!(text, "leftright");
    }

    #[test]
    fn a_wrong_checksum_is_found() {
        let mut file = member(b"left");
        let crc = file.len() - 8;
        file[crc] ^= 1;
        assert!(
            Members::new(&file[..])
                .read_to_end(&mut Vec::new())
                .is_err()
        );
    }
}
