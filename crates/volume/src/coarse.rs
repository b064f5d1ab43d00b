//! A volume of fewer, larger voxels, in which thin bone stays.
//!
//! Blocks of voxels become one. Their mean would lose a wall that crosses them, and their brightest
//! value would take noise for bone; so the mean of the brightest quarter counts. A wall a quarter of
//! a block thick keeps its grey, and noise is raised by 1.3 standard deviations. What is bone grows by
//! up to half a block on each side: a coarse volume is to be looked at, not measured.

use std::num::NonZeroUsize;

use bonemesh_task::{Cancelled, Task};
use ndarray::parallel::prelude::*;
use ndarray::{Array3, Axis, s};

use crate::{Affine, Geometry, Volume, Voxels};

/// Of how many voxels of a block one counts.
const COUNTED: usize = 4;

/// How much longer blocks are made at a time, until they are few enough.
const LONGER: f64 = 1.02;

impl Geometry {
    /// How many columns, rows and slices to take together so that at most `most` blocks are left, as
    /// nearly cubes in the patient as whole numbers of voxels allow.
    pub fn block_for(&self, most: NonZeroUsize) -> [NonZeroUsize; 3] {
        let [slices, rows, columns] = self.shape();
        let shape = [columns, rows, slices];
        let spacing = self.patient_from_voxel().spacing();
        let block = |side_mm: f64| -> [NonZeroUsize; 3] {
            std::array::from_fn(|axis| {
                let voxels = (side_mm / spacing[axis]).round() as usize;
                NonZeroUsize::new(voxels.min(shape[axis])).unwrap_or(NonZeroUsize::MIN)
            })
        };
        let blocks = |block: [NonZeroUsize; 3]| -> usize {
            let sides = shape.iter().zip(block);
            sides.map(|(n, b)| n.div_ceil(b.get())).product()
        };
        let mut side_mm = spacing.into_iter().fold(f64::INFINITY, f64::min);
        while blocks(block(side_mm)) > most.get() {
            side_mm *= LONGER;
        }
        block(side_mm)
    }

    /// The grid of blocks of so many columns, rows and slices; those at the end may be smaller.
    fn coarsened(&self, block: [NonZeroUsize; 3]) -> Self {
        let [i, j, k] = block.map(|b| b.get() as f64);
        let fine = self.patient_from_voxel();
        let axis = |axis: usize, by: f64| fine.axis(axis).map(|c| c * by);
        // The middle of a block lies between its first and its last voxel.
        let middle = fine.apply([(i - 1.0) / 2.0, (j - 1.0) / 2.0, (k - 1.0) / 2.0]);
        let coarse = Affine::from_axes(axis(0, i), axis(1, j), axis(2, k), middle);
        let [slices, rows, columns] = self.shape();
        let shape = [
            slices.div_ceil(block[2].get()),
            rows.div_ceil(block[1].get()),
            columns.div_ceil(block[0].get()),
        ];
        Self::new(shape, coarse).expect("blocks of a sound grid are one; otherwise this is a bug")
    }
}

impl Volume {
    /// The volume of blocks of so many columns, rows and slices, each with the mean of its brightest
    /// quarter. The stage is `coarsening`.
    ///
    /// Values that are no numbers count only where a block has no others.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn coarsened(&self, block: [NonZeroUsize; 3], task: &Task) -> Result<Self, Cancelled> {
        let geometry = self.geometry.coarsened(block);
        let voxels = match &self.voxels {
            Voxels::I16(hu) => Voxels::I16(coarsened(hu, block, of_whole, task)?),
            Voxels::F32(hu) => Voxels::F32(coarsened(hu, block, of_fractional, task)?),
        };
        Ok(Self { voxels, geometry })
    }
}

fn coarsened<T>(
    hu: &Array3<T>,
    block: [NonZeroUsize; 3],
    value: impl Fn(&mut [T]) -> T + Sync,
    task: &Task,
) -> Result<Array3<T>, Cancelled>
where
    T: Copy + Default + Send + Sync,
{
    let [columns, rows, slices] = block.map(NonZeroUsize::get);
    let (all_slices, all_rows, all_columns) = hu.dim();
    let shape = (
        all_slices.div_ceil(slices),
        all_rows.div_ceil(rows),
        all_columns.div_ceil(columns),
    );
    let mut coarse = Array3::from_elem(shape, T::default());
    task.begin("coarsening", shape.0);
    coarse
        .axis_iter_mut(Axis(0))
        .into_par_iter()
        .zip(hu.axis_chunks_iter(Axis(0), slices))
        .try_for_each(|(mut coarse, hu)| {
            let mut members = Vec::with_capacity(columns * rows * slices);
            for (j, mut coarse) in coarse.outer_iter_mut().enumerate() {
                task.check()?;
                let end = ((j + 1) * rows).min(all_rows);
                let hu = hu.slice(s![.., j * rows..end, ..]);
                for (value_of, hu) in coarse.iter_mut().zip(hu.axis_chunks_iter(Axis(2), columns)) {
                    members.clear();
                    members.extend(hu.iter().copied());
                    *value_of = value(&mut members);
                }
            }
            task.advance(1)
        })?;
    Ok(coarse)
}

/// The mean of the brightest quarter, rounded.
fn of_whole(members: &mut [i16]) -> i16 {
    let brightest = brightest(members, i16::cmp);
    let sum: i64 = brightest.iter().map(|v| i64::from(*v)).sum();
    (sum as f64 / brightest.len() as f64).round() as i16
}

fn of_fractional(members: &mut [f32]) -> f32 {
    // What is no number goes behind, and does not count.
    members.sort_unstable_by_key(|value| value.is_nan());
    let numbers = members.iter().take_while(|v| !v.is_nan()).count();
    if numbers == 0 {
        return f32::NAN;
    }
    let brightest = brightest(&mut members[..numbers], f32::total_cmp);
    let sum: f64 = brightest.iter().map(|v| f64::from(*v)).sum();
    (sum / brightest.len() as f64) as f32
}

/// The brightest quarter, at least one, in any order.
fn brightest<T>(members: &mut [T], order: impl Fn(&T, &T) -> std::cmp::Ordering) -> &[T] {
    let first = members.len() - members.len().div_ceil(COUNTED);
    members.select_nth_unstable_by(first, order);
    &members[first..]
}

#[cfg(test)]
#[allow(
    clippy::float_cmp,
    reason = "the numbers are chosen so that no step rounds"
)]
mod tests {
    use super::*;

    fn block(sides: [usize; 3]) -> [NonZeroUsize; 3] {
        sides.map(|n| NonZeroUsize::new(n).unwrap())
    }

    fn volume<T>(voxels: impl Fn(Array3<T>) -> Voxels, hu: Array3<T>) -> Volume {
        let (slices, rows, columns) = hu.dim();
        let affine = Affine::from_axes(
            [0.0, 0.5, 0.0],
            [0.25, 0.0, 0.0],
            [0.0, 0.1, 2.0],
            [1.0, 2.0, 3.0],
        );
        let geometry = Geometry::new([slices, rows, columns], affine).unwrap();
        Volume::new(voxels(hu), geometry).unwrap()
    }

    fn whole(volume: &Volume) -> &Array3<i16> {
        let Voxels::I16(hu) = volume.voxels() else {
            unreachable!()
        };
        hu
    }

    #[test]
    fn a_wall_of_one_voxel_keeps_its_grey_and_a_lone_bright_voxel_does_not() {
        let wall = Array3::from_shape_fn([4, 8, 8], |(_, j, i)| {
            if j == 2 || (i, j) == (6, 6) {
                900
            } else {
                -900
            }
        });
        let fine = volume(Voxels::I16, wall);
        let coarse = fine.coarsened(block([4, 4, 4]), &Task::default()).unwrap();
        // The upper blocks hold the wall; of the others one has four bright voxels of 64.
        assert_eq!(whole(&coarse).as_slice().unwrap(), [900, 900, -900, -450]);
    }

    #[test]
    fn blocks_of_one_voxel_change_nothing() {
        let hu = Array3::from_shape_fn([3, 4, 5], |(k, j, i)| (100 * k + 10 * j + i) as i16);
        let fine = volume(Voxels::I16, hu);
        let same = fine.coarsened(block([1, 1, 1]), &Task::default()).unwrap();
        assert_eq!(whole(&same), whole(&fine));
        assert_eq!(
            same.geometry().patient_from_voxel(),
            fine.geometry().patient_from_voxel()
        );
    }

    #[test]
    fn a_block_lies_in_the_middle_of_its_voxels_and_the_last_ones_may_be_smaller() {
        let hu = Array3::from_shape_fn([3, 5, 7], |(k, _, _)| k as i16);
        let fine = volume(Voxels::I16, hu);
        let coarse = fine.coarsened(block([3, 2, 2]), &Task::default()).unwrap();
        assert_eq!(coarse.geometry().shape(), [2, 3, 3]);
        assert_eq!(
            coarse
                .geometry()
                .patient_from_voxel()
                .apply([1.0, 2.0, 0.0]),
            fine.geometry().patient_from_voxel().apply([4.0, 4.5, 0.5])
        );
        assert_eq!(whole(&coarse)[[1, 2, 2]], 2);
    }

    #[test]
    fn what_is_no_number_does_not_count() {
        let mut hu = Array3::from_elem([1, 2, 4], 1.5);
        hu[[0, 0, 0]] = f32::NAN;
        hu.slice_mut(s![.., .., 2..]).fill(f32::NAN);
        let fine = volume(Voxels::F32, hu);
        let coarse = fine.coarsened(block([2, 2, 1]), &Task::default()).unwrap();
        let Voxels::F32(hu) = coarse.voxels() else {
            unreachable!()
        };
        assert_eq!(hu[[0, 0, 0]], 1.5);
        assert!(hu[[0, 0, 1]].is_nan());
    }

    #[test]
    fn blocks_are_nearly_cubes_and_few_enough() {
        let affine = Affine::from_axes(
            [0.45, 0.0, 0.0],
            [0.0, 0.45, 0.0],
            [0.0, 0.0, 1.0],
            [0.0; 3],
        );
        let geometry = Geometry::new([140, 512, 512], affine).unwrap();
        let few = NonZeroUsize::new(1_200_000).unwrap();
        assert_eq!(geometry.block_for(few), block([4, 4, 2]));
        let many = NonZeroUsize::new(100_000_000).unwrap();
        assert_eq!(geometry.block_for(many), block([1, 1, 1]));
        assert_eq!(
            geometry.block_for(NonZeroUsize::MIN),
            block([512, 512, 140])
        );
    }

    #[test]
    fn coarsening_stops_on_request() {
        let fine = volume(Voxels::I16, Array3::from_elem([4, 4, 4], 0));
        let task = Task::default();
        task.cancel().cancel();
        assert!(fine.coarsened(block([2, 2, 2]), &task).is_err());
    }
}
