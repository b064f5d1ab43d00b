//! The connected pieces of a mask.
//!
//! 1. `find_runs`: in each row, the stretches of marked voxels; rows in parallel.
//! 2. `join_rows`: a run is joined with those it touches in the rows before it; slabs of slices
//!    in parallel, each with a forest of its own.
//! 3. `join_slabs`: the same across the borders of the slabs.
//!
//! The first run of a component, in the order of slices, rows and columns, stands for it; so
//! components are numbered by their first voxel, whatever the number of threads.
//!
//! Source: runs and a union-find forest, as in K. Wu, E. Otoo, K. Suzuki, "Optimizing two-pass
//! connected-component labeling algorithms", Pattern Analysis and Applications 12(2), 2009.

mod forest;
mod runs;
#[cfg(test)]
mod tests;

use std::ops::Range;

use bonemesh_task::Task;
use ndarray::parallel::prelude::*;
use ndarray::{Array3, Axis};

use crate::{Mask, SegmentError};
use forest::Lattice;
use runs::{Run, find_runs};

/// Which neighbours of a voxel are connected with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Connectivity {
    /// The 6 that share a face.
    Faces,
    /// The 26 that share a face, an edge or a corner.
    #[default]
    Corners,
}

impl Connectivity {
    /// How many neighbours are connected with a voxel: 6 or 26.
    pub fn neighbours(self) -> usize {
        match self {
            Self::Faces => 6,
            Self::Corners => 26,
        }
    }

    /// How far apart along a row runs in neighbouring rows may be.
    fn reach(self) -> u32 {
        match self {
            Self::Faces => 0,
            Self::Corners => 1,
        }
    }
}

/// The connected pieces of a mask, numbered from 0 by their first voxel in the order of slices,
/// rows and columns.
#[derive(Clone, Debug)]
pub struct Components {
    geometry: bonemesh_volume::Geometry,
    /// By slice, row and column.
    runs: Vec<Run>,
    /// Where the runs of each row begin in `runs`; one more than there are rows.
    rows: Vec<usize>,
    /// The component of each run.
    component: Vec<u32>,
    /// Voxels of each component.
    sizes: Vec<u64>,
}

/// Finds the connected pieces of `mask`.
///
/// # Errors
/// [`SegmentError::Shape`] when the mask is not of its geometry's shape,
/// [`SegmentError::TooManyRuns`] when it is noise of some thousand million voxels,
/// [`SegmentError::Cancelled`].
pub fn connected_components(
    mask: &Mask,
    connectivity: Connectivity,
    task: &Task,
) -> Result<Components, SegmentError> {
    let [slices, rows_of_slice, _] = mask.checked_shape()?;
    task.begin("components", 2 * slices);
    let found = find_runs(&mask.voxels, task)?;
    let mut rows = Vec::with_capacity(slices * rows_of_slice + 1);
    let mut runs = Vec::with_capacity(found.iter().map(|(_, runs)| runs.len()).sum());
    for (row_ends, of_slice) in found {
        let before = runs.len();
        runs.extend(of_slice);
        rows.extend(row_ends.into_iter().map(|end| before + end));
    }
    rows.push(runs.len());
    if u32::try_from(runs.len()).is_err() {
        return Err(SegmentError::TooManyRuns(runs.len()));
    }
    let lattice = Lattice {
        runs: &runs,
        rows: &rows,
        rows_of_slice,
        reach: connectivity.reach(),
        has_corners: connectivity == Connectivity::Corners,
    };
    let mut parents = lattice.join_rows(slices, task)?;
    lattice.join_slabs(slices, &mut parents, task)?;
    let (component, sizes) = number(&runs, &mut parents);
    Ok(Components {
        geometry: mask.geometry.clone(),
        runs,
        rows,
        component,
        sizes,
    })
}

/// The largest connected piece of `mask`; the first of equally large ones.
///
/// # Errors
/// [`SegmentError::NoComponent`] when nothing is marked, and those of [`connected_components`].
pub fn largest_component(
    mask: &Mask,
    connectivity: Connectivity,
    task: &Task,
) -> Result<Mask, SegmentError> {
    let components = connected_components(mask, connectivity, task)?;
    let largest = components.largest().ok_or(SegmentError::NoComponent)?;
    Ok(components.mask(|component| component == largest))
}

impl Components {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.sizes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.sizes.is_empty()
    }

    /// Voxels of each component, by its number.
    pub fn sizes(&self) -> &[u64] {
        &self.sizes
    }

    /// Number of the component with most voxels, the first of equally large ones.
    pub fn largest(&self) -> Option<usize> {
        let largest = self.sizes.iter().max()?;
        self.sizes.iter().position(|size| size == largest)
    }

    /// Number of the component that holds the voxel `[slice, row, column]`, if one does.
    pub fn at(&self, [slice, row, column]: [usize; 3]) -> Option<usize> {
        let [slices, rows, columns] = self.geometry.shape();
        if slice >= slices || row >= rows || column >= columns {
            return None;
        }
        let runs = self.runs_of(slice * rows + row);
        let column = column as u32;
        let after = self.runs[runs.clone()].partition_point(|run| run.end <= column);
        let run = runs.start + after;
        (after < runs.len() && self.runs[run].start <= column).then(|| self.component[run] as usize)
    }

    /// The mask of the components whose number `is_kept`.
    pub fn mask(&self, is_kept: impl Fn(usize) -> bool + Sync) -> Mask {
        let mut voxels = Array3::from_elem(self.geometry.shape(), false);
        self.paint(&mut voxels, |component| is_kept(component).then_some(true));
        Mask {
            voxels,
            geometry: self.geometry.clone(),
        }
    }

    /// For each component, whether `mask`, which must be of the same shape, marks any of it.
    pub(crate) fn holding_any(&self, mask: &Mask) -> Vec<bool> {
        let rows = self.geometry.shape()[1];
        let mut is_held = vec![false; self.len()];
        for (slice, plane) in mask.voxels.outer_iter().enumerate() {
            for (row, line) in plane.outer_iter().enumerate() {
                for run in self.runs_of(slice * rows + row) {
                    let is_held = &mut is_held[self.component[run] as usize];
                    *is_held = *is_held
                        || line
                            .slice_axis(Axis(0), self.runs[run].columns())
                            .iter()
                            .any(|v| *v);
                }
            }
        }
        is_held
    }

    /// The number of each voxel's component plus one, `[slice, row, column]`; 0 where none is.
    pub fn labels(&self) -> Array3<u32> {
        let mut labels = Array3::zeros(self.geometry.shape());
        self.paint(&mut labels, |component| Some(component as u32 + 1));
        labels
    }

    /// Writes what `colour` gives for its component into each marked voxel.
    fn paint<T: Copy + Send + Sync>(
        &self,
        voxels: &mut Array3<T>,
        colour: impl Fn(usize) -> Option<T> + Sync,
    ) {
        let rows = self.geometry.shape()[1];
        voxels
            .axis_iter_mut(Axis(0))
            .into_par_iter()
            .enumerate()
            .for_each(|(slice, mut plane)| {
                for (row, mut line) in plane.outer_iter_mut().enumerate() {
                    for run in self.runs_of(slice * rows + row) {
                        let Some(colour) = colour(self.component[run] as usize) else {
                            continue;
                        };

                        line.slice_axis_mut(Axis(0), self.runs[run].columns())
                            .fill(colour);
                    }
                }
            });
    }

    fn runs_of(&self, row: usize) -> Range<usize> {
        self.rows[row]..self.rows[row + 1]
    }
}

/// Numbers the components by their first run and counts their voxels.
fn number(runs: &[Run], parents: &mut [u32]) -> (Vec<u32>, Vec<u64>) {
    let mut sizes: Vec<u64> = Vec::new();
    for run in 0..runs.len() {
        let parent = parents[run] as usize;
        // A parent comes before its children, so it already holds its component's number.
        let component = if parent == run {
            sizes.push(0);
            sizes.len() as u32 - 1
        } else {
            parents[parent]
        };
        parents[run] = component;
        sizes[component as usize] += u64::from(runs[run].end - runs[run].start);
    }
    (parents.to_vec(), sizes)
}
