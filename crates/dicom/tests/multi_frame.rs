//! One file with all slices: Enhanced CT with shared and per-frame functional groups.

#![allow(clippy::unwrap_used)]

mod common;

use bonemesh_dicom::{DicomError, find_series, read_series};
use bonemesh_task::Task;
use common::{COLUMNS, Image, ROWS, assert_near, error, hu, read, scan, stored};
use dicom_core::value::DataSetSequence;
use dicom_core::{DataElement, PrimitiveValue, Tag, VR};
use dicom_dictionary_std::{tags, uids};
use dicom_object::InMemDicomObject;

/// A functional group: one macro with its values.
fn group(
    sequence: Tag,
    values: &[(Tag, &str)],
) -> DataElement<InMemDicomObject, dicom_object::mem::InMemFragment> {
    let mut item = InMemDicomObject::new_empty();
    for (tag, text) in values {
        item.put(DataElement::new(*tag, VR::DS, PrimitiveValue::from(*text)));
    }
    DataElement::new(sequence, VR::SQ, DataSetSequence::from(vec![item]))
}

/// Frames of the series of [`Image::new`] in `order`; slice `k` has the rescale slope `k + 1`.
fn enhanced(order: &[usize]) -> Image {
    turned(order, |_| 0.0)
}

/// The same, slice `k` turned by `angle(k)` (radians) about the normal.
fn turned(order: &[usize], angle: impl Fn(usize) -> f64) -> Image {
    let mut shared = InMemDicomObject::new_empty();
    shared.put(group(
        tags::PIXEL_MEASURES_SEQUENCE,
        &[(tags::PIXEL_SPACING, "0.75\\0.5")],
    ));
    let frames: Vec<InMemDicomObject> = order
        .iter()
        .map(|k| {
            let mut frame = InMemDicomObject::new_empty();
            let (position, slope) = (format!("-10\\20\\{}", 2 * k), (k + 1).to_string());
            frame.put(group(
                tags::PLANE_POSITION_SEQUENCE,
                &[(tags::IMAGE_POSITION_PATIENT, &position)],
            ));
            let (s, c) = angle(*k).sin_cos();
            frame.put(group(
                tags::PLANE_ORIENTATION_SEQUENCE,
                &[(
                    tags::IMAGE_ORIENTATION_PATIENT,
                    &format!("{c:.6}\\{s:.6}\\0\\{:.6}\\{c:.6}\\0", -s),
                )],
            ));
            frame.put(group(
                tags::PIXEL_VALUE_TRANSFORMATION_SEQUENCE,
                &[
                    (tags::RESCALE_INTERCEPT, "-1024"),
                    (tags::RESCALE_SLOPE, &slope),
                ],
            ));
            frame
        })
        .collect();
    let pixels: Vec<u16> = order
        .iter()
        .flat_map(|k| (0..ROWS * COLUMNS).map(move |n| stored(*k, n / COLUMNS, n % COLUMNS)))
        .collect();
    let mut image = Image::new(0)
        .without(tags::IMAGE_POSITION_PATIENT)
        .without(tags::IMAGE_ORIENTATION_PATIENT)
        .without(tags::PIXEL_SPACING)
        .without(tags::RESCALE_SLOPE)
        .without(tags::RESCALE_INTERCEPT)
        .text(tags::NUMBER_OF_FRAMES, VR::IS, &order.len().to_string());
    for (tag, items) in [
        (tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE, vec![shared]),
        (tags::PER_FRAME_FUNCTIONAL_GROUPS_SEQUENCE, frames),
    ] {
        image
            .elements
            .put(DataElement::new(tag, VR::SQ, DataSetSequence::from(items)));
    }
    image.elements.put(DataElement::new(
        tags::PIXEL_DATA,
        VR::OW,
        PrimitiveValue::U16(pixels.into()),
    ));
    image
}

#[test]
fn shuffled_frames_are_ordered_and_rescaled_each_by_its_own_groups() {
    let folder = tempfile::tempdir().unwrap();
    enhanced(&[3, 0, 4, 1, 2]).write(&folder.path().join("all"));
    let (volume, warnings) = read(folder.path());
    assert_eq!(volume.geometry().shape(), [5, ROWS, COLUMNS]);
    assert!(warnings.is_empty(), "{warnings:?}");
    for k in 0..5 {
        let expected = f64::from(stored(k, 2, 1)) * (k + 1) as f64 - 1024.0;
        assert!(
            (hu(&volume, [k, 2, 1]) - expected).abs() < 1e-9,
            "slice {k}"
        );
    }
    let place = volume.geometry().patient_from_voxel();
    assert_near(place.apply([2.0, 1.0, 3.0]), [-9.0, 20.75, 6.0]);
}

#[test]
fn deflated_frames_are_those_of_the_plain_file() {
    let [plain, deflated] = [
        uids::EXPLICIT_VR_LITTLE_ENDIAN,
        uids::DEFLATED_EXPLICIT_VR_LITTLE_ENDIAN,
    ]
    .map(|syntax| {
        let folder = tempfile::tempdir().unwrap();
        let mut image = enhanced(&[3, 0, 4, 1, 2]);
        image.syntax = syntax;
        image.write(&folder.path().join("all"));
        read(folder.path()).0
    });
    assert_eq!(plain, deflated);
}

#[test]
fn a_multi_frame_file_can_be_given_by_its_own_path() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("all.dcm");
    enhanced(&[0, 1, 2]).write(&path);
    let scan = find_series(&path, &Task::default()).unwrap();
    let (volume, _) = read_series(&scan.series[0], &Task::default()).unwrap();
    assert_eq!(volume, read(folder.path()).0);
    assert_eq!(scan.series[0].files, [path]);
}

#[test]
fn frames_and_groups_that_disagree_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let image = enhanced(&[0, 1, 2]).text(tags::NUMBER_OF_FRAMES, VR::IS, "4");
    image.write(&folder.path().join("all"));
    let error = error(folder.path());
    assert!(matches!(error, DicomError::NoSeries { .. }));
    assert!(
        error.to_string().contains("4 frames, but positions for 3"),
        "{error}"
    );
}

#[test]
fn phases_of_a_moving_patient_are_one_volume_each() {
    let folder = tempfile::tempdir().unwrap();
    enhanced(&[0, 1, 2]).write(&folder.path().join("first"));
    let mut later = enhanced(&[0, 1, 2]);
    let pixels: Vec<u16> = (0..3 * ROWS * COLUMNS).map(|n| n as u16).collect();
    later.elements.put(DataElement::new(
        tags::PIXEL_DATA,
        VR::OW,
        PrimitiveValue::U16(pixels.into()),
    ));
    later.write(&folder.path().join("later"));
    let scan = scan(folder.path());
    let slices: Vec<usize> = scan.series.iter().map(|s| s.slices).collect();
    assert_eq!(slices, [3, 3]);
    for series in &scan.series {
        assert!(
            series.warnings[0].contains("of 2 there"),
            "{:?}",
            series.warnings
        );
    }
}

#[test]
fn frames_in_hundreds_of_directions_are_no_volume() {
    let folder = tempfile::tempdir().unwrap();
    let order: Vec<usize> = (0..600).collect();
    let image = turned(&order, |k| k as f64 / 100.0);
    image.write(&folder.path().join("all"));
    let error = error(folder.path()).to_string();
    assert!(error.contains("more than 256 directions"), "{error}");
}
