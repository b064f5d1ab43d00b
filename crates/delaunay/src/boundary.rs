//! The facets that only one cell has.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::kept::outward;
use crate::{AlphaBoundary, Points, Tetrahedra};

/// Facets sorted by one thread at a time.
const FACETS_PER_CHUNK: usize = 1 << 14;

/// Cells done between two looks at the cancel switch: a few milliseconds.
const CELLS_PER_CHECK: usize = 1 << 16;

impl Tetrahedra {
    /// Triangles that bound the cells: the facets of exactly one cell, counter-clockwise seen
    /// from outside in the input's coordinates, sorted by their vertices, the smallest first.
    ///
    /// The boundary of an alpha complex may touch itself in edges and vertices.
    ///
    /// # Errors
    /// [`Cancelled`]
    pub fn boundary(&self, task: &Task) -> Result<Vec<[u32; 3]>, Cancelled> {
        let largest = self.cells.as_flattened().iter().copied().max().unwrap_or(0);
        // The sort below has a place for every index and 31 bits for each: should the indices
        // be sparse or larger, number the used ones first.
        if largest >> 31 != 0 || largest as usize > 64 * (self.cells.len() + 1024) {
            let mut used = self.cells.as_flattened().to_vec();
            used.par_sort_unstable();
            used.dedup();
            let place = |v: u32| used.partition_point(|&u| u < v) as u32;
            let cells = self.cells.par_iter().map(|c| c.map(place)).collect();
            let mut triangles = Self { cells }.boundary(task)?;
            for v in triangles.as_flattened_mut() {
                *v = used[*v as usize];
            }
            return Ok(triangles);
        }
        single_facets(&self.cells, largest as usize + 1, task)
    }

    /// The cells' total volume in mm^3: summed exactly on a lattice.
    pub fn volume_mm3(&self, points: Points<'_>) -> f64 {
        volume_mm3(self.cells.par_iter().copied(), points)
    }
}

impl AlphaBoundary {
    /// The volume in mm^3 that the triangles enclose, which is that of the tetrahedra: summed
    /// exactly on a lattice.
    pub fn volume_mm3(&self, points: Points<'_>) -> f64 {
        // The cones from one of the points to all triangles.
        let Some(&[apex, ..]) = self.triangles.first() else {
            return 0.0;
        };
        let cones = self.triangles.par_iter().map(|&[a, b, c]| [apex, a, b, c]);
        volume_mm3(cones, points)
    }
}

/// The total signed volume of `cells`.
fn volume_mm3(cells: impl IndexedParallelIterator<Item = [u32; 4]>, points: Points<'_>) -> f64 {
    match points {
        Points::Lattice { coordinates, gram } => {
            let at = |v: u32| coordinates[v as usize].map(i128::from);
            let six: i128 = cells.map(|c| determinant(c.map(at))).sum();
            let rows = [[0.0; 3], gram[0], gram[1], gram[2]];
            six as f64 * determinant(rows).sqrt() / 6.0
        }
        Points::Free(free) => {
            let at = |v: u32| free[v as usize];
            let six = cells.map(|c| determinant(c.map(at)));
            bonemesh_task::chunked_sum(&six.collect::<Vec<f64>>()) / 6.0
        }
    }
}

/// Six times the signed volume of a tetrahedron.
fn determinant<T>([a, b, c, d]: [[T; 3]; 4]) -> T
where
    T: Copy + std::ops::Add<Output = T> + std::ops::Sub<Output = T> + std::ops::Mul<Output = T>,
{
    let [u, v, w] = [b, c, d].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
    u[0] * (v[1] * w[2] - v[2] * w[1])
        + u[1] * (v[2] * w[0] - v[0] * w[2])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

/// A facet's smallest vertex, and its others as a key: in ascending order, the last bit telling
/// whether that turns the facet over.
#[inline]
fn key([a, b, c]: [u32; 3]) -> (u32, u64) {
    let (first, p, q) = if a < b && a < c {
        (a, b, c)
    } else if b < c {
        (b, c, a)
    } else {
        (c, a, b)
    };
    let pack = |low: u32, high: u32| u64::from(low) << 32 | u64::from(high) << 1;
    let key = if p < q { pack(p, q) } else { pack(q, p) | 1 };
    (first, key)
}

/// A facet of [`key`].
#[inline]
fn facet(first: u32, key: u64) -> [u32; 3] {
    let (low, high) = ((key >> 32) as u32, (key as u32) >> 1);
    if key & 1 == 0 {
        [first, low, high]
    } else {
        [first, high, low]
    }
}

/// Facets that occur once, in the order of [`Tetrahedra::boundary`]: for a list of which nearly
/// all do.
pub(crate) fn single_facets_sorted(
    facets: impl ParallelIterator<Item = [u32; 3]>,
    task: &Task,
) -> Result<Vec<[u32; 3]>, Cancelled> {
    let mut keys: Vec<(u32, u64)> = facets.map(key).collect();
    task.check()?;
    keys.par_sort_unstable_by_key(|&(first, key)| u128::from(first) << 64 | u128::from(key));
    task.check()?;
    let same = keys.par_chunk_by(|(a, p), (b, q)| a == b && p >> 1 == q >> 1);
    let singles = same.filter(|facets| facets.len() == 1);
    Ok(singles.map(|f| facet(f[0].0, f[0].1)).collect())
}

/// Facets that occur once: put in bins by their smallest vertex, then sorted bin by bin.
fn single_facets(
    cells: &[[u32; 4]],
    vertices: usize,
    task: &Task,
) -> Result<Vec<[u32; 3]>, Cancelled> {
    let mut ends = vec![0usize; vertices + 1];
    for cells in cells.chunks(CELLS_PER_CHECK) {
        task.check()?;
        for facet in cells.iter().copied().flat_map(outward) {
            ends[key(facet).0 as usize] += 1;
        }
    }
    let mut total = 0;
    for end in &mut ends {
        let count = *end;
        *end = total;
        total += count;
    }
    // Where each bin starts, until it is filled; then where it ends.
    let mut keys = vec![0u64; total];
    for cells in cells.chunks(CELLS_PER_CHECK) {
        task.check()?;
        for facet in cells.iter().copied().flat_map(outward) {
            let (first, key) = key(facet);
            let place = &mut ends[first as usize];
            keys[*place] = key;
            *place += 1;
        }
    }
    let bins = split_into_chunks(&mut keys, &ends);
    let singles = |(first_bin, ends, keys)| {
        task.check()?;
        Ok(singles_of_chunk(first_bin, ends, keys))
    };
    let chunks: Result<Vec<_>, Cancelled> = bins.into_par_iter().map(singles).collect();
    Ok(chunks?.concat())
}

/// Consecutive bins: the first one's number, the ends of all, their keys.
type Bins<'a> = (usize, Vec<usize>, &'a mut [u64]);

/// Cuts the keys between bins into pieces of about [`FACETS_PER_CHUNK`].
fn split_into_chunks<'a>(mut keys: &'a mut [u64], ends: &[usize]) -> Vec<Bins<'a>> {
    let mut chunks = Vec::new();
    let (mut first_bin, mut start) = (0, 0);
    for (bin, &end) in ends.iter().enumerate() {
        if end - start >= FACETS_PER_CHUNK || bin + 1 == ends.len() {
            let (head, tail) = keys.split_at_mut(end - start);
            let local = ends[first_bin..=bin].iter().map(|e| e - start).collect();
            chunks.push((first_bin, local, head));
            keys = tail;
            (first_bin, start) = (bin + 1, end);
        }
    }
    chunks
}

fn singles_of_chunk(first_bin: usize, ends: Vec<usize>, keys: &mut [u64]) -> Vec<[u32; 3]> {
    let mut singles = Vec::new();
    let mut start = 0;
    for (bin, end) in (first_bin as u32..).zip(ends) {
        let keys = &mut keys[start..end];
        start = end;
        keys.sort_unstable();
        for same in keys.chunk_by(|a, b| a >> 1 == b >> 1) {
            if let &[key] = same {
                singles.push(facet(bin, key));
            }
        }
    }
    singles
}
