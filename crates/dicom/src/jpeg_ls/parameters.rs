//! What comes before the scan: sizes, presets, thresholds.

use super::DAMAGED;

/// What the segments before the scan set (C.2.4).
pub(super) struct Parameters {
    pub(super) max: i32,
    pub(super) near: i32,
    pub(super) thresholds: [i32; 3],
    pub(super) reset: i32,
}

impl Parameters {
    /// The parameters, and the scan that follows them.
    pub(super) fn read(bytes: &[u8]) -> Result<(Self, &[u8]), &'static str> {
        let mut at = 2;
        let mut bits = 0;
        let mut preset = [0; 5];
        loop {
            let [0xff, marker] = *bytes.get(at..at + 2).ok_or(DAMAGED)? else {
                return Err(DAMAGED);
            };
            let length = number(bytes, at + 2)? as usize;
            let end = at + 2 + length;
            let content = bytes.get(at + 4..end).ok_or(DAMAGED)?;
            match marker {
                0xf7 => bits = u32::from(*content.first().ok_or(DAMAGED)?),
                0xf8 if content.first() == Some(&1) => {
                    for (i, value) in preset.iter_mut().enumerate() {
                        *value = number(content, 1 + 2 * i)?;
                    }
                }
                0xf8 => return Err("JPEG-LS mapping tables are not supported"),
                0xdd => return Err("JPEG-LS restart intervals are not supported"),
                0xda => {
                    let [1, _, 0, near, ..] = *content else {
                        return Err("JPEG-LS with several components is not supported");
                    };
                    let parameters = Self::new(bits, i32::from(near), preset)?;
                    return Ok((parameters, &bytes[end..]));
                }
                _ => {}
            }
            at = end;
        }
    }

    /// Presets, and defaults where they are 0 (C.2.4.1.1).
    fn new(bits: u32, near: i32, preset: [i32; 5]) -> Result<Self, &'static str> {
        if !(2..=16).contains(&bits) {
            return Err(DAMAGED);
        }
        let [max, t1, t2, t3, reset] = preset;
        let max = if max == 0 { (1 << bits) - 1 } else { max };
        if max >= 1 << bits || near > 255.min(max / 2) {
            return Err(DAMAGED);
        }
        let (a, b, c) = if max >= 128 {
            let factor = (max.min(4095) + 128) >> 8;
            (factor + 2, factor * 4 + 3, factor * 17 + 4)
        } else {
            let factor = 256 / (max + 1);
            (
                (3 / factor).max(2),
                (7 / factor).max(3),
                (21 / factor).max(4),
            )
        };
        let clamped = |value: i32, least: i32| {
            if value > max || value < least {
                least
            } else {
                value
            }
        };
        let or = |preset: i32, default: i32| if preset == 0 { default } else { preset };
        let t1 = or(t1, clamped(a + 3 * near, near + 1));
        let t2 = or(t2, clamped(b + 5 * near, t1));
        let t3 = or(t3, clamped(c + 7 * near, t2));
        let reset = or(reset, 64);
        if reset < 3 {
            return Err(DAMAGED);
        }
        Ok(Self {
            max,
            near,
            thresholds: [t1, t2, t3],
            reset,
        })
    }
}

fn number(bytes: &[u8], at: usize) -> Result<i32, &'static str> {
    match bytes.get(at..at + 2) {
        Some([high, low]) => Ok(i32::from(u16::from_be_bytes([*high, *low]))),
        _ => Err(DAMAGED),
    }
}
