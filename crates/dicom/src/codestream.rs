//! Sizes that a compressed frame declares, looked up before a decoder believes them.

/// How a codestream was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Process {
    /// JPEG, lossy.
    Dct,
    /// JPEG, lossless.
    Lossless,
    JpegLs,
    Jpeg2000,
}

/// What a JPEG, JPEG-LS or JPEG 2000 codestream says about itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Declared {
    pub(crate) rows: u32,
    pub(crate) columns: u32,
    pub(crate) bits: u32,
    pub(crate) components: u32,
    pub(crate) process: Process,
}

/// Whether these are the first bytes of a codestream.
pub(crate) fn begins(bytes: &[u8]) -> bool {
    bytes.starts_with(&JPEG) || bytes.starts_with(&JPEG_2000)
}

/// Start of a JPEG or JPEG-LS image.
const JPEG: [u8; 2] = [0xff, 0xd8];

/// Start of a JPEG 2000 codestream, and of its SIZ segment, which comes first.
const JPEG_2000: [u8; 4] = [0xff, 0x4f, 0xff, 0x51];

/// Start of a JPEG 2000 file, which DICOM forbids and some write.
const JP2: [u8; 8] = [0, 0, 0, 12, b'j', b'P', b' ', b' '];

/// In how many bytes the codestream of a JPEG 2000 file begins.
const JP2_BOXES: usize = 1024;

/// Marker of the segment before the entropy-coded data of a JPEG.
const START_OF_SCAN: u8 = 0xda;

/// Reads what the codestream declares; `None` where it declares nothing that makes sense.
pub(crate) fn declared(bytes: &[u8]) -> Option<Declared> {
    if bytes.starts_with(&JP2) {
        let boxes = &bytes[..bytes.len().min(JP2_BOXES)];
        let at = boxes.windows(4).position(|w| w == JPEG_2000)?;
        return jpeg_2000(&bytes[at..]);
    }
    if bytes.starts_with(&JPEG) {
        return jpeg(bytes);
    }
    jpeg_2000(bytes)
}

fn number(bytes: &[u8], at: usize, length: usize) -> Option<u32> {
    let field = bytes.get(at..at + length)?;
    Some(field.iter().fold(0, |n, b| n << 8 | u32::from(*b)))
}

/// JPEG and JPEG-LS: segments up to the frame header (ITU T.81 B.2.2, T.87 C.2.2).
fn jpeg(bytes: &[u8]) -> Option<Declared> {
    let mut at = 2;
    loop {
        let [0xff, marker] = *bytes.get(at..at + 2)? else {
            return None;
        };
        match marker {
            // A fill byte before a marker.
            0xff => at += 1,
            // All frame headers but those numbers that mean tables.
            0xc0..=0xc3 | 0xc5..=0xc7 | 0xc9..=0xcb | 0xcd..=0xcf | 0xf7 => {
                return Some(Declared {
                    bits: number(bytes, at + 4, 1)?,
                    rows: number(bytes, at + 5, 2)?,
                    columns: number(bytes, at + 7, 2)?,
                    components: number(bytes, at + 9, 1)?,
                    process: match marker {
                        0xf7 => Process::JpegLs,
                        0xc3 | 0xc7 | 0xcb | 0xcf => Process::Lossless,
                        _ => Process::Dct,
                    },
                });
            }
            _ => at += 2 + number(bytes, at + 2, 2)? as usize,
        }
    }
}

/// Puts right the scan of a sequential JPEG, which always has all 64 coefficients whole (ITU
/// T.81 B.2.3): some writers leave the bytes that say so empty, and decoders complain.
///
/// Only of the first scan; an image of one component has one.
pub(crate) fn repair_scan(jpeg: &mut [u8]) {
    let mut at = 2;
    let mut is_sequential = false;
    while let Some(&[0xff, marker]) = jpeg.get(at..at + 2) {
        let Some(length) = number(jpeg, at + 2, 2) else {
            return;
        };
        let end = at + 2 + length as usize;
        match marker {
            0xff => at += 1,
            0xc0 | 0xc1 => (is_sequential, at) = (true, end),
            START_OF_SCAN => {
                // A component, its tables and these three bytes at least.
                if let (true, 8.., Some(last)) = (is_sequential, length, jpeg.get_mut(end - 3..end))
                {
                    last.copy_from_slice(&[0, 63, 0]);
                }
                return;
            }
            _ => at = end,
        }
    }
}

/// JPEG 2000: the SIZ segment (ITU T.800 A.5.1).
fn jpeg_2000(bytes: &[u8]) -> Option<Declared> {
    if !bytes.starts_with(&JPEG_2000) {
        return None;
    }
    let field = |i: usize| number(bytes, 8 + 4 * i, 4);
    Some(Declared {
        columns: field(0)?.checked_sub(field(2)?)?,
        rows: field(1)?.checked_sub(field(3)?)?,
        components: number(bytes, 40, 2)?,
        bits: (number(bytes, 42, 1)? & 0x7f) + 1,
        process: Process::Jpeg2000,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_header_is_found_behind_other_segments() {
        let mut bytes = vec![0xff, 0xd8, 0xff, 0xe0, 0, 4, 9, 9, 0xff];
        bytes.extend([0xff, 0xc3, 0, 11, 16, 0x02, 0x00, 0x01, 0x80, 1, 0, 0x11, 0]);
        let expected = Declared {
            rows: 512,
            columns: 384,
            bits: 16,
            components: 1,
            process: Process::Lossless,
        };
        assert_eq!(declared(&bytes), Some(expected));
    }

    #[test]
    fn only_the_scan_of_a_sequential_jpeg_is_put_right() {
        let jpeg = |frame: u8| {
            let mut bytes = vec![0xff, 0xd8, 0xff, 0xff, frame, 0, 3, 12];
            bytes.extend([0xff, 0xda, 0, 8, 1, 1, 0, 0, 0, 0, 9, 9]);
            bytes
        };
        let mut sequential = jpeg(0xc1);
        repair_scan(&mut sequential);
        assert_eq!(sequential[8..], [0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0, 9, 9]);
        let mut progressive = jpeg(0xc2);
        repair_scan(&mut progressive);
        assert_eq!(progressive, jpeg(0xc2));
        for end in 0..18 {
            let mut broken_off = jpeg(0xc1);
            broken_off.truncate(end);
            let before = broken_off.clone();
            repair_scan(&mut broken_off);
            assert_eq!(broken_off, before);
        }
    }

    #[test]
    fn a_jpeg_2000_size_is_the_extent_without_the_offset() {
        let mut bytes = vec![0xff, 0x4f, 0xff, 0x51, 0, 41, 0, 0];
        for n in [74_u32, 64, 10, 0, 64, 64, 0, 0] {
            bytes.extend(n.to_be_bytes());
        }
        bytes.extend([0, 1, 0x80 | 15, 1, 1]);
        let expected = Declared {
            rows: 64,
            columns: 64,
            bits: 16,
            components: 1,
            process: Process::Jpeg2000,
        };
        assert_eq!(declared(&bytes), Some(expected));
    }

    #[test]
    fn nonsense_and_short_streams_declare_nothing() {
        for bytes in [
            &[][..],
            &[0xff],
            &[0xff, 0xd8],
            &[0xff, 0xd8, 0xff, 0xc3, 0],
            &[0xff, 0x4f, 0xff, 0x51, 0, 41],
            b"hello",
        ] {
            assert_eq!(declared(bytes), None);
        }
    }
}
