//! Which parts of a cloud bound a hollow in another.
//!
//! How many parts enclose a point is the sum of the angles under which it sees their pieces: turns
//! of contours in its own slice, where the cloud is made of slices, solid angles elsewhere. Slices
//! are better because bone that the scan cuts off is closed in each of them, but not in space.

use std::f64::consts::PI;

use bonemesh_task::{Cancelled, Task, chunked_sum};
use rayon::prelude::*;

use super::neighbourhoods::Neighbourhoods;
use super::orient::flip;
use super::{dot, minus};

/// Parts that are looked at: the largest ones.
const PARTS: usize = 256;
/// Fewer points enclose nothing worth telling.
const PART_POINTS: usize = 30;
/// Neighbours along a contour whose distance tells for which length a point stands.
const ALONG_CONTOUR: usize = 6;

/// Turns the parts that lie inside an odd number of others. `parts` are sorted by size.
pub(super) fn turn(
    points: &[[f64; 3]],
    normals: &mut [[f64; 3]],
    parts: &[Vec<u32>],
    around: &Neighbourhoods,
    task: &Task,
) -> Result<(), Cancelled> {
    let large = parts.iter().take(PARTS);
    let large: Vec<&Vec<u32>> = large.filter(|p| p.len() >= PART_POINTS).collect();
    if large.len() < 2 {
        return Ok(());
    }
    let mut members = Vec::new();
    for (part, of_part) in large.iter().enumerate() {
        members.extend(of_part.iter().map(|&i| (part, i as usize)));
    }
    let view = View {
        points,
        normals,
        around,
        members,
    };
    let mut hollows = Vec::new();
    for (part, of_part) in large.iter().enumerate() {
        task.check()?;
        if view.enclosing(part, of_part) % 2 != 0 {
            hollows.push(part);
        }
    }
    for part in hollows {
        flip(normals, large[part]);
    }
    Ok(())
}

struct View<'a> {
    points: &'a [[f64; 3]],
    normals: &'a [[f64; 3]],
    around: &'a Neighbourhoods,
    /// Each point with the number of its part.
    members: Vec<(usize, usize)>,
}

impl View<'_> {
    /// How many other parts enclose the first point of a part.
    fn enclosing(&self, part: usize, of_part: &[u32]) -> i64 {
        let eye = of_part[0] as usize;
        let in_slice = |i: usize| self.around.share_slice(eye, i);
        let is_sliced = of_part.iter().filter(|i| in_slice(**i as usize)).count() >= PART_POINTS;
        let angle = |&(of, i): &(usize, usize)| {
            let step = minus(self.points[i], self.points[eye]);
            let distance = dot(step, step).sqrt();
            if of == part || distance == 0.0 || (is_sliced && !in_slice(i)) {
                0.0
            } else if is_sliced {
                self.turn_along(i, step) / (2.0 * PI * distance.powi(2))
            } else {
                self.area_mm2(i) * dot(self.normals[i], step) / (4.0 * PI * distance.powi(3))
            }
        };
        let angles: Vec<f64> = self.members.par_iter().map(angle).collect();
        chunked_sum(&angles).round() as i64
    }

    /// The surface that a point stands for: a disc to its farthest neighbour, shared by all.
    fn area_mm2(&self, i: usize) -> f64 {
        let neighbours = self.around.of_point(i);
        let squared = |&j: &u32| self.squared_mm2(i, j);
        let farthest = neighbours.iter().map(squared).fold(0.0, f64::max);
        PI * farthest / (neighbours.len() + 1) as f64
    }

    /// The contour that a point stands for, seen along `step`.
    fn turn_along(&self, i: usize, step: [f64; 3]) -> f64 {
        let own = self.around.of_point(i).iter();
        let own = own.filter(|j| self.around.share_slice(i, **j as usize));
        // The nearest come first.
        let (count, squared) = own
            .take(ALONG_CONTOUR)
            .fold((0, 0.0), |(n, _), &j| (n + 1, self.squared_mm2(i, j)));
        let (normal, across) = (self.normals[i], self.around.across_slices);
        let off = dot(normal, across);
        let in_slice = (1.0 - off * off).max(0.0).sqrt();
        if count == 0 || in_slice < 1e-3 {
            return 0.0;
        }
        2.0 * squared.sqrt() / f64::from(count) * dot(normal, step) / in_slice
    }

    fn squared_mm2(&self, i: usize, j: u32) -> f64 {
        let step = minus(self.points[j as usize], self.points[i]);
        dot(step, step)
    }
}
