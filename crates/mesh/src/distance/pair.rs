//! How near two surfaces come to one another.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::squared_distance;
use crate::exact::{Corners, meet};
use crate::tree::Bounds;
use crate::vector::{Vector, dot, minus, plus_scaled};
use crate::{MeshError, TriangleMesh, TriangleTree};

/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 9;

/// The least distance (mm) between two surfaces, 0 where they meet; `None` if it is more than `within_mm`.
///
/// It is that between their triangles, not only between vertices; whether these meet is decided exactly.
///
/// # Errors
/// [`MeshError::Length`] for a reach that is none, [`MeshError::Cancelled`].
pub fn least_distance(
    mesh: &TriangleMesh,
    other: &TriangleTree<'_>,
    within_mm: f64,
    task: &Task,
) -> Result<Option<f64>, MeshError> {
    let within_mm = MeshError::length("reach", within_mm)?;
    let chunks = mesh.triangles().par_chunks(STRIDE).map(|triangles| {
        task.check()?;
        let mut stack = Vec::new();
        let mut least = within_mm * within_mm;
        let mut is_found = false;
        for triangle in triangles {
            let corners = mesh.corners_mm(*triangle);
            let reach_mm = least.sqrt();
            other.visit_touching(&around(&corners, reach_mm), &mut stack, |slot| {
                let squared = squared_between(&corners, &other.corners_mm(slot));
                if squared <= least {
                    (least, is_found) = (squared, true);
                }
            });
        }
        Ok(is_found.then(|| least.sqrt()))
    });
    let found = chunks.collect::<Result<Vec<Option<f64>>, Cancelled>>()?;
    Ok(found.into_iter().flatten().reduce(f64::min))
}

/// The box around a triangle that is so much (mm) larger.
fn around(corners: &Corners, by_mm: f64) -> Bounds {
    let moved = |by: f64| corners.map(|corner| corner.map(|value| value + by));
    Bounds::of([moved(-by_mm), moved(by_mm)].as_flattened())
}

/// The squared distance (mm2) of two triangles.
///
/// Where they do not meet, the nearest places are a corner of one and a place of the other, or places of two
/// edges (Ericson, *Real-time collision detection*, 2005, section 5.1.10).
fn squared_between(a: &Corners, b: &Corners) -> f64 {
    if meet(a, b) {
        return 0.0;
    }
    let of_corners = |from: &Corners, to: &Corners| {
        let squared = from.map(|corner| squared_distance(corner, *to));
        squared[0].min(squared[1]).min(squared[2])
    };
    let edges = |[p, q, r]: Corners| [[p, q], [q, r], [r, p]];
    let of_edges = edges(*a).into_iter().flat_map(|edge| {
        let others = edges(*b).into_iter();
        others.map(move |other| squared_between_segments(edge, other))
    });
    of_edges.fold(of_corners(a, b).min(of_corners(b, a)), f64::min)
}

/// The squared distance of two segments where the nearest places are inside of both; else no less than
/// that of an end.
fn squared_between_segments([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> f64 {
    let (u, v, between) = (minus(b, a), minus(d, c), minus(a, c));
    let (uu, uv, vv) = (dot(u, u), dot(u, v), dot(v, v));
    let (ub, vb) = (dot(u, between), dot(v, between));
    let determinant = uu * vv - uv * uv;
    // Of parallel segments an end of one is as near as anything.
    if determinant <= f64::EPSILON * uu * vv {
        return f64::INFINITY;
    }
    let on_first = ((uv * vb - vv * ub) / determinant).clamp(0.0, 1.0);
    let on_second = ((uu * vb - uv * ub) / determinant).clamp(0.0, 1.0);
    let away = minus(plus_scaled(a, on_first, u), plus_scaled(c, on_second, v));
    dot(away, away)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(corners: Corners) -> TriangleMesh {
        TriangleMesh::new(corners.to_vec(), vec![[0, 1, 2]]).expect("it is a triangle")
    }

    fn distance(a: Corners, b: Corners, within_mm: f64) -> Option<f64> {
        let (a, b) = (triangle(a), triangle(b));
        let task = Task::default();
        let ways = [(&a, &b), (&b, &a)].map(|(mesh, other)| {
            let tree = TriangleTree::new(other, &task).expect("nobody cancels");
            least_distance(mesh, &tree, within_mm, &task).expect("nobody cancels")
        });
        assert_eq!(ways[0].is_some(), ways[1].is_some());
        if let [Some(one), Some(other)] = ways {
            assert!((one - other).abs() < 1e-12);
        }
        ways[0]
    }

    const FLAT: Corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    #[test]
    fn a_corner_above_a_triangle() {
        let above = [[1.0, 1.0, 0.5], [1.0, 1.0, 9.0], [2.0, 1.0, 9.0]];
        assert!((distance(FLAT, above, 1.0).expect("it is near") - 0.5).abs() < 1e-12);
        assert_eq!(distance(FLAT, above, 0.4), None);
    }

    #[test]
    fn edges_that_cross_with_no_corner_near() {
        // Over the middle of the edge along x, at right angles to it.
        let across = [[2.0, -3.0, -0.3], [2.0, 3.0, -0.3], [2.0, 0.0, -9.0]];
        let beside = across.map(|[x, y, z]| [x, y - 3.0, z + 0.3]);
        assert!((distance(FLAT, across, 1.0).expect("it is near") - 0.3).abs() < 1e-12);
        assert_eq!(distance(FLAT, beside, 0.0), Some(0.0));
    }

    #[test]
    fn triangles_that_pass_through_one_another() {
        let through = [[1.0, 1.0, -5.0], [1.0, 1.2, 5.0], [1.2, 1.0, 5.0]];
        assert_eq!(distance(FLAT, through, 3.0), Some(0.0));
    }
}
