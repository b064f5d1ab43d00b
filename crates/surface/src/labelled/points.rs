//! The points to tetrahedralise: where the surface crosses the lattice of voxels.
//!
//! 1. `crossings`: on every edge between an inside and an outside voxel one point, by the grey
//!    within a slice and by the field across slices.
//! 2. `merged`: crossings around one voxel, which crowd, become one in their middle.
//! 3. `Grid::around`: in patient space, points are rounded to whole parts of a mm, a power of two
//!    of them, so that 32-bit coordinates hold them exactly and predicates stay exact.

use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::Affine;
use rayon::prelude::*;

use super::field::Field;
use crate::isosurface::cut::{self, Crossing as Rule};
use crate::isosurface::grey::Grey;
use crate::isosurface::march::cut_edges;
use crate::isosurface::signs::Signs;

/// Crossings that are nearer to a voxel than this part of a pixel may be merged.
const MERGED_WITHIN: f32 = 0.5;
/// Steps that the predicates allow along an axis.
const SPAN_LIMIT: f64 = 32_000.0;
/// Bits of a coordinate that a 32-bit float holds exactly.
const EXACT_BITS: i32 = 24;
/// The finest step is two to the power of minus this, in mm.
const FINEST: i32 = 9;
/// Interior and exterior points are this far apart at least, in mm, and in reaches of the field.
const SPARSE: (f32, f32) = (8.0, 2.0);
/// How far the box of air reaches beyond the points, as a part of their extent.
const AIR: f64 = 0.1;

/// A crossing by the voxel that it is nearest to and the direction from there, 0 to 5; by itself
/// if there is no voxel near.
struct Crossing {
    voxel: usize,
    direction: u8,
    place: [f32; 3],
}

const ALONE: usize = usize::MAX;

/// Places in voxels where the surface crosses edges between voxels.
pub(super) fn crossings(
    above: &Grey<'_, f32>,
    crossing: Rule,
    field: &Field,
    voxel_mm: [f32; 3],
    task: &Task,
) -> Result<Vec<[f32; 3]>, Cancelled> {
    let shape = above.shape();
    let signs = Signs::of(shape, |at| above.at(at) > 0.0, task)?;
    let within_mm = MERGED_WITHIN * voxel_mm.into_iter().fold(f32::INFINITY, f32::min);
    let found: Vec<Vec<Crossing>> = (0..signs.slices())
        .into_par_iter()
        .map(|k| {
            task.check()?;
            let mut found = Vec::new();
            cut_edges(&signs, k, |node, axis| {
                let mut place = cut::between(node, axis, shape, |at| above.at(at), crossing);
                if let (2, Some(place)) = (axis, &mut place) {
                    let voxel = node.map(|n| n - 1);
                    place[2] = voxel[2] as f32 + field.part_of_way(voxel);
                }
                found.push(match place {
                    Some(place) => near_voxel(node, axis, place, shape, within_mm / voxel_mm[axis]),
                    None => Crossing {
                        voxel: ALONE,
                        direction: 0,
                        place: cut::border(node, axis),
                    },
                });
            });
            Ok(found)
        })
        .collect::<Result<_, Cancelled>>()?;
    Ok(merged(found.into_iter().flatten().collect()))
}

fn near_voxel(
    node: [usize; 3],
    axis: usize,
    place: [f32; 3],
    [columns, rows, _]: [usize; 3],
    within: f32,
) -> Crossing {
    let mut voxel = node.map(|n| n - 1);
    let part = place[axis] - voxel[axis] as f32;
    let is_beyond = part > 0.5;
    voxel[axis] += usize::from(is_beyond);
    let is_near = part.min(1.0 - part) <= within;
    Crossing {
        voxel: if is_near {
            (voxel[2] * rows + voxel[1]) * columns + voxel[0]
        } else {
            ALONE
        },
        direction: 2 * axis as u8 + u8::from(is_beyond),
        place,
    }
}

/// Crossings around one voxel in their middle, unless the voxel lies between two of them.
fn merged(mut crossings: Vec<Crossing>) -> Vec<[f32; 3]> {
    // Those of no voxel keep their order.
    crossings.par_sort_by_key(|c| (c.voxel, c.direction));
    let mut places = Vec::with_capacity(crossings.len());
    for group in crossings.chunk_by(|a, b| a.voxel == b.voxel) {
        let is_between = group
            .windows(2)
            .any(|pair| pair[0].direction / 2 == pair[1].direction / 2);
        if group[0].voxel == ALONE || is_between {
            places.extend(group.iter().map(|c| c.place));
        } else {
            let sum = |axis: usize| group.iter().map(|c| c.place[axis]).sum::<f32>();
            places.push([0, 1, 2].map(|axis| sum(axis) / group.len() as f32));
        }
    }
    places
}

/// Voxels far from any edge, which keep tetrahedra short: places in voxels.
pub(super) fn far_points(field: &Field, shape: [usize; 3], voxel_mm: [f32; 3]) -> Vec<[f32; 3]> {
    let apart_mm = SPARSE.0.max(SPARSE.1 * field.reach_mm);
    let step = voxel_mm.map(|mm| (apart_mm / mm).ceil().max(1.0) as usize);
    let mut places = Vec::new();
    let along = |axis: usize| (step[axis] / 2..shape[axis]).step_by(step[axis]);
    for k in along(2) {
        for j in along(1) {
            for i in along(0) {
                let place = [i, j, k].map(|v| v as f32);
                if field.between(place).abs() >= 0.999 * field.reach_mm {
                    places.push(place);
                }
            }
        }
    }
    places
}

/// Points in patient space, rounded.
pub(super) struct Grid {
    /// In steps from the origin; the last eight are the corners of a box of air.
    pub(super) coordinates: Vec<[i32; 3]>,
    /// In steps of the patient's frame.
    origin: [f64; 3],
    /// Length of a step in mm, a power of two.
    pub(super) step_mm: f64,
}

impl Grid {
    /// Of places in voxels.
    pub(super) fn around(places: &[[f32; 3]], affine: &Affine) -> Self {
        let points = |place: &[f32; 3]| affine.apply(place.map(f64::from));
        let (low, high) = places.iter().map(points).fold(
            ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]),
            |(low, high), p| {
                let of = |f: fn(f64, f64) -> f64, a: [f64; 3]| [0, 1, 2].map(|k| f(a[k], p[k]));
                (of(f64::min, low), of(f64::max, high))
            },
        );
        let extents = [0, 1, 2].map(|k| high[k] - low[k]);
        let extent = extents.into_iter().fold(0.0, f64::max);
        let air = AIR * extent;
        let farthest = low.into_iter().chain(high).map(f64::abs);
        let farthest = farthest.fold(0.0, f64::max) + air;
        let fits = |exponent: &i32| {
            let step = 2f64.powi(*exponent);
            (extent + 2.0 * air) / step < SPAN_LIMIT && farthest / step < 2f64.powi(EXACT_BITS)
        };
        let exponent = (-FINEST..=EXACT_BITS).find(fits).unwrap_or(-FINEST);
        let step_mm = 2f64.powi(exponent);
        let origin = low.map(|v| ((v - air) / step_mm).floor());
        let end = [0, 1, 2].map(|k| ((high[k] + air) / step_mm).ceil() - origin[k]);
        let rounded = |place: &[f32; 3]| {
            let p = points(place);
            [0, 1, 2].map(|k| ((p[k] / step_mm).round() - origin[k]) as i32)
        };
        let mut coordinates: Vec<[i32; 3]> = places.par_iter().map(rounded).collect();
        coordinates.extend((0..8).map(|corner: usize| {
            [0, 1, 2].map(|k| {
                if corner >> k & 1 == 1 {
                    end[k] as i32
                } else {
                    0
                }
            })
        }));
        Self {
            coordinates,
            origin,
            step_mm,
        }
    }

    /// In the patient's frame; 32-bit coordinates hold it exactly.
    pub(super) fn point_mm(&self, point: u32) -> [f64; 3] {
        let at = self.coordinates[point as usize];
        [0, 1, 2].map(|k| (self.origin[k] + f64::from(at[k])) * self.step_mm)
    }

    /// The metric of steps.
    pub(super) fn gram(&self) -> [[f64; 3]; 3] {
        let square = self.step_mm * self.step_mm;
        [[square, 0.0, 0.0], [0.0, square, 0.0], [0.0, 0.0, square]]
    }
}
