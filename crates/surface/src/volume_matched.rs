//! The alpha with which the tetrahedra have the volume of the bone.
//!
//! 1. Tetrahedralise the cloud once, and sort the tetrahedra by circumradius.
//! 2. Their volumes, added up in that order, are the volumes of all alpha complexes: take the one
//!    nearest to the volume asked for. Tetrahedra of one radius stay together.
//! 3. Keep the tetrahedra up to there; alpha is halfway to the next radius.

use bonemesh_cloud::PointCloud;
use bonemesh_delaunay::{AlphaBoundary, Tetrahedra, tetrahedralize};
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::SurfaceError;
use crate::alpha::points;
use bonemesh_mesh::vector::{cross, dot, minus};

/// Radii that differ by less than this part are one: on a lattice many are equal but for rounding.
const SAME: f64 = 1e-9;
/// Tetrahedra between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// The alpha complex of a given volume.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeMatched {
    /// Largest circumradius kept.
    pub alpha_mm: f64,
    /// The volume of the tetrahedra kept: as near to what was asked for as any alpha brings it.
    pub volume_mm3: f64,
    /// Their boundary, for [`boundary_surface`](crate::boundary_surface).
    pub boundary: AlphaBoundary,
}

/// The Delaunay tetrahedra of `cloud` up to that circumradius with which their volume is nearest
/// to `volume_mm3`, such as that of all voxels of the bone.
///
/// Limits: the volume asked for may not be had: a solid body whose points lie on its outermost
/// voxels has less even in its convex hull. Where thin parts need a large alpha, gaps elsewhere
/// close to make up the volume. The stages are those of `tetrahedralize` and `surface`.
///
/// R. Gardiner et al., *Alpha shapes: determining 3D shape complexity across morphologically diverse
/// structures*, 2018, whose coefficient is this alpha over the mean distance to the neighbours.
///
/// # Errors
/// [`SurfaceError::Volume`] for no volume, [`SurfaceError::Delaunay`] where the points enclose no
/// space, [`SurfaceError::Cancelled`].
pub fn volume_matched_boundary(
    cloud: &PointCloud,
    volume_mm3: f64,
    task: &Task,
) -> Result<VolumeMatched, SurfaceError> {
    if !volume_mm3.is_finite() || volume_mm3 <= 0.0 {
        return Err(SurfaceError::Volume(volume_mm3));
    }
    let Tetrahedra { cells } = tetrahedralize(points(cloud), task)?;
    task.begin("surface", 1);
    let radii: Vec<f64> = measured(cloud, &cells, radius_mm, task)?;
    let volumes: Vec<f64> = measured(cloud, &cells, |corners| six_volumes(corners) / 6.0, task)?;
    let mut order: Vec<u32> = (0..cells.len() as u32).collect();
    order.par_sort_unstable_by(|&a, &b| {
        let by_radius = radii[a as usize].total_cmp(&radii[b as usize]);
        by_radius.then(a.cmp(&b))
    });
    task.check()?;
    let (mut best, mut sum_mm3) = ((f64::INFINITY, 0.0, 0.0), 0.0);
    for (place, &cell) in order.iter().enumerate() {
        let radius = radii[cell as usize];
        sum_mm3 += volumes[cell as usize];
        let next = order.get(place + 1).map(|&c| radii[c as usize]);
        if next.is_some_and(|next| next <= radius * (1.0 + SAME)) {
            continue;
        }
        let off = (sum_mm3 - volume_mm3).abs();
        if off < best.0 {
            let end = next.unwrap_or(radius * (1.0 + 2.0 * SAME));
            best = (off, f64::midpoint(radius, end), sum_mm3);
        }
    }
    let (_, alpha_mm, volume_mm3) = best;
    let kept = cells
        .par_iter()
        .zip(&radii)
        .filter(|(_, r)| **r <= alpha_mm);
    let kept = Tetrahedra {
        cells: kept.map(|(cell, _)| *cell).collect(),
    };
    Ok(VolumeMatched {
        alpha_mm,
        volume_mm3,
        boundary: AlphaBoundary {
            triangles: kept.boundary(task)?,
            tetrahedra: kept.cells.len(),
        },
    })
}

/// Something of each cell's corners.
fn measured(
    cloud: &PointCloud,
    cells: &[[u32; 4]],
    measure: impl Fn([[f64; 3]; 4]) -> f64 + Sync,
    task: &Task,
) -> Result<Vec<f64>, Cancelled> {
    let points_mm = cloud.points_mm();
    let of_cell = |cell: &[u32; 4]| measure(cell.map(|v| points_mm[v as usize]));
    let chunks: Vec<Vec<f64>> = cells
        .par_chunks(STRIDE)
        .map(|cells| {
            task.check()?;
            Ok(cells.iter().map(of_cell).collect())
        })
        .collect::<Result<_, Cancelled>>()?;
    Ok(chunks.concat())
}

fn six_volumes([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    dot(minus(b, a), cross(minus(c, a), minus(d, a))).abs()
}

fn radius_mm(corners: [[f64; 3]; 4]) -> f64 {
    let [a, b, c, d] = corners;
    let (u, v, w) = (minus(b, a), minus(c, a), minus(d, a));
    let (p, q, r) = (cross(v, w), cross(w, u), cross(u, v));
    let (uu, vv, ww) = (dot(u, u), dot(v, v), dot(w, w));
    let sum = [0, 1, 2].map(|k| uu * p[k] + vv * q[k] + ww * r[k]);
    dot(sum, sum).sqrt() / (2.0 * six_volumes(corners))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alpha_boundary;
    use crate::synthetic::{cylinder, sphere};

    #[test]
    fn a_volume_that_can_be_had_is_met_within_a_part_in_a_hundred() {
        let scattered = |i: u64| {
            let mixed = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            30.0 * ((mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb) >> 11) as f64
                / (1u64 << 53) as f64
        };
        let points = (0..6000).map(|i| [0, 1, 2].map(|k| scattered(3 * i + k)));
        let cloud = PointCloud::from_points(points.collect()).unwrap();
        for volume_mm3 in [5_000.0, 13_000.0, 20_000.0] {
            let found = volume_matched_boundary(&cloud, volume_mm3, &Task::default()).unwrap();
            let off = found.volume_mm3 / volume_mm3 - 1.0;
            assert!(off.abs() < 0.01, "{volume_mm3} {off}");
        }
    }

    #[test]
    fn a_hollow_cylinder_is_its_wall() {
        let cloud = cylinder(12, 1.0, [75.0, 65.0]);
        let wall_mm3 = std::f64::consts::PI * (75.0_f64.powi(2) - 65.0_f64.powi(2));
        let wall_mm3 = wall_mm3 * 0.4492_f64.powi(2) * 11.0;
        let found = volume_matched_boundary(&cloud, wall_mm3, &Task::default()).unwrap();
        // The outermost pixels of each ring lie up to half a pixel off the circle.
        assert!((found.volume_mm3 / wall_mm3 - 1.0).abs() < 0.1);
        assert!((2.0..25.0).contains(&found.alpha_mm), "{}", found.alpha_mm);
    }

    #[test]
    fn the_complex_is_that_of_its_alpha() {
        for volume_mm3 in [800.0, 2000.0, 1e9] {
            for cloud in [cylinder(4, 2.0, [30.0, 24.0]), sphere(800, 9.0, [3.0; 3])] {
                let task = Task::default();
                let found = volume_matched_boundary(&cloud, volume_mm3, &task).unwrap();
                let again = alpha_boundary(&cloud, found.alpha_mm, &task).unwrap();
                assert_eq!(found.boundary, again);
                let volume_mm3 = again.volume_mm3(points(&cloud));
                assert!((found.volume_mm3 / volume_mm3 - 1.0).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn no_volume_is_refused() {
        let cloud = sphere(50, 9.0, [0.0; 3]);
        for volume_mm3 in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = volume_matched_boundary(&cloud, volume_mm3, &Task::default()).unwrap_err();
            assert!(matches!(error, SurfaceError::Volume(_)));
        }
    }
}
