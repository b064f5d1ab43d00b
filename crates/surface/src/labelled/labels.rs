//! How deep tetrahedra lie in the bone, and so which are bone.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::field::Field;

/// Tetrahedra looked at between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// Shares of a tetrahedron's corners at the places where it is sampled besides the middle: towards
/// each corner.
const TOWARDS: [f32; 2] = [0.55, 0.15];
/// Where the middle is this deep, in reaches of the field, nothing else matters.
const DEEP: f32 = 0.3;

/// The mean of the field's samples in each cell, in mm, positive inside. `places` are those of
/// the points in voxels but for the last eight, the box of air. The stage is `labels`.
pub(super) fn depths(
    cells: &[[u32; 4]],
    places: &[[f32; 3]],
    field: &Field,
    task: &Task,
) -> Result<Vec<f32>, Cancelled> {
    task.begin("labels", cells.len());
    let mut depths = vec![0.0; cells.len()];
    depths
        .par_chunks_mut(STRIDE)
        .zip(cells.par_chunks(STRIDE))
        .try_for_each(|(depths, cells)| {
            task.advance(cells.len())?;
            for (found, cell) in depths.iter_mut().zip(cells) {
                let is_of_places = cell.iter().all(|&v| (v as usize) < places.len());
                *found = if is_of_places {
                    depth(cell.map(|v| places[v as usize]), field)
                } else {
                    -field.reach_mm
                };
            }
            Ok(())
        })?;
    Ok(depths)
}

/// The mean of the field in a cell.
fn depth(corners: [[f32; 3]; 4], field: &Field) -> f32 {
    let [near, far] = TOWARDS;
    let sum: [f32; 3] = std::array::from_fn(|axis| corners.iter().map(|c| c[axis]).sum());
    let middle = field.between(sum.map(|s| 0.25 * s));
    if middle.abs() > DEEP * field.reach_mm {
        return middle;
    }
    let towards = |corner: &[f32; 3]| {
        let place = std::array::from_fn(|axis| far * sum[axis] + (near - far) * corner[axis]);
        field.between(place)
    };
    0.2 * (middle + corners.iter().map(towards).sum::<f32>())
}
