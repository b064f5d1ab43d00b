//! What a selection takes of the surface around a rim.
//!
//! A lasso around a defect picks up the first vertices of the wall inside it, and the sides of a cut would
//! stand upright on these, not on the surface that was meant. What faces another way than most of the patch
//! around it, and hangs together with the patch's border, is such a flap.

use rustc_hash::FxHashMap;

use super::crop::Neighbourhood;
use crate::vector::{Vector, dot, plus_scaled, unit};

/// Side (mm) of the cells over which it is looked what most of the patch faces; with their neighbours.
const CELL_MM: f64 = 3.0;
/// Cosine of the most that a triangle faces away from that.
const ALONG: f64 = 0.5;

type Cell = [i64; 3];

fn cell(place: Vector) -> Cell {
    place.map(|v| (v / CELL_MM).floor() as i64)
}

/// Takes the flaps out of a patch.
pub(super) fn drop_flaps(near: &Neighbourhood, has_triangle: &mut [bool]) {
    let mut facings: FxHashMap<Cell, Vector> = FxHashMap::default();
    let own = |has: &[bool]| -> Vec<usize> { (0..has.len()).filter(|t| has[*t]).collect() };
    let patch = own(has_triangle);
    let middle = |t: usize| {
        let corners = near.triangles[t].map(|v| near.vertices_mm[v as usize]);
        let sum = corners
            .iter()
            .fold([0.0; 3], |sum, c| plus_scaled(sum, 1.0, *c));
        sum.map(|v| v / 3.0)
    };
    for &t in &patch {
        let sum = facings.entry(cell(middle(t))).or_default();
        *sum = plus_scaled(*sum, 1.0, near.facing(near.triangles[t]));
    }
    let around: FxHashMap<Cell, Vector> = facings
        .keys()
        .map(|cell| {
            let shifts = (0..27).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]);
            let cells = shifts.map(|s| [0, 1, 2].map(|axis| cell[axis] + s[axis]));
            let near = cells.filter_map(|cell| facings.get(&cell));
            (
                *cell,
                unit(near.fold([0.0; 3], |sum, n| plus_scaled(sum, 1.0, *n))),
            )
        })
        .collect();
    let mut is_apart = vec![false; has_triangle.len()];
    for &t in &patch {
        let facing = unit(near.facing(near.triangles[t]));
        is_apart[t] = dot(facing, around[&cell(middle(t))]) < ALONG;
    }
    spread_from_border(near, has_triangle, &is_apart);
}

/// Takes out what is apart and hangs together, by vertices, with what is not of the patch.
fn spread_from_border(near: &Neighbourhood, has_triangle: &mut [bool], is_apart: &[bool]) {
    let mut is_border = vec![false; near.vertices_mm.len()];
    for (triangle, _) in near
        .triangles
        .iter()
        .zip(&*has_triangle)
        .filter(|(_, has)| !**has)
    {
        for vertex in triangle {
            is_border[*vertex as usize] = true;
        }
    }
    let mut apart: Vec<usize> = (0..is_apart.len()).filter(|t| is_apart[*t]).collect();
    loop {
        let before = apart.len();
        apart.retain(|&t| {
            let triangle = near.triangles[t];
            let is_reached = triangle.iter().any(|v| is_border[*v as usize]);
            if is_reached {
                has_triangle[t] = false;
                for vertex in triangle {
                    is_border[vertex as usize] = true;
                }
            }
            !is_reached
        });
        if apart.len() == before {
            return;
        }
    }
}
