//! Every voxel is where the scanner says it is.

#![allow(clippy::float_cmp)]

mod common;

use bonemesh_dicom::read_series;
use bonemesh_task::Task;
use common::{Image, assert_near, file, folder, hu, read, scan, stored};
use dicom_core::VR;
use dicom_dictionary_std::tags;

/// Places of the voxels with the stored values of the standard images.
fn assert_placed(folder: &std::path::Path, slices: usize, place: impl Fn([f64; 3]) -> [f64; 3]) {
    let (volume, _) = read(folder);
    let to_patient = volume.geometry().patient_from_voxel();
    for k in 0..slices {
        for (j, i) in [(0, 0), (0, 3), (2, 0), (2, 3)] {
            let value = f64::from(stored(k, j, i)) - 1024.0;
            // Where in the volume this value is, whatever the order of its axes.
            let at = (0..slices).find(|at| hu(&volume, [*at, j, i]) == value);
            let at = at.expect("the value is somewhere");
            let expected = place([i as f64, j as f64, k as f64]);
            let found = to_patient.apply([i as f64, j as f64, at as f64]);
            assert_near(found, expected);
        }
    }
}

#[test]
fn left_stays_left_in_an_axial_stack() {
    let folder = folder(5, |_, image| image);
    assert_placed(folder.path(), 5, |[i, j, k]| {
        [-10.0 + 0.5 * i, 20.0 + 0.75 * j, 2.0 * k]
    });
    let (volume, warnings) = read(folder.path());
    assert!(warnings.is_empty());
    assert_eq!(volume.geometry().spacing_mm(), [0.5, 0.75, 2.0]);
    assert!(volume.geometry().patient_from_voxel().determinant() > 0.0);
}

#[test]
fn head_first_files_are_put_foot_first() {
    let folder = folder(5, |k, image| image.position([-10.0, 20.0, -3.0 * k as f64]));
    assert_placed(folder.path(), 5, |[i, j, k]| {
        [-10.0 + 0.5 * i, 20.0 + 0.75 * j, -3.0 * k]
    });
}

#[test]
fn a_sagittal_stack_keeps_its_place() {
    let folder = folder(4, |k, image| {
        let image = image.orientation([0.0, 1.0, 0.0, 0.0, 0.0, -1.0]);
        image.position([1.5 * k as f64, 7.0, 9.0])
    });
    assert_placed(folder.path(), 4, |[i, j, k]| {
        [1.5 * k, 7.0 + 0.5 * i, 9.0 - 0.75 * j]
    });
    let words = &scan(folder.path()).series[0].orientation;
    assert!(words.starts_with("sagittal; columns run to the back, rows to the feet"));
}

#[test]
fn an_image_seen_from_above_is_not_mirrored() {
    // Columns to the right: the normal points to the feet.
    let folder = folder(4, |_, image| {
        image.orientation([-1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
    });
    assert_placed(folder.path(), 4, |[i, j, k]| {
        [-10.0 - 0.5 * i, 20.0 + 0.75 * j, 2.0 * k]
    });
}

#[test]
fn an_oblique_tilted_stack_keeps_its_shear() {
    let (s, c) = 20.0_f64.to_radians().sin_cos();
    let folder = folder(5, |k, image| {
        let image = image.orientation([1.0, 0.0, 0.0, 0.0, c, s]);
        image.position([0.1 * k as f64, 0.0, 2.5 * k as f64])
    });
    assert_placed(folder.path(), 5, |[i, j, k]| {
        [0.5 * i + 0.1 * k, 0.75 * c * j, 0.75 * s * j + 2.5 * k]
    });
}

#[test]
fn slice_locations_place_the_image_frame_when_they_are_even() {
    let location = |offset: f64, sign: f64| {
        folder(3, move |k, image| {
            let text = (offset + sign * 2.0 * k as f64).to_string();
            image.text(tags::SLICE_LOCATION, VR::DS, &text)
        })
    };
    let place = |folder: &tempfile::TempDir, k: f64| {
        let (volume, _) = read(folder.path());
        volume.geometry().image_from_voxel().apply([0.0, 0.0, k])
    };
    assert_eq!(place(&location(-70.25, 1.0), 1.0), [-0.25, -0.375, -68.25]);
    // Locations may run against the order of the slices, as the published frame takes them.
    assert_eq!(place(&location(-70.25, -1.0), 1.0), [-0.25, -0.375, -72.25]);
    // Uneven ones say nothing: positions are used.
    let uneven = folder(3, |k, image| {
        image.text(tags::SLICE_LOCATION, VR::DS, ["0", "1", "9"][k])
    });
    assert_eq!(place(&uneven, 1.0), [-0.25, -0.375, 2.0]);
}

#[test]
fn missing_slices_are_filled_linearly() {
    let folder = folder(6, |_, image| image);
    std::fs::remove_file(file(folder.path(), 6, 2)).unwrap();
    std::fs::remove_file(file(folder.path(), 6, 3)).unwrap();
    let series = &scan(folder.path()).series[0];
    assert_eq!((series.slices, series.slices_found), (6, 4));
    let (volume, warnings) = read(folder.path());
    assert!(warnings[0].contains("2 slices are missing"), "{warnings:?}");
    for k in 0..6 {
        // Linear content is restored exactly.
        assert_eq!(hu(&volume, [k, 1, 2]), f64::from(stored(k, 1, 2)) - 1024.0);
    }
}

#[test]
fn uneven_slices_are_resampled_and_said() {
    let z = [0.0, 1.0, 2.3, 3.0, 4.0, 5.6, 6.0, 7.0];
    let folder = folder(8, |k, image| {
        let value = (1024.0 + 100.0 * z[k]) as u16;
        image.position([0.0, 0.0, z[k]]).pixels(|_, _| value)
    });
    let (volume, warnings) = read(folder.path());
    assert!(warnings[0].contains("resampled"), "{warnings:?}");
    let [slices, ..] = volume.geometry().shape();
    for k in 0..slices {
        let z = volume
            .geometry()
            .patient_from_voxel()
            .apply([0.0, 0.0, k as f64])[2];
        let step = volume.geometry().spacing_mm()[2];
        assert!((hu(&volume, [k, 0, 0]) - 100.0 * z).abs() <= 100.0 * 0.05 * step + 0.5);
    }
}

#[test]
fn a_wide_gap_makes_two_volumes() {
    let folder = folder(10, |k, image| {
        image.position([0.0, 0.0, if k < 6 { k as f64 } else { 200.0 + k as f64 }])
    });
    let scan = scan(folder.path());
    let slices: Vec<usize> = scan.series.iter().map(|s| s.slices).collect();
    assert_eq!(slices, [6, 4]);
}

#[test]
fn slices_shifted_sideways_are_reported() {
    let folder = folder(5, |k, image| {
        image.position([if k == 2 { 3.0 } else { 0.0 }, 0.0, k as f64])
    });
    let warnings = &scan(folder.path()).series[0].warnings;
    assert!(warnings[0].contains("shifted sideways by up to 3.00 mm"));
}

#[test]
fn slices_beside_the_line_are_moved_to_it() {
    for crooked in [0, 2, 4] {
        // Two columns to the left: 0.5 mm each.
        let folder = folder(5, |k, image| {
            image.position([
                if k == crooked { -11.0 } else { -10.0 },
                20.0,
                2.0 * k as f64,
            ])
        });
        let (volume, warnings) = read(folder.path());
        assert!(warnings[0].contains("up to 1.00 mm"), "{warnings:?}");
        assert_near(
            volume.geometry().patient_from_voxel().origin(),
            [-10.0, 20.0, 0.0],
        );
        for k in 0..5 {
            let value = |j, i| f64::from(stored(k, j, i)) - 1024.0;
            if k == crooked {
                assert_eq!(hu(&volume, [k, 1, 0]), value(1, 2));
                assert_eq!(hu(&volume, [k, 2, 1]), value(2, 3));
                assert_eq!(hu(&volume, [k, 1, 2]), -1000.0);
            } else {
                assert_eq!(hu(&volume, [k, 1, 2]), value(1, 2));
            }
        }
    }
}

#[test]
fn a_stack_centred_anew_halfway_is_not_tilted() {
    for from in 1..12 {
        // Two columns to the left: 0.5 mm each.
        let left = |k| if k < from { -10.0 } else { -11.0 };
        let folder = folder(12, |k, image| {
            image.position([left(k), 20.0, 2.0 * k as f64])
        });
        let series = &scan(folder.path()).series[0];
        assert!(series.tilt_degrees < 1e-9, "{from}: {series:?}");
        let note = &series.warnings[0];
        assert!(note.contains("shifted sideways by up to 1.00 mm"), "{note}");
        assert!(note.contains("up to 1.00 mm of their edge"), "{note}");
        let (volume, _) = read(folder.path());
        let origin = volume.geometry().patient_from_voxel().origin();
        for k in 0..12 {
            let columns = ((left(k) - origin[0]) / 0.5).round() as i64;
            for i in 0..4 {
                let expected = usize::try_from(i - columns)
                    .ok()
                    .filter(|own| *own < 4)
                    .map_or(-1000.0, |own| f64::from(stored(k, 1, own)) - 1024.0);
                assert_eq!(
                    hu(&volume, [k, 1, i as usize]),
                    expected,
                    "{from}, {k}, {i}"
                );
            }
        }
    }
}

#[test]
fn a_tilted_stack_keeps_its_tilt_where_it_is_centred_anew() {
    let (s, c) = 20.0_f64.to_radians().sin_cos();
    let hundredths = |v: f64| (v * 100.0).round() / 100.0;
    let folder = folder(40, |k, image| {
        let image = image.orientation([1.0, 0.0, 0.0, 0.0, c, s]);
        let left = if k < 20 { 0.0 } else { 12.0 };
        image.position([left, 0.0, hundredths(0.625 * k as f64)])
    });
    let series = &scan(folder.path()).series[0];
    assert!((series.tilt_degrees - 20.0).abs() < 0.2, "{series:?}");
}

#[test]
fn without_positions_the_slice_location_serves_and_is_said() {
    let folder = folder(4, |k, image| {
        let image = image.without(tags::IMAGE_POSITION_PATIENT);
        let image = image.without(tags::IMAGE_ORIENTATION_PATIENT);
        image.text(
            tags::SLICE_LOCATION,
            VR::DS,
            &(30.0 - 3.0 * k as f64).to_string(),
        )
    });
    let (volume, warnings) = read(folder.path());
    assert!(warnings[0].contains("placed by Slice Location"));
    assert_eq!(volume.geometry().spacing_mm()[2], 3.0);
    assert_eq!(hu(&volume, [0, 0, 0]), f64::from(stored(3, 0, 0)) - 1024.0);
}

#[test]
fn a_missing_end_that_turns_out_unreadable_shortens_the_volume() {
    let folder = folder(6, |_, image| image);
    let scan = scan(folder.path());
    std::fs::write(file(folder.path(), 6, 0), b"gone").unwrap();
    let (volume, warnings) = read_series(&scan.series[0], &Task::default()).unwrap();
    assert_eq!(volume.geometry().shape()[0], 5);
    assert_near(
        volume.geometry().patient_from_voxel().origin(),
        [-10.0, 20.0, 2.0],
    );
    assert_eq!(hu(&volume, [0, 0, 0]), f64::from(stored(1, 0, 0)) - 1024.0);
    assert!(warnings[0].contains("1 of 6 slices") && warnings[0].contains("0006"));
}

#[test]
fn a_rotated_copy_of_a_slice_is_no_neighbour() {
    let folder = folder(5, |_, image| image);
    let turned = Image::new(2).orientation([0.0, 1.0, 0.0, 0.0, 0.0, -1.0]);
    turned.write(&folder.path().join("turned"));
    let scan = scan(folder.path());
    assert_eq!(scan.series[0].slices_found, 5);
    assert!(scan.left_out[0].reason.contains("single slice"));
}
