//! Bone by a global threshold.

use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};
use ndarray::parallel::prelude::*;
use ndarray::{Array3, ArrayView2, ArrayViewMut2, Axis, Zip};

use crate::{Mask, SegmentError};

/// No scan holds larger values, whatever its unit: pixels have 32 bits at most.
const MOST_HU: f64 = 1e10;

/// A finite bone threshold in Hounsfield units; bone is strictly above it.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct HuThreshold(f64);

impl HuThreshold {
    /// Checks the value.
    ///
    /// # Errors
    /// [`SegmentError::Threshold`] for NaN, infinities and what no scan holds.
    pub fn new(hu: f64) -> Result<Self, SegmentError> {
        if hu.abs() <= MOST_HU {
            Ok(Self(hu))
        } else {
            Err(SegmentError::Threshold(hu))
        }
    }

    /// The threshold in HU.
    pub fn hu(self) -> f64 {
        self.0
    }
}

/// Bone = HU strictly above the threshold; NaN is not bone.
///
/// # Errors
/// [`SegmentError::NothingAbove`] and [`SegmentError::NothingBelow`] when the mask would be all
/// of one kind, [`SegmentError::Cancelled`].
pub fn threshold(
    volume: &Volume,
    threshold: HuThreshold,
    task: &Task,
) -> Result<Mask, SegmentError> {
    let (voxels, bone) = match volume.voxels() {
        Voxels::I16(hu) => {
            // A whole number is above t exactly when it is above floor(t); comparing 16-bit
            // values with one another is several times faster than converting each.
            let limit = threshold.hu().floor();
            if limit < f64::from(i16::MIN) {
                mark(hu, |_| true, task)?
            } else if limit >= f64::from(i16::MAX) {
                mark(hu, |_| false, task)?
            } else {
                let limit = limit as i16;
                mark(hu, move |v| v > limit, task)?
            }
        }
        Voxels::F32(hu) => mark(hu, |v: f32| f64::from(v) > threshold.hu(), task)?,
    };
    if bone == 0 || bone == voxels.len() {
        let (lowest_hu, highest_hu) = volume.hu_range();
        let threshold_hu = threshold.hu();
        return Err(if bone == 0 {
            SegmentError::NothingAbove {
                threshold_hu,
                lowest_hu,
                highest_hu,
            }
        } else {
            SegmentError::NothingBelow {
                threshold_hu,
                lowest_hu,
                highest_hu,
            }
        });
    }
    Ok(Mask {
        voxels,
        geometry: volume.geometry().clone(),
    })
}

/// The mask of `is_bone`, slice by slice in parallel, and how many voxels it holds.
fn mark<T: Copy + Sync>(
    hu: &Array3<T>,
    is_bone: impl Fn(T) -> bool + Sync,
    task: &Task,
) -> Result<(Array3<bool>, usize), SegmentError> {
    let mut voxels = Array3::from_elem(hu.raw_dim(), false);
    task.begin("threshold", hu.dim().0);
    let bone = Zip::from(voxels.axis_iter_mut(Axis(0)))
        .and(hu.axis_iter(Axis(0)))
        .into_par_iter()
        .map(|(bone, hu)| {
            task.check()?;
            let count = mark_slice(bone, &hu, &is_bone);
            task.advance(1)?;
            Ok(count)
        })
        .try_reduce(|| 0, |a, b| Ok(a + b))
        .map_err(SegmentError::Cancelled)?;
    Ok((voxels, bone))
}

/// Marks one slice and counts its bone voxels.
fn mark_slice<T: Copy>(
    mut bone: ArrayViewMut2<'_, bool>,
    hu: &ArrayView2<'_, T>,
    is_bone: &impl Fn(T) -> bool,
) -> usize {
    Zip::from(&mut bone)
        .and(hu)
        .for_each(|bone, hu| *bone = is_bone(*hu));
    bone.rows()
        .into_iter()
        .map(|row| row.iter().map(|b| u32::from(*b)).sum::<u32>() as usize)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bonemesh_volume::{Affine, Geometry};
    use ndarray::Array3;

    fn volume(voxels: Voxels) -> Volume {
        let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        let geometry = Geometry::new(voxels.shape(), affine).unwrap();
        Volume::new(voxels, geometry).unwrap()
    }

    fn bone_at(voxels: Voxels, hu: f64) -> Result<Mask, SegmentError> {
        threshold(
            &volume(voxels),
            HuThreshold::new(hu).unwrap(),
            &Task::default(),
        )
    }

    fn whole(values: &[i16]) -> Voxels {
        Voxels::I16(Array3::from_shape_vec([1, 1, values.len()], values.to_vec()).unwrap())
    }

    #[test]
    fn bone_is_strictly_above_the_threshold() {
        let mask = bone_at(whole(&[349, 350, 351]), 350.0).unwrap();
        assert_eq!(mask.voxels.as_slice().unwrap(), [false, false, true]);
    }

    #[test]
    fn whole_and_floating_volumes_agree_at_any_threshold() {
        let values = [i16::MIN, -1025, -1024, -1, 0, 1, 349, 350, 3071, i16::MAX];
        let float = Voxels::F32(Array3::from_shape_fn([1, 1, values.len()], |(_, _, i)| {
            f32::from(values[i])
        }));
        for hu in [
            -32768.0, -1024.5, -1024.0, -0.5, 0.0, 0.3, 350.0, 3071.0, 32766.9,
        ] {
            assert_eq!(
                bone_at(whole(&values), hu).unwrap(),
                bone_at(float.clone(), hu).unwrap(),
                "{hu}"
            );
        }
    }

    #[test]
    fn a_threshold_above_everything_names_the_range() {
        for hu in [900.0, 1e9] {
            let message = bone_at(whole(&[-1000, 900]), hu).unwrap_err().to_string();
            assert!(message.contains("-1000 to 900 HU"), "{message}");
            assert!(message.contains("below 900"), "{message}");
        }
    }

    #[test]
    fn a_threshold_below_everything_names_the_range() {
        for hu in [-1001.0, -1e9] {
            let error = bone_at(whole(&[-1000, 900]), hu).unwrap_err();
            assert!(matches!(error, SegmentError::NothingBelow { .. }));
            assert!(error.to_string().contains("at least -1000"), "{error}");
        }
    }

    #[test]
    fn a_threshold_that_is_no_number_is_refused() {
        for hu in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(HuThreshold::new(hu).is_err());
        }
    }

    #[test]
    fn cancelling_stops_the_threshold() {
        let task = Task::default();
        task.cancel().cancel();
        let result = threshold(
            &volume(whole(&[0, 1])),
            HuThreshold::new(0.0).unwrap(),
            &task,
        );
        assert!(matches!(result, Err(SegmentError::Cancelled(_))));
    }
}
