//! Scans: the same for any number of threads, in every orientation, refused where impossible.

use std::num::NonZeroUsize;

use bonemesh_phantom::{
    ORIENTATIONS, Orientation, Phantom, PhantomError, ScanSettings, model_images, scan,
};
use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};
use ndarray::Array3;

fn hu(volume: &Volume) -> &Array3<i16> {
    let Voxels::I16(hu) = volume.voxels() else {
        unreachable!("phantoms are whole Hounsfield units")
    };
    hu
}

fn small(phantom: Phantom) -> ScanSettings {
    phantom.settings().coarser(4.0)
}

#[test]
fn any_number_of_threads_gives_the_same_scan() {
    let settings = small(Phantom::Head);
    let with = |threads| {
        bonemesh_task::pool(NonZeroUsize::new(threads))
            .unwrap()
            .install(|| scan(Phantom::Head, &settings, &Task::default()))
            .unwrap()
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
}

#[test]
fn another_seed_is_another_noise() {
    let settings = small(Phantom::Tube);
    let other = ScanSettings {
        seed: 1,
        ..settings.clone()
    };
    let task = Task::default();
    assert_ne!(
        scan(Phantom::Tube, &settings, &task).unwrap(),
        scan(Phantom::Tube, &other, &task).unwrap()
    );
}

#[test]
fn every_orientation_shows_each_point_of_the_head_where_it_lies() {
    let body = Phantom::Head.body().unwrap();
    for (name, _) in ORIENTATIONS {
        let settings = ScanSettings {
            columns: 64,
            rows: 64,
            slices: 64,
            pixel_mm: [3.4; 2],
            slice_mm: 3.4,
            orientation: name.parse().unwrap(),
            ..Phantom::Head.settings().ideal()
        };
        let volume = scan(Phantom::Head, &settings, &Task::default()).unwrap();
        let affine = *volume.geometry().patient_from_voxel();
        for ((k, j, i), value) in hu(&volume).indexed_iter().step_by(23) {
            let p = affine.apply([i as f64, j as f64, k as f64]);
            // Far from bone and skin a voxel is one tissue.
            if body.signed_distance_mm(p) < -4.0 {
                assert!(*value >= 1240, "{name} {p:?}: {value}");
            }
        }
        let bone = hu(&volume).iter().filter(|v| **v > 640).count() as f64;
        let ratio = bone * affine.determinant().abs() / 1e3;
        assert!(
            (400.0..900.0).contains(&ratio),
            "{name}: {ratio} cm3 of bone"
        );
    }
}

#[test]
fn a_model_is_scanned_as_it_is_drawn() {
    let settings = Phantom::Line.settings();
    let volume = scan(Phantom::Line, &settings, &Task::default()).unwrap();
    let drawn = model_images(Phantom::Line, volume.geometry().shape()).unwrap();
    assert_eq!(hu(&volume).mapv(|v| v > 350), drawn);
}

#[test]
fn blur_lowers_the_peak_of_a_thin_wall() {
    let settings = Phantom::Tube.settings().ideal();
    let blurred = ScanSettings {
        psf_px: 6.0,
        ..settings.clone()
    };
    let peak = |s| {
        let volume = scan(Phantom::Tube, s, &Task::default()).unwrap();
        volume.hu_range().1
    };
    assert!((peak(&settings) - 1240.0).abs() < 1.0);
    assert!(peak(&blurred) < 1100.0);
}

#[test]
fn impossible_settings_are_named() {
    let good = small(Phantom::Tube);
    let task = Task::default();
    for (settings, word) in [
        (
            ScanSettings {
                slice_mm: 0.0,
                ..good.clone()
            },
            "slice_mm",
        ),
        (
            ScanSettings {
                pixel_mm: [f64::NAN, 1.0],
                ..good.clone()
            },
            "pixel_mm",
        ),
        (
            ScanSettings {
                psf_px: -1.0,
                ..good.clone()
            },
            "psf_px",
        ),
        (
            ScanSettings {
                noise_hu: f64::INFINITY,
                ..good.clone()
            },
            "noise_hu",
        ),
        (
            ScanSettings {
                columns: 0,
                ..good.clone()
            },
            "at least one",
        ),
    ] {
        let error = scan(Phantom::Tube, &settings, &task).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
    }
    let skewed = Orientation {
        row_direction: [0.6, 0.8, 0.0],
        ..Orientation::axial()
    };
    let settings = ScanSettings {
        orientation: skewed,
        ..good
    };
    assert!(scan(Phantom::Tube, &settings, &task).is_err());
}

#[test]
fn unknown_names_list_the_known_ones() {
    let error = "skull".parse::<Phantom>().unwrap_err();
    assert!(
        error.to_string().contains("sphere-shell, tube, femur"),
        "{error}"
    );
    assert!("upside-down".parse::<Orientation>().is_err());
    for phantom in Phantom::ALL {
        assert_eq!(phantom.name().parse::<Phantom>().unwrap(), phantom);
    }
}

#[test]
fn a_cancelled_scan_stops() {
    let task = Task::default();
    task.cancel().cancel();
    let result = scan(Phantom::Tube, &small(Phantom::Tube), &task);
    assert!(matches!(result, Err(PhantomError::Cancelled(_))));
}

#[test]
fn bodies_have_no_binary_images() {
    assert!(matches!(
        model_images(Phantom::Head, [1, 512, 512]),
        Err(PhantomError::NoModel(Phantom::Head))
    ));
}
