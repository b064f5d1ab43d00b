//! Slices of a volume as plain rows of values.

use bonemesh_volume::{Volume, Voxels};
use ndarray::Axis;

/// The values of one slice, row after row.
pub(crate) fn slice_hu(volume: &Volume, slice: usize) -> Vec<f32> {
    match volume.voxels() {
        Voxels::I16(hu) => {
            let values = hu.index_axis(Axis(0), slice);
            values.iter().map(|v| f32::from(*v)).collect()
        }
        Voxels::F32(hu) => hu.index_axis(Axis(0), slice).iter().copied().collect(),
    }
}
