//! One body, stored in every order and orientation: the same bone at the same place, left on the
//! left.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

mod common;

use std::collections::{HashMap, HashSet};
use std::sync::{LazyLock, OnceLock};

use bonemesh::{
    Frame, Phantom, Rendered, ScanSettings, Settings, Task, TriangleMesh, Volume, Voxels,
    point_cloud, read_mesh, render_volume, scan_phantom, write_mesh,
};
use common::distance::{Triangles, length, means, sampled};
use common::femur::{
    ALL_OTHERS, LANDMARKS, PARALLEL, PIXEL_MM, femur, mirrored_landmarks, settings,
    written_and_read,
};
use common::{fit, halfway, interpolated};
use ndarray::Array3;

/// Its mesh with the alpha that suits it: smaller than the marrow's canal is wide, larger than
/// the wall is thick, so that no web across the canal comes and goes with the grid.
fn rendered(volume: &Volume) -> Rendered {
    let settings = Settings {
        alpha_mm: Some(5.0),
        ..halfway()
    };
    render_volume(volume, &settings, &Task::default()).unwrap()
}

/// All orientations, each scanned, written, read and rendered once.
static FEMURS: LazyLock<HashMap<&str, OnceLock<(Volume, TriangleMesh)>>> = LazyLock::new(|| {
    let names = PARALLEL.into_iter().chain(ALL_OTHERS);
    names.map(|name| (name, OnceLock::new())).collect()
});

fn known(orientation: &str) -> &'static (Volume, TriangleMesh) {
    FEMURS[orientation].get_or_init(|| {
        let volume = femur(orientation);
        let mesh = rendered(&volume).mesh;
        (volume, mesh)
    })
}

/// The triangles by the numbers of their corners on the axial grid, each from its lowest corner
/// on, so that equal surfaces that face the same way are equal sets.
fn on_the_axial_grid(mesh: &TriangleMesh) -> HashSet<[[i64; 3]; 3]> {
    let back = known("axial")
        .0
        .geometry()
        .patient_from_voxel()
        .inverse()
        .unwrap();
    let corner = |p: [f64; 3]| {
        back.apply(p).map(|v| {
            assert!((v - v.round()).abs() < 1e-5, "{p:?} is no voxel's centre");
            v.round() as i64
        })
    };
    let triangles = mesh.triangles().iter();
    triangles
        .map(|t| {
            let mut corners = mesh.corners_mm(*t).map(corner);
            let first = (0..3).min_by_key(|c| corners[*c]).unwrap();
            corners.rotate_left(first);
            corners
        })
        .collect()
}

#[test]
fn every_order_of_the_same_voxels_gives_the_same_mesh() {
    let expected = on_the_axial_grid(&known("axial").1);
    assert!(expected.len() > 20_000);
    for name in PARALLEL {
        let mesh = &known(name).1;
        assert_eq!(mesh.triangles().len(), expected.len(), "{name}");
        assert!(on_the_axial_grid(mesh) == expected, "{name}");
    }
}

/// What the test above is for: found in the planes of storage, edges are others.
#[test]
fn edges_found_in_the_planes_of_storage_are_others() {
    let task = Task::default();
    let back = known("axial").0.geometry().patient_from_voxel().inverse();
    let back = back.unwrap();
    let edges = |name: &str| -> HashSet<[i64; 3]> {
        let volume = &known(name).0;
        let cloud = point_cloud(volume, &halfway(), Frame::Image, &task).unwrap();
        let affine = volume.geometry().patient_from_voxel();
        let voxels = cloud.lattice().unwrap().coordinates.iter();
        voxels
            .map(|at| back.apply(affine.apply(at.map(f64::from))))
            .map(|at| at.map(|v| v.round() as i64))
            .collect()
    };
    let expected = edges("axial");
    for name in ["sagittal", "coronal"] {
        let others = edges(name).symmetric_difference(&expected).count();
        println!("{name}: {others} of {} edge voxels differ", expected.len());
        assert!(others > 100, "{name}: {others}");
    }
}

#[test]
fn the_default_alpha_does_not_depend_on_the_order_either() {
    let alpha = |volume: &Volume| {
        let rendered = render_volume(volume, &halfway(), &Task::default()).unwrap();
        rendered.report.alpha_mm.unwrap()
    };
    let expected = alpha(&known("axial").0);
    for name in ["feet-first", "sagittal", "decubitus-left"] {
        assert!((alpha(&known(name).0) - expected).abs() < 1e-9, "{name}");
    }
}

/// Vertices of the published method are centres of voxels beside the surface, so each is off by
/// a quarter of a pixel in the mean (a uniform error of half a pixel at most), whatever the
/// orientation: two grids that share no voxel cannot come nearer than that. What must vanish is
/// everything systematic: the shift of the whole, and the mean with its sign.
#[test]
fn other_grids_give_the_same_surface_up_to_the_size_of_their_voxels() {
    let body = Phantom::Femur.body().unwrap();
    let axial = &known("axial").1;
    let reference = Triangles::new(axial, 2.0 * PIXEL_MM);
    for name in ALL_OTHERS {
        let mesh = &known(name).1;
        let truth = fit(mesh, body.as_ref(), |_| true);
        let to = |other: &Triangles, mesh: &TriangleMesh| {
            let places = sampled(mesh, 3).into_iter();
            means(places.map(|(p, area)| (other.signed_distance_mm(p), area)))
        };
        let there = to(&reference, mesh);
        let back = to(&Triangles::new(mesh, 2.0 * PIXEL_MM), axial);
        println!("{name}: to the truth {truth:?}; to the axial mesh {there:?}, back {back:?}");
        assert!(truth.distance_mm.unsigned < 0.30 * PIXEL_MM, "{name}");
        assert!(truth.distance_mm.signed.abs() < 0.1 * PIXEL_MM, "{name}");
        assert!(truth.shift_mm < 0.1 * PIXEL_MM, "{name}");
        for means in [there, back] {
            assert!(means.unsigned < 0.25 * PIXEL_MM, "{name}: {means:?}");
            assert!(means.signed.abs() < 0.1 * PIXEL_MM, "{name}: {means:?}");
        }
    }
}

#[test]
fn left_front_and_head_stay_where_they_are() {
    let absent = mirrored_landmarks();
    for name in PARALLEL.into_iter().chain(ALL_OTHERS) {
        let surface = Triangles::new(&known(name).1, 2.0 * PIXEL_MM);
        for landmark in LANDMARKS {
            let near = surface.signed_distance_mm(landmark).abs();
            assert!(near < 8.0, "{name}: {near} mm from {landmark:?}");
        }
        for mirrored in &absent {
            let far = surface.signed_distance_mm(*mirrored).abs();
            assert!(far > 12.0, "{name}: {far} mm from {mirrored:?}");
        }
    }
}

#[test]
fn triangles_face_outward_in_grids_of_either_hand() {
    let body = Phantom::Tube.body().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut hands = HashSet::new();
    for name in ["axial", "reversed", "coronal", "sagittal"] {
        // Thick slices stay slices: coronal ones make a left-handed grid.
        let slice_mm = 2.0;
        let settings = ScanSettings {
            columns: 80,
            rows: 80,
            slices: 40,
            pixel_mm: [1.0; 2],
            slice_mm,
            orientation: name.parse().unwrap(),
            ..Phantom::Tube.settings().ideal()
        };
        let volume = scan_phantom(Phantom::Tube, &settings, &Task::default()).unwrap();
        let ordered = volume.in_patient_order(&Task::default()).unwrap();
        let spacing = ordered.geometry().spacing_mm();
        assert!((spacing[2] - slice_mm).abs() < 1e-9, "{name}: {spacing:?}");
        hands.insert(ordered.geometry().patient_from_voxel().determinant() > 0.0);

        let stl = folder.path().join(format!("{name}.stl"));
        let mesh = rendered(&volume).mesh;
        write_mesh(&stl, &mesh, &Task::default()).unwrap();
        let mesh = read_mesh(&stl, &Task::default()).unwrap();
        let report = bonemesh::check(&mesh, None, &Task::default()).unwrap();
        assert!(
            report.topology.volume_mm3 > 20_000.0,
            "{name}: {}",
            report.topology.volume_mm3
        );
        let outward = mesh.triangles().iter().filter(|t| {
            let [a, b, c] = mesh.corners_mm(**t);
            let (u, v) = (
                [0, 1, 2].map(|i| b[i] - a[i]),
                [0, 1, 2].map(|i| c[i] - a[i]),
            );
            let normal = [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ];
            let off = |mm: f64| {
                let size = length(normal).max(1e-9);
                let p = std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0 + mm * normal[i] / size);
                body.signed_distance_mm(p)
            };
            off(1.0) > off(-1.0)
        });
        let share = outward.count() as f64 / mesh.triangles().len() as f64;
        println!("{name}: {share:.3} of the triangles face away from the bone");
        assert!(share > 0.85, "{name}: {share}");
    }
    assert_eq!(hands.len(), 2);
}

/// Hounsfield units that no mirrored or shifted grid shows: 1 HU is a tenth of a millimetre.
fn slope_hu(p: [f64; 3]) -> f64 {
    10.0 * p[0] - 7.0 * p[1] + 4.0 * p[2]
}

#[test]
fn every_volume_shows_the_same_hounsfield_units_at_a_point_of_the_patient() {
    for name in PARALLEL.into_iter().chain(ALL_OTHERS) {
        let settings = ScanSettings {
            pixel_mm: [0.75, 1.0],
            slice_mm: 2.5,
            columns: 24,
            rows: 20,
            slices: 16,
            centre_mm: [11.0, -23.0, 35.0],
            ..settings(name)
        };
        let geometry = settings.geometry().unwrap();
        let affine = *geometry.patient_from_voxel();
        let hu = Array3::from_shape_fn(geometry.shape(), |(k, j, i)| {
            slope_hu(affine.apply([i as f64, j as f64, k as f64])).round() as i16
        });
        let volume = Volume::new(Voxels::I16(hu), geometry).unwrap();
        let read = written_and_read(&volume, &settings);
        let mut inside = 0;
        for step in 0..1000 {
            // Points of a coarse grid about the middle, on no voxel's centre.
            let [a, b, c] = [step % 10, step / 10 % 10, step / 100].map(|n| f64::from(n) - 4.5);
            let p = [11.0 + 2.1 * a, -23.0 + 2.3 * b, 35.0 + 4.1 * c];
            if let Some(value) = interpolated(&read, p) {
                assert!(
                    (value - slope_hu(p)).abs() < 0.6,
                    "{name} at {p:?}: {value}"
                );
                inside += 1;
            }
        }
        assert!(inside > 200, "{name}: {inside}");
    }
}
