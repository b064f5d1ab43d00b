//! Bytes as a cloud file: the first chooses between npy, PLY and text.

#![no_main]

use bonemesh_cloud::read_cloud;
use bonemesh_fuzz::with_files;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let Some((kind, bytes)) = input.split_first() else {
        return;
    };
    let name = ["cloud.npy", "cloud.ply", "cloud.xyz"][usize::from(kind % 3)];
    with_files(&[(name, bytes)], |folder| {
        if let Ok(cloud) = read_cloud(&folder.join(name)) {
            assert!(cloud.points_mm().iter().flatten().all(|v| v.is_finite()));
        }
    });
});
