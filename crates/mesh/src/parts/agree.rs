//! Which triangles have to be turned over so that neighbours face the same way.
//!
//! 1. `pairs`: the triangles on both sides of each edge that has exactly two.
//! 2. `Sheets::of`: what hangs together through such edges, and which of its triangles face against its first.
//! 3. Of each sheet the smaller part, by area, is turned.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::TriangleMesh;
use crate::vector::{cross, dot, minus};

/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// By triangle: whether it is turned over, so that neighbours agree as far as that is possible.
///
/// A sheet with one side only (a Möbius strip) stays as it is.
pub(super) fn turned_over(
    mesh: &TriangleMesh,
    pairs: &[Pair],
    task: &Task,
) -> Result<Vec<bool>, Cancelled> {
    // What is sound, as most meshes are, needs no second look.
    if pairs.iter().all(|pair| pair.agree) {
        return Ok(vec![false; mesh.triangles().len()]);
    }
    let sheets = Sheets::of(mesh.triangles().len(), pairs, task)?;
    Ok(sheets.smaller_parts(mesh))
}

/// The two triangles at an edge.
pub(super) struct Pair {
    pub(super) triangles: [u32; 2],
    /// Whether they run along it in opposite directions, as neighbours that face the same way do.
    agree: bool,
}

/// In an order that only the mesh decides.
pub(super) fn pairs(mesh: &TriangleMesh, task: &Task) -> Result<Vec<Pair>, Cancelled> {
    let chunks = mesh.triangles().par_chunks(STRIDE).enumerate();
    let sides: Vec<Vec<([u32; 2], u32, bool)>> = chunks
        .map(|(chunk, triangles)| {
            task.check()?;
            let first = chunk * STRIDE;
            let numbered = (first as u32..).zip(triangles);
            let sides = numbered.filter(|(_, [a, b, c])| a != b && b != c && c != a);
            let sides = sides.flat_map(|(number, [a, b, c])| {
                [[*a, *b], [*b, *c], [*c, *a]].map(|[from, to]| {
                    let edge = [from.min(to), from.max(to)];
                    (edge, number, from < to)
                })
            });
            Ok(sides.collect())
        })
        .collect::<Result<_, Cancelled>>()?;
    let mut sides = sides.concat();
    task.check()?;
    sides.par_sort_unstable();
    task.check()?;
    let at_edges = sides.chunk_by(|a, b| a.0 == b.0);
    let pairs = at_edges.filter_map(|at_edge| match at_edge {
        [(_, a, ahead), (_, b, other)] => Some(Pair {
            triangles: [*a, *b],
            agree: ahead != other,
        }),
        _ => None,
    });
    Ok(pairs.collect())
}

/// Triangles that hang together through edges of exactly two.
struct Sheets {
    /// The sheet of each triangle.
    of_triangles: Vec<u32>,
    /// By triangle: whether it faces against the first of its sheet.
    is_against: Vec<bool>,
    /// By sheet: whether it has two sides.
    has_sides: Vec<bool>,
}

impl Sheets {
    fn of(triangles: usize, pairs: &[Pair], task: &Task) -> Result<Self, Cancelled> {
        let neighbours = Neighbours::of(triangles, pairs);
        let mut sheets = Self {
            of_triangles: vec![u32::MAX; triangles],
            is_against: vec![false; triangles],
            has_sides: Vec::new(),
        };
        let mut todo = Vec::new();
        let mut looked = 0_usize;
        for first in 0..triangles {
            if sheets.of_triangles[first] != u32::MAX {
                continue;
            }
            let sheet = sheets.has_sides.len() as u32;
            sheets.has_sides.push(true);
            sheets.of_triangles[first] = sheet;
            todo.push(first);
            while let Some(here) = todo.pop() {
                looked += 1;
                if looked.is_multiple_of(STRIDE) {
                    task.check()?;
                }
                for &(there, agree) in neighbours.at(here) {
                    let there = there as usize;
                    let is_against = sheets.is_against[here] == agree;
                    if sheets.of_triangles[there] == u32::MAX {
                        sheets.of_triangles[there] = sheet;
                        sheets.is_against[there] = is_against;
                        todo.push(there);
                    } else if sheets.is_against[there] != is_against {
                        sheets.has_sides[sheet as usize] = false;
                    }
                }
            }
        }
        Ok(sheets)
    }

    fn smaller_parts(&self, mesh: &TriangleMesh) -> Vec<bool> {
        let mut areas2 = vec![[0.0; 2]; self.has_sides.len()];
        for (number, triangle) in mesh.triangles().iter().enumerate() {
            let [a, b, c] = mesh.corners_mm(*triangle);
            let facing = cross(minus(b, a), minus(c, a));
            let sheet = self.of_triangles[number] as usize;
            areas2[sheet][usize::from(self.is_against[number])] += dot(facing, facing).sqrt();
        }
        let turned = self.of_triangles.iter().zip(&self.is_against);
        let turned = turned.map(|(sheet, is_against)| {
            let [with, against] = areas2[*sheet as usize];
            self.has_sides[*sheet as usize] && *is_against == (against <= with)
        });
        turned.collect()
    }
}

/// The neighbours of each triangle, and whether they agree.
struct Neighbours {
    starts: Vec<usize>,
    others: Vec<(u32, bool)>,
}

impl Neighbours {
    fn of(triangles: usize, pairs: &[Pair]) -> Self {
        let mut starts = vec![0; triangles + 1];
        for triangle in pairs.iter().flat_map(|pair| pair.triangles) {
            starts[triangle as usize + 1] += 1;
        }
        for triangle in 0..triangles {
            starts[triangle + 1] += starts[triangle];
        }
        let mut next = starts.clone();
        let mut others = vec![(0, true); starts[triangles]];
        for pair in pairs {
            let [a, b] = pair.triangles;
            for [here, there] in [[a, b], [b, a]] {
                others[next[here as usize]] = (there, pair.agree);
                next[here as usize] += 1;
            }
        }
        Self { starts, others }
    }

    fn at(&self, triangle: usize) -> &[(u32, bool)] {
        &self.others[self.starts[triangle]..self.starts[triangle + 1]]
    }
}
