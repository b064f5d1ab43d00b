//! How alike the normals of some points are, as published.

use std::f64::consts::PI;

use bonemesh_task::{Cancelled, Task};

use super::normal::least_direction;
use crate::sampling::remaining::Remaining;

/// Points from which a normal is estimated, itself included.
pub(in crate::sampling) const NEIGHBOURS: usize = 30;

/// Cosines are rounded to so many parts, so that equal normals have an angle of 0.
const PARTS: f64 = 1e6;

/// For each point the least principal direction of its nearest ones among these.
pub(in crate::sampling) fn normals(
    points: &[[f64; 3]],
    neighbours: usize,
    task: &Task,
) -> Result<Vec<[f64; 3]>, Cancelled> {
    let mut all = Remaining::new(points, [1.0; 3]);
    (0..points.len() as u32)
        .map(|point| {
            task.check()?;
            let nearest = all.nearest(point, neighbours);
            let nearest = nearest.iter().map(|n| points[n.1 as usize]);
            Ok(least_direction(covariance(nearest)))
        })
        .collect()
}

/// Mean products less products of means, as the published program's package adds them up.
fn covariance(points: impl ExactSizeIterator<Item = [f64; 3]>) -> [[f64; 3]; 3] {
    let count = points.len() as f64;
    let (mut sums, mut products) = ([0.0; 3], [[0.0; 3]; 3]);
    for p in points {
        for i in 0..3 {
            sums[i] += p[i];
            (0..3).for_each(|j| products[i][j] += p[i] * p[j]);
        }
    }
    let means = sums.map(|s| s / count);
    let of = |i: usize, j: usize| products[i][j] / count - means[i] * means[j];
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| of(i, j)))
}

/// The mean over all ordered pairs, each with itself among them, of 1 - angle / pi; 1 of nothing.
pub(in crate::sampling) fn mean_similarity(
    normals: &[[f64; 3]],
    task: &Task,
) -> Result<f64, Cancelled> {
    if normals.is_empty() {
        return Ok(1.0);
    }
    let mut angles = 0.0;
    for a in normals {
        task.check()?;
        for b in normals {
            let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let rounded = (cosine * PARTS).round_ties_even() / PARTS;
            // Most pairs are equal or opposite.
            angles += match rounded {
                r if r >= 1.0 => 0.0,
                r if r <= -1.0 => PI,
                r => libm::acos(r),
            };
        }
    }
    let pairs = (normals.len() * normals.len()) as f64;
    Ok(1.0 - angles / pairs / PI)
}
