//! How deep the bone is below each place of the patch, where another bone follows.
//!
//! Rays go from the patch into the bone. Where one leaves it, crosses a hollow and enters bone again within
//! the thickness, such as the second wall of a long bone or of a sinus, the cut ends in the hollow. Gaps
//! narrower than [`PORE_MM`] are pores of one and the same bone. A single ray that gets lost in a canal
//! does not count, and from place to place the depth changes as steeply as [`SLOPE`] at most.

use bonemesh_mesh::TriangleTree;
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::sheet::Sheet;
use bonemesh_mesh::vector::{Vector, cross, dot, length, minus, plus_scaled};

/// The narrowest hollow (mm).
const PORE_MM: f64 = 3.0;
/// How far (mm) outside of the patch a ray starts: the patch is smoother than the bone.
const BEFORE_MM: f64 = 1.0;
/// How far (mm) from there a ray may go until it enters the bone.
const ENTERED_MM: f64 = 3.0;
/// What is passed over after a hit, so that it is not met again.
const AFTER_HIT_MM: f64 = 1e-6;
/// Change of depth by distance.
const SLOPE: f64 = 1.0;
/// Means over neighbours by which lonely rays are told from hollows.
const BLURS: usize = 6;
/// Rounds in which depths spread; more are never needed, as a hollow's border is not longer than that.
const SPREADS: usize = 200;
/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 8;

/// Sets how deep is cut below each place of `sheet`: to the far side of the bone, else to `thickness_mm`.
///
/// `straight`: the direction of all rays, else they go along the surface's inward normals.
pub(super) fn end_at_far_side(
    sheet: &mut Sheet,
    bone: &TriangleTree<'_>,
    straight: Option<Vector>,
    thickness_mm: f64,
    task: &Task,
) -> Result<(), Cancelled> {
    // What follows a hollow lies beyond the thickness.
    if thickness_mm <= PORE_MM {
        return Ok(());
    }
    task.begin("far side", sheet.normals.len());
    let far_mm = |vertex: usize| {
        let inward = sheet.normals[vertex].map(|n| -n);
        let direction = straight.unwrap_or(inward);
        let place = sheet.mesh.vertices_mm()[vertex];
        (sheet.inside_mm[vertex] > 0.0)
            .then(|| far_side(bone, place, direction, thickness_mm))
            .flatten()
    };
    let mut found: Vec<Option<f64>> = vec![None; sheet.normals.len()];
    found
        .par_chunks_mut(STRIDE)
        .enumerate()
        .try_for_each(|(chunk, found)| {
            for (vertex, found) in (chunk * STRIDE..).zip(found.iter_mut()) {
                *found = far_mm(vertex);
            }
            task.advance(found.len())
        })?;
    if found.iter().all(Option::is_none) {
        return Ok(());
    }
    drop_lonely(&mut found, sheet);
    let depths = found.iter().map(|far| far.unwrap_or(thickness_mm));
    sheet.bottom_mm = depths.collect();
    flatten(sheet);
    task.check()
}

/// Where (mm) in the hollow behind the bone a cut ends, if more bone follows within the thickness.
fn far_side(
    bone: &TriangleTree<'_>,
    place: Vector,
    direction: Vector,
    thickness_mm: f64,
) -> Option<f64> {
    let start = plus_scaled(place, -BEFORE_MM, direction);
    let end = BEFORE_MM + thickness_mm;
    let mut gone = 0.0;
    let mut left_at: Option<f64> = None;
    let mut is_first = true;
    while gone < end {
        let from = plus_scaled(start, gone, direction);
        let (away, triangle) = bone.first_hit(from, direction, end - gone)?;
        gone += away;
        let [a, b, c] = bone
            .mesh()
            .corners_mm(bone.mesh().triangles()[triangle as usize]);
        let enters = dot(cross(minus(b, a), minus(c, a)), direction) < 0.0;
        match (enters, left_at) {
            (true, _) if is_first && gone > ENTERED_MM => return None,
            (true, Some(left)) if gone - left > PORE_MM => {
                return Some(left + PORE_MM / 2.0 - BEFORE_MM);
            }
            (true, _) => left_at = None,
            // A start inside of a neighbour: what it leaves first is not the bone below.
            (false, _) if is_first && gone < BEFORE_MM => {}
            (false, _) => left_at = Some(gone),
        }
        is_first = is_first && !enters;
        gone += AFTER_HIT_MM;
    }
    None
}

/// Forgets depths that most places around do not share.
fn drop_lonely(found: &mut [Option<f64>], sheet: &Sheet) {
    let triangles = sheet.mesh.triangles();
    let mut share: Vec<f64> = found
        .iter()
        .map(|f| f64::from(u8::from(f.is_some())))
        .collect();
    for _ in 0..BLURS {
        let mut sums: Vec<[f64; 2]> = share.iter().map(|s| [*s, 1.0]).collect();
        for [a, b, c] in triangles {
            for (to, from) in [(a, b), (b, c), (c, a), (a, c), (b, a), (c, b)] {
                let sum = &mut sums[*to as usize];
                sum[0] += share[*from as usize];
                sum[1] += 1.0;
            }
        }
        share = sums.iter().map(|[sum, count]| sum / count).collect();
    }
    for (found, share) in found.iter_mut().zip(share) {
        if share < 0.5 {
            *found = None;
        }
    }
}

/// Makes depths change from place to place no more steeply than the slope, by lowering them.
fn flatten(sheet: &mut Sheet) {
    let vertices = sheet.mesh.vertices_mm();
    let depths = &mut sheet.bottom_mm;
    for _ in 0..SPREADS {
        let mut is_done = true;
        for triangle in sheet.mesh.triangles() {
            for turn in 0..3 {
                let [a, b] = [triangle[turn], triangle[(turn + 1) % 3]].map(|v| v as usize);
                let rise = SLOPE * length(minus(vertices[b], vertices[a]));
                for (from, to) in [(a, b), (b, a)] {
                    if depths[to] > depths[from] + rise * (1.0 + 1e-9) {
                        depths[to] = depths[from] + rise;
                        is_done = false;
                    }
                }
            }
        }
        if is_done {
            return;
        }
    }
}
