//! DICOM series read back with another library's eyes.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use bonemesh_phantom::{
    ORIENTATIONS, Phantom, PhantomError, ScanSettings, SeriesLabels, scan, write_dicom_series,
    write_phantom,
};
use bonemesh_task::Task;
use bonemesh_volume::{Affine, Geometry, Volume, Voxels};
use dicom_dictionary_std::tags;
use dicom_object::{DefaultDicomObject, open_file};
use ndarray::Array3;

fn floats(file: &DefaultDicomObject, tag: dicom_core::Tag) -> Vec<f64> {
    file.element(tag).unwrap().to_multi_float64().unwrap()
}

fn text(file: &DefaultDicomObject, tag: dicom_core::Tag) -> String {
    file.element(tag).unwrap().to_str().unwrap().into_owned()
}

/// Hounsfield units of a file by its own slope, intercept and sign.
fn hu(file: &DefaultDicomObject) -> Vec<f64> {
    let (slope, intercept) = (
        floats(file, tags::RESCALE_SLOPE)[0],
        floats(file, tags::RESCALE_INTERCEPT)[0],
    );
    let signed = floats(file, tags::PIXEL_REPRESENTATION)[0] > 0.5;
    let bytes = file.element(tags::PIXEL_DATA).unwrap().to_bytes().unwrap();
    bytes
        .chunks_exact(2)
        .map(|b| {
            let word = [b[0], b[1]];
            let stored = if signed {
                f64::from(i16::from_le_bytes(word))
            } else {
                f64::from(u16::from_le_bytes(word))
            };
            slope * stored + intercept
        })
        .collect()
}

fn small(orientation: &str) -> ScanSettings {
    ScanSettings {
        pixel_mm: [4.0, 3.0],
        columns: 24,
        orientation: orientation.parse().unwrap(),
        ..Phantom::Tube.settings().coarser(4.0)
    }
}

#[test]
fn a_series_reads_back_to_the_same_voxels_at_the_same_places() {
    let task = Task::default();
    for (name, _) in ORIENTATIONS {
        let volume = scan(Phantom::Tube, &small(name), &task).unwrap();
        let dir = tempfile::tempdir().unwrap();
        let labels = SeriesLabels::default();
        let files = write_dicom_series(&volume, dir.path(), &labels, &task).unwrap();
        let affine = volume.geometry().patient_from_voxel();
        let Voxels::I16(voxels) = volume.voxels() else {
            panic!("phantoms are whole Hounsfield units")
        };
        assert_eq!(files.len(), volume.geometry().shape()[0]);
        for (k, path) in files.iter().enumerate() {
            let file = open_file(path).unwrap();
            let position = floats(&file, tags::IMAGE_POSITION_PATIENT);
            let axes = floats(&file, tags::IMAGE_ORIENTATION_PATIENT);
            let spacing = floats(&file, tags::PIXEL_SPACING);
            let expected = affine.apply([5.0, 7.0, k as f64]);
            for c in 0..3 {
                // PixelSpacing: between rows first.
                let step = axes[c] * spacing[1] * 5.0 + axes[3 + c] * spacing[0] * 7.0;
                assert!((position[c] + step - expected[c]).abs() < 1e-9, "{name}");
            }
            let slice = voxels.index_axis(ndarray::Axis(0), k);
            let same = hu(&file)
                .into_iter()
                .zip(slice)
                .all(|(a, b)| (a - f64::from(*b)).abs() < 1e-9);
            assert!(same, "{name} slice {k}");
            assert_eq!(
                text(&file, tags::INSTANCE_NUMBER).trim(),
                (k + 1).to_string()
            );
        }
    }
}

#[test]
fn identity_is_artificial_and_uids_follow_from_the_content() {
    let (task, settings) = (Task::default(), small("axial"));
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, settings| {
        let target = dir.path().join(name);
        let written = write_phantom(Phantom::Tube, &target, settings, &task).unwrap();
        open_file(&written.files[3]).unwrap()
    };
    let one = write("one", &settings);
    let again = write("again", &settings);
    let seed = 9;
    let other = write("other", &ScanSettings { seed, ..settings });
    assert_eq!(text(&one, tags::PATIENT_NAME).trim(), "Phantom^Tube");
    assert_eq!(text(&one, tags::PATIENT_ID).trim(), "PHANTOM");
    for tag in [
        tags::SERIES_INSTANCE_UID,
        tags::SOP_INSTANCE_UID,
        tags::STUDY_INSTANCE_UID,
    ] {
        assert!(text(&one, tag).starts_with("2.25."));
        assert_eq!(text(&one, tag), text(&again, tag));
        assert_ne!(text(&one, tag), text(&other, tag));
    }
}

#[test]
fn a_phantom_lies_beside_its_truth() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("new/head");
    let settings = Phantom::Head.settings().coarser(8.0);
    let written = write_phantom(Phantom::Head, &target, &settings, &Task::default()).unwrap();
    assert_eq!(written.series, target.join("dicom"));
    assert!(written.files.iter().all(|f| f.is_file()));
    let truth: serde_json::Value =
        serde_json::from_slice(&fs::read(&written.truth).unwrap()).unwrap();
    assert_eq!(truth["phantom"], "head");
    assert_eq!(truth["scan"]["slices"], settings.slices);
    // Nothing but the folder is left.
    assert_eq!(fs::read_dir(dir.path().join("new")).unwrap().count(), 1);
}

#[test]
fn a_folder_that_holds_files_stays_as_it_is() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("mine.txt"), "mine").unwrap();
    let task = Task::default();
    let error = write_phantom(Phantom::Tube, dir.path(), &small("axial"), &task).unwrap_err();
    assert!(matches!(error, PhantomError::FolderInUse(_)), "{error}");
    assert!(error.to_string().contains("empty or a new folder"));
    let file = dir.path().join("mine.txt");
    let error = write_phantom(Phantom::Tube, &file, &small("axial"), &task).unwrap_err();
    assert!(matches!(error, PhantomError::NotAFolder(_)), "{error}");
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
}

#[test]
fn cancelling_leaves_nothing_behind() {
    let dir = tempfile::tempdir().unwrap();
    let task = Task::default();
    let volume = scan(Phantom::Tube, &small("axial"), &task).unwrap();
    task.cancel().cancel();
    let labels = SeriesLabels::default();
    let result = write_dicom_series(&volume, &dir.path().join("series"), &labels, &task);
    assert!(matches!(result, Err(PhantomError::Cancelled(_))));
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}

fn written_hu(voxels: Voxels, dir: &Path) -> Vec<f64> {
    let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
    let geometry = Geometry::new(voxels.shape(), affine).unwrap();
    let volume = Volume::new(voxels, geometry).unwrap();
    let labels = SeriesLabels::default();
    let files = write_dicom_series(&volume, dir, &labels, &Task::default()).unwrap();
    hu(&open_file(&files[0]).unwrap())
}

#[test]
fn every_16_bit_value_survives() {
    let dir = tempfile::tempdir().unwrap();
    let values = [i16::MIN, -1025, -1024, 0, 3071, i16::MAX];
    let voxels = Array3::from_shape_vec([1, 2, 3], values.to_vec()).unwrap();
    let back = written_hu(Voxels::I16(voxels), dir.path());
    assert_eq!(back, values.map(f64::from));
}

#[test]
fn fractional_units_survive_to_a_16th_bit_of_their_range() {
    let dir = tempfile::tempdir().unwrap();
    let values = [-1000.25_f32, -3.3, 0.1, 999.9];
    let voxels = Array3::from_shape_vec([1, 2, 2], values.to_vec()).unwrap();
    let back = written_hu(Voxels::F32(voxels), dir.path());
    for (a, b) in back.into_iter().zip(values) {
        assert!(
            (a - f64::from(b)).abs() < 0.5 * 2000.2 / 65_535.0 + 1e-6,
            "{a} {b}"
        );
    }
}

#[test]
fn labels_that_dicom_cannot_hold_are_refused() {
    let volume = scan(Phantom::Tube, &small("axial"), &Task::default()).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let labels = SeriesLabels {
        patient_name: "back\\slash".to_owned(),
        ..SeriesLabels::default()
    };
    let result = write_dicom_series(&volume, dir.path(), &labels, &Task::default());
    assert!(matches!(result, Err(PhantomError::Dicom { .. })));
}
