//! Damaged and hostile files cost themselves, never the program.

#![allow(clippy::unwrap_used)]

mod common;

use bonemesh_dicom::{DicomError, find_series, read_series};
use bonemesh_task::Task;
use common::{Image, folder, scan};
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
    let placed = |z: [f64; 4]| {
        let folder = folder(4, |k, image| image.position([0.0, 0.0, z[k]]));
        let far = folder.path().join("far");
        Image::new(0).position([1e300, 1e300, -1e300]).write(&far);
        folder
    };
    let kilometre = "more than a kilometre";
    // The slices that are left, how many a volume of them may have at most, and why others are not
    // among them.
    for (z, found, most, reasons) in [
        ([0.0, 0.001_5, 1e9, 1e12], 2, 2, vec![kilometre; 3]),
        ([0.0, 0.1, 0.2, 9e5], 3, 3, vec!["single slice", kilometre]),
        // Two slices a hair apart do not set the distance of all.
        ([0.0, 0.02, 5.0, 10.0], 4, 33, vec![kilometre]),
    ] {
        let folder = placed(z);
        let scan = scan(folder.path());
        assert_eq!(scan.series.len(), 1, "{z:?}");
        let series = &scan.series[0];
        assert_eq!(series.slices_found, found, "{z:?}");
        assert!(series.slices <= most, "{z:?}: {} slices", series.slices);
        let (volume, _) = read_series(series, &Task::default()).unwrap();
        assert_eq!(volume.geometry().shape()[0], series.slices, "{z:?}");
        assert_eq!(scan.left_out.len(), reasons.len(), "{z:?}");
        for (left_out, reason) in scan.left_out.iter().zip(reasons) {
            assert!(left_out.reason.contains(reason), "{}", left_out.reason);
        }
    }
}

#[test]
fn files_that_change_between_scan_and_read_are_an_error() {
    type Change = fn(&std::path::Path);
    let changes: [(&str, Change); 5] = [
        ("gone", |path| std::fs::remove_file(path).unwrap()),
        ("empty", |path| std::fs::write(path, []).unwrap()),
        ("shorter", |path| {
            let file = std::fs::File::options().write(true).open(path).unwrap();
            file.set_len(file.metadata().unwrap().len() - 10).unwrap();
        }),
        ("other bytes", |path| {
            let length = std::fs::metadata(path).unwrap().len();
            std::fs::write(path, vec![0xff; length as usize]).unwrap();
        }),
        ("a folder", |path| {
            std::fs::remove_file(path).unwrap();
            std::fs::create_dir(path).unwrap();
        }),
    ];
    for syntax in [
        uids::EXPLICIT_VR_LITTLE_ENDIAN,
        uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN,
    ] {
        for (name, change) in changes {
            let folder = folder(4, |_, mut image| {
                image.syntax = syntax;
                image
            });
            let scan = scan(folder.path());
            let series = &scan.series[0];
            for path in &series.files[1..] {
                change(path);
            }
            let result = read_series(series, &Task::default());
            let is_readable = name == "other bytes" && syntax == uids::EXPLICIT_VR_LITTLE_ENDIAN;
            match result {
                Ok(_) => assert!(is_readable, "{name} {syntax}"),
                Err(error) => assert!(
                    matches!(error, DicomError::Unreadable { readable: 1, .. }),
                    "{name} {syntax}: {error}"
                ),
            }
        }
    }
}

#[test]
fn numbers_that_no_scan_has_are_named() {
    for (tag, text, says) in [
        (tags::PIXEL_SPACING, "1e300\\1", "1e300"),
        (tags::PIXEL_SPACING, "1e-320\\1", "1e-320"),
        (tags::PIXEL_SPACING, "-1\\1", "-1 x 1 mm"),
        (tags::PIXEL_SPACING, "nan\\nan", "no pixel spacing"),
        (tags::IMAGE_POSITION_PATIENT, "0\\0\\1e300", "kilometre"),
        (tags::IMAGE_POSITION_PATIENT, "inf\\0\\0", "no position"),
        (tags::RESCALE_SLOPE, "1e300", "1e300"),
        (tags::RESCALE_SLOPE, "0", "slope 0"),
        (tags::RESCALE_INTERCEPT, "-1e300", "-1e300"),
    ] {
        let folder = folder(3, |k, image| {
            if k == 1 {
                image.text(tag, VR::DS, text)
            } else {
                image
            }
        });
        let scan = scan(folder.path());
        assert_eq!(scan.left_out.len(), 1, "{text}");
        let reason = &scan.left_out[0].reason;
        assert!(reason.contains(says), "{reason} does not say {says}");
    }
}

#[test]
fn a_long_description_is_cut_and_a_long_number_refused() {
    let long = "1".repeat(60_000);
    let described = folder(2, |_, image| {
        image.text(tags::SERIES_DESCRIPTION, VR::UT, &long)
    });
    let scan = scan(described.path());
    assert_eq!(scan.series[0].description.len(), 1024);
    let placed = folder(2, |_, image| {
        image.text(tags::SLICE_LOCATION, VR::UT, &long)
    });
    let error = find_series(placed.path(), &Task::default()).unwrap_err();
    assert!(error.to_string().contains("far too long"), "{error}");
}
