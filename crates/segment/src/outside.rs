//! The air around whatever was scanned.

use std::ops::Range;

use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::{Volume, Voxels};
use ndarray::parallel::prelude::*;
use ndarray::{Array2, Array3, ArrayView2, Axis};

use crate::Mask;

/// Air and foam are below this, soft tissue (fat from -120 HU) and plastics above.
const AIR_HU: f32 = -400.0;

/// The air around the patient and the scanner's table: what can be reached from the border of a
/// slice through air, without leaving the slice.
///
/// Air in the body (sinuses, bowel, bronchi) is not part of it, but for the slices in which an
/// airway opens to the outside. Foam counts as air.
///
/// # Errors
/// [`Cancelled`]
pub fn outside_air(volume: &Volume, task: &Task) -> Result<Mask, Cancelled> {
    let voxels = match volume.voxels() {
        Voxels::I16(hu) => each_slice(hu, task)?,
        Voxels::F32(hu) => each_slice(hu, task)?,
    };
    Ok(Mask {
        voxels,
        geometry: volume.geometry().clone(),
    })
}

fn each_slice<T: Copy + Sync + Into<f32>>(
    hu: &Array3<T>,
    task: &Task,
) -> Result<Array3<bool>, Cancelled> {
    let mut outside = Array3::from_elem(hu.dim(), false);
    outside
        .axis_iter_mut(Axis(0))
        .into_par_iter()
        .zip(hu.axis_iter(Axis(0)))
        .try_for_each(|(mut outside, hu)| {
            task.check()?;
            outside.assign(&reached(&hu));
            Ok(())
        })?;
    Ok(outside)
}

/// What air reaches from the border of a slice: runs of air in rows, joined where they touch.
fn reached<T: Copy + Into<f32>>(hu: &ArrayView2<'_, T>) -> Array2<bool> {
    let (rows, columns) = hu.dim();
    let mut runs = Runs::default();
    let mut above = 0..0;
    for (row, values) in hu.rows().into_iter().enumerate() {
        let first = runs.known.len();
        let mut start = None;
        for (column, &value) in values.iter().enumerate() {
            let is_air = value.into() < AIR_HU;
            match start {
                None if is_air => start = Some(column),
                Some(from) if !is_air => {
                    runs.add(row, from..column);
                    start = None;
                }
                _ => {}
            }
        }
        if let Some(from) = start {
            runs.add(row, from..columns);
        }
        let here = first..runs.known.len();
        runs.join_touching(above, here.clone());
        above = here;
    }
    let is_outermost = |(row, run): &(usize, Range<usize>)| {
        *row == 0 || *row + 1 == rows || run.start == 0 || run.end == columns
    };
    let mut is_outside = vec![false; runs.known.len()];
    for number in 0..runs.known.len() {
        let set = runs.set(number);
        is_outside[set] |= is_outermost(&runs.known[number]);
    }
    let mut reached = Array2::from_elem((rows, columns), false);
    for number in 0..runs.known.len() {
        if is_outside[runs.set(number)] {
            let (row, run) = runs.known[number].clone();
            let pixels = run.map(|column| [row, column]);
            pixels.for_each(|at| reached[at] = true);
        }
    }
    reached
}

/// Runs of air, each in a row, and sets of those that touch.
#[derive(Default)]
struct Runs {
    known: Vec<(usize, Range<usize>)>,
    /// An earlier run of the same set, or the run itself.
    earlier: Vec<usize>,
}

impl Runs {
    fn add(&mut self, row: usize, run: Range<usize>) {
        self.earlier.push(self.known.len());
        self.known.push((row, run));
    }

    /// The first run of a run's set.
    fn set(&mut self, mut run: usize) -> usize {
        while self.earlier[run] != run {
            self.earlier[run] = self.earlier[self.earlier[run]];
            run = self.earlier[run];
        }
        run
    }

    /// Joins the runs of two neighbouring rows.
    fn join_touching(&mut self, mut above: Range<usize>, mut below: Range<usize>) {
        while !above.is_empty() && !below.is_empty() {
            let [a, b] = [above.start, below.start].map(|run| self.known[run].1.clone());
            if a.start < b.end && b.start < a.end {
                let [x, y] = [self.set(above.start), self.set(below.start)];
                self.earlier[x.max(y)] = x.min(y);
            }
            if a.end <= b.end {
                above.start += 1;
            } else {
                below.start += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bonemesh_volume::{Affine, Geometry};

    #[test]
    fn air_within_a_body_is_not_outside() {
        // A ring of tissue, open to the outside in the second slice only.
        let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        let hu = Array3::from_shape_fn((2, 9, 9), |(slice, row, column)| {
            let ring = row.abs_diff(4).max(column.abs_diff(4)) == 2;
            let is_open = slice == 1 && row == 4 && column == 6;
            if ring && !is_open { 40_i16 } else { -1000 }
        });
        let geometry = Geometry::new([2, 9, 9], affine).unwrap();
        let volume = Volume::new(Voxels::I16(hu), geometry).unwrap();
        let outside = outside_air(&volume, &Task::default()).unwrap();
        assert!(outside.voxels[[0, 0, 0]] && outside.voxels[[0, 8, 4]]);
        assert!(!outside.voxels[[0, 4, 4]] && !outside.voxels[[0, 4, 6]]);
        assert!(outside.voxels[[1, 4, 4]] && outside.voxels[[1, 4, 6]]);
        assert!(!outside.voxels[[1, 4, 2]]);
    }
}
