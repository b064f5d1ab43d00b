//! Every codec gives back the stored values, and what is damaged is named.

// Helpers of these tests may panic.
#![allow(clippy::unwrap_used)]

mod common;

use bonemesh_dicom::{DicomError, read_series};
use bonemesh_task::Task;
use common::{COLUMNS, Image, ROWS, folder, hu, read, scan, stored};
use dicom_core::value::PixelFragmentSequence;
use dicom_core::{DataElement, VR};
use dicom_dictionary_std::{tags, uids};
use dicom_encoding::adapters::EncodeOptions;
use dicom_encoding::transfer_syntax::TransferSyntaxIndex;
use dicom_object::FileMetaTableBuilder;
use dicom_transfer_syntax_registry::TransferSyntaxRegistry;

/// 3 x 4 samples of 12 bits: a ramp from 0 to 23, compressed by dcmtk.
const JPEG_12: &str = "ffd8ffe000104a46494600010100000100010000ffdb00430003020203020203030303\
    04030304050805050404050a070706080c0a0c0c0b0a0b0b0d0e12100d0e110e0b0b1016101113141515150c0f17\
    1816141812141514ffc1000b0c0003000401011100ffc4001400010000000000000000000000000000000dffc400\
    1b10000007010000000000000000000000000001020304051223ffda0008010100003f002b6dbab8992e081fffff\
    d9";

/// What dcmtk and pydicom decode it to.
const DECODED: [[i32; COLUMNS]; ROWS] = [[0, 0, 2, 2], [10, 11, 13, 13], [19, 21, 22, 23]];

fn bytes(hexadecimal: &str) -> Vec<u8> {
    (0..hexadecimal.len() / 2)
        .map(|i| u8::from_str_radix(&hexadecimal[2 * i..2 * i + 2], 16).unwrap())
        .collect()
}

fn compressed(mut image: Image, syntax: &'static str, fragments: Vec<Vec<u8>>) -> Image {
    let fragments = PixelFragmentSequence::new_fragments(fragments);
    let element = DataElement::new(tags::PIXEL_DATA, VR::OB, fragments);
    image.elements.put(element);
    image.syntax = syntax;
    image
}

fn twelve_bits(image: Image) -> Image {
    image
        .number(tags::BITS_STORED, 12)
        .number(tags::HIGH_BIT, 11)
}

/// What reading says of a series whose every frame is `frame`.
fn refusal(syntax: &'static str, frame: &[u8]) -> String {
    let folder = folder(3, |_, image| {
        compressed(twelve_bits(image), syntax, vec![frame.to_vec()])
    });
    let series = &scan(folder.path()).series[0];
    read_series(series, &Task::default())
        .unwrap_err()
        .to_string()
}

fn jpeg_ls(image: Image) -> Image {
    let syntax = uids::JPEGLS_LOSSLESS;
    let meta = FileMetaTableBuilder::new()
        .transfer_syntax(uids::EXPLICIT_VR_LITTLE_ENDIAN)
        .media_storage_sop_class_uid(uids::CT_IMAGE_STORAGE)
        .media_storage_sop_instance_uid("1.2.3.9");
    let file = image.elements.clone().with_meta(meta).unwrap();
    let codec = TransferSyntaxRegistry.get(syntax).unwrap();
    let writer = codec.pixel_data_writer().unwrap();
    let mut frame = Vec::new();
    writer
        .encode_frame(&file, 0, EncodeOptions::default(), &mut frame)
        .unwrap();
    // In two fragments: one frame is all of them.
    let rest = frame.split_off(frame.len() / 4 * 2);
    compressed(image, syntax, vec![frame, rest])
}

#[test]
fn jpeg_ls_slices_are_the_uncompressed_ones() {
    for is_signed in [0, 1] {
        for bits in [12, 16] {
            let plain = |image: Image| {
                let value = |j, i| stored(0, j, i) + if is_signed == 1 { 1_200 } else { 0 };
                let image = image.pixels(value);
                image
                    .number(tags::BITS_STORED, bits)
                    .number(tags::HIGH_BIT, bits - 1)
                    .number(tags::PIXEL_REPRESENTATION, is_signed)
            };
            let expected = folder(2, |_, image| plain(image));
            let packed = folder(2, |_, image| jpeg_ls(plain(image)));
            assert!(read(expected.path()).0 == read(packed.path()).0);
        }
    }
}

#[test]
fn a_jpeg_ls_scan_that_breaks_off_is_an_error_and_no_endless_loop() {
    let mut frame = bytes("ffd8fff7000b0c0003000401011100ffda0008010100000000");
    frame.extend([0, 0]);
    let error = refusal(uids::JPEGLS_LOSSLESS, &frame);
    assert!(error.contains(uids::JPEGLS_LOSSLESS), "{error}");
}

#[test]
fn jpeg_of_12_bits_is_decoded_as_other_decoders_do() {
    let jpeg = bytes(JPEG_12);
    let folder = folder(2, |_, image| {
        let image = twelve_bits(image).text(tags::RESCALE_INTERCEPT, VR::DS, "1000");
        compressed(image, uids::JPEG_EXTENDED12_BIT, vec![jpeg.clone()])
    });
    let (volume, _) = read(folder.path());
    for (j, row) in DECODED.iter().enumerate() {
        for (i, value) in row.iter().enumerate() {
            let difference = hu(&volume, [1, j, i]) - f64::from(1000 + value);
            assert!(difference.abs() <= 1.0, "{j} {i}: {difference}");
        }
    }
}

#[test]
fn a_damaged_jpeg_of_12_bits_is_an_error_and_no_guess() {
    let jpeg = bytes(JPEG_12);
    for length in [jpeg.len() - 8, 140, 30] {
        let error = refusal(uids::JPEG_EXTENDED12_BIT, &jpeg[..length]);
        assert!(error.contains("JPEG Extended"), "{error}");
    }
}

#[test]
fn uncompressed_frames_in_items_are_read() {
    let plain = folder(3, |_, image| image);
    let wrapped = folder(3, |k, image| {
        let values = (0..ROWS * COLUMNS).map(|n| stored(k, n / COLUMNS, n % COLUMNS));
        let frame = values.flat_map(u16::to_le_bytes).collect();
        let syntax = uids::ENCAPSULATED_UNCOMPRESSED_EXPLICIT_VR_LITTLE_ENDIAN;
        compressed(image, syntax, vec![frame])
    });
    assert!(read(plain.path()).0 == read(wrapped.path()).0);
}

#[test]
fn run_lengths_of_countless_segments_are_refused() {
    let mut frame = u32::MAX.to_le_bytes().to_vec();
    frame.resize(200, 0);
    let error = refusal(uids::RLE_LOSSLESS, &frame);
    assert!(error.contains("4294967295 segments where 2"), "{error}");
}

#[test]
fn jpeg_xl_is_refused_by_name_and_uid() {
    let folder = folder(3, |_, image| {
        compressed(image, uids::JPEGXL_LOSSLESS, vec![vec![0xff; 40]])
    });
    let series = &scan(folder.path()).series[0];
    let error = read_series(series, &Task::default()).unwrap_err();
    assert!(matches!(error, DicomError::TransferSyntax { .. }));
    assert!(error.to_string().contains(uids::JPEGXL_LOSSLESS), "{error}");
}
