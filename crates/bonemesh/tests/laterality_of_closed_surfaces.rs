//! The methods for use on one bone in every order and orientation of voxels: the same surface at
//! the true place, left on the left.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use std::collections::HashMap;
use std::sync::{LazyLock, OnceLock};

use bonemesh::{
    Method, Phantom, Rendered, ScanSettings, Settings, Task, TriangleMesh, Volume, read_mesh,
    render_volume, scan_phantom, write_mesh,
};
use bonemesh_phantom::BoneSurface;
use common::distance::{Means, Triangles, cross, length, means, sampled, shift, sub};
use common::femur::{ALL_OTHERS, LANDMARKS, PARALLEL, PIXEL_MM, femur, mirrored_landmarks};

const METHODS: [Method; 2] = [Method::Isosurface, Method::Labelled];

/// At the default threshold, 290 HU below the middle of the edge.
fn rendered(volume: &Volume, method: Method) -> Rendered {
    let settings = Settings {
        method,
        ..Settings::default()
    };
    render_volume(volume, &settings, &Task::default()).unwrap()
}

/// All orientations, each scanned, written, read and rendered once by each method.
static FEMURS: LazyLock<HashMap<&str, OnceLock<[TriangleMesh; 2]>>> = LazyLock::new(|| {
    let names = PARALLEL.into_iter().chain(ALL_OTHERS);
    names.map(|name| (name, OnceLock::new())).collect()
});

fn known(orientation: &str) -> &'static [TriangleMesh; 2] {
    FEMURS[orientation].get_or_init(|| {
        let volume = femur(orientation);
        METHODS.map(|method| rendered(&volume, method).mesh)
    })
}

/// Every mesh of the femur with what it is called.
fn all(names: impl IntoIterator<Item = &'static str>) -> Vec<(String, &'static TriangleMesh)> {
    let of = |name: &'static str| {
        let meshes = known(name).iter().zip(METHODS);
        meshes.map(move |(mesh, method)| (format!("{name}, {}", method.name()), mesh))
    };
    names.into_iter().flat_map(of).collect()
}

#[test]
fn every_order_of_the_same_voxels_gives_the_same_mesh() {
    for name in PARALLEL {
        for (mesh, axial) in known(name).iter().zip(known("axial")) {
            assert!(axial.triangles().len() > 20_000);
            assert!(mesh.triangles() == axial.triangles(), "{name}");
            let pairs = mesh.vertices_mm().iter().zip(axial.vertices_mm());
            let most = pairs.map(|(a, b)| length(sub(*a, *b))).fold(0.0, f64::max);
            assert!(most < 1e-9, "{name}: {most} mm");
        }
    }
}

/// How far a mesh's triangles are from the bone's surface, away from its creases, and where they
/// lie as a whole.
fn against_truth(mesh: &TriangleMesh) -> (Means, f64) {
    let surface = BoneSurface::of(Phantom::Femur).unwrap();
    let (points, areas): (Vec<_>, Vec<_>) = sampled(mesh, 5).into_iter().unzip();
    let nearest = surface.nearest_of_all(&points, PIXEL_MM, &Task::default());
    let nearest = nearest.unwrap().into_iter().zip(areas);
    let nearest: Vec<_> = nearest.filter(|(n, _)| !n.crease).collect();
    (
        means(nearest.iter().map(|(n, area)| (n.distance_mm, *area))),
        length(shift(
            nearest.iter().map(|(n, _)| (n.distance_mm, n.normal)),
        )),
    )
}

/// Bars are parts of a voxel of 2 mm: the mean error is a fortieth.
#[test]
fn every_grid_gives_the_true_surface_at_its_true_place() {
    let all_axial = known("axial").each_ref();
    let references = all_axial.map(|mesh| Triangles::new(mesh, 2.0 * PIXEL_MM));
    for (name, mesh) in all(ALL_OTHERS) {
        let (distance_mm, shift_mm) = against_truth(mesh);
        println!("{name}: {distance_mm:?}, shift {shift_mm:.4} mm");
        assert!(distance_mm.unsigned < 0.04 * PIXEL_MM, "{name}");
        assert!(distance_mm.p95 < 0.1 * PIXEL_MM, "{name}");
        assert!(distance_mm.signed.abs() < 0.015 * PIXEL_MM, "{name}");
        assert!(shift_mm < 0.01 * PIXEL_MM, "{name}");
    }
    for name in ALL_OTHERS {
        for (mesh, axial) in known(name).iter().zip(&references) {
            let places = sampled(mesh, 3).into_iter();
            let apart = means(places.map(|(p, area)| (axial.signed_distance_mm(p), area)));
            assert!(apart.unsigned < 0.03 * PIXEL_MM, "{name}: {apart:?}");
            assert!(apart.signed.abs() < 0.005 * PIXEL_MM, "{name}: {apart:?}");
        }
    }
}

#[test]
fn left_front_and_head_stay_where_they_are() {
    let absent = mirrored_landmarks();
    for (name, mesh) in all(PARALLEL.into_iter().chain(ALL_OTHERS)) {
        let surface = Triangles::new(mesh, 2.0 * PIXEL_MM);
        for landmark in LANDMARKS {
            let near = surface.signed_distance_mm(landmark).abs();
            assert!(near < 5.0, "{name}: {near} mm from {landmark:?}");
        }
        for mirrored in &absent {
            let far = surface.signed_distance_mm(*mirrored);
            assert!(far > 13.0, "{name}: {far} mm from {mirrored:?}");
        }
    }
}

#[test]
fn every_orientation_can_be_printed() {
    for (name, mesh) in all(["axial", "oblique", "tilted", "decubitus-right"]) {
        let report = bonemesh::check(mesh, None, &Task::default()).unwrap();
        assert!(report.printable, "{name}: {report:?}");
    }
}

/// The part of the area that faces away from the bone.
fn outward(surface: &BoneSurface, mesh: &TriangleMesh) -> f64 {
    let (mut whole, mut outward) = (0.0, 0.0);
    for triangle in mesh.triangles() {
        let [a, b, c] = mesh.corners_mm(*triangle);
        let normal = cross(sub(b, a), sub(c, a));
        let middle = [0, 1, 2].map(|i| (a[i] + b[i] + c[i]) / 3.0);
        let truth = surface.nearest(middle, 1.0).normal;
        let facing: f64 = (0..3).map(|i| normal[i] * truth[i]).sum();
        whole += length(normal);
        outward += if facing > 0.0 { length(normal) } else { 0.0 };
    }
    outward / whole
}

#[test]
fn triangles_face_outward_in_grids_of_either_hand() {
    let surface = BoneSurface::of(Phantom::Tube).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut left_handed = 0;
    for name in ["axial", "reversed", "coronal", "sagittal"] {
        // Thick slices stay slices: coronal ones make a left-handed grid.
        let settings = ScanSettings {
            columns: 80,
            rows: 80,
            slices: 40,
            pixel_mm: [1.0; 2],
            slice_mm: 2.0,
            orientation: name.parse().unwrap(),
            ..Phantom::Tube.settings().ideal()
        };
        let volume = scan_phantom(Phantom::Tube, &settings, &Task::default()).unwrap();
        let ordered = volume.in_patient_order(&Task::default()).unwrap();
        let hand = ordered.geometry().patient_from_voxel().determinant();
        left_handed += u32::from(hand < 0.0);
        for method in METHODS {
            let stl = folder.path().join(format!("{name}.stl"));
            let made = rendered(&volume, method).mesh;
            write_mesh(&stl, &made, &Task::default()).unwrap();
            let mesh = read_mesh(&stl, &Task::default()).unwrap();
            let part = outward(&surface, &mesh);
            println!("{name}, {}: {part:.4} of the area", method.name());
            assert!(part > 0.99, "{name}: {part}");
        }
    }
    assert!((1..4).contains(&left_handed));
}
