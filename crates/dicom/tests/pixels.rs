//! Every stored value becomes the right Hounsfield unit.

#![allow(clippy::float_cmp)]

mod common;

use bonemesh_dicom::{DicomError, read_series};
use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};
use common::{COLUMNS, Image, ROWS, folder, hu, read, scan, stored};
use dicom_core::value::PixelFragmentSequence;
use dicom_core::{DataElement, PrimitiveValue, VR};
use dicom_dictionary_std::{tags, uids};

/// HU of the first pixels of slice 1 of a series of two equal images.
fn first_row(change: impl Fn(Image) -> Image) -> Vec<f64> {
    let folder = folder(2, |_, image| change(image));
    let (volume, _) = read(folder.path());
    (0..COLUMNS).map(|i| hu(&volume, [1, 0, i])).collect()
}

fn bits(image: Image, allocated: u16, stored: u16, high: u16, is_signed: bool) -> Image {
    image
        .number(tags::BITS_ALLOCATED, allocated)
        .number(tags::BITS_STORED, stored)
        .number(tags::HIGH_BIT, high)
        .number(tags::PIXEL_REPRESENTATION, u16::from(is_signed))
}

fn is_whole(volume: &Volume) -> bool {
    matches!(volume.voxels(), Voxels::I16(_))
}

#[test]
fn garbage_above_the_high_bit_is_ignored() {
    let row = first_row(|image| {
        let image = bits(image, 16, 12, 11, false);
        image.pixels(|_, i| [0x0000, 0xf064, 0x3fff, 0xa400][i])
    });
    assert_eq!(row, [-1024.0, -924.0, 3071.0, 0.0]);
}

#[test]
fn signed_values_are_extended_from_their_highest_bit() {
    let row = first_row(|image| {
        let image = bits(image, 16, 12, 11, true).text(tags::RESCALE_INTERCEPT, VR::DS, "0");
        image.pixels(|_, i| [0x07ff, 0x0800, 0x5fff, 0x0001][i])
    });
    assert_eq!(row, [2047.0, -2048.0, -1.0, 1.0]);
    let row = first_row(|image| {
        let image = bits(image, 16, 16, 15, true);
        image.pixels(|_, i| [24, (-1000_i16).cast_unsigned(), 1024, 0][i])
    });
    assert_eq!(row, [-1000.0, -2024.0, 0.0, -1024.0]);
}

#[test]
fn values_at_the_upper_end_of_the_cell_are_shifted_down() {
    let row = first_row(|image| {
        let image = bits(image, 16, 12, 15, false);
        image.pixels(|_, i| [0x0010, 0x400f, 0xffff, 0x0000][i])
    });
    assert_eq!(row, [-1023.0, 0.0, 3071.0, -1024.0]);
}

#[test]
fn eight_and_thirty_two_bits_are_read() {
    let bytes: Vec<u8> = (0..ROWS * COLUMNS).map(|n| 200 + n as u8).collect();
    let row = first_row(|image| {
        let mut image = bits(image, 8, 8, 7, false);
        let value = PrimitiveValue::U8(bytes.clone().into());
        let element = DataElement::new(tags::PIXEL_DATA, VR::OB, value);
        image.elements.put(element);
        image
    });
    assert_eq!(row, [-824.0, -823.0, -822.0, -821.0]);
    let wide: Vec<u8> = (0..ROWS * COLUMNS)
        .flat_map(|n| (-70_000 + n as i32).to_le_bytes())
        .collect();
    let row = first_row(|image| {
        let mut image = bits(image, 32, 32, 31, true);
        let value = PrimitiveValue::U8(wide.clone().into());
        let element = DataElement::new(tags::PIXEL_DATA, VR::OW, value);
        image.elements.put(element);
        image
    });
    assert_eq!(row, [-71_024.0, -71_023.0, -71_022.0, -71_021.0]);
}

#[test]
fn each_slice_has_its_own_rescale() {
    let folder = folder(3, |k, image| {
        let slope = ["1", "0.5", "0.25"][k];
        image.text(tags::RESCALE_SLOPE, VR::DS, slope).text(
            tags::RESCALE_INTERCEPT,
            VR::DS,
            &format!("-{}", 1000 + k),
        )
    });
    let (volume, _) = read(folder.path());
    assert!(!is_whole(&volume));
    for (k, slope) in [1.0, 0.5, 0.25].into_iter().enumerate() {
        let expected = f64::from(stored(k, 2, 1)) * slope - (1000 + k) as f64;
        assert_eq!(hu(&volume, [k, 2, 1]), expected);
    }
}

#[test]
fn whole_values_take_16_bits_and_only_then() {
    let half = folder(2, |_, image| {
        let image = image.text(tags::RESCALE_SLOPE, VR::DS, "0.5");
        image.pixels(|j, i| (2 * (10 * j + i)) as u16)
    });
    assert!(is_whole(&read(half.path()).0));
    let large = folder(2, |_, image| image.pixels(|_, i| [0, 60_000, 1, 2][i]));
    let (volume, _) = read(large.path());
    assert!(!is_whole(&volume));
    assert_eq!(hu(&volume, [0, 0, 1]), 58_976.0);
}

#[test]
fn padding_is_recognised_before_the_rescale_and_becomes_air() {
    let row = first_row(|image| {
        let image = image.number(tags::PIXEL_PADDING_VALUE, 63_536);
        let image = image.pixels(|_, i| [63_536, 2_024, 1, 24][i]);
        bits(image, 16, 16, 15, true)
    });
    assert_eq!(row, [-1000.0, 1000.0, -1023.0, -1000.0]);
    let row = first_row(|image| {
        let image = image.number(tags::PIXEL_PADDING_VALUE, 4_000);
        let image = image.number(tags::PIXEL_PADDING_RANGE_LIMIT, 4_095);
        image.pixels(|_, i| [3_999, 4_000, 4_050, 4_095][i])
    });
    assert_eq!(row, [2975.0, -1000.0, -1000.0, -1000.0]);
}

#[test]
fn padding_wider_than_the_stored_bits_is_recognised() {
    let row = first_row(|image| {
        let image = bits(image, 16, 12, 11, false).number(tags::PIXEL_PADDING_VALUE, 63_536);
        image.pixels(|_, i| [63_536, 1_024, 2_096, 0][i])
    });
    assert_eq!(row, [-1000.0, 0.0, 1072.0, -1024.0]);
}

#[test]
fn monochrome1_changes_nothing() {
    let row =
        first_row(|image| image.text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "MONOCHROME1"));
    assert_eq!(row[3], f64::from(stored(1, 0, 3)) - 1024.0 - 0.0);
}

/// Run-length encoding in literal runs: high bytes, then low bytes (PS3.5 annex G).
fn rle(values: &[u16]) -> Vec<u8> {
    let segment = |bytes: Vec<u8>| {
        let mut run = vec![(bytes.len() - 1) as u8];
        run.extend(bytes);
        run.resize(run.len().next_multiple_of(2), 0x80);
        run
    };
    let high = segment(values.iter().map(|v| v.to_be_bytes()[0]).collect());
    let low = segment(values.iter().map(|v| v.to_be_bytes()[1]).collect());
    let mut frame: Vec<u8> = [2, 64, 64 + high.len() as u32]
        .into_iter()
        .chain([0; 13])
        .flat_map(u32::to_le_bytes)
        .collect();
    frame.extend(high);
    frame.extend(low);
    frame
}

fn compressed(mut image: Image, syntax: &'static str, frame: Vec<u8>) -> Image {
    let fragments = PixelFragmentSequence::new_fragments(vec![frame]);
    let element = DataElement::new(tags::PIXEL_DATA, VR::OB, fragments);
    image.elements.put(element);
    image.syntax = syntax;
    image
}

fn values(k: usize) -> Vec<u16> {
    let pixels = 0..ROWS * COLUMNS;
    pixels
        .map(|n| stored(k, n / COLUMNS, n % COLUMNS))
        .collect()
}

#[test]
fn run_length_encoded_slices_are_the_uncompressed_ones() {
    let plain = folder(4, |_, image| image);
    let packed = folder(4, |k, image| {
        compressed(image, uids::RLE_LOSSLESS, rle(&values(k)))
    });
    assert!(read(plain.path()).0 == read(packed.path()).0);
}

#[test]
fn a_damaged_compressed_slice_is_named_and_filled() {
    let packed = folder(5, |k, image| {
        let mut frame = rle(&values(k));
        if k == 2 {
            frame.truncate(70);
        }
        compressed(image, uids::RLE_LOSSLESS, frame)
    });
    let (volume, warnings) = read(packed.path());
    assert!(
        warnings[0].contains("1 of 5 slices cannot be read"),
        "{warnings:?}"
    );
    assert!(warnings[0].contains("RLE Lossless"), "{warnings:?}");
    assert_eq!(hu(&volume, [2, 1, 1]), f64::from(stored(2, 1, 1)) - 1024.0);
}

#[test]
fn elements_written_otherwise_than_the_transfer_syntax_says_are_read() {
    let truth = read(folder(3, |_, image| image).path()).0;
    for (written, said) in [
        (
            uids::IMPLICIT_VR_LITTLE_ENDIAN,
            uids::EXPLICIT_VR_LITTLE_ENDIAN,
        ),
        (
            uids::EXPLICIT_VR_LITTLE_ENDIAN,
            uids::IMPLICIT_VR_LITTLE_ENDIAN,
        ),
    ] {
        let folder = folder(3, |_, mut image| {
            image.syntax = written;
            image
        });
        for k in 0..3 {
            let path = common::file(folder.path(), 3, k);
            let mut bytes = std::fs::read(&path).unwrap();
            let (from, to) = (transfer_syntax(written), transfer_syntax(said));
            let at = bytes.windows(from.len()).position(|w| w == from).unwrap();
            bytes.splice(at..at + from.len(), to);
            std::fs::write(path, bytes).unwrap();
        }
        assert_eq!(read(folder.path()).0, truth, "{said}");
    }
}

/// The element (0002,0010) as it stands in a file.
fn transfer_syntax(uid: &str) -> Vec<u8> {
    let mut value = uid.as_bytes().to_vec();
    value.resize(value.len().next_multiple_of(2), 0);
    let length = (value.len() as u16).to_le_bytes();
    [&[2, 0, 0x10, 0, b'U', b'I'], &length[..], &value].concat()
}

#[test]
fn numbers_of_colours_are_no_hounsfield_units() {
    let folder = folder(3, |_, image| {
        image.text(tags::PHOTOMETRIC_INTERPRETATION, VR::CS, "PALETTE COLOR")
    });
    let message = common::error(folder.path()).to_string();
    assert!(message.contains("a colour picture"), "{message}");
}

#[test]
fn a_frame_that_declares_another_size_is_refused() {
    let jpeg = vec![
        0xff, 0xd8, 0xff, 0xc3, 0, 11, 16, 0xff, 0xff, 0xff, 0xff, 1, 1, 0x11, 0,
    ];
    let folder = folder(3, |_, image| {
        compressed(image, uids::JPEG_LOSSLESS_SV1, jpeg.clone())
    });
    let error = read_series(&scan(folder.path()).series[0], &Task::default()).unwrap_err();
    assert!(
        error.to_string().contains("65535 x 65535 pixels where"),
        "{error}"
    );
}

#[test]
fn an_unknown_form_of_pixels_is_named_with_its_uid() {
    let folder = folder(3, |_, image| {
        compressed(image, uids::MPEG2MPML, vec![1, 2, 3, 4])
    });
    let series = &scan(folder.path()).series[0];
    assert!(series.warnings[0].contains(uids::MPEG2MPML));
    let error = read_series(series, &Task::default()).unwrap_err();
    assert!(matches!(error, DicomError::TransferSyntax { .. }));
    assert!(error.to_string().contains(uids::MPEG2MPML), "{error}");
}

#[test]
fn one_and_many_threads_give_the_same_volume() {
    let folder = folder(40, |k, image| {
        image.position([0.0, 0.0, k as f64 + if k % 3 == 0 { 0.3 } else { 0.0 }])
    });
    let volumes: Vec<Volume> = [1, 2, 7]
        .into_iter()
        .map(|n| {
            let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(n)).unwrap();
            pool.install(|| read(folder.path()).0)
        })
        .collect();
    assert!(volumes[0] == volumes[1] && volumes[1] == volumes[2]);
}
