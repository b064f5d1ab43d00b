//! Whether a frame of RLE (PS3.5 annex G) is whole, looked up before its decoder sees it, which
//! panics where bytes are missing.

use crate::header::Layout;

/// Refuses another number of segments than the pixels have bytes, and segments that are too short.
pub(crate) fn check(frame: &[u8], layout: &Layout) -> Result<(), String> {
    let (head, _) = frame.split_first_chunk::<64>().ok_or("no segments")?;
    let (numbers, _) = head.as_chunks::<4>();
    let numbers: Vec<usize> = numbers
        .iter()
        .map(|n| u32::from_le_bytes(*n) as usize)
        .collect();
    let (declared, needed) = (numbers[0], layout.bits_allocated as usize / 8);
    if declared != needed {
        return Err(format!("{declared} segments where {needed} are needed"));
    }
    let ends = numbers[2..=needed].iter().copied().chain([frame.len()]);
    for (begin, end) in numbers[1..].iter().zip(ends) {
        let segment = frame.get(*begin..end).ok_or("segments beyond the frame")?;
        let (found, pixels) = (expanded(segment), layout.rows * layout.columns);
        if found < pixels {
            return Err(format!(
                "{found} bytes in a segment where {pixels} are needed"
            ));
        }
    }
    Ok(())
}

/// Bytes that a segment expands to.
fn expanded(mut segment: &[u8]) -> usize {
    let mut count = 0;
    while let [control, rest @ ..] = segment {
        let control = control.cast_signed();
        let (bytes, taken) = match control {
            // Says nothing, by definition.
            i8::MIN => (0, 0),
            0.. => {
                let literal = (control as usize + 1).min(rest.len());
                (literal, literal)
            }
            _ if rest.is_empty() => (0, 0),
            _ => (1 + usize::from(control.unsigned_abs()), 1),
        };
        count += bytes;
        segment = &rest[taken..];
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(bits_allocated: u32) -> Layout {
        Layout {
            rows: 2,
            columns: 3,
            bits_allocated,
            bits_stored: bits_allocated,
            high_bit: bits_allocated - 1,
            is_signed: false,
            padding: None,
        }
    }

    fn frame(head: &[u32], segments: &[u8]) -> Vec<u8> {
        let mut numbers = [0; 16];
        numbers[..head.len()].copy_from_slice(head);
        let mut bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        bytes.extend(segments);
        bytes
    }

    #[test]
    fn runs_and_literals_are_counted() {
        assert_eq!(expanded(&[0xfe, 7, 2, 1, 2, 3]), 6);
        assert_eq!(expanded(&[0x80, 0x80, 0x81, 9]), 128);
        assert_eq!(expanded(&[5, 1, 2]), 2);
        assert_eq!(expanded(&[0x81]), 0);
    }

    #[test]
    fn whole_frames_pass_and_others_do_not() {
        let run = [0xfb, 7];
        assert!(check(&frame(&[1, 64], &run), &layout(8)).is_ok());
        assert!(check(&frame(&[2, 64, 66], &[run, run].concat()), &layout(16)).is_ok());
        for (head, segments) in [
            (&[1, 64][..], &[0xfc, 7][..]),
            (&[2, 64, 66], &[0xfb, 7]),
            (&[1, 67], &run),
            (&[u32::MAX, 64], &run),
            (&[0], &run),
        ] {
            assert!(check(&frame(head, segments), &layout(8)).is_err());
        }
        assert!(check(&frame(&[2, 66, 64], &[run, run].concat()), &layout(16)).is_err());
        assert!(check(&[1, 0, 0], &layout(8)).is_err());
    }
}
