//! How far each voxel is from the bone's edge, positive inside: what is interpolated between
//! slices.
//!
//! Grey does not say where a slanted surface passes between two thick slices: interpolated, it
//! changes halfway up everywhere, which makes stairs. Distance does, because it grows evenly
//! from the outline (S. P. Raya, J. K. Udupa, *Shape-based interpolation of multidimensional
//! objects*, 1990). Where the surface is so flat that no outline is near, the grey of the voxels
//! above and below says more.
//!
//! 1. `Outline::of`: where the grey passes the level in each slice, and which way it faces.
//! 2. `Outline::distances_mm`: the distance of each pixel to the nearest of these.
//! 3. `Field::column`: between a pixel inside and the one of the next slice outside, distances
//!    tell where the surface passes if the outlines are near each other, and the grey if not.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::isosurface::cut::{self, Crossing, FROM_VOXEL};
use crate::isosurface::grey::Grey;

/// Distances are stored as whole parts of the greatest.
const WHOLE: f32 = 32_000.0;
/// How far from outlines distances are told: in slices' thickness, and in pixels at least and
/// at most.
const REACH: f32 = 1.25;
const REACH_PIXELS: (f32, f32) = (2.0, 16.0);
/// Outlines of neighbouring slices that are apart by less than this part of the reach belong
/// together; beyond the reach they do not.
const NEAR: f32 = 0.6;
/// Parts into which steps between slices are divided where grey tells the place.
const PLACES: f32 = 250.0;

/// Signed distances to the edge, positive inside.
pub(super) struct Field {
    /// To the outline in the voxel's own slice.
    parts: Vec<i16>,
    /// Where the grey passes the level on the way to the next slice.
    passes: Vec<u8>,
    shape: [usize; 3],
    voxel_mm: [f32; 3],
    /// The greatest distance told.
    pub(super) reach_mm: f32,
}

impl Field {
    /// By what the grey is above the level, positive inside. The stage is `distances`.
    pub(super) fn of(
        above: &Grey<'_, f32>,
        crossing: Crossing,
        voxel_mm: [f32; 3],
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let shape = above.shape();
        let pixel_mm = voxel_mm[0].min(voxel_mm[1]);
        let (least, greatest) = REACH_PIXELS;
        let reach_mm = (REACH * voxel_mm[2]).clamp(least * pixel_mm, greatest * pixel_mm);
        let mut parts = vec![0; shape.iter().product()];
        let mut passes = vec![0; parts.len()];
        task.begin("distances", shape[2]);
        let pixels = shape[0] * shape[1];
        parts
            .par_chunks_mut(pixels)
            .zip(passes.par_chunks_mut(pixels))
            .enumerate()
            .try_for_each(|(k, (parts, passes))| {
                task.advance(1)?;
                let outline = Outline::of(above, crossing, k, voxel_mm);
                let outline_mm = outline.distances_mm(shape, voxel_mm, reach_mm);
                for (place, distance_mm) in outline_mm.into_iter().enumerate() {
                    let at = [place % shape[0], place / shape[0], k];
                    // Never 0: a voxel keeps its side.
                    let size = (distance_mm.min(reach_mm) / reach_mm * WHOLE).max(1.0) as i16;
                    parts[place] = if above.at(at) > 0.0 { size } else { -size };
                    passes[place] = pass(above, crossing, at);
                }
                Ok(())
            })?;
        Ok(Self {
            parts,
            passes,
            shape,
            voxel_mm,
            reach_mm,
        })
    }

    /// Where the surface passes on the way from a voxel to that of the next slice, if these are on
    /// different sides: the part of the way.
    pub(super) fn part_of_way(&self, [i, j, k]: [usize; 3]) -> f32 {
        let here = self.place([i, j, k]);
        let way = self.way(here, self.place([i, j, k + 1]));
        (way.to_edge / way.length).clamp(FROM_VOXEL, 1.0 - FROM_VOXEL)
    }

    /// At any place in voxels, in mm; beyond the outermost voxels' ends all is outside.
    #[inline]
    pub(super) fn between(&self, place: [f32; 3]) -> f32 {
        let mut low = [0; 3];
        let mut part = [0.0; 3];
        let mut step = [0; 3];
        let mut to_border = f32::INFINITY;
        for axis in 0..3 {
            let end = self.shape[axis] as f32;
            let past = (place[axis] + 0.5).min(end - 0.5 - place[axis]);
            to_border = to_border.min(past * self.voxel_mm[axis]);
            let p = place[axis].clamp(0.0, end - 1.0);
            low[axis] = p as usize;
            part[axis] = p - low[axis] as f32;
            step[axis] = usize::from(low[axis] + 1 < self.shape[axis]);
        }
        let [i, j, k] = low;
        let line = |j: usize| {
            let column = |i: usize| self.column([i, j, k], k + step[2], part[2]);
            let (a, b) = (column(i), column(i + step[0]));
            a + part[0] * (b - a)
        };
        let (a, b) = (line(j), line(j + step[1]));
        to_border.min(a + part[1] * (b - a))
    }

    /// Between a voxel and the one of slice `next` in its column.
    #[inline]
    fn column(&self, [i, j, k]: [usize; 3], next: usize, part: f32) -> f32 {
        let (here, there) = (self.place([i, j, k]), self.place([i, j, next]));
        let (a, b) = (self.mm(here), self.mm(there));
        if (a > 0.0) == (b > 0.0) {
            return a + part * (b - a);
        }
        let way = self.way(here, there);
        let inside = (way.to_edge - part * way.length).clamp(-b.abs(), a.abs());
        if a > 0.0 { inside } else { -inside }
    }

    /// From one voxel to the next, which are on different sides.
    #[inline]
    fn way(&self, here: usize, there: usize) -> Way {
        let (a, b) = (self.mm(here).abs(), self.mm(there).abs());
        let near = NEAR * self.reach_mm;
        let together = ((self.reach_mm - a - b) / (self.reach_mm - near)).clamp(0.0, 1.0);
        let pass = f32::from(self.passes[here]) / PLACES;
        let thickness = (1.0 - together) * self.voxel_mm[2];
        Way {
            to_edge: together * a + thickness * pass,
            length: together * (a + b) + thickness,
        }
    }

    #[inline]
    fn place(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.shape[1] + j) * self.shape[0] + i
    }

    #[inline]
    fn mm(&self, place: usize) -> f32 {
        f32::from(self.parts[place]) * (self.reach_mm / WHOLE)
    }
}

/// How far it is to the edge, and in all: in mm to outlines, or across slices.
struct Way {
    to_edge: f32,
    length: f32,
}

/// Where the surface passes between a voxel and the next slice's by their grey, in [`PLACES`].
fn pass(above: &Grey<'_, f32>, crossing: Crossing, [i, j, k]: [usize; 3]) -> u8 {
    if k + 1 == above.shape()[2] {
        return 0;
    }
    let (here, there) = (above.at([i, j, k]), above.at([i, j, k + 1]));
    if (here > 0.0) == (there > 0.0) {
        return 0;
    }
    (crossing(here, there).clamp(0.0, 1.0) * PLACES).round() as u8
}

/// Where the grey of a slice passes the level.
struct Outline(Vec<Cut>);

struct Cut {
    /// Column and row.
    at: [f32; 2],
    /// Direction in which the grey changes fastest, a unit vector in mm; 0 where there is none.
    across: [f32; 2],
}

impl Outline {
    fn of(above: &Grey<'_, f32>, crossing: Crossing, k: usize, voxel_mm: [f32; 3]) -> Self {
        let [columns, rows, _] = above.shape();
        let mut crossings = Vec::new();
        for j in 0..rows {
            for i in 0..columns {
                let is_inside = above.at([i, j, k]) > 0.0;
                for axis in 0..2 {
                    let mut next = [i, j, k];
                    next[axis] += 1;
                    if next[axis] >= above.shape()[axis] || (above.at(next) > 0.0) == is_inside {
                        continue;
                    }
                    let here = [i, j, k];
                    let part = crossing(above.at(here), above.at(next));
                    let place = cut::place(here, axis, part);
                    let gradient = above.gradient_between(here, next, part);
                    crossings.push(Cut {
                        at: [place[0], place[1]],
                        across: unit([gradient[0] / voxel_mm[0], gradient[1] / voxel_mm[1]]),
                    });
                }
            }
        }
        Self(crossings)
    }

    /// Of each pixel, in mm, to the line through the nearest crossing; infinite beyond `reach_mm`.
    fn distances_mm(&self, shape: [usize; 3], voxel_mm: [f32; 3], reach_mm: f32) -> Vec<f32> {
        let [columns, rows, _] = shape;
        let mut nearest = vec![(f32::INFINITY, f32::INFINITY); columns * rows];
        let pixel_mm = voxel_mm[0].max(voxel_mm[1]);
        let around = |at: f32, axis: usize, end: usize| {
            let reach = reach_mm / voxel_mm[axis];
            let first = (at - reach).ceil().max(0.0) as usize;
            first..((at + reach).floor() + 1.0).clamp(0.0, end as f32) as usize
        };
        for crossing in &self.0 {
            for j in around(crossing.at[1], 1, rows) {
                let y = (j as f32 - crossing.at[1]) * voxel_mm[1];
                for i in around(crossing.at[0], 0, columns) {
                    let x = (i as f32 - crossing.at[0]) * voxel_mm[0];
                    let squared = x * x + y * y;
                    let entry = &mut nearest[j * columns + i];
                    if squared < entry.0 {
                        let across = (x * crossing.across[0] + y * crossing.across[1]).abs();
                        // Around a corner the line through its last crossing is too near.
                        *entry = (squared, across.max(squared.sqrt() - 0.5 * pixel_mm));
                    }
                }
            }
        }
        nearest.into_iter().map(|(_, distance)| distance).collect()
    }
}

fn unit(v: [f32; 2]) -> [f32; 2] {
    let length = v[0].hypot(v[1]);
    if length > 0.0 {
        v.map(|c| c / length)
    } else {
        v
    }
}
