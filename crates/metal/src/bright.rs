//! Where a volume is as bright as metal.

use std::ops::Range;

use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::{Volume, Voxels};
use ndarray::parallel::prelude::*;
use ndarray::{Array3, ArrayView1, ArrayView2, Axis};

use crate::METAL_HU;

/// Slices, rows and columns.
pub(crate) type Bounds = [Range<usize>; 3];

/// How many voxels there are from [`METAL_HU`] up.
pub(crate) fn count(volume: &Volume, task: &Task) -> Result<usize, Cancelled> {
    match volume.voxels() {
        Voxels::I16(hu) => count_from(hu, METAL_HU as i16, task),
        Voxels::F32(hu) => count_from(hu, METAL_HU, task),
    }
}

fn count_from<T>(hu: &Array3<T>, least: T, task: &Task) -> Result<usize, Cancelled>
where
    T: Copy + PartialOrd + Send + Sync,
{
    let slices = hu.axis_iter(Axis(0)).into_par_iter().map(|slice| {
        task.check()?;
        let of_row = |row: ArrayView1<'_, T>| row.iter().filter(|v| **v >= least).count();
        Ok(slice.rows().into_iter().map(of_row).sum::<usize>())
    });
    slices.sum()
}

/// The box around all voxels from [`METAL_HU`] up; `None` if there are none.
pub(crate) fn bounds(volume: &Volume, task: &Task) -> Result<Option<Bounds>, Cancelled> {
    match volume.voxels() {
        Voxels::I16(hu) => of_slices(hu, METAL_HU as i16, task),
        Voxels::F32(hu) => of_slices(hu, METAL_HU, task),
    }
}

fn of_slices<T>(hu: &Array3<T>, least: T, task: &Task) -> Result<Option<Bounds>, Cancelled>
where
    T: Copy + PartialOrd + Send + Sync,
{
    let slices: Vec<Option<[Range<usize>; 2]>> = hu
        .axis_iter(Axis(0))
        .into_par_iter()
        .map(|slice| {
            task.check()?;
            Ok(of_slice(&slice, least))
        })
        .collect::<Result<_, Cancelled>>()?;
    let mut found: Option<Bounds> = None;
    for (slice, [rows, columns]) in slices
        .into_iter()
        .enumerate()
        .filter_map(|(k, b)| Some((k, b?)))
    {
        found = Some(match found {
            None => [slice..slice + 1, rows, columns],
            Some([k, j, i]) => [k.start..slice + 1, hull(j, rows), hull(i, columns)],
        });
    }
    Ok(found)
}

fn of_slice<T: Copy + PartialOrd>(hu: &ArrayView2<'_, T>, least: T) -> Option<[Range<usize>; 2]> {
    let mut found: Option<[Range<usize>; 2]> = None;
    for (row, line) in hu.rows().into_iter().enumerate() {
        // Counting all of a row is quicker than stopping at the first.
        if line.iter().filter(|v| **v >= least).count() == 0 {
            continue;
        }
        for (column, _) in line.iter().enumerate().filter(|(_, v)| **v >= least) {
            let here = [row..row + 1, column..column + 1];
            found = Some(match found {
                None => here,
                Some([rows, columns]) => {
                    let [row, column] = here;
                    [hull(rows, row), hull(columns, column)]
                }
            });
        }
    }
    found
}

fn hull(a: Range<usize>, b: Range<usize>) -> Range<usize> {
    a.start.min(b.start)..a.end.max(b.end)
}
