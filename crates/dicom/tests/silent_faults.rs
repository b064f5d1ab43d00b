//! Headers that lack something: no wrong volume without a word.

#![allow(clippy::float_cmp, clippy::unwrap_used)]

mod common;

use bonemesh_dicom::{Scan, find_one_series, read_series};
use bonemesh_task::Task;
use common::{Image, error, file, folder, hu, read, scan, stored};
use dicom_core::{Tag, VR};
use dicom_dictionary_std::tags;

const ORIENTATION: Tag = tags::IMAGE_ORIENTATION_PATIENT;
const POSITION: Tag = tags::IMAGE_POSITION_PATIENT;

fn located(image: Image, mm: f64) -> Image {
    image.text(tags::SLICE_LOCATION, VR::DS, &mm.to_string())
}

fn says(warnings: &[String], part: &str) -> bool {
    warnings.iter().any(|w| w.contains(part))
}

/// The reason for which slice `k` of a folder of `slices` is left out.
fn reason(folder: &tempfile::TempDir, scan: &Scan, slices: usize, k: usize) -> String {
    let path = file(folder.path(), slices, k);
    let found = scan.left_out.iter().find(|l| l.path == path).unwrap();
    found.reason.clone()
}

/// Slice 3 of 8 is left out for `part`, and its place is filled between its neighbours.
fn assert_filled(folder: &tempfile::TempDir, part: &str) {
    let scan = scan(folder.path());
    let why = reason(folder, &scan, 8, 3);
    assert!(why.contains(part), "{why}");
    assert_eq!(scan.left_out.len(), 1);
    let (volume, warnings) = read(folder.path());
    assert_eq!(volume.geometry().shape()[0], 8);
    assert_eq!(volume.geometry().spacing_mm()[2], 2.0);
    for k in 0..8 {
        assert_eq!(hu(&volume, [k, 1, 2]), f64::from(stored(k, 1, 2)) - 1024.0);
    }
    assert!(
        says(&warnings, "1 file is left out, first 0005"),
        "{warnings:?}"
    );
}

#[test]
fn an_orientation_is_not_assumed_where_a_position_is_known() {
    let folder = folder(4, |k, image| {
        located(image.without(ORIENTATION), 2.0 * k as f64)
    });
    let error = error(folder.path()).to_string();
    assert!(
        error.contains("no orientation (Image Orientation Patient)"),
        "{error}"
    );
}

#[test]
fn an_orientation_that_has_to_be_assumed_is_said() {
    let folder = folder(4, |k, image| {
        located(image.without(ORIENTATION).without(POSITION), 2.0 * k as f64)
    });
    let (_, warnings) = read(folder.path());
    assert!(
        says(&warnings, "left and right may be swapped"),
        "{warnings:?}"
    );
}

#[test]
fn a_known_orientation_is_not_said_to_be_assumed() {
    let folder = folder(4, |k, image| {
        located(image.without(POSITION), 2.0 * k as f64)
    });
    let (_, warnings) = read(folder.path());
    assert!(says(&warnings, "placed by Slice Location"), "{warnings:?}");
    assert!(!says(&warnings, "head first"), "{warnings:?}");
}

#[test]
fn a_damaged_position_or_orientation_is_named_and_not_replaced() {
    for (tag, text) in [(POSITION, "-10\\20"), (ORIENTATION, "1\\0\\0\\0\\x\\0")] {
        let folder = folder(4, |k, image| {
            located(image.text(tag, VR::DS, text), 2.0 * k as f64)
        });
        let error = error(folder.path()).to_string();
        assert!(error.contains(&format!("`{text}`")), "{error}");
    }
}

#[test]
fn a_slice_without_position_is_not_mixed_with_placed_ones() {
    let folder = folder(8, |k, image| match k {
        // Slice Location counts from elsewhere than the positions.
        3 => located(image.without(POSITION), 28.0),
        _ => image,
    });
    assert_filled(
        &folder,
        "no position (Image Position Patient), which the other slices",
    );
}

#[test]
fn taking_the_folder_as_one_series_mixes_no_unplaced_slice_in() {
    let folder = folder(8, |k, image| {
        let image = image.uid(&format!("1.2.{}", k + 1));
        match k {
            3 => located(image.without(POSITION), 28.0),
            _ => image,
        }
    });
    let scan = find_one_series(folder.path(), &Task::default()).unwrap();
    assert!(reason(&folder, &scan, 8, 3).contains("no position"));
    let (volume, _) = read_series(&scan.series[0], &Task::default()).unwrap();
    assert_eq!(volume.geometry().shape()[0], 8);
}

#[test]
fn a_slice_without_orientation_is_not_mixed_with_oriented_ones() {
    let folder = folder(8, |k, image| {
        let image = located(image.without(POSITION), 2.0 * k as f64);
        match k {
            3 => image.without(ORIENTATION),
            _ => image,
        }
    });
    assert_filled(
        &folder,
        "no orientation (Image Orientation Patient), which the other slices",
    );
}

#[test]
fn a_slice_without_rescale_is_not_mixed_with_rescaled_ones() {
    for lost in [
        &[tags::RESCALE_INTERCEPT][..],
        &[tags::RESCALE_INTERCEPT, tags::RESCALE_SLOPE],
    ] {
        let folder = folder(8, |k, image| match k {
            3 => lost.iter().fold(image, |image, tag| image.without(*tag)),
            _ => image,
        });
        assert_filled(
            &folder,
            "no rescale (Rescale Slope, Rescale Intercept), which the other slices",
        );
    }
}

#[test]
fn a_series_without_rescale_is_read_and_doubted() {
    let folder = folder(4, |_, image| {
        image
            .without(tags::RESCALE_INTERCEPT)
            .without(tags::RESCALE_SLOPE)
    });
    let (volume, warnings) = read(folder.path());
    assert_eq!(hu(&volume, [1, 1, 1]), f64::from(stored(1, 1, 1)));
    assert!(
        says(
            &warnings,
            "no rescale (Rescale Slope, Rescale Intercept) in the files"
        ),
        "{warnings:?}"
    );
}

#[test]
fn a_series_with_half_a_rescale_is_doubted() {
    for (tag, part) in [
        (tags::RESCALE_INTERCEPT, "no Rescale Intercept in the files"),
        (tags::RESCALE_SLOPE, "no Rescale Slope in the files"),
    ] {
        let (_, warnings) = read(folder(4, |_, image| image.without(tag)).path());
        assert!(says(&warnings, part), "{warnings:?}");
    }
}

#[test]
fn a_rescale_that_is_no_number_is_named_and_not_replaced() {
    for text in ["NaN", "1,5", "one", "1\\2"] {
        for tag in [tags::RESCALE_SLOPE, tags::RESCALE_INTERCEPT] {
            let folder = folder(8, |k, image| match k {
                3 => image.text(tag, VR::DS, text),
                _ => image,
            });
            let why = reason(&folder, &scan(folder.path()), 8, 3);
            assert!(
                why.contains("rescale") && why.contains(&format!("`{text}`")),
                "{why}"
            );
        }
    }
}

#[test]
fn an_unknown_sign_of_the_pixels_is_said() {
    let folder = folder(4, |_, image| image.without(tags::PIXEL_REPRESENTATION));
    let (_, warnings) = read(folder.path());
    assert!(
        says(&warnings, "do not say whether pixels are signed"),
        "{warnings:?}"
    );
}

#[test]
fn a_padding_limit_on_the_wrong_side_makes_no_air_of_the_patient() {
    let folder = folder(4, |_, image| {
        let signed = |value: i16| value.cast_unsigned();
        image
            .text(tags::RESCALE_INTERCEPT, VR::DS, "0")
            .number(tags::PIXEL_REPRESENTATION, 1)
            .number(tags::PIXEL_PADDING_VALUE, signed(-2000))
            .number(tags::PIXEL_PADDING_RANGE_LIMIT, 2000)
            .pixels(|_, i| [signed(-2000), signed(-900), 40, 1500][i])
    });
    let (volume, warnings) = read(folder.path());
    let row = [0, 1, 2, 3].map(|i| hu(&volume, [1, 1, i]));
    assert_eq!(row, [-1000.0, -900.0, 40.0, 1500.0]);
    assert!(
        says(&warnings, "Pixel Padding Range Limit is not used"),
        "{warnings:?}"
    );
}

#[test]
fn every_slice_is_asked_for_its_modality_and_the_kind_of_its_values() {
    let folder = folder(6, |k, image| match k {
        2 => image.without(tags::MODALITY),
        4 => image.text(tags::RESCALE_TYPE, VR::LO, "US"),
        _ => image.text(tags::RESCALE_TYPE, VR::LO, "HU"),
    });
    let (_, warnings) = read(folder.path());
    let part = "the files of 1 of 6 slices do not say that they are CT";
    assert!(says(&warnings, part), "{warnings:?}");
    let part = "the files of 1 of 6 slices give their values as `US`";
    assert!(says(&warnings, part), "{warnings:?}");
}

#[test]
fn complete_headers_raise_no_doubt() {
    let (_, warnings) = read(folder(6, |_, image| image).path());
    assert!(warnings.is_empty(), "{warnings:?}");
}
