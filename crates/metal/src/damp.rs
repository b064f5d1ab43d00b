//! All slices with metal, damped one by one.

use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::{Volume, Voxels};
use rayon::prelude::*;

use crate::find::stored_from_ordered;
use crate::project::Grid;
use crate::reduce::correction;
use crate::slice::slice_hu;
use crate::{Metal, MetalError};

/// Smaller changes (HU) are none.
const LEAST_HU: f32 = 0.5;
/// Nothing is darker than where scales of 12 bits begin, as air is stored.
const DARKEST_HU: f32 = -1024.0;

/// The `volume` with the streaks of its `metal` damped; the metal itself stays.
///
/// Slices without metal are the same to the last bit, and so is what differs by less than half a
/// unit in the others. The stage is `damp metal`.
///
/// # Errors
/// [`MetalError::OtherVolume`], [`MetalError::Cancelled`].
pub fn damp_metal(volume: &Volume, metal: &Metal, task: &Task) -> Result<Volume, MetalError> {
    if volume.geometry() != &metal.geometry {
        return Err(MetalError::OtherVolume);
    }
    let ordered = volume.in_patient_order(task)?;
    let [_, rows, columns] = ordered.geometry().shape();
    let [dx, dy, _] = ordered.geometry().spacing_mm();
    let grid = Grid {
        rows,
        columns,
        step_mm: [dx, dy],
    };
    task.begin("damp metal", metal.voxels.len());
    let changes = metal
        .voxels
        .par_iter()
        .map(|(slice, pixels)| {
            let mut is_metal = vec![false; rows * columns];
            for [row, column] in pixels {
                is_metal[row * columns + column] = true;
            }
            let hu = slice_hu(&ordered, *slice);
            let change = correction(&hu, &is_metal, grid, task)?;
            task.advance(1)?;
            Ok((*slice, change))
        })
        .collect::<Result<Vec<_>, Cancelled>>()?;
    let back = stored_from_ordered(ordered.geometry(), volume.geometry());
    let (mut voxels, geometry) = volume.clone().into_parts();
    for (slice, change) in changes {
        task.check()?;
        let changed = change.into_iter().enumerate();
        for (pixel, change) in changed.filter(|(_, change)| change.abs() >= LEAST_HU) {
            let at = back([slice, pixel / columns, pixel % columns]);
            match &mut voxels {
                Voxels::I16(hu) => hu[at] = damped(f32::from(hu[at]), change).round() as i16,
                Voxels::F32(hu) => hu[at] = damped(hu[at], change),
            }
        }
    }
    Ok(Volume::new(voxels, geometry)?)
}

fn damped(hu: f32, change: f32) -> f32 {
    (hu + change).max(hu.min(DARKEST_HU))
}
