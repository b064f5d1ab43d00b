//! The air around whatever was scanned.

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

/// What air reaches from the border of a slice: a flood over neighbours in rows and columns.
fn reached<T: Copy + Into<f32>>(hu: &ArrayView2<'_, T>) -> Array2<bool> {
    let (rows, columns) = hu.dim();
    let mut reached = Array2::from_elem((rows, columns), false);
    let mut front = Vec::new();
    let mut reach = |at: [usize; 2], front: &mut Vec<[usize; 2]>| {
        if !reached[at] && hu[at].into() < AIR_HU {
            reached[at] = true;
            front.push(at);
        }
    };
    for row in 0..rows {
        for column in 0..columns {
            if row == 0 || column == 0 || row + 1 == rows || column + 1 == columns {
                reach([row, column], &mut front);
            }
        }
    }
    while let Some([row, column]) = front.pop() {
        reach([row.saturating_sub(1), column], &mut front);
        reach([(row + 1).min(rows - 1), column], &mut front);
        reach([row, column.saturating_sub(1)], &mut front);
        reach([row, (column + 1).min(columns - 1)], &mut front);
    }
    reached
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
