//! Bytes as a file that holds a volume, or as the two files of one.
//!
//! The first byte chooses the names, the next two where the second file begins.

#![no_main]

use bonemesh_fuzz::with_files;
use bonemesh_task::Task;
use bonemesh_volume_file::VolumeFile;
use libfuzzer_sys::fuzz_target;

/// Names of the header and of the data, as the formats pair them.
const NAMES: [[&str; 2]; 2] = [["volume.hdr", "volume.img"], ["volume.nhdr", "volume.raw"]];

fuzz_target!(|input: &[u8]| {
    let Some(([kind, low, high], bytes)) = input.split_first_chunk() else {
        return;
    };
    let split = usize::from(u16::from_le_bytes([*low, *high]));
    let (header, data) = bytes.split_at(split.min(bytes.len()));
    let [first, second] = NAMES[usize::from(kind & 1)];
    with_files(&[(first, header), (second, data)], |folder| {
        if let Ok(file) = VolumeFile::open(&folder.join(first)) {
            let _ = file.read(&Task::default());
        }
    });
});
