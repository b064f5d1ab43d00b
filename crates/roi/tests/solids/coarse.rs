//! Meshes of few triangles, whose size says nothing of the body's.

use bonemesh_mesh::TriangleMesh;
use bonemesh_roi::{RoiError, select_solid};
use bonemesh_task::Task;

use crate::bodies::{length, request, shell, solid, volume_mm3};

/// A box of twelve triangles.
fn box_of([x, y, z]: [f64; 3]) -> TriangleMesh {
    let corners = (0..8).map(|c| [c & 1, c >> 1 & 1, c >> 2].map(f64::from));
    let corners = corners.map(|[i, j, k]| [i * x, j * y, k * z]).collect();
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = faces
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    TriangleMesh::new(corners, halves.collect()).unwrap()
}

#[test]
fn the_lid_of_a_box_of_twelve_triangles_is_cut_off() {
    let block = box_of([40.0, 30.0, 20.0]);
    let lid = solid(&block, &[4, 5, 6, 7], 5.0);
    let part = volume_mm3(&lid) / (40.0 * 30.0 * 5.0);
    assert!((part - 1.0).abs() < 0.02, "{part}");
    let all = solid(&block, &[0, 1, 2, 3, 4, 5, 6, 7], 50.0);
    assert!((volume_mm3(&all) / 24_000.0 - 1.0).abs() < 1e-6);
}

#[test]
fn half_a_face_is_one_triangle() {
    let block = box_of([40.0, 30.0, 20.0]);
    let half = solid(&block, &[4, 5, 7], 5.0);
    assert!((half.patch_mm2 - 600.0).abs() < 1e-9);
    let part = volume_mm3(&half) / (600.0 * 5.0);
    assert!((part - 1.0).abs() < 0.05, "{part}");
}

#[test]
fn of_one_small_triangle_a_splinter_is_cut_or_nothing() {
    // Edges of 0.75 mm, as a clinical scan gives them.
    let places = shell()
        .vertices_mm()
        .iter()
        .map(|v| v.map(|c| 3.0 * c))
        .collect();
    let shell = TriangleMesh::new(places, shell().triangles().to_vec()).unwrap();
    let triangles = shell.triangles().iter();
    let up = triangles.filter(|t| {
        let corners = shell.corners_mm(**t);
        corners.iter().all(|c| length(*c) > 51.0 && c[2] > 57.0)
    });
    let mut cut = 0;
    for triangle in up.step_by(149) {
        match select_solid(&shell, triangle, &request(3.0), &Task::default()) {
            Ok(solid) => {
                assert!((0.1..2.0).contains(&(volume_mm3(&solid) / 3.0 / solid.patch_mm2)));
                cut += 1;
            }
            Err(error) => assert!(matches!(error, RoiError::TooSmall { .. }), "{error}"),
        }
    }
    assert!(cut > 0);
}
