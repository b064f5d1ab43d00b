//! Normals of a cloud's points: across the plane that fits their neighbours best, all outward.
//!
//! 1. `Neighbourhoods::of`: the nearest points of each, within a radius. Points of one slice lie in
//!    one plane, whose normal says nothing of the bone; where a neighbourhood stays in the slice of
//!    its point, it grows until a part of it comes from other slices.
//! 2. `across`: the direction in which a neighbourhood varies least (principal components).
//! 3. `oriented`: signs are carried from neighbour to neighbour along a minimum spanning tree, and
//!    each tree faces away from the body that it encloses.

mod eigen;
mod hollows;
mod neighbourhoods;
mod orient;

use bonemesh_task::Task;
use rayon::prelude::*;

use crate::{CloudError, PointCloud};
use eigen::least_direction;
use neighbourhoods::Neighbourhoods;
use orient::oriented;

/// Points that one worker handles between two looks at the task.
const BATCH: usize = 256;

/// From which neighbours a normal is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalSettings {
    /// How many points make a neighbourhood, the point itself included.
    pub neighbours: usize,
    /// How far away they may be.
    pub radius_mm: f64,
}

impl Default for NormalSettings {
    /// Those of the published method: 30 points within 1 cm.
    fn default() -> Self {
        Self {
            neighbours: 30,
            radius_mm: 10.0,
        }
    }
}

/// A unit normal for each point, facing away from the body whose surface the points are on.
///
/// Principal components give the line, a minimum spanning tree over all neighbourhoods the side.
/// Parts of the cloud that no neighbourhood joins are taken for surfaces of their own: one that
/// lies inside an odd number of others bounds a hollow and faces into it. The stages are
/// `neighbours` and `normals`.
///
/// Limits: where no other slice lies within the radius, or the cloud has one slice only, normals
/// stand across the slice, which is no property of the bone. A neighbourhood wider than the bone's
/// detail mixes both walls of it. Of parts beyond the 256 largest, hollows are not told from bodies.
///
/// After H. Hoppe et al., *Surface reconstruction from unorganized points*, 1992, for lines and
/// tree; H. Xie et al., *Piecewise C1 continuous surface reconstruction of noisy point clouds*,
/// 2003, for normals reflected from point to point, which are right on arcs and across walls.
///
/// # Errors
/// [`CloudError::TooFew`] below three points, [`CloudError::NeighbourCount`] below three
/// neighbours, [`CloudError::Radius`], [`CloudError::Cancelled`].
pub fn estimate_normals(
    cloud: &PointCloud,
    settings: NormalSettings,
    task: &Task,
) -> Result<Vec<[f64; 3]>, CloudError> {
    let points = cloud.points_mm();
    if points.len() < 3 {
        return Err(CloudError::TooFew(points.len()));
    }
    if settings.neighbours < 3 {
        return Err(CloudError::NeighbourCount(settings.neighbours));
    }
    if !settings.radius_mm.is_finite() || settings.radius_mm <= 0.0 {
        return Err(CloudError::Radius(settings.radius_mm));
    }
    let around = Neighbourhoods::of(cloud, settings, task)?;
    let lines: Vec<[f64; 3]> = (0..points.len())
        .into_par_iter()
        .with_min_len(BATCH)
        .map(|i| {
            if i % BATCH == 0 {
                task.check()?;
            }
            Ok(across(points, i, around.of_point(i)))
        })
        .collect::<Result<_, CloudError>>()?;
    Ok(oriented(points, &lines, &around, task)?)
}

/// Unit direction in which the neighbours of point `i`, with itself, vary least.
fn across(points: &[[f64; 3]], i: usize, neighbours: &[u32]) -> [f64; 3] {
    let origin = points[i];
    let count = (neighbours.len() + 1) as f64;
    let steps = neighbours
        .iter()
        .map(|&j| minus(points[j as usize], origin));
    let mut mean = [0.0; 3];
    for step in steps.clone() {
        (0..3).for_each(|k| mean[k] += step[k] / count);
    }
    // The point itself is a step of nothing.
    let mut covariance = [[0.0; 3]; 3];
    for step in steps.chain([[0.0; 3]]) {
        let off = minus(step, mean);
        for (row, a) in covariance.iter_mut().zip(off) {
            (0..3).for_each(|k| row[k] += a * off[k]);
        }
    }
    least_direction(covariance)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests;
