//! Numbers written as text, as the bytes of 64-bit floating point numbers.

use std::io::{self, BufRead, Read};

/// Longest number that is read; far more digits than any has.
const MAX_DIGITS: usize = 64;

/// Reads white space or commas between numbers; gives little-endian `f64`s.
pub(crate) struct Numbers<R> {
    text: R,
    /// Bytes of the number that was read last.
    bytes: [u8; 8],
    /// How many of them were given away.
    given: usize,
}

impl<R: BufRead> Numbers<R> {
    pub(crate) fn new(text: R) -> Self {
        Self {
            text,
            bytes: [0; 8],
            given: 8,
        }
    }

    /// The next number, or `None` at the end of the text.
    fn next(&mut self) -> io::Result<Option<f64>> {
        let mut digits = Vec::with_capacity(MAX_DIGITS);
        loop {
            let ready = self.text.fill_buf()?;
            if ready.is_empty() {
                break;
            }
            let (mut used, mut is_done) = (0, false);
            for byte in ready {
                used += 1;
                if !is_separator(*byte) {
                    digits.push(*byte);
                } else if !digits.is_empty() {
                    is_done = true;
                }
                if is_done || digits.len() > MAX_DIGITS {
                    break;
                }
            }
            self.text.consume(used);
            if is_done || digits.len() > MAX_DIGITS {
                break;
            }
        }
        if digits.is_empty() {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&digits);
        match text.parse() {
            Ok(number) if digits.len() <= MAX_DIGITS => Ok(Some(number)),
            _ => Err(io::Error::new(
                io::ErrorKind::InvalidData,
                format!("`{}` is no number", text.escape_debug()),
            )),
        }
    }
}

fn is_separator(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == b','
}

impl<R: BufRead> Read for Numbers<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut filled = 0;
        while filled < buffer.len() {
            if self.given == self.bytes.len() {
                let Some(number) = self.next()? else { break };
                self.bytes = number.to_le_bytes();
                self.given = 0;
            }
            let count = (buffer.len() - filled).min(self.bytes.len() - self.given);
            buffer[filled..filled + count]
                .copy_from_slice(&self.bytes[self.given..self.given + count]);
            self.given += count;
            filled += count;
        }
        Ok(filled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(text: &str) -> io::Result<Vec<f64>> {
        let mut bytes = Vec::new();
        // A tiny buffer, so that numbers run across its ends.
        Numbers::new(io::BufReader::with_capacity(3, text.as_bytes())).read_to_end(&mut bytes)?;
        Ok(bytes
            .as_chunks()
            .0
            .iter()
            .map(|b| f64::from_le_bytes(*b))
            .collect())
    }

    #[test]
    fn numbers_are_read_across_lines_and_commas() {
        assert_eq!(
            numbers("\n-1000, 1.5e2\t+7\r\n40000").unwrap(),
            [-1000.0, 150.0, 7.0, 40000.0]
        );
        assert!(numbers(" \n").unwrap().is_empty());
    }

    #[test]
    fn what_is_no_number_is_named() {
        assert!(numbers("1 two").unwrap_err().to_string().contains("`two`"));
        assert!(numbers(&"9".repeat(1000)).is_err());
    }
}
