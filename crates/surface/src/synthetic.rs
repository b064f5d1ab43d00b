//! Clouds that the published study meshed, and a sphere.

use bonemesh_cloud::{Lattice, PointCloud};
use bonemesh_volume::Affine;

/// Pixels of the study's models, mm.
const PIXEL_MM: f64 = 0.4492;

/// Points spread evenly over a sphere.
pub(crate) fn sphere(count: usize, radius_mm: f64, centre_mm: [f64; 3]) -> PointCloud {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let points = (0..count).map(|i| {
        let z = 1.0 - (2 * i + 1) as f64 / count as f64;
        let (ring, turn) = ((1.0 - z * z).sqrt(), golden * i as f64);
        let on = [ring * turn.cos(), ring * turn.sin(), z];
        [0, 1, 2].map(|k| centre_mm[k] + radius_mm * on[k])
    });
    PointCloud::from_points(points.collect()).unwrap()
}

/// Slices with the pixels of which `is_edge` (column, row) says so.
pub(crate) fn slices(count: i32, slice_mm: f64, is_edge: impl Fn(i32, i32) -> bool) -> PointCloud {
    let mut coordinates = Vec::new();
    for k in 0..count {
        for j in 0..512 {
            let row = (0..512).filter(|&i| is_edge(i, j));
            coordinates.extend(row.map(|i| [i, j, k]));
        }
    }
    let frame_from_lattice = Affine::from_axes(
        [PIXEL_MM, 0.0, 0.0],
        [0.0, PIXEL_MM, 0.0],
        [0.0, 0.0, slice_mm],
        [0.0; 3],
    );
    PointCloud::from_lattice(Lattice {
        coordinates,
        frame_from_lattice,
    })
    .unwrap()
}

/// The study's line: the outline of a bar of 21 x 257 pixels, in each slice.
pub(crate) fn line_model(count: i32, slice_mm: f64) -> PointCloud {
    slices(count, slice_mm, |i, j| {
        let is_in = (245..=265).contains(&i) && (128..=384).contains(&j);
        is_in && (i == 245 || i == 265 || j == 128 || j == 384)
    })
}

/// A hollow cylinder of two radii in pixels; the study's has 150 and 140.
pub(crate) fn cylinder(count: i32, slice_mm: f64, [outer, inner]: [f64; 2]) -> PointCloud {
    slices(count, slice_mm, |i, j| {
        let radius = f64::from(i - 256).hypot(f64::from(j - 256));
        (radius - outer).abs() < 0.5 || (radius - inner).abs() < 0.5
    })
}
