//! A femur in every order and orientation of voxels, written as a series and read again.

use std::fs;
use std::path::Path;

use bonemesh::{Phantom, ScanSettings, Task, Volume, scan_phantom};
use bonemesh_dicom::{find_series, read_series};
use bonemesh_phantom::{SeriesLabels, write_dicom_series};

/// Side of the cubic voxels.
pub(crate) const PIXEL_MM: f64 = 2.0;

/// Columns of the grid along the patient's axes: the femur lies inside with room to spare.
const COUNTS: [usize; 3] = [64, 60, 216];

/// Orientations whose grids have the same voxel centres as the axial one.
pub(crate) const PARALLEL: [&str; 7] = [
    "reversed",
    "feet-first",
    "sagittal",
    "coronal",
    "prone",
    "decubitus-left",
    "decubitus-right",
];

pub(crate) const ALL_OTHERS: [&str; 3] = ["axial", "oblique", "tilted"];

/// A femur without blur and noise, on voxels that are cubes.
pub(crate) fn settings(orientation: &str) -> ScanSettings {
    let settings = ScanSettings {
        orientation: orientation.parse().unwrap(),
        pixel_mm: [PIXEL_MM; 2],
        slice_mm: PIXEL_MM,
        ..Phantom::Femur.settings().ideal()
    };
    let o = &settings.orientation;
    let directions = [o.column_direction, o.row_direction, o.slice_direction];
    let [columns, rows, slices] = directions.map(|direction| {
        let axis = direction.iter().position(|c| c.abs() > 0.999_999);
        // A turned grid is larger, so that the bone stays inside.
        axis.map_or(116, |axis| COUNTS[axis])
    });
    let slices = if PARALLEL.contains(&orientation) {
        slices
    } else {
        COUNTS[2] + 40
    };
    ScanSettings {
        columns,
        rows,
        slices: if orientation == "axial" {
            COUNTS[2]
        } else {
            slices
        },
        ..settings
    }
}

/// Writes `volume` as a series whose file names say nothing of the order.
fn write_shuffled(volume: &Volume, folder: &Path, settings: &ScanSettings) {
    let labels = SeriesLabels {
        patient_position: settings.orientation.patient_position,
        ..SeriesLabels::default()
    };
    let files = write_dicom_series(volume, folder, &labels, &Task::default()).unwrap();
    for (k, file) in files.iter().enumerate() {
        // A prime larger than any number of slices.
        fs::rename(file, folder.join(format!("{:03}", (k + 1) * 389 % 997))).unwrap();
    }
}

/// The volume that reading a written series gives.
pub(crate) fn written_and_read(volume: &Volume, settings: &ScanSettings) -> Volume {
    let folder = tempfile::tempdir().unwrap();
    write_shuffled(volume, folder.path(), settings);
    let task = Task::default();
    let found = find_series(folder.path(), &task).unwrap();
    let (volume, warnings) = read_series(found.choose(None).unwrap(), &task).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    volume
}

pub(crate) fn femur(orientation: &str) -> Volume {
    let settings = settings(orientation);
    let scanned = scan_phantom(Phantom::Femur, &settings, &Task::default()).unwrap();
    written_and_read(&scanned, &settings)
}

/// Points of the bone. Left: the greater trochanter's outer side. Right: the head's. Front, back
/// and below: the condyles and the groove between them.
pub(crate) const LANDMARKS: [[f64; 3]; 3] = [
    [17.0, 19.0, 190.0],
    [-67.0, -9.0, 196.0],
    [22.0, 40.0, -184.0],
];

/// Landmarks mirrored along each axis that the bone is far from.
pub(crate) fn mirrored_landmarks() -> Vec<[f64; 3]> {
    let body = Phantom::Femur.body().unwrap();
    let away = |p: [f64; 3]| body.signed_distance_mm(p);
    assert!(LANDMARKS.iter().all(|p| away(*p).abs() < 4.0));
    let along = |axis: usize| {
        let mirrored = LANDMARKS.map(|mut p| {
            p[axis] *= -1.0;
            p
        });
        let absent: Vec<_> = mirrored.into_iter().filter(|p| away(*p) > 14.0).collect();
        assert!(!absent.is_empty(), "{axis}");
        absent
    };
    (0..3).flat_map(along).collect()
}
