//! The bits of a scan, and the codes they form.

use super::DAMAGED;

/// The scan, bit by bit.
pub(super) struct Bits<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Bits read and not yet taken, in the lower end.
    held: u64,
    count: u32,
    is_after_ff: bool,
}

impl<'a> Bits<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            at: 0,
            held: 0,
            count: 0,
            is_after_ff: false,
        }
    }

    /// Holds 32 bits or more, fewer at the end of the scan.
    fn fill(&mut self) {
        while self.count <= 48 {
            let Some(byte) = self.bytes.get(self.at) else {
                return;
            };
            // After 0xff one bit is stuffed; were it 1, this would be a marker, the scan's end.
            if self.is_after_ff && *byte >= 0x80 {
                return;
            }
            let bits = if self.is_after_ff { 7 } else { 8 };
            self.held = self.held << bits | u64::from(*byte);
            self.count += bits;
            self.is_after_ff = *byte == 0xff;
            self.at += 1;
        }
    }

    /// The next `count` bits, 32 at most.
    pub(super) fn take(&mut self, count: u32) -> Result<u32, &'static str> {
        if self.count < count {
            self.fill();
        }
        self.count = self.count.checked_sub(count).ok_or(DAMAGED)?;
        let mask = (1_u64 << count) - 1;
        Ok((self.held >> self.count & mask) as u32)
    }

    /// A Golomb code of parameter `k` and bounded length (A.5.3).
    pub(super) fn golomb(&mut self, k: u32, limit: u32, qbpp: u32) -> Result<u32, &'static str> {
        let longest = limit.checked_sub(qbpp + 1).ok_or(DAMAGED)?;
        let mut zeros = 0;
        while self.take(1)? == 0 {
            zeros += 1;
            if zeros > longest {
                return Err(DAMAGED);
            }
        }
        if zeros < longest {
            Ok(zeros << k | self.take(k)?)
        } else {
            Ok(self.take(qbpp)? + 1)
        }
    }
}
