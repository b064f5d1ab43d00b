//! JPEG-LS, lossless and near-lossless, one component (ITU-T T.87, the numbers below are its).
//!
//! 1. [`Parameters::read`]: segments up to the scan (C.2).
//! 2. [`Decoder::line`]: each sample from its four neighbours, in regular mode (A.4 to A.6) or,
//!    where these are equal, in run mode (A.7).
//! 3. [`Bits`]: bits of the scan without the stuffing after `0xff` (A.1), and Golomb codes (A.5.3).
//!
//! Written for this crate: the codec that dicom-rs can use needs a C++ compiler and more tools.

mod bits;
mod parameters;

use std::cmp::Ordering;

use bits::Bits;
use parameters::Parameters;

/// Lengths of runs, as powers of two (A.2.1).
const J: [u32; 32] = [
    0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 9, 10, 11, 12, 13,
    14, 15,
];

/// Contexts of regular mode; two more are those of run interruptions.
const REGULAR: usize = 365;

const DAMAGED: &str = "damaged JPEG-LS data";

/// Decodes a frame of `rows` x `columns` samples, whose size the caller has compared.
pub(crate) fn decode(bytes: &[u8], rows: usize, columns: usize) -> Result<Vec<u16>, &'static str> {
    let (parameters, scan) = Parameters::read(bytes)?;
    let mut decoder = Decoder::new(&parameters, scan);
    let mut samples = Vec::with_capacity(rows * columns);
    // One sample more at each end: what lies left of the first and right of the last (A.2.1).
    let mut above = vec![0; columns + 2];
    for _ in 0..rows {
        let mut line = vec![0; columns + 2];
        line[0] = above[1];
        above[columns + 1] = above[columns];
        decoder.line(&above, &mut line, columns)?;
        samples.extend(line[1..=columns].iter().map(|v| *v as u16));
        above = line;
    }
    Ok(samples)
}

/// Statistics of one context (A.2.1).
#[derive(Clone, Copy)]
struct Context {
    /// Sum of the errors' magnitudes.
    a: i32,
    /// Bias; in run interruptions the count of negative errors.
    b: i32,
    /// Correction of the prediction.
    c: i32,
    /// Occurrences.
    n: i32,
}

impl Context {
    fn golomb(self, magnitude: i32) -> u32 {
        let mut k = 0;
        while k < 24 && i64::from(self.n) << k < i64::from(magnitude) {
            k += 1;
        }
        k
    }
}

struct Decoder<'a> {
    parameters: &'a Parameters,
    bits: Bits<'a>,
    contexts: [Context; REGULAR + 2],
    run_index: usize,
    range: i32,
    /// Bits of an error that is not Golomb coded.
    qbpp: u32,
    limit: u32,
}

impl<'a> Decoder<'a> {
    fn new(parameters: &'a Parameters, scan: &'a [u8]) -> Self {
        let Parameters { max, near, .. } = *parameters;
        let range = (max + 2 * near) / (2 * near + 1) + 1;
        let bits_for = |values: i32| 32 - (values - 1).leading_zeros();
        let bpp = bits_for(max + 1).max(2);
        let context = Context {
            a: ((range + 32) / 64).max(2),
            b: 0,
            c: 0,
            n: 1,
        };
        Self {
            parameters,
            bits: Bits::new(scan),
            contexts: [context; REGULAR + 2],
            run_index: 0,
            range,
            qbpp: bits_for(range),
            limit: 2 * (bpp + bpp.max(8)),
        }
    }

    /// Decodes one line; both lines have one sample more at each end.
    fn line(
        &mut self,
        above: &[i32],
        line: &mut [i32],
        columns: usize,
    ) -> Result<(), &'static str> {
        let near = self.parameters.near;
        let mut i = 1;
        while i <= columns {
            let (ra, rb, rc, rd) = (line[i - 1], above[i], above[i - 1], above[i + 1]);
            let gradients = [rd - rb, rb - rc, rc - ra];
            if gradients.iter().all(|d| d.abs() <= near) {
                i = self.run(above, line, i, columns)?;
            } else {
                line[i] = self.regular(ra, rb, rc, gradients)?;
                i += 1;
            }
        }
        Ok(())
    }

    fn quantized(&self, d: i32) -> i32 {
        let [t1, t2, t3] = self.parameters.thresholds;
        let size = d.abs();
        let level = if size <= self.parameters.near {
            0
        } else if size < t1 {
            1
        } else if size < t2 {
            2
        } else if size < t3 {
            3
        } else {
            4
        };
        level * d.signum()
    }

    fn regular(&mut self, ra: i32, rb: i32, rc: i32, d: [i32; 3]) -> Result<i32, &'static str> {
        let [q1, q2, q3] = d.map(|d| self.quantized(d));
        let q = 81 * q1 + 9 * q2 + q3;
        let sign = if q < 0 { -1 } else { 1 };
        let at = q.unsigned_abs() as usize;
        let context = self.contexts[at];
        let (low, high) = (ra.min(rb), ra.max(rb));
        let predicted = if rc >= high {
            low
        } else if rc <= low {
            high
        } else {
            ra + rb - rc
        };
        let predicted = (predicted + sign * context.c).clamp(0, self.parameters.max);
        let k = context.golomb(context.a);
        let code = self.code(k, self.limit)?;
        let is_flipped = self.parameters.near == 0 && k == 0 && 2 * context.b <= -context.n;
        let half = code >> 1;
        let error = match (code & 1 == 1, is_flipped) {
            (false, false) | (true, true) => half,
            (true, false) | (false, true) => -half - 1,
        };
        self.update(at, error);
        Ok(self.restored(predicted, sign * error))
    }

    /// The next coded error, which no sound encoder makes larger than the range of errors.
    fn code(&mut self, k: u32, limit: u32) -> Result<i32, &'static str> {
        let code = self.bits.golomb(k, limit, self.qbpp)? as i32;
        (code <= 2 * self.range + 1).then_some(code).ok_or(DAMAGED)
    }

    /// Statistics and bias after an error (A.6).
    fn update(&mut self, at: usize, error: i32) {
        let step = 2 * self.parameters.near + 1;
        let Context { a, b, c, n } = &mut self.contexts[at];
        *b += error * step;
        // Only damaged data come near the limits.
        *a = a.saturating_add(error.abs());
        if *n == self.parameters.reset {
            *a >>= 1;
            *b >>= 1;
            *n >>= 1;
        }
        *n += 1;
        if *b <= -*n {
            *b = (*b + *n).max(1 - *n);
            *c = (*c - 1).max(-128);
        } else if *b > 0 {
            *b = (*b - *n).min(0);
            *c = (*c + 1).min(127);
        }
    }

    /// Prediction and error to a sample, modulo the range of errors (A.4.5).
    fn restored(&self, predicted: i32, error: i32) -> i32 {
        let Parameters { max, near, .. } = *self.parameters;
        let step = 2 * near + 1;
        let value = predicted + error * step;
        let wrapped = if value < -near {
            value + self.range * step
        } else if value > max + near {
            value - self.range * step
        } else {
            value
        };
        wrapped.clamp(0, max)
    }

    /// A run from sample `i` and the sample that ends it (A.7); gives the next sample's number.
    fn run(
        &mut self,
        above: &[i32],
        line: &mut [i32],
        mut i: usize,
        columns: usize,
    ) -> Result<usize, &'static str> {
        let value = line[i - 1];
        while self.bits.take(1)? == 1 {
            let length = 1_usize << J[self.run_index];
            let end = (i + length).min(columns + 1);
            line[i..end].fill(value);
            if i + length == end {
                self.run_index = (self.run_index + 1).min(J.len() - 1);
            }
            i = end;
            if i > columns {
                return Ok(i);
            }
        }
        let length = self.bits.take(J[self.run_index])? as usize;
        if i + length > columns {
            return Err(DAMAGED);
        }
        line[i..i + length].fill(value);
        i += length;
        line[i] = self.interruption(value, above[i])?;
        self.run_index = self.run_index.saturating_sub(1);
        Ok(i + 1)
    }

    fn interruption(&mut self, ra: i32, rb: i32) -> Result<i32, &'static str> {
        let is_flat = (ra - rb).abs() <= self.parameters.near;
        let kind = i32::from(is_flat);
        let at = REGULAR + usize::from(is_flat);
        let context = self.contexts[at];
        let magnitude = context.a + kind * (context.n >> 1);
        let k = context.golomb(magnitude);
        let limit = self.limit - J[self.run_index] - 1;
        let code = self.code(k, limit)?;
        let odd = (code + kind) & 1;
        let size = (code + kind + odd) / 2;
        let is_negative = (k != 0 || 2 * context.b >= context.n) == (odd == 1);
        let error = if is_negative { -size } else { size };
        let Context { a, b, n, .. } = &mut self.contexts[at];
        *b += i32::from(error < 0);
        *a = a.saturating_add((code + 1 - kind) >> 1);
        if *n == self.parameters.reset {
            *a >>= 1;
            *b >>= 1;
            *n >>= 1;
        }
        *n += 1;
        Ok(match (is_flat, ra.cmp(&rb)) {
            (true, _) => self.restored(ra, error),
            (false, Ordering::Greater) => self.restored(rb, -error),
            (false, _) => self.restored(rb, error),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// One component of 8 bits, 4 x 4 samples, near-lossless by `near`.
    fn frame(near: u8, scan: &[u8]) -> Vec<u8> {
        let mut bytes = vec![0xff, 0xd8, 0xff, 0xf7, 0, 11, 8, 0, 4, 0, 4, 1, 1, 0x11, 0];
        bytes.extend([0xff, 0xda, 0, 8, 1, 1, 0, near, 0, 0]);
        bytes.extend(scan);
        bytes
    }

    #[test]
    fn the_standards_example_is_decoded() {
        // T.87 annex H.3.
        let scan = [
            0xc0, 0x00, 0x00, 0x6c, 0x80, 0x20, 0x8e, 0x01, 0xc0, 0x00, 0x00, 0x57, 0x40, 0x00,
            0x00, 0x6e, 0xe6, 0x00, 0x00, 0x01, 0xbc, 0x18, 0x00, 0x00, 0x05, 0xd8, 0x00, 0x00,
            0x91, 0x60, 0xff, 0xd9,
        ];
        let expected = [
            0, 0, 90, 74, 68, 50, 43, 205, 64, 145, 145, 145, 100, 145, 145, 145,
        ];
        assert_eq!(decode(&frame(0, &scan), 4, 4).unwrap(), expected);
    }

    #[test]
    fn a_scan_that_ends_early_is_damaged() {
        assert_eq!(decode(&frame(0, &[0xc0, 0x00]), 4, 4), Err(DAMAGED));
        assert_eq!(decode(&[0xff, 0xd8], 4, 4), Err(DAMAGED));
    }

    proptest! {
        #[test]
        fn no_scan_panics(
            near in 0..130_u8,
            scan in proptest::collection::vec(any::<u8>(), 0..200),
            presets in proptest::option::of(proptest::array::uniform10(any::<u8>())),
        ) {
            let mut bytes = frame(near, &scan);
            if let Some(presets) = presets {
                let segment = [0xff, 0xf8, 0, 13, 1].into_iter().chain(presets);
                bytes.splice(2..2, segment);
            }
            if let Ok(samples) = decode(&bytes, 40, 40) {
                prop_assert_eq!(samples.len(), 1600);
            }
        }
    }
}
