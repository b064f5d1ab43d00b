//! What a NIfTI file says is what the volume holds.

#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use std::num::NonZeroUsize;

use bonemesh_task::Task;
use bonemesh_volume::Voxels;
use bonemesh_volume_file::{VolumeFile, VolumeFileError};
use common::{
    Folder, Nifti, Rows, SIDES, TYPES, assert_rows, gzip, open, read, small_values, values,
};

#[test]
fn every_type_in_both_byte_orders_and_versions_gives_the_same_volume() {
    for version in [1, 2] {
        for is_big_endian in [false, true] {
            for (code, name, _) in TYPES {
                let mut file = Nifti::new(version);
                file.is_big_endian = is_big_endian;
                let file = file.with(code, &small_values());
                for bytes in [file.bytes(), gzip(&file.bytes())] {
                    let (volume, _) = read("volume.nii", &bytes).unwrap();
                    let case = format!("{name}, version {version}, big endian {is_big_endian}");
                    assert_eq!(values(&volume), small_values(), "{case}");
                    assert!(matches!(volume.voxels(), Voxels::I16(_)), "{case}");
                    let [i, j, k] = SIDES;
                    assert_eq!(volume.geometry().shape(), [k, j, i], "{case}");
                }
            }
        }
    }
}

#[test]
fn the_content_decides_not_the_name() {
    let bytes = Nifti::new(1).bytes();
    let folder = Folder::new();
    for (name, bytes) in [
        ("a.dat", bytes.clone()),
        ("b.nii", gzip(&bytes)),
        ("c.nii.gz", bytes),
    ] {
        let path = folder.write(name, &bytes);
        assert!(VolumeFile::is_one(&path), "{name}");
        assert!(VolumeFile::open(&path).is_ok(), "{name}");
    }
    let text = folder.write("d.dat", b"not a volume at all");
    assert!(!VolumeFile::is_one(&text));
    assert!(!VolumeFile::is_one(folder.path()));
    assert!(!VolumeFile::is_one(&folder.path().join("nothing")));
    let error = VolumeFile::open(&text).unwrap_err();
    assert!(matches!(error, VolumeFileError::UnknownFormat(_)));
    // Of content that is none, the name says what it should have been.
    let text = folder.write("e.nii", b"not a volume at all");
    assert!(!VolumeFile::is_one(&text));
    let error = VolumeFile::open(&text).unwrap_err();
    assert!(matches!(error, VolumeFileError::Header { .. }), "{error}");
}

#[test]
fn the_header_is_shown_before_a_voxel_is_read() {
    let file = open("volume.nii.gz", &gzip(&Nifti::new(2).bytes())).unwrap();
    assert_eq!(file.format(), "NIfTI-2, gzip");
    assert_eq!(file.description(), "test head");
    assert_eq!(file.estimated_memory_bytes(), 48);
    assert!(file.warnings().is_empty());
    let real = Nifti::new(1).with(16, &small_values());
    let file = open("volume.nii", &real.bytes()).unwrap();
    assert_eq!(file.format(), "NIfTI-1, uncompressed");
    assert_eq!(file.estimated_memory_bytes(), 96);
}

#[test]
fn slope_and_intercept_give_hounsfield_units() {
    let mut file = Nifti::new(1);
    (file.slope, file.intercept) = (2.0, -1024.0);
    let (volume, warnings) = read("volume.nii", &file.bytes()).unwrap();
    let expected: Vec<f64> = small_values().iter().map(|v| v * 2.0 - 1024.0).collect();
    assert_eq!(values(&volume), expected);
    assert!(matches!(volume.voxels(), Voxels::I16(_)));
    assert!(warnings.is_empty());
    file.slope = 0.25;
    let (volume, _) = read("volume.nii", &file.bytes()).unwrap();
    let expected: Vec<f64> = small_values().iter().map(|v| v / 4.0 - 1024.0).collect();
    assert_eq!(values(&volume), expected);
    assert!(matches!(volume.voxels(), Voxels::F32(_)));
}

#[test]
fn a_slope_of_zero_or_no_number_scales_nothing() {
    for (slope, intercept) in [
        (0.0, 7.0),
        (f64::NAN, f64::NAN),
        (1.0, f64::NAN),
        (f64::INFINITY, 0.0),
    ] {
        let mut file = Nifti::new(1);
        (file.slope, file.intercept) = (slope, intercept);
        let (volume, warnings) = read("volume.nii", &file.bytes()).unwrap();
        assert_eq!(values(&volume), small_values(), "{slope} {intercept}");
        // The standard's 0 says that there is no slope; no number says nothing.
        let is_told = warnings.iter().any(|w| w.contains("make no sense"));
        assert_eq!(is_told, slope != 0.0, "{slope} {intercept}: {warnings:?}");
    }
}

#[test]
fn the_first_value_beyond_16_bits_turns_the_volume_into_floating_point() {
    let mut expected = vec![-1000.0; 24];
    expected[23] = 40_000.0;
    let (volume, _) = read("volume.nii", &Nifti::new(1).with(8, &expected).bytes()).unwrap();
    assert!(matches!(volume.voxels(), Voxels::F32(_)));
    assert_eq!(values(&volume), expected);
}

#[test]
fn a_volume_of_many_blocks_that_turns_to_floating_point_late_keeps_what_came_before() {
    let sides = [200_i64, 150, 40];
    let mut expected: Vec<f64> = (0..1_200_000).map(|n| f64::from(n % 3001 - 1000)).collect();
    *expected.last_mut().unwrap() = 0.5;
    let mut file = Nifti::new(1).with(16, &expected);
    file.dim = [3, sides[0], sides[1], sides[2], 1, 1, 1, 1];
    for bytes in [file.bytes(), gzip(&file.bytes())] {
        let (volume, _) = read("volume.nii", &bytes).unwrap();
        assert!(matches!(volume.voxels(), Voxels::F32(_)));
        assert!(values(&volume) == expected);
    }
}

#[test]
fn any_number_of_threads_reads_the_same_and_progress_ends_at_one() {
    let mut stored: Vec<f64> = (0..1_200_000).map(|n| f64::from(n % 4001) / 3.0).collect();
    stored[700_000] = f64::NAN;
    let mut file = Nifti::new(2).with(16, &stored);
    (file.dim, file.slope, file.intercept) = ([3, 200, 150, 40, 1, 1, 1, 1], 1.5, -1024.0);
    let folder = Folder::new();
    let file = VolumeFile::open(&folder.write("volume", &gzip(&file.bytes()))).unwrap();
    let [one, three] = [1, 3].map(|threads| {
        let task = Task::default();
        let pool = bonemesh_task::pool(NonZeroUsize::new(threads)).unwrap();
        let reading = pool.install(|| file.read(&task)).unwrap();
        assert_eq!(task.progress().stage, "read");
        assert!(task.progress().fraction >= 1.0);
        reading
    });
    assert!(one == three);
}

#[test]
fn voxels_that_are_no_number_become_air_and_are_counted() {
    let mut stored = small_values();
    (stored[3], stored[4], stored[5]) = (f64::NAN, f64::INFINITY, f64::NEG_INFINITY);
    let (volume, warnings) = read("volume.nii", &Nifti::new(1).with(16, &stored).bytes()).unwrap();
    let found = values(&volume);
    assert_eq!(found[3..6], [-1000.0; 3]);
    assert_eq!(found[6..], stored[6..]);
    assert!(
        warnings.iter().any(|w| w.starts_with("3 voxels")),
        "{warnings:?}"
    );
}

#[test]
fn values_without_air_are_pointed_out() {
    let (_, warnings) = read("volume.nii", &Nifti::new(1).bytes()).unwrap();
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("may not be Hounsfield units"))
    );
    let hu: Vec<f64> = small_values().iter().map(|v| v - 12.0).collect();
    let (_, warnings) = read("volume.nii", &Nifti::new(1).with(4, &hu).bytes()).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn the_sform_is_turned_from_ras_to_lps() {
    let file = open("volume.nii", &Nifti::new(1).bytes()).unwrap();
    assert_rows(
        file.geometry(),
        [
            [-0.5, 0.0, 0.0, -10.0],
            [0.0, -0.75, 0.0, -20.0],
            [0.0, 0.0, 2.0, 30.0],
        ],
    );
}

/// A quarter turn about each axis, as b, c, d and as the columns that it gives.
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

#[test]
fn the_qform_is_a_rotation_with_its_own_hand() {
    let cases: [([f64; 3], f64, Rows); 5] = [
        (
            [0.0; 3],
            1.0,
            [
                [-0.5, 0.0, 0.0, -1.0],
                [0.0, -0.75, 0.0, -2.0],
                [0.0, 0.0, 2.0, 3.0],
            ],
        ),
        (
            [0.0; 3],
            -1.0,
            [
                [-0.5, 0.0, 0.0, -1.0],
                [0.0, -0.75, 0.0, -2.0],
                [0.0, 0.0, -2.0, 3.0],
            ],
        ),
        // About x: rows run up, slices to the back.
        (
            [HALF, 0.0, 0.0],
            1.0,
            [
                [-0.5, 0.0, 0.0, -1.0],
                [0.0, 0.0, 2.0, -2.0],
                [0.0, 0.75, 0.0, 3.0],
            ],
        ),
        // About z: columns run to the front.
        (
            [0.0, 0.0, HALF],
            1.0,
            [
                [0.0, 0.75, 0.0, -1.0],
                [-0.5, 0.0, 0.0, -2.0],
                [0.0, 0.0, 2.0, 3.0],
            ],
        ),
        // Half a turn about z, longer than 1 by rounding: no real part left.
        (
            [0.0, 0.0, 1.000_001],
            0.0,
            [
                [0.5, 0.0, 0.0, -1.0],
                [0.0, 0.75, 0.0, -2.0],
                [0.0, 0.0, 2.0, 3.0],
            ],
        ),
    ];
    for version in [1, 2] {
        for (quaternion, hand, rows) in cases {
            let mut file = Nifti::new(version);
            (file.sform_code, file.qform_code) = (0, 1);
            file.quaternion = quaternion;
            file.quaternion_offset = [1.0, 2.0, 3.0];
            file.pixdim[0] = hand;
            assert_rows(open("volume.nii", &file.bytes()).unwrap().geometry(), rows);
        }
    }
}

#[test]
fn the_sform_goes_before_the_qform_and_their_quarrel_is_told() {
    let mut file = Nifti::new(1);
    file.qform_code = 1;
    let agreed = open("volume.nii", &file.bytes()).unwrap();
    assert!(agreed.warnings().is_empty());
    file.pixdim[0] = -1.0;
    let quarrel = open("volume.nii", &file.bytes()).unwrap();
    assert_eq!(agreed.geometry(), quarrel.geometry());
    assert!(quarrel.warnings()[0].contains("disagree about left and right"));
    file.srow = [[0.0; 4]; 3];
    let flat = open("volume.nii", &file.bytes()).unwrap();
    assert!(flat.warnings()[0].contains("degenerate"));
    assert!(flat.geometry().spacing_mm()[2] > 1.9);
}

#[test]
fn a_quarrel_about_the_size_of_a_voxel_is_told() {
    for version in [1, 2] {
        for (factor, is_told) in [(1.0, false), (0.999, false), (1.02, true), (f64::NAN, true)] {
            let mut file = Nifti::new(version);
            file.qform_code = 1;
            file.pixdim[3] *= factor;
            let file = open("volume.nii", &file.bytes()).unwrap();
            let size = "sform and qform disagree about the size of a voxel";
            let told = file.warnings().iter().any(|w| w.contains(size));
            assert_eq!(told, is_told, "{factor}: {:?}", file.warnings());
            assert!((file.geometry().spacing_mm()[2] - 2.0).abs() < 1e-9);
        }
    }
}

#[test]
fn a_sheared_sform_is_kept_and_a_flat_one_refused() {
    let mut file = Nifti::new(1);
    file.srow[1][2] = 0.5;
    let volume = open("volume.nii", &file.bytes()).unwrap();
    let slice = volume.geometry().patient_from_voxel().axis(2);
    assert!((slice[1] + 0.5).abs() < 1e-6);
    file.srow[2] = file.srow[1];
    let error = open("volume.nii", &file.bytes()).unwrap_err();
    assert!(matches!(error, VolumeFileError::Volume { .. }), "{error}");
    file.srow[0][3] = f64::NAN;
    assert!(open("volume.nii", &file.bytes()).is_err());
}

#[test]
fn a_file_without_orientation_keeps_its_spacing_and_says_so() {
    let mut file = Nifti::new(1);
    file.sform_code = 0;
    let volume = open("volume.nii", &file.bytes()).unwrap();
    assert!(volume.warnings()[0].contains("no orientation"));
    let spacing = volume.geometry().spacing_mm();
    for (found, expected) in spacing.into_iter().zip([0.5, 0.75, 2.0]) {
        assert!((found - expected).abs() < 1e-6);
    }
}

#[test]
fn lengths_become_millimetres() {
    for (units, mm) in [
        (0, 1.0),
        (1, 1000.0),
        (2, 1.0),
        (3, 0.001),
        (10, 1.0),
        (7, 1.0),
    ] {
        let mut file = Nifti::new(1);
        file.units = units;
        let volume = open("volume.nii", &file.bytes()).unwrap();
        let spacing = volume.geometry().spacing_mm();
        assert!((spacing[2] / mm - 2.0).abs() < 1e-6, "unit {units}");
        let is_quiet = matches!(units, 0 | 2 | 10);
        assert_eq!(volume.warnings().is_empty(), is_quiet, "unit {units}");
    }
}

#[test]
fn a_header_and_its_image_are_one_volume_by_either_name() {
    let mut file = Nifti::new(1);
    file.is_pair = true;
    file.offset = 0.0;
    for (header, image, is_gzip) in [
        ("a.hdr", "a.img", false),
        ("b.hdr.gz", "b.img.gz", true),
        ("c.1.hdr", "c.1.img", false),
    ] {
        let pack = |bytes: Vec<u8>| if is_gzip { gzip(&bytes) } else { bytes };
        let folder = Folder::new();
        let header = folder.write(header, &pack(file.header()));
        let missing = VolumeFile::open(&header).unwrap_err().to_string();
        assert!(
            missing.contains(".img") && missing.contains("not there"),
            "{missing}"
        );
        let image = folder.write(image, &pack(file.data.clone()));
        for path in [&header, &image] {
            assert!(VolumeFile::is_one(path), "{}", path.display());
            let found = VolumeFile::open(path).unwrap();
            assert_eq!(found.path(), header);
            let (volume, _) = found.read(&Task::default()).unwrap();
            assert_eq!(values(&volume), small_values());
        }
    }
}

#[test]
fn extensions_before_the_voxels_are_skipped() {
    let mut file = Nifti::new(1);
    file.offset = 352.0 + 1600.0;
    file.data = [vec![1; 1600], file.data].concat();
    for bytes in [file.bytes(), gzip(&file.bytes())] {
        let (volume, _) = read("volume.nii", &bytes).unwrap();
        assert_eq!(values(&volume), small_values());
    }
    let mut file = Nifti::new(1);
    file.offset = 0.0;
    let (volume, _) = read("volume.nii", &file.bytes()).unwrap();
    assert_eq!(values(&volume), small_values());
}

#[test]
fn several_volumes_are_counted_and_one_with_a_time_is_read() {
    let mut file = Nifti::new(1);
    file.dim = [4, 4, 3, 2, 1, 0, 0, 0];
    assert!(read("volume.nii", &file.bytes()).is_ok());
    file.dim[4] = 5;
    let error = open("volume.nii", &file.bytes()).unwrap_err();
    assert!(
        matches!(error, VolumeFileError::SeveralVolumes { volumes: 5, .. }),
        "{error}"
    );
    file.dim = [5, 4, 3, 2, 1, 3, 0, 0];
    let error = open("volume.nii", &file.bytes()).unwrap_err().to_string();
    assert!(error.contains("3 values a voxel"), "{error}");
}

#[test]
fn a_picture_is_no_volume() {
    let mut file = Nifti::new(1);
    for dim in [[2, 4, 3, 0, 0, 0, 0, 0], [3, 4, 3, 1, 0, 0, 0, 0]] {
        file.dim = dim;
        let error = open("volume.nii", &file.bytes()).unwrap_err();
        assert!(
            matches!(error, VolumeFileError::TooFewSlices { .. }),
            "{error}"
        );
    }
}

#[test]
fn voxels_that_are_no_numbers_are_refused_by_name() {
    for (code, name) in [
        (32, "complex"),
        (128, "RGB"),
        (2304, "RGBA"),
        (1536, "128-bit"),
        (77, "code 77"),
    ] {
        let mut file = Nifti::new(2);
        file.datatype = code;
        let error = open("volume.nii", &file.bytes()).unwrap_err();
        assert!(matches!(error, VolumeFileError::Unsupported { .. }));
        assert!(error.to_string().contains(name), "{error}");
    }
}

#[test]
fn its_predecessor_is_refused_by_name() {
    let mut header = Nifti::new(1).header();
    header[344..348].fill(0);
    header[38] = b'r';
    let error = open("volume.hdr", &header).unwrap_err();
    assert!(error.to_string().contains("ANALYZE"), "{error}");
}
