//! The surface between inside and outside: a vertex on every cut edge, triangles in every cube.
//!
//! 1. `Rows::of`: count the cut edges that start in each row of nodes and number their vertices.
//! 2. `vertices`: place them, row by row.
//! 3. `triangles`: in each cube that is cut, look its case up; a vertex's number follows from the
//!    cut edges before it in its row, so no table of edges is needed.
//!
//! Rows are numbered before any work is shared out: the result does not depend on threads. After
//! W. Schroeder, R. Maynard, B. Geveci, *Flying edges*, 2015.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::cases::CASES;
use super::signs::{Signs, after};

/// Numbers of the first vertices on edges along each axis that start in each row of nodes.
pub(super) struct Rows {
    starts: Vec<[u32; 3]>,
    /// How many vertices there are.
    pub(super) vertices: usize,
}

impl Rows {
    /// Numbers the vertices; `None` if there are more than an index can name.
    pub(super) fn of(signs: &Signs) -> Option<Self> {
        let rows = signs.rows();
        let counts: Vec<[u32; 3]> = (0..rows * signs.slices())
            .into_par_iter()
            .map(|row| signs.count_cuts(row % rows, row / rows))
            .collect();
        let mut vertices = 0u64;
        let mut starts = Vec::with_capacity(counts.len());
        for count in counts {
            starts.push(count.map(|c| {
                let start = vertices as u32;
                vertices += u64::from(c);
                start
            }));
        }
        (vertices < u64::from(u32::MAX)).then_some(Self {
            starts,
            vertices: vertices as usize,
        })
    }
}

/// Calls `found` with every cut edge of a slice of nodes, in the order of vertices: its lower
/// node and its axis.
pub(crate) fn cut_edges(signs: &Signs, k: usize, mut found: impl FnMut([usize; 3], usize)) {
    for j in 0..signs.rows() {
        for axis in 0..3 {
            for w in 0..signs.words {
                let mut cuts = signs.cuts(axis, j, k, w);
                while cuts != 0 {
                    found([64 * w + cuts.trailing_zeros() as usize, j, k], axis);
                    cuts &= cuts - 1;
                }
            }
        }
    }
}

/// Triangles over the vertices, from outside counter-clockwise among columns, rows and slices.
pub(super) fn triangles(
    signs: &Signs,
    rows: &Rows,
    task: &Task,
) -> Result<Vec<[u32; 3]>, Cancelled> {
    let slices: Result<Vec<_>, Cancelled> = (0..signs.slices() - 1)
        .into_par_iter()
        .map(|k| {
            task.advance(1)?;
            let mut triangles = Vec::new();
            for j in 0..signs.rows() - 1 {
                CubeRow::new(signs, rows, j, k).triangles(&mut triangles);
            }
            Ok(triangles)
        })
        .collect();
    Ok(slices?.concat())
}

/// Where a cube's four rows of nodes are, as row and slice beyond the first.
const CORNER_ROWS: [[usize; 2]; 4] = [[0, 0], [1, 0], [0, 1], [1, 1]];

/// A row of cubes.
struct CubeRow<'a> {
    signs: &'a Signs,
    place: [usize; 2],
    /// Bits of the four rows of nodes, in the order of [`CORNER_ROWS`].
    rows: [&'a [u64]; 4],
    /// Numbers of the next vertices of each of [`Self::cuts`].
    next: [u32; 8],
}

impl<'a> CubeRow<'a> {
    fn new(signs: &'a Signs, numbers: &Rows, j: usize, k: usize) -> Self {
        let start = |[dj, dk]: [usize; 2]| numbers.starts[(k + dk) * signs.rows() + j + dj];
        let [a, b, c, d] = CORNER_ROWS.map(start);
        Self {
            signs,
            place: [j, k],
            rows: CORNER_ROWS.map(|[dj, dk]| signs.row(j + dj, k + dk)),
            next: [a[0], b[0], c[0], d[0], a[1], c[1], a[2], b[2]],
        }
    }

    /// Cuts in word `w` of edges along x (four rows), y (two) and z (two).
    #[inline]
    fn cuts(&self, w: usize) -> [u64; 8] {
        let ([j, k], s) = (self.place, self.signs);
        let [a, b, c, d] = self.rows;
        [
            a[w] ^ after(a, w),
            b[w] ^ after(b, w),
            c[w] ^ after(c, w),
            d[w] ^ after(d, w),
            s.cuts(1, j, k, w),
            s.cuts(1, j, k + 1, w),
            s.cuts(2, j, k, w),
            s.cuts(2, j + 1, k, w),
        ]
    }

    fn triangles(mut self, triangles: &mut Vec<[u32; 3]>) {
        for w in 0..self.signs.words {
            let here = self.rows.map(|row| row[w]);
            let there = self.rows.map(|row| after(row, w));
            let fold = |f: fn(u64, u64) -> u64| {
                here.into_iter().chain(there).reduce(f).unwrap_or_default()
            };
            let mut mixed = fold(|a, b| a | b) & !fold(|a, b| a & b);
            let cuts = self.cuts(w);
            while mixed != 0 {
                let i = mixed.trailing_zeros();
                mixed &= mixed - 1;
                let bit = |word: u64, corner: usize| (word >> i & 1) << corner;
                let inside = (0..4).fold(0, |inside, row| {
                    inside | bit(here[row], 2 * row) | bit(there[row], 2 * row + 1)
                });
                let vertices = self.vertices(&cuts, i);
                let filled = CASES[inside as usize].iter();
                triangles.extend(filled.map(|t| t.map(|edge| vertices[edge as usize])));
            }
            for (next, cuts) in self.next.iter_mut().zip(cuts) {
                *next += cuts.count_ones();
            }
        }
    }

    /// Numbers of the vertices on the twelve edges of cube `i` of a word; those of edges that are
    /// not cut mean nothing.
    #[inline]
    fn vertices(&self, cuts: &[u64; 8], i: u32) -> [u32; 12] {
        let below = |line: usize| self.next[line] + (cuts[line] & ((1 << i) - 1)).count_ones();
        let further = |line: usize| below(line) + (cuts[line] >> i & 1) as u32;
        [
            below(0),
            below(1),
            below(2),
            below(3),
            below(4),
            further(4),
            below(5),
            further(5),
            below(6),
            further(6),
            below(7),
            further(7),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::isosurface::cases::ends;
    use bonemesh_task::Task;

    #[test]
    fn edges_are_numbered_as_their_corners_say() {
        // The order in `CubeRow::vertices`: x by row and slice, y by column and slice, z by
        // column and row.
        let starts: Vec<[u8; 2]> = (0..12).map(ends).collect();
        assert_eq!(starts[1], [2, 3]);
        assert_eq!(starts[2], [4, 5]);
        assert_eq!(starts[5], [1, 3]);
        assert_eq!(starts[6], [4, 6]);
        assert_eq!(starts[9], [1, 5]);
        assert_eq!(starts[10], [2, 6]);
    }

    #[test]
    fn vertices_come_in_the_order_in_which_edges_are_found() {
        let shape = [70, 5, 4];
        let inside = |[i, j, k]: [usize; 3]| (i * 7 + j * 5 + k * 3) % 4 == 0;
        let signs = Signs::of(shape, inside, &Task::default()).unwrap();
        let rows = Rows::of(&signs).unwrap();
        let mut found = 0;
        for k in 0..signs.slices() {
            cut_edges(&signs, k, |_, _| found += 1);
        }
        assert_eq!(found, rows.vertices);
        let triangles = triangles(&signs, &rows, &Task::default()).unwrap();
        let mut used = vec![false; rows.vertices];
        triangles
            .iter()
            .flatten()
            .for_each(|&v| used[v as usize] = true);
        assert!(used.into_iter().all(|u| u));
    }
}
