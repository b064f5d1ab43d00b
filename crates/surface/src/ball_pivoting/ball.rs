//! Balls of one radius among the points.

use std::f64::consts::TAU;

use bonemesh_cloud::{Forest, Near};
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use bonemesh_mesh::vector::{cross, dot, minus, plus_scaled};

/// How far a point is moved to settle ties, as a part of the radius.
const MOVED: f64 = 1e-5;
/// A point is inside a ball where it is nearer to the centre than the radius less this part.
const INSIDE: f64 = 1e-9;

/// Points, each moved a little so that no four share a ball, and balls of one radius among them.
pub(super) struct Balls {
    points: Vec<[f64; 3]>,
    forest: Forest,
    radius: f64,
}

/// A ball that touches three points.
pub(super) struct Touch {
    pub(super) centre: [f64; 3],
    corners: [u32; 3],
}

impl Balls {
    pub(super) fn new(
        points_mm: &[[f64; 3]],
        radius_mm: f64,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let moved = |p: &[f64; 3]| {
            let mut state = scattered(p.map(|v| (v + 0.0).to_bits()));
            p.map(|v| {
                state = mixed(state);
                let part = (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
                v + MOVED * radius_mm * part
            })
        };
        let points: Vec<[f64; 3]> = points_mm.par_iter().map(moved).collect();
        Ok(Self {
            forest: Forest::new(&points, task)?,
            points,
            radius: radius_mm,
        })
    }

    pub(super) fn place(&self, v: u32) -> [f64; 3] {
        self.points[v as usize]
    }

    /// Points within `reach`, the nearest first.
    fn within(&self, place: [f64; 3], reach: f64) -> Vec<u32> {
        numbers(self.forest.within(place, reach * reach))
    }

    /// The points that a ball can touch together with `v`, the nearest first, without `v`.
    pub(super) fn around(&self, v: u32) -> Vec<u32> {
        let mut found = self.within(self.place(v), 2.0 * self.radius);
        found.retain(|&u| u != v);
        found
    }

    /// The points in a ball or on it.
    pub(super) fn near(&self, centre: [f64; 3]) -> Vec<u32> {
        let reach = self.radius * (1.0 + 1e-6);
        numbers(self.forest.within_unsorted(centre, reach * reach))
    }

    /// Whether none of `near` but its corners lies inside a ball.
    pub(super) fn is_empty(&self, touch: &Touch, near: &[u32]) -> bool {
        let least = self.radius * (1.0 - INSIDE);
        near.iter().all(|&v| {
            let off = minus(self.place(v), touch.centre);
            touch.corners.contains(&v) || dot(off, off) >= least * least
        })
    }

    /// The ball on the side from which the corners run counter-clockwise; `None` if it is too
    /// small to touch them all.
    pub(super) fn touching(&self, corners: [u32; 3]) -> Option<Touch> {
        let [a, b, c] = corners.map(|v| self.place(v));
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = cross(u, v);
        let squared = dot(normal, normal);
        if squared <= 0.0 {
            return None;
        }
        // The circumcentre seen from `a`.
        let to_centre = cross(plus_scaled([0.0; 3], dot(u, u), v), normal);
        let to_centre = plus_scaled(to_centre, dot(v, v), cross(normal, u));
        let to_centre = to_centre.map(|x| x / (2.0 * squared));
        let height = self.radius * self.radius - dot(to_centre, to_centre);
        if height.is_nan() || height < 0.0 {
            return None;
        }
        let middle = plus_scaled(a, 1.0, to_centre);
        let centre = plus_scaled(middle, (height / squared).sqrt(), normal);
        Some(Touch { centre, corners })
    }

    /// The first point that a ball at `centre` meets when it rolls over the edge `[a, b]`, away
    /// from the triangle's third corner.
    pub(super) fn pivot(
        &self,
        [a, b]: [u32; 2],
        opposite: u32,
        centre: [f64; 3],
    ) -> Option<(u32, Touch)> {
        let (from, to) = (self.place(a), self.place(b));
        let middle = [0, 1, 2].map(|k| f64::midpoint(from[k], to[k]));
        let axis = minus(to, from);
        let axis = axis.map(|x| x / dot(axis, axis).sqrt());
        let start = minus(centre, middle);
        let near = self.within(middle, 2.0 * self.radius);
        let mut first: Option<(f64, u32, Touch)> = None;
        for &v in near.iter().filter(|v| ![a, b, opposite].contains(v)) {
            let Some(touch) = self.touching([b, a, v]) else {
                continue;
            };
            let end = minus(touch.centre, middle);
            let turn = dot(axis, cross(start, end)).atan2(dot(start, end));
            let turn = if turn < 0.0 { turn + TAU } else { turn };
            if first.as_ref().is_none_or(|(least, _, _)| turn < *least) {
                first = Some((turn, v, touch));
            }
        }
        let (_, v, touch) = first?;
        self.is_empty(&touch, &near).then_some((v, touch))
    }
}

fn numbers(found: Vec<Near>) -> Vec<u32> {
    found.into_iter().map(|near| near.point).collect()
}

/// A number without pattern that a place alone decides.
pub(super) fn scattered(place: [u64; 3]) -> u64 {
    place
        .into_iter()
        .fold(0x9e37_79b9_7f4a_7c15, |h, v| mixed(h ^ v))
}

/// Spreads the bits of a number over all of it.
fn mixed(mut x: u64) -> u64 {
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}
