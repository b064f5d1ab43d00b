//! What a selection takes of the surface around a rim.
//!
//! A lasso around a defect picks up the first vertices of the wall inside it, and the sides of a cut would
//! stand upright on these, not on the surface that was meant. What faces another way than most of the patch
//! around it, and hangs together with the patch's border, is such a flap.

use rustc_hash::FxHashMap;

use super::patch::Patch;
use bonemesh_mesh::vector::{Vector, dot, length, plus_scaled, unit_or_zero};

/// Side (mm) of the cells over which it is looked what most of the patch faces; with their neighbours.
const CELL_MM: f64 = 3.0;
/// Cosine of the most that a triangle faces away from that.
const ALONG: f64 = 0.5;

type Cell = [i64; 3];

fn cell(place: Vector) -> Cell {
    place.map(|v| (v / CELL_MM).floor() as i64)
}

/// What some triangles face.
#[derive(Clone, Copy, Default)]
struct Facing {
    sum: Vector,
    /// The sum of the lengths.
    all: f64,
}

impl Facing {
    fn of(facing: Vector) -> Self {
        Self {
            sum: facing,
            all: length(facing),
        }
    }

    fn plus(&self, other: &Self) -> Self {
        Self {
            sum: plus_scaled(self.sum, 1.0, other.sum),
            all: self.all + other.all,
        }
    }

    /// Whether most face about the same way; around a thin bone they do not.
    fn is_common(&self) -> bool {
        length(self.sum) > ALONG * self.all
    }
}

/// Takes the flaps out of a patch.
pub(super) fn drop_flaps(patch: &mut Patch) {
    let near = &patch.near;
    let facing = |t: u32| near.facing(near.triangles[t as usize]);
    let mut facings: FxHashMap<Cell, Facing> = FxHashMap::default();
    for t in patch.own() {
        let sum = facings.entry(cell(near.middle(t))).or_default();
        *sum = sum.plus(&Facing::of(facing(t)));
    }
    let around: FxHashMap<Cell, Facing> = facings
        .keys()
        .map(|cell| {
            let shifts = (0..27).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]);
            let cells = shifts.map(|s| [0, 1, 2].map(|axis| cell[axis] + s[axis]));
            let near = cells.filter_map(|cell| facings.get(&cell));
            (*cell, near.fold(Facing::default(), |sum, n| sum.plus(n)))
        })
        .collect();
    let is_apart = |t: &u32| {
        let most = around[&cell(near.middle(*t))];
        most.is_common() && dot(unit_or_zero(facing(*t)), unit_or_zero(most.sum)) < ALONG
    };
    let apart = patch.own().filter(is_apart).collect();
    spread_from_border(patch, apart);
}

/// Takes out what is apart and hangs together, by vertices, with what is not of the patch.
fn spread_from_border(patch: &mut Patch, mut apart: Vec<u32>) {
    let triangles = &patch.near.triangles;
    let mut is_border = vec![false; patch.near.vertices_mm.len()];
    let others = triangles.iter().zip(&patch.has_triangle);
    for (triangle, _) in others.filter(|(_, has)| !**has) {
        for vertex in triangle {
            is_border[*vertex as usize] = true;
        }
    }
    loop {
        let before = apart.len();
        apart.retain(|&t| {
            let triangle = triangles[t as usize];
            let is_reached = triangle.iter().any(|v| is_border[*v as usize]);
            if is_reached {
                patch.has_triangle[t as usize] = false;
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
