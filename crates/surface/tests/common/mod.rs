//! What the tests of surfaces of volumes share: volumes whose truth is a formula, and what every
//! surface must be.

#![allow(dead_code, reason = "each test file uses its part")]

use bonemesh_mesh::{TriangleMesh, TriangleTree, check_topology, find_intersections};
use bonemesh_surface::IsosurfaceSettings;
use bonemesh_task::Task;
use bonemesh_volume::{Affine, Geometry, Volume, Voxels};
use ndarray::Array3;

pub(crate) const SOFT_HU: f64 = 40.0;
pub(crate) const BONE_HU: f64 = 1240.0;
pub(crate) const PIXEL_MM: f64 = 0.5;
pub(crate) const BLUR_MM: f64 = 0.4;

pub(crate) fn at(threshold_hu: f64, true_edges: bool) -> IsosurfaceSettings<'static> {
    IsosurfaceSettings {
        threshold_hu,
        leveled: None,
        true_edges,
    }
}

/// A volume of `[slices, rows, columns]` around the origin.
pub(crate) fn volume(shape: [usize; 3], slice_mm: f64, hu: impl Fn([f64; 3]) -> f64) -> Volume {
    let [slices, rows, columns] = shape;
    let middle = |n: usize, step: f64| -0.5 * step * (n as f64 - 1.0);
    let origin = [
        middle(columns, PIXEL_MM),
        middle(rows, PIXEL_MM),
        middle(slices, slice_mm),
    ];
    let map = Affine::from_axes(
        [PIXEL_MM, 0.0, 0.0],
        [0.0, PIXEL_MM, 0.0],
        [0.0, 0.0, slice_mm],
        origin,
    );
    let voxels = Array3::from_shape_fn((slices, rows, columns), |(k, j, i)| {
        hu(map.apply([i as f64, j as f64, k as f64])).round() as i16
    });
    of_voxels(voxels, map)
}

pub(crate) fn of_voxels(hu: Array3<i16>, patient_from_voxel: Affine) -> Volume {
    let shape = hu.dim();
    let geometry = Geometry::new([shape.0, shape.1, shape.2], patient_from_voxel).unwrap();
    Volume::new(Voxels::I16(hu), geometry).unwrap()
}

/// The same voxels on axes of the other hand.
pub(crate) fn mirrored(volume: Volume) -> Volume {
    let (voxels, geometry) = volume.into_parts();
    let map = geometry.patient_from_voxel();
    let map = Affine::from_axes(map.axis(1), map.axis(0), map.axis(2), map.origin());
    let geometry = Geometry::new(geometry.shape(), map).unwrap();
    Volume::new(voxels, geometry).unwrap()
}

/// Bone beyond a blurred edge, by the distance from it into the bone.
pub(crate) fn blurred(inside_mm: f64) -> f64 {
    let part = 0.5 * (1.0 + libm::erf(inside_mm / (BLUR_MM * std::f64::consts::SQRT_2)));
    SOFT_HU + (BONE_HU - SOFT_HU) * part
}

/// Voxels of which some, chosen by `seed`, are above 350 HU.
pub(crate) fn random_voxels(shape: [usize; 3], seed: u64, eighths: u64) -> Array3<i16> {
    let mut state = seed;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as i16 & 0xfff
    };
    Array3::from_shape_simple_fn((shape[0], shape[1], shape[2]), || {
        if (random() as u64) % 8 < eighths {
            351 + random() % 900
        } else {
            random() % 350
        }
    })
}

/// Closed, manifold, outward, and as a file would hold it, in 32-bit coordinates, free of
/// self-intersections.
pub(crate) fn assert_is_closed(mesh: &TriangleMesh) {
    let topology = check_topology(mesh, &Task::default()).unwrap();
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    assert_eq!(topology.inconsistent_edges, 0);
    assert_eq!(topology.degenerate_triangles, 0);
    assert_eq!(topology.unused_vertices, 0);
    assert!(topology.volume_mm3 > 0.0);
    let written = mesh.as_written(&Task::default()).unwrap();
    assert_eq!(written.vertices_mm().len(), mesh.vertices_mm().len());
    let tree = TriangleTree::new(&written, &Task::default()).unwrap();
    let found = find_intersections(&tree, 3, &Task::default()).unwrap();
    assert_eq!(found.count, 0, "{:?}", found.pairs);
}

pub(crate) fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

pub(crate) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}
