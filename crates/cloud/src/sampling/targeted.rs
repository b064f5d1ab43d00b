//! Our targeted sampling: as [`super::uniform`], but denser where contours bend.
//!
//! 1. `tangents`: at each point the line that fits the points before and after it best, in the plane
//!    of the slice and without a sign, so that it stands for the normal as well.
//! 2. `curvatures`: how far those nearby are turned against it.
//! 3. `densities`: between neighbours a chord leaves an arc by the square of its length times the
//!    curvature, so chords as far off as each other ask for a density that grows with the root.
//!
//! Nowhere is the density below that of straight contours, so nothing vanishes.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::Percent;
use super::contours::{Walk, walk};
use super::lines::{double_angle, squared_sine};
use super::slices::Slices;
use super::spread::spread;
use crate::PointCloud;

/// Points that a tangent is fitted to on either side, least and most: fewer see the steps of pixels as
/// bends, more see no corner.
const REACH: (f64, f64) = (3.0, 10.0);
/// The reach as a part of the points from one kept point to the next.
const REACH_OF_STEP: f64 = 0.5;
/// How far off an even chord may be, in the usual distance of two points, before the density grows.
const FREE_SAGITTA: f64 = 0.15;
/// Density of the sharpest bend, in that of straight contours: what bends gain, the rest loses.
const DENSEST: f64 = 2.5;

/// The indices to keep, along the contours.
pub(super) fn keep(
    cloud: &PointCloud,
    percent: Percent,
    task: &Task,
) -> Result<Vec<u32>, Cancelled> {
    let slices = Slices::of(cloud);
    let step = 1.0 / percent.fraction();
    let of_slices: Vec<Vec<(Walk, Vec<f64>)>> = slices
        .par_iter()
        .map(|members| {
            task.check()?;
            let mut found = Vec::new();
            for walk in walk(&slices, members, task)? {
                task.check()?;
                let places: Vec<_> = walk.points.iter().map(|p| slices.in_plane_mm(*p)).collect();
                let densities = densities(&walk, &places, step);
                found.push((walk, densities));
            }
            task.advance(members.len())?;
            Ok(found)
        })
        .collect::<Result<_, Cancelled>>()?;
    let (walks, densities): (Vec<Walk>, Vec<Vec<f64>>) = of_slices.into_iter().flatten().unzip();
    Ok(spread(&walks, &densities, percent.fraction()))
}

/// How many times as densely as on a straight contour the points are to lie, if one in `step` is kept.
fn densities(walk: &Walk, places_mm: &[[f64; 2]], step: f64) -> Vec<f64> {
    let length_mm: f64 = walk.steps_mm.iter().sum();
    let usual_mm = length_mm / walk.steps_mm.len().max(1) as f64;
    if usual_mm <= 0.0 {
        return vec![1.0; places_mm.len()];
    }
    let reach = (REACH_OF_STEP * step).clamp(REACH.0, REACH.1) as usize;
    let around = Around {
        count: places_mm.len(),
        is_closed: walk.is_closed(),
        reach,
    };
    let tangents = tangents(places_mm, &around);
    // A chord of n points leaves an arc by n^2 / 8 times its curvature.
    let free = 8.0 * FREE_SAGITTA / (step * step);
    let density = |turn: f64| (turn / free).sqrt().clamp(1.0, DENSEST);
    curvatures(&tangents, &around).map(density).collect()
}

/// Which points of a walk are near one of them.
struct Around {
    count: usize,
    is_closed: bool,
    reach: usize,
}

impl Around {
    /// Up to `reach` steps before and after, with the point itself: the number of the point, and how many
    /// steps away it is.
    fn of(&self, at: usize) -> impl Iterator<Item = (usize, f64)> + Clone + use<> {
        let (count, at, reach) = (self.count as i64, at as i64, self.reach as i64);
        let is_round = self.is_closed && count > 2 * reach;
        let (first, last) = if is_round {
            (at - reach, at + reach)
        } else {
            ((at - reach).max(0), (at + reach).min(count - 1))
        };
        (first..=last).map(move |i| (i.rem_euclid(count) as usize, (i - at) as f64))
    }
}

/// The tangent of each point, see [`double_angle`].
fn tangents(places_mm: &[[f64; 2]], around: &Around) -> Vec<[f64; 2]> {
    let tangent = |at| double_angle(around.of(at).map(|(i, _)| places_mm[i]));
    (0..places_mm.len()).map(tangent).collect()
}

/// Turn (radians) of the tangent from one point to the next.
///
/// On an arc the mean square of the angles to the tangents up to some steps away is the turn's square
/// times the mean square of the steps.
fn curvatures(tangents: &[[f64; 2]], around: &Around) -> impl Iterator<Item = f64> {
    (0..tangents.len()).map(|at| {
        let (mut sines, mut squares) = (0.0, 0.0);
        for (other, steps) in around.of(at) {
            sines += squared_sine(tangents[at], tangents[other]);
            squares += steps * steps;
        }
        (sines / squares.max(1.0)).sqrt()
    })
}
