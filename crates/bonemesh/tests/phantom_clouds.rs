//! The tetrahedra of every phantom's edge points, judged without the code that made them.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use std::collections::HashMap;

use bonemesh::{Frame, point_cloud};
use bonemesh_delaunay::{Points, alpha_boundary, alpha_complex, tetrahedralize};
use bonemesh_phantom::{Phantom, scan};
use bonemesh_task::Task;
use common::halfway;

type Vec3 = [f64; 3];

fn minus(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Centre (from the first corner) and squared radius of the sphere through four points.
fn sphere([a, b, c, d]: [Vec3; 4]) -> (Vec3, f64) {
    let (u, v, w) = (minus(b, a), minus(c, a), minus(d, a));
    let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
    let scale = 0.5 / dot(u, vw);
    let centre =
        [0, 1, 2].map(|k| scale * (dot(u, u) * vw[k] + dot(v, v) * wu[k] + dot(w, w) * uv[k]));
    (centre, dot(centre, centre))
}

#[test]
fn the_tetrahedra_of_every_phantom_are_delaunay_and_alpha_keeps_the_small_ones() {
    let task = Task::default();
    for phantom in Phantom::ALL {
        let mut settings = phantom.settings();
        if phantom.body().is_some() {
            settings = settings.coarser(4.0);
        } else {
            // Drawn in pixels, the same in every slice.
            settings.slices = 4;
        }
        let volume = scan(phantom, &settings, &task).unwrap();
        let cloud = point_cloud(&volume, &halfway(), Frame::Patient, &task).unwrap();
        let lattice = cloud.lattice().unwrap();
        let points = Points::Lattice {
            coordinates: &lattice.coordinates,
            gram: lattice.frame_from_lattice.gram(),
        };
        let mm = cloud.points_mm();
        let cells = tetrahedralize(points, &task).unwrap().cells;
        assert!(cells.len() > cloud.len(), "{phantom}");
        let corners = |cell: &[u32; 4]| cell.map(|v| mm[v as usize]);

        // Across every inner facet the neighbour's point is not inside: then none is anywhere.
        let mut beyond: HashMap<[u32; 3], (usize, u32)> = HashMap::new();
        for (index, cell) in cells.iter().enumerate() {
            for apex in 0..4 {
                let mut facet: Vec<u32> = (0..4).filter(|k| *k != apex).map(|k| cell[k]).collect();
                facet.sort_unstable();
                let facet = [facet[0], facet[1], facet[2]];
                let Some((other, point)) = beyond.insert(facet, (index, cell[apex])) else {
                    continue;
                };
                for (of, query) in [(index, point), (other, cell[apex])] {
                    let around = corners(&cells[of]);
                    let (centre, squared) = sphere(around);
                    let query = minus(minus(mm[query as usize], around[0]), centre);
                    let inside = (squared - dot(query, query)) / squared;
                    assert!(inside < 1e-6, "{phantom}: {inside}");
                }
            }
        }

        let radius = |cell: &[u32; 4]| sphere(corners(cell)).1.sqrt();
        let mut radii: Vec<f64> = cells.iter().map(radius).collect();
        radii.sort_unstable_by(f64::total_cmp);
        // Between two radii that rounding cannot confuse, so that the count is sure.
        let gap = |pair: &&[f64]| pair[1] - pair[0] > 1e-6 * pair[0];
        let pair = radii[radii.len() / 2..].windows(2).find(gap).unwrap();
        let alpha = f64::midpoint(pair[0], pair[1]);
        let small: Vec<[u32; 4]> = cells
            .iter()
            .filter(|c| radius(c) < alpha)
            .copied()
            .collect();
        let kept = alpha_complex(points, alpha, &task).unwrap();
        assert_eq!(kept.cells, small, "{phantom}");
        let boundary = alpha_boundary(points, alpha, &task).unwrap();
        assert_eq!(
            boundary.triangles,
            kept.boundary(&task).unwrap(),
            "{phantom}"
        );
    }
}
