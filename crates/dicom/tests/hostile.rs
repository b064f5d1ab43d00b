//! Damaged and hostile files cost themselves, never the program.

#![allow(clippy::unwrap_used)]

mod common;

use bonemesh_dicom::{find_series, read_series};
use bonemesh_task::Task;
use common::{Image, file, folder, scan};
use dicom_core::VR;
use dicom_dictionary_std::{tags, uids};
use proptest::prelude::*;

/// Retired, and still in archives.
const BIG_ENDIAN: &str = "1.2.840.10008.1.2.2";

/// Reads the folder as far as it goes; only a panic or a hang can fail.
fn try_to_read(folder: &std::path::Path) {
    if let Ok(scan) = find_series(folder, &Task::default()) {
        for series in &scan.series {
            let _ = read_series(series, &Task::default());
        }
    }
}

fn bytes_of(image: Image) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("image");
    image.write(&path);
    std::fs::read(path).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn changed_bytes_never_panic(
        changes in proptest::collection::vec((0..2000_usize, any::<u8>()), 1..6),
        cut in proptest::option::of(0..2000_usize),
        syntax in 0..4_usize,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let syntaxes = [
            uids::EXPLICIT_VR_LITTLE_ENDIAN,
            uids::IMPLICIT_VR_LITTLE_ENDIAN,
            BIG_ENDIAN,
            uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN,
        ];
        for k in 0..3 {
            let mut image = Image::new(k);
            image.syntax = syntaxes[syntax];
            let mut bytes = bytes_of(image);
            // The preamble is not read.
            let start = 132;
            let length = bytes.len() - start;
            for (at, value) in &changes {
                bytes[start + at % length] = *value;
            }
            if let Some(cut) = cut {
                bytes.truncate(start + cut % length);
            }
            std::fs::write(folder.path().join(k.to_string()), bytes).unwrap();
        }
        try_to_read(folder.path());
    }

    #[test]
    fn random_bytes_are_no_image(bytes in proptest::collection::vec(any::<u8>(), 0..600)) {
        let folder = tempfile::tempdir().unwrap();
        let mut with_preamble = vec![0; 128];
        with_preamble.extend(b"DICM");
        with_preamble.extend(&bytes);
        std::fs::write(folder.path().join("a"), with_preamble).unwrap();
        let mut bare = vec![8, 0, 5, 0];
        bare.extend(&bytes);
        std::fs::write(folder.path().join("b"), bare).unwrap();
        prop_assert!(find_series(folder.path(), &Task::default()).is_err());
    }
}

#[test]
fn a_length_of_four_gigabytes_is_not_believed() {
    let folder = folder(3, |_, image| image);
    // A text of unlimited length that claims to be longer than the file.
    let mut bytes = bytes_of(Image::new(7));
    let modality = bytes
        .windows(4)
        .position(|w| w == [0x08, 0x00, 0x60, 0x00])
        .unwrap();
    let claim = [0x08, 0, 0x60, 0, b'U', b'T', 0, 0, 0xf0, 0xff, 0xff, 0xff];
    bytes.splice(modality..modality, claim);
    std::fs::write(folder.path().join("claims"), bytes).unwrap();
    let scan = scan(folder.path());
    assert_eq!(scan.series[0].slices, 3);
    assert!(scan.left_out[0].reason.contains("cut off"));
}

#[test]
fn nested_sequences_end_the_file_and_not_the_stack() {
    let folder = folder(3, |_, image| image);
    let mut bytes = bytes_of(Image::new(7));
    let modality = bytes
        .windows(4)
        .position(|w| w == [0x08, 0x00, 0x60, 0x00])
        .unwrap();
    let sequence = [
        [
            0x08, 0, 0x40, 0x11, b'S', b'Q', 0, 0, 0xff, 0xff, 0xff, 0xff,
        ]
        .as_slice(),
        &[0xfe, 0xff, 0, 0xe0, 0xff, 0xff, 0xff, 0xff],
    ]
    .concat();
    bytes.splice(modality..modality, sequence.repeat(20_000));
    std::fs::write(folder.path().join("nested"), bytes).unwrap();
    let scan = scan(folder.path());
    assert!(scan.left_out[0].reason.contains("nested too deeply"));
}

#[test]
fn frames_without_end_are_not_believed() {
    let folder = folder(3, |_, image| image);
    let many = Image::new(7).text(tags::NUMBER_OF_FRAMES, VR::IS, "2000000000");
    many.write(&folder.path().join("many"));
    let scan = scan(folder.path());
    assert!(
        scan.left_out[0]
            .reason
            .contains("without a position for each")
    );
}

#[test]
fn positions_beyond_all_reason_give_no_endless_volume() {
    let folder = folder(4, |k, image| {
        image.position([0.0, 0.0, [0.0, 0.001_5, 1e9, 1e12][k]])
    });
    try_to_read(folder.path());
    let far = folder.path().join("far");
    Image::new(0).position([1e300, 1e300, -1e300]).write(&far);
    try_to_read(folder.path());
    assert!(file(folder.path(), 4, 0).exists());
}
