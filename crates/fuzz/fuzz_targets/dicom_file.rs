//! Bytes as the two files of a folder: found, grouped and read.
//!
//! The first two bytes say where the second file begins; where they say nothing that makes sense,
//! it is the first with a digit of its position changed, so that the two make a series.

#![no_main]

use bonemesh_fuzz::{catch_decoder_panics, read_folder, with_files};
use libfuzzer_sys::fuzz_target;

/// Image Position Patient.
const POSITION: [[u8; 4]; 2] = [[0x20, 0, 0x32, 0], [0, 0x20, 0, 0x32]];

fuzz_target!(init: catch_decoder_panics(), |input: &[u8]| {
    let Some(([low, high], bytes)) = input.split_first_chunk() else {
        return;
    };
    let split = usize::from(u16::from_le_bytes([*low, *high]));
    if split > 0 && split < bytes.len() {
        let (first, second) = bytes.split_at(split);
        with_files(&[("1", first), ("2", second)], read_folder);
    } else {
        with_files(&[("1", bytes), ("2", &moved(bytes))], read_folder);
    }
});

/// The same file with the last digit of its position changed.
fn moved(bytes: &[u8]) -> Vec<u8> {
    let mut moved = bytes.to_vec();
    let tag = |at: &[u8]| POSITION.iter().any(|tag| at.starts_with(tag));
    let Some(at) = (0..bytes.len()).find(|i| tag(&bytes[*i..])) else {
        return moved;
    };
    let is_text = |b: &u8| b.is_ascii_digit() || b"+-.eE\\ ".contains(b);
    // Behind the tag, the value representation and the length.
    let begin = (at + 8).min(bytes.len());
    let length = bytes[begin..].iter().take_while(|b| is_text(b)).count();
    let value = &mut moved[begin..begin + length];
    if let Some(digit) = value.iter_mut().rev().find(|b| b.is_ascii_digit()) {
        *digit = if *digit == b'9' { b'0' } else { *digit + 1 };
    }
    moved
}
