//! Which runs belong together.

use bonemesh_task::{Cancelled, Task};
use ndarray::parallel::prelude::*;

use super::runs::Run;

/// Slices of a slab: few enough to share the work out evenly, enough that borders are few.
const SLAB: usize = 8;

/// The runs of a mask and which of them touch.
pub(super) struct Lattice<'a> {
    pub(super) runs: &'a [Run],
    pub(super) rows: &'a [usize],
    pub(super) rows_of_slice: usize,
    /// How far apart along a row runs in neighbouring rows may be.
    pub(super) reach: u32,
    pub(super) has_corners: bool,
}

impl Lattice<'_> {
    /// Joins the runs within each slab; every run's parent is a run before it in its slab, or
    /// itself.
    pub(super) fn join_rows(&self, slices: usize, task: &Task) -> Result<Vec<u32>, Cancelled> {
        let mut parents: Vec<u32> = (0..self.runs.len() as u32).collect();
        let mut rest = &mut parents[..];
        let mut slabs = Vec::new();
        for first in (0..slices).step_by(SLAB) {
            let end = (first + SLAB).min(slices);
            let start = self.rows[first * self.rows_of_slice];
            let (slab, after) = rest.split_at_mut(self.rows[end * self.rows_of_slice] - start);
            slabs.push((
                first..end,
                Forest {
                    first: start,
                    parents: slab,
                },
            ));
            rest = after;
        }
        slabs.into_par_iter().try_for_each(|(slab, mut forest)| {
            for slice in slab.clone() {
                for row in 0..self.rows_of_slice {
                    if row > 0 {
                        self.join(slice, row, slice, row - 1, &mut forest);
                    }
                    if slice > slab.start {
                        self.join_with_slice_before(slice, row, &mut forest);
                    }
                }
                task.advance(1)?;
            }
            Ok(())
        })?;
        Ok(parents)
    }

    /// Joins the runs across the borders of the slabs.
    pub(super) fn join_slabs(
        &self,
        slices: usize,
        parents: &mut [u32],
        task: &Task,
    ) -> Result<(), Cancelled> {
        let mut forest = Forest { first: 0, parents };
        for slice in (SLAB..slices).step_by(SLAB) {
            task.check()?;
            for row in 0..self.rows_of_slice {
                self.join_with_slice_before(slice, row, &mut forest);
            }
        }
        Ok(())
    }

    fn join_with_slice_before(&self, slice: usize, row: usize, forest: &mut Forest<'_>) {
        let rows = if self.has_corners {
            row.saturating_sub(1)..(row + 2).min(self.rows_of_slice)
        } else {
            row..row + 1
        };
        for other in rows {
            self.join(slice, row, slice - 1, other, forest);
        }
    }

    /// Joins the runs of one row with those they touch in another.
    fn join(
        &self,
        slice: usize,
        row: usize,
        other_slice: usize,
        other_row: usize,
        forest: &mut Forest<'_>,
    ) {
        let of = |slice: usize, row: usize| {
            let row = slice * self.rows_of_slice + row;
            self.rows[row]..self.rows[row + 1]
        };
        let (here, there) = (of(slice, row), of(other_slice, other_row));
        let (mut a, mut b) = (here.start, there.start);
        while a < here.end && b < there.end {
            let (run, other) = (self.runs[a], self.runs[b]);
            if run.start < other.end + self.reach && other.start < run.end + self.reach {
                forest.join(a, b);
            }
            if run.end < other.end {
                a += 1;
            } else {
                b += 1;
            }
        }
    }
}

/// A union-find forest over the runs from number `first` on; a parent never comes after its
/// child.
struct Forest<'a> {
    first: usize,
    parents: &'a mut [u32],
}

impl Forest<'_> {
    fn root(&mut self, mut run: usize) -> usize {
        loop {
            let parent = self.parents[run - self.first] as usize;
            if parent == run {
                return run;
            }
            // Halving the path keeps later ways short.
            let grandparent = self.parents[parent - self.first];
            self.parents[run - self.first] = grandparent;
            run = grandparent as usize;
        }
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) - self.first] = a.min(b) as u32;
    }
}
