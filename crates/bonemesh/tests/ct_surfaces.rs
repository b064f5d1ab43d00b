//! The methods for use on series from the world outside, one pitfall each; skipped without
//! `BONEMESH_CT`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

mod common;

use std::path::PathBuf;

use bonemesh::{Islands, Method, Rendered, Settings, Task, TriangleMesh, render};
use common::distance::{Means, Triangles, means, sampled};

type Point = [f64; 3];

fn folder(name: &str) -> Option<PathBuf> {
    let Some(root) = std::env::var_os("BONEMESH_CT") else {
        eprintln!("skipped: BONEMESH_CT is not set");
        return None;
    };
    Some(PathBuf::from(root).join("hard").join(name))
}

fn rendered(name: &str, settings: &Settings) -> Option<Rendered> {
    let folder = folder(name)?;
    let task = Task::default();
    let rendered = render(&folder, settings, &task).unwrap_or_else(|e| panic!("{name}: {e}"));
    let report = bonemesh::check(&rendered.mesh, None, &task).unwrap();
    assert!(report.printable, "{name}: {report:?}");
    Some(rendered)
}

/// The settings of both methods for use.
fn both() -> [Settings; 2] {
    [Method::Isosurface, Method::Labelled].map(|method| Settings {
        method,
        ..Settings::default()
    })
}

const BASE: &str = "00_base_explicit_le";

#[test]
fn what_says_the_same_gives_the_same_mesh() {
    for settings in both() {
        let Some(base) = rendered(BASE, &settings) else {
            return;
        };
        for name in [
            "01_implicit_le",
            "02_explicit_be",
            "03_deflated",
            "04_rle",
            "05_jpeg_lossless_sv1",
            "06_jpeg_lossless_p14",
            "07_jpegls_lossless",
            "09_j2k_lossless",
            "20_no_instance_no_location_random_names",
            "22_duplicate_slice",
            "24_monochrome1_label_only",
            "25_unsigned_12bit",
            "26_12bit_garbage_in_high_nibble",
            "27_pixel_padding_minus2000",
            "28_reverse_order_head_to_foot",
            "41_no_preamble_no_meta_implicit",
            "42_enhanced_multiframe",
        ] {
            let same = rendered(name, &settings).unwrap();
            assert!(same.mesh == base.mesh, "{name}");
        }
    }
}

/// The base's mesh with its vertices elsewhere.
fn moved(mesh: &TriangleMesh, to: impl Fn(Point) -> Point) -> TriangleMesh {
    let vertices = mesh.vertices_mm().iter().map(|p| to(*p)).collect();
    TriangleMesh::new(vertices, mesh.triangles().to_vec()).unwrap()
}

/// Distances between meshes, the greater way.
fn apart(a: &TriangleMesh, b: &TriangleMesh) -> Means {
    let from = |mesh: &TriangleMesh, to: &TriangleMesh| {
        let to = Triangles::new(to, 4.0);
        let places = sampled(mesh, 3).into_iter();
        means(places.map(|(p, area)| (to.signed_distance_mm(p), area)))
    };
    let [there, back] = [from(a, b), from(b, a)];
    if there.unsigned > back.unsigned {
        there
    } else {
        back
    }
}

/// Asserts that a folder's meshes are those of the base, moved, up to this mean distance, where
/// pixels are 3.2 mm wide.
fn assert_is_base(name: &str, crop: Option<&str>, to: impl Fn(Point) -> Point, up_to_mm: f64) {
    for settings in both() {
        let of_base = Settings {
            crop: crop.map(|crop| crop.parse().unwrap()),
            ..settings.clone()
        };
        let Some(base) = rendered(BASE, &of_base) else {
            return;
        };
        let made = rendered(name, &settings).unwrap();
        let means = apart(&made.mesh, &moved(&base.mesh, &to));
        println!("{name}, {}: {means:?}", settings.method.name());
        assert!(means.unsigned < up_to_mm, "{name}: {means:?}");
        assert!(means.signed.abs() < 0.3 * up_to_mm, "{name}: {means:?}");
    }
}

/// Asserts the same of isosurfaces at the threshold, whose vertices know no millimetres, specks and all:
/// what is one is a question of volume.
fn assert_is_exactly_base(name: &str, crop: Option<&str>, to: impl Fn(Point) -> Point) {
    let mut settings = Settings {
        true_edges: false,
        ..Settings::default()
    };
    settings.after_care.islands = Some(Islands::AtLeastMm3(0.0));
    let of_base = Settings {
        crop: crop.map(|crop| crop.parse().unwrap()),
        ..settings.clone()
    };
    let Some(base) = rendered(BASE, &of_base) else {
        return;
    };
    let made = rendered(name, &settings).unwrap().mesh;
    let base = moved(&base.mesh, &to);
    // Triangles may be others: in which order voxels are looked at depends on their size.
    assert_eq!(made.vertices_mm().len(), base.vertices_mm().len(), "{name}");
    let base = Triangles::new(&base, 4.0);
    let away = |p: &Point| base.signed_distance_mm(*p).abs();
    let most = made.vertices_mm().iter().map(away).fold(0.0, f64::max);
    assert!(most < 1e-3, "{name}: {most} mm");
}

const CORNER: Point = [-100.8, -100.8, 60.0];

#[test]
fn values_that_are_a_little_off_move_the_surface_a_little() {
    for name in [
        "08_jpegls_near_unsigned12",
        "10_j2k_lossy",
        "23_slope_intercept_per_slice",
    ] {
        assert_is_base(name, None, |p| p, 0.1);
    }
}

#[test]
fn missing_slices_change_the_surface_only_where_they_are() {
    assert_is_base("21_missing_2_slices", None, |p| p, 0.15);
}

#[test]
fn a_coarser_second_half_stretches_the_surface() {
    let stretched = |[x, y, z]: Point| [x, y, z + (z - 76.5).max(0.0)];
    assert_is_base("29_variable_spacing_1.5_then_3", None, stretched, 0.4);
}

#[test]
fn a_tilted_gantry_shears_the_surface() {
    let (s, c) = 15.0_f64.to_radians().sin_cos();
    let sheared = |[x, y, z]: Point| {
        let row_mm = y - CORNER[1];
        [x, CORNER[1] + c * row_mm, z + s * row_mm]
    };
    let name = "30_gantry_tilt_header_15deg";
    assert_is_exactly_base(name, None, sheared);
    assert_is_base(name, None, sheared, 0.2);
}

#[test]
fn pixels_that_are_not_square_make_the_surface_narrower() {
    let narrower = |[x, y, z]: Point| [CORNER[0] + 0.5 * (x - CORNER[0]), y, z];
    let crop = Some("0:48,0:64,0:24");
    let name = "31_nonsquare_matrix_and_pixels";
    assert_is_exactly_base(name, crop, narrower);
    assert_is_base(name, crop, narrower, 0.3);
}
