//! Which tetrahedra are bone.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::field::Field;

/// Tetrahedra labelled between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// Shares of a tetrahedron's corners at the places where it is sampled: the middle, and towards
/// each corner.
const TOWARDS: [f32; 2] = [0.55, 0.15];

/// Whether each cell lies inside for the most part, by the mean of the field's samples in it.
/// `places` are those of the points in voxels but for the last eight, the box of air. The stage
/// is `labels`.
pub(super) fn bone(
    cells: &[[u32; 4]],
    places: &[[f32; 3]],
    field: &Field,
    task: &Task,
) -> Result<Vec<bool>, Cancelled> {
    task.begin("labels", cells.len());
    let mut is_bone = vec![false; cells.len()];
    is_bone
        .par_chunks_mut(STRIDE)
        .zip(cells.par_chunks(STRIDE))
        .try_for_each(|(is_bone, cells)| {
            task.advance(cells.len())?;
            for (is_bone, cell) in is_bone.iter_mut().zip(cells) {
                let is_of_places = cell.iter().all(|&v| (v as usize) < places.len());
                *is_bone = is_of_places && depth(cell.map(|v| places[v as usize]), field) > 0.0;
            }
            Ok(())
        })?;
    Ok(is_bone)
}

/// The mean of the field in a cell.
fn depth(corners: [[f32; 3]; 4], field: &Field) -> f32 {
    let [near, far] = TOWARDS;
    let sum: [f32; 3] = std::array::from_fn(|axis| corners.iter().map(|c| c[axis]).sum());
    let middle = field.between(sum.map(|s| 0.25 * s));
    let towards = |corner: &[f32; 3]| {
        let place = std::array::from_fn(|axis| far * sum[axis] + (near - far) * corner[axis]);
        field.between(place)
    };
    middle + corners.iter().map(towards).sum::<f32>()
}
