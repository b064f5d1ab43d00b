//! The stretches of marked voxels of a mask.

use bonemesh_task::{Cancelled, Task};
use ndarray::parallel::prelude::*;
use ndarray::{Array3, Axis, Slice};

/// Marked voxels of a row without a gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run {
    pub(super) start: u32,
    /// The first column after it.
    pub(super) end: u32,
}

impl Run {
    /// Its columns in a row.
    pub(super) fn columns(self) -> Slice {
        Slice::from(self.start as usize..self.end as usize)
    }
}

/// Runs of a slice, and before them where those of each row begin.
pub(super) type SliceRuns = (Vec<usize>, Vec<Run>);

/// The runs of each slice; slices in parallel.
pub(super) fn find_runs(voxels: &Array3<bool>, task: &Task) -> Result<Vec<SliceRuns>, Cancelled> {
    voxels
        .axis_iter(Axis(0))
        .into_par_iter()
        .map(|plane| {
            task.check()?;
            let (mut starts, mut runs) = (Vec::with_capacity(plane.nrows()), Vec::new());
            for row in plane.outer_iter() {
                starts.push(runs.len());
                if let Some(row) = row.as_slice() {
                    runs_of_row(row, &mut runs);
                } else {
                    runs_of_row(&row.to_vec(), &mut runs);
                }
            }
            task.advance(1)?;
            Ok((starts, runs))
        })
        .collect()
}

fn runs_of_row(row: &[bool], runs: &mut Vec<Run>) {
    let mut column = 0;
    while let Some(start) = next(row, column, true) {
        let end = next(row, start, false).unwrap_or(row.len());
        runs.push(Run {
            start: start as u32,
            end: end as u32,
        });
        column = end;
    }
}

/// Voxels that are looked at together.
const WORD: usize = 16;

/// The first voxel from `column` on that is `wanted`.
fn next(row: &[bool], mut column: usize, wanted: bool) -> Option<usize> {
    // Whole words first: most of a row is one long stretch.
    while let Some(word) = row.get(column..column + WORD) {
        if word.iter().filter(|v| **v == wanted).count() > 0 {
            break;
        }
        column += WORD;
    }
    let rest = row.get(column..)?;
    rest.iter().position(|v| *v == wanted).map(|i| column + i)
}
