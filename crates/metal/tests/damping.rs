//! What damping does to slices and surfaces of a tube with steel beside it, scanned with X-rays of
//! many energies.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use std::num::NonZeroUsize;
use std::sync::LazyLock;

use bonemesh_metal::{Metal, damp_metal, find_metal};
use bonemesh_phantom::{BoneSurface, Phantom, ScanSettings};
use bonemesh_surface::{IsosurfaceSettings, isosurface};
use bonemesh_task::{Task, pool};
use bonemesh_volume::{Volume, Voxels};
use ndarray::Array3;

use common::{Alloy, Rod, Scanner};

/// A tube of bone, and a screw on either side of it.
struct Scene {
    scanner: Scanner,
    without: Volume,
    with: Volume,
    metal: Metal,
    damped: Volume,
}

static SCENE: LazyLock<Scene> = LazyLock::new(|| {
    let task = Task::default();
    let screw = |x: f64, y: f64| Rod {
        a: [x, y, -2.0],
        b: [x, y, 2.0],
        radius_mm: 2.0,
        alloy: Alloy::Steel,
    };
    let settings = ScanSettings {
        columns: 120,
        rows: 120,
        slices: 12,
        ..Phantom::Tube.settings()
    };
    let scanner = Scanner {
        settings,
        trunk_mm: Some(27.0),
        photons: 3e5,
        metal: vec![screw(-19.0, 0.0), screw(19.0, 4.0)],
    };
    let without = scanner.scan(Phantom::Tube, false);
    let with = scanner.scan(Phantom::Tube, true);
    let metal = find_metal(&with, &task).unwrap().unwrap();
    let damped = damp_metal(&with, &metal, &task).unwrap();
    Scene {
        scanner,
        without,
        with,
        metal,
        damped,
    }
});

fn whole(volume: &Volume) -> &Array3<i16> {
    let Voxels::I16(hu) = volume.voxels() else {
        unreachable!("scans are whole numbers")
    };
    hu
}

impl Scene {
    fn to_metal_mm(&self, p: [f64; 3]) -> f64 {
        let distances = self.scanner.metal.iter().map(|rod| rod.distance_mm(p));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// The error (HU, root mean square) of voxels of slices with metal that have `hu` without it
    /// and lie `away` mm from it.
    fn error_hu(&self, volume: &Volume, hu: [i16; 2], away: [f64; 2]) -> f64 {
        let affine = self.without.geometry().patient_from_voxel();
        let (mut count, mut sum) = (0.0, 0.0);
        for ((k, j, i), truth) in whole(&self.without).indexed_iter() {
            let is_meant = (self.metal.slices[0]..=self.metal.slices[1]).contains(&k)
                && (hu[0]..=hu[1]).contains(truth);
            let from = self.to_metal_mm(affine.apply([i as f64, j as f64, k as f64]));
            if is_meant && (away[0]..away[1]).contains(&from) {
                count += 1.0;
                sum += f64::from(whole(volume)[[k, j, i]] - truth).powi(2);
            }
        }
        f64::sqrt(sum / count)
    }

    /// Distances (mm) of the surface to the truth in slices with metal, 2.5 mm and more away from it.
    fn surface_errors_mm(&self, volume: &Volume) -> Vec<f64> {
        let task = Task::default();
        let placing = IsosurfaceSettings {
            threshold_hu: 350.0,
            leveled: None,
            true_edges: true,
        };
        let mesh = isosurface(volume, placing, &task).unwrap();
        let [low, high] = self.metal.z_mm;
        let near: Vec<[f64; 3]> = mesh
            .vertices_mm()
            .iter()
            .copied()
            .filter(|v| (low..=high).contains(&v[2]) && self.to_metal_mm(*v) > 2.5)
            .collect();
        let truth = BoneSurface::of(Phantom::Tube).unwrap();
        let found = truth.nearest_of_all(&near, 1.2, &task).unwrap();
        let mut errors: Vec<f64> = found.iter().map(|n| n.distance_mm.abs()).collect();
        errors.sort_by(f64::total_cmp);
        errors
    }
}

const SOFT: [i16; 2] = [-200, 200];
const BONE: [i16; 2] = [700, 2000];

#[test]
fn steel_is_found_with_its_streaks_and_a_scan_without_has_none() {
    let metal = &SCENE.metal;
    assert_eq!(metal.pieces, 2);
    let true_mm3 = 2.0 * std::f64::consts::PI * (4.0 * 4.0 + 4.0 / 3.0 * 8.0);
    let bloomed = metal.volume_mm3 / true_mm3;
    assert!((1.0..2.0).contains(&bloomed), "{bloomed}");
    let streaks = metal.streaks.unwrap();
    println!(
        "{metal:?} {streaks:?}",
        metal = (metal.volume_mm3, metal.slices)
    );
    assert!(
        streaks.with_metal_hu > 2.0 * streaks.without_hu,
        "{streaks:?}"
    );
    assert!(
        find_metal(&SCENE.without, &Task::default())
            .unwrap()
            .is_none()
    );
}

#[test]
fn damping_more_than_halves_the_error_of_soft_tissue_and_lessens_that_of_bone() {
    for (name, hu, away, at_most) in [
        ("soft", SOFT, [1.5, 5.0], 0.5),
        ("soft", SOFT, [5.0, 10.0], 0.5),
        ("soft", SOFT, [10.0, 30.0], 0.5),
        ("bone", BONE, [1.5, 5.0], 0.95),
        ("bone", BONE, [5.0, 10.0], 0.9),
        ("bone", BONE, [10.0, 30.0], 0.7),
    ] {
        let before = SCENE.error_hu(&SCENE.with, hu, away);
        let after = SCENE.error_hu(&SCENE.damped, hu, away);
        println!("{name} {away:?} mm: {before:.1} -> {after:.1} HU");
        assert!(
            after < at_most * before,
            "{name} {away:?}: {before} {after}"
        );
    }
}

#[test]
fn the_surface_beside_metal_comes_nearer_to_the_truth() {
    let errors = [&SCENE.without, &SCENE.with, &SCENE.damped];
    let [clean, before, after] = errors.map(|volume| SCENE.surface_errors_mm(volume));
    let mean = |e: &[f64]| e.iter().sum::<f64>() / e.len() as f64;
    let high = |e: &[f64]| e[e.len() * 95 / 100];
    let most = |e: &[f64]| e[e.len() - 1];
    for (name, e) in [("without", &clean), ("with", &before), ("damped", &after)] {
        println!(
            "{name}: mean {:.3}, 95 % {:.3}, most {:.3} mm, {} vertices",
            mean(e),
            high(e),
            most(e),
            e.len()
        );
    }
    assert!(
        mean(&after) < 0.6 * mean(&before),
        "{} {}",
        mean(&before),
        mean(&after)
    );
    assert!(
        high(&after) < 0.6 * high(&before),
        "{} {}",
        high(&before),
        high(&after)
    );
}

#[test]
fn slices_without_metal_and_metal_itself_keep_every_value() {
    let task = Task::default();
    let (with, damped) = (whole(&SCENE.with), whole(&SCENE.damped));
    let [first, last] = SCENE.metal.slices;
    let mut changed = 0;
    for (k, (a, b)) in with.outer_iter().zip(damped.outer_iter()).enumerate() {
        if k + 1 < first || k > last + 1 {
            assert_eq!(a, b, "slice {k}");
        }
        changed += usize::from(a != b);
        assert!(
            a.iter().zip(b).all(|(a, b)| *a < 3000 || a == b),
            "slice {k}"
        );
    }
    assert!(changed > last - first);
    let again = find_metal(&SCENE.damped, &task).unwrap().unwrap();
    assert!((again.volume_mm3 - SCENE.metal.volume_mm3).abs() < 1e-9);
}

#[test]
fn the_result_is_the_same_for_any_number_of_threads_and_any_order_of_slices() {
    let task = Task::default();
    let one = pool(NonZeroUsize::new(1)).unwrap();
    let alone = one.install(|| damp_metal(&SCENE.with, &SCENE.metal, &task).unwrap());
    assert!(alone == SCENE.damped);

    let turned = bottom_up(&SCENE.with);
    let metal = find_metal(&turned, &task).unwrap().unwrap();
    let [slices, ..] = turned.geometry().shape();
    assert_eq!(
        metal.slices,
        [
            slices - 1 - SCENE.metal.slices[1],
            slices - 1 - SCENE.metal.slices[0]
        ]
    );
    let damped = damp_metal(&turned, &metal, &task).unwrap();
    assert!(bottom_up(&damped).voxels() == SCENE.damped.voxels());
    assert!(
        damp_metal(&turned, &SCENE.metal, &task).is_err(),
        "not its own metal"
    );
}

/// The same body with its slices stored in the other order.
fn bottom_up(volume: &Volume) -> Volume {
    let mut hu = whole(volume).clone();
    hu.invert_axis(ndarray::Axis(0));
    let affine = volume.geometry().patient_from_voxel();
    let [slices, ..] = volume.geometry().shape();
    let down = affine.axis(2).map(|c| -c);
    let top = affine.apply([0.0, 0.0, (slices - 1) as f64]);
    let affine = bonemesh_volume::Affine::from_axes(affine.axis(0), affine.axis(1), down, top);
    let geometry = bonemesh_volume::Geometry::new(volume.geometry().shape(), affine).unwrap();
    Volume::new(Voxels::I16(hu.as_standard_layout().into_owned()), geometry).unwrap()
}

#[test]
fn it_stops_when_cancelled() {
    let task = Task::default();
    task.cancel().cancel();
    assert!(find_metal(&SCENE.with, &task).is_err());
    assert!(damp_metal(&SCENE.with, &SCENE.metal, &task).is_err());
}
