//! Files that lie: an error that names the file, never a panic, never memory on a header's word.

#![allow(clippy::unwrap_used)]

mod common;

use std::io::Read;

use bonemesh_task::{Cancel, Task};
use bonemesh_volume_file::{VolumeFile, VolumeFileError};
use common::{Folder, NRRD, Nifti, gzip, nrrd, open, read, small_values, stored};
use flate2::Compression;
use flate2::read::GzEncoder;
use proptest::prelude::*;

/// The most voxels that a byte of a file can stand for: gzip of single bytes.
const MOST_VOXELS: usize = 1032;

/// Opens and reads; whatever is read must have been in the file.
fn survive(bytes: &[u8]) {
    if let Ok((volume, _)) = read("volume", bytes) {
        let voxels: usize = volume.voxels().shape().iter().product();
        assert!(
            voxels <= MOST_VOXELS * bytes.len(),
            "{voxels} voxels in {} bytes",
            bytes.len()
        );
    }
}

fn files() -> Vec<Vec<u8>> {
    let data = stored(4, &small_values(), false);
    let mut big = Nifti::new(1);
    big.is_big_endian = true;
    vec![
        Nifti::new(1).bytes(),
        Nifti::new(2).bytes(),
        big.with(8, &small_values()).bytes(),
        nrrd(NRRD, &data),
        nrrd(&NRRD.replace("raw", "gzip"), &gzip(&data)),
        nrrd(
            &NRRD.replace("raw", "ascii"),
            b"1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24",
        ),
    ]
}

#[test]
fn the_files_that_are_damaged_below_are_good_themselves() {
    for bytes in files() {
        assert!(read("volume", &bytes).is_ok());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn no_changed_bytes_panic(
        file in 0..6_usize,
        is_gzip in any::<bool>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
    ) {
        let mut bytes = files()[file].clone();
        for (place, value) in changes {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        survive(&if is_gzip { gzip(&bytes) } else { bytes });
    }

    #[test]
    fn no_changed_bytes_of_the_compressed_file_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = gzip(&Nifti::new(1).bytes());
        for (place, value) in changes {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        survive(&bytes);
    }

    #[test]
    fn no_cut_panics(file in 0..6_usize, length in any::<prop::sample::Index>()) {
        let bytes = files()[file].clone();
        survive(&bytes[..length.index(bytes.len())]);
        let packed = gzip(&bytes);
        let end = length.index(packed.len());
        survive(&packed[..end]);
    }

    #[test]
    fn no_number_in_a_nifti_header_panics(
        dim in prop::array::uniform8(prop_oneof![-2_i64..9, any::<i64>()]),
        pixdim in prop::array::uniform8(any::<f64>()),
        srow in prop::array::uniform12(any::<f64>()),
        quaternion in prop::array::uniform3(any::<f64>()),
        offset in any::<f64>(),
        codes in (any::<i16>(), -1_i16..5, -1_i16..5, any::<u8>()),
        scale in (any::<f64>(), any::<f64>()),
        version in 1..3_u8,
    ) {
        let mut file = Nifti::new(version);
        (file.dim, file.pixdim, file.quaternion, file.offset) = (dim, pixdim, quaternion, offset);
        file.srow = std::array::from_fn(|r| std::array::from_fn(|c| srow[4 * r + c]));
        (file.datatype, file.qform_code, file.sform_code, file.units) = codes;
        (file.slope, file.intercept) = scale;
        survive(&file.bytes());
    }

    #[test]
    fn no_words_in_an_nrrd_header_panic(
        fields in prop::collection::vec((
            prop::sample::select(vec![
                "type", "dimension", "sizes", "space", "space directions", "space origin", "kinds",
                "spacings", "encoding", "endian", "byte skip", "line skip", "data file", "units",
                "space units", "block size", "content",
            ]),
            prop::collection::vec(prop::sample::select(vec![
                "3", "0", "-1", "1", "4", "99999999999999999999", "9223372036854775807", "nan",
                "(1,0,0)", "(0,1,0)", "(0,0,1)", "(", ")", "(1", "\"mm\"", "\"", "none", "domain",
                "raw", "gzip", "ascii", "short", "uchar", "little", "big", "LPS", "RAS", "%", "/",
                ".", "..", "LIST", "\u{b5}m", "\u{1f9b4}",
            ]), 0..5),
        ), 0..14),
    ) {
        let lines: Vec<String> = fields
            .into_iter()
            .map(|(name, words)| format!("{name}: {}\n", words.join(" ")))
            .collect();
        let header = format!("NRRD0004\n{}", lines.concat());
        survive(&nrrd(&header, &[1; 200]));
    }
}

#[test]
fn claims_beyond_the_file_are_refused_before_a_voxel_is_read() {
    let mut file = Nifti::new(2);
    file.dim = [3, 65_535, 65_535, 10_000, 1, 1, 1, 1];
    for bytes in [file.bytes(), gzip(&file.bytes())] {
        let error = open("volume.nii", &bytes).unwrap_err();
        assert!(matches!(error, VolumeFileError::CutOff { .. }), "{error}");
        assert!(error.to_string().contains("volume.nii"), "{error}");
    }
    file.dim[3] = i64::MAX;
    assert!(matches!(
        open("volume.nii", &file.bytes()).unwrap_err(),
        VolumeFileError::Volume { .. }
    ));
    for encoding in ["raw", "gzip", "ascii"] {
        let header = NRRD
            .replace("sizes: 4 3 2", "sizes: 65535 65535 10000")
            .replace("raw", encoding);
        let error = open("volume.nrrd", &nrrd(&header, &[0; 1000])).unwrap_err();
        assert!(matches!(error, VolumeFileError::CutOff { .. }), "{error}");
    }
}

#[test]
fn a_bomb_is_refused_before_it_is_inflated() {
    // 400 MB claimed in half a megabyte: gzip could hold that, but no scan is so even.
    let mut file = Nifti::new(1);
    (file.dim, file.data) = ([3, 1000, 1000, 200, 1, 1, 1, 1], vec![0; 520_000]);
    let contents = file.bytes();
    let mut encoder = GzEncoder::new(&contents[..], Compression::none());
    let mut bytes = Vec::new();
    encoder.read_to_end(&mut bytes).unwrap();
    let error = open("volume.nii.gz", &bytes).unwrap_err();
    assert!(matches!(error, VolumeFileError::Inflated { .. }), "{error}");
}

#[test]
fn compressed_data_that_end_early_are_named() {
    // Noise that cannot be compressed, and a header that claims what gzip could hold at best.
    let mut file = Nifti::new(1);
    let noise = (0..4000_u32).map(|n| (n.wrapping_mul(2_654_435_761) >> 24) as u8);
    file.data = noise.collect();
    file.dim = [3, 100, 100, 50, 1, 1, 1, 1];
    let error = read("volume.nii.gz", &gzip(&file.bytes())).unwrap_err();
    assert!(
        matches!(error, VolumeFileError::CutOff { found: 4000, .. }),
        "{error}"
    );
}

#[test]
fn a_wrong_checksum_is_an_error() {
    let mut bytes = gzip(&Nifti::new(1).bytes());
    let crc = bytes.len() - 8;
    bytes[crc] ^= 0xff;
    let error = read("volume.nii.gz", &bytes).unwrap_err();
    assert!(matches!(error, VolumeFileError::Data { .. }), "{error}");
}

#[test]
fn a_cancelled_reading_gives_nothing() {
    let cancel = Cancel::default();
    cancel.cancel();
    let folder = Folder::new();
    let mut skipping = Nifti::new(1);
    skipping.offset = 100_352.0;
    skipping.data = [vec![0; 100_000], skipping.data].concat();
    for bytes in [Nifti::new(1).bytes(), gzip(&skipping.bytes())] {
        let file = VolumeFile::open(&folder.write("volume.nii", &bytes)).unwrap();
        let error = file.read(&Task::new(cancel.clone())).unwrap_err();
        assert!(matches!(error, VolumeFileError::Cancelled(_)), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn a_device_is_not_opened() {
    let error = VolumeFile::open("/dev/zero".as_ref()).unwrap_err();
    assert!(matches!(error, VolumeFileError::NotAFile(_)), "{error}");
    let folder = Folder::new();
    let error = VolumeFile::open(folder.path()).unwrap_err();
    assert!(matches!(error, VolumeFileError::NotAFile(_)), "{error}");
    let error = VolumeFile::open(&folder.path().join("nothing.nii")).unwrap_err();
    assert!(matches!(error, VolumeFileError::NotFound(_)), "{error}");
}
