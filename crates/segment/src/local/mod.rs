//! A threshold of its own for every voxel, from the values around it.
//!
//! 1. `windows`: mean and spread of the values around each voxel;
//! 2. `LocalThreshold::at`: the voxel's threshold.
//!
//! Sources: J. Bernsen, "Dynamic thresholding of grey-level images", ICPR 1986, for a threshold
//! that only holds where there is contrast; J. H. Waarsing, J. S. Day, H. Weinans, "An improved
//! segmentation method for in vivo `µCT` imaging", Journal of Bone and Mineral Research 19(10),
//! 2004, for local thresholds on bone.

mod windows;

use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};

use crate::{HuThreshold, Mask, SegmentError};
use windows::{Around, Counted, over_windows};

/// How a voxel's own threshold is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalThreshold {
    around: HuThreshold,
    leeway_hu: f64,
    window_mm: f64,
    contrast_hu: f64,
}

/// Usual side of the window: a few times the thickness of thin bone.
const WINDOW_MM: f64 = 10.0;
/// Usual leeway: half of what lies between soft tissue and the published 350 HU.
const LEEWAY_HU: f64 = 150.0;
/// Usual contrast: above noise, below an edge of thin bone.
const CONTRAST_HU: f64 = 60.0;

/// Longest half of a window, in voxels; sums of more could overflow.
const MAX_RADIUS: usize = 127;

impl LocalThreshold {
    /// The usual window (10 mm), leeway (150 HU) and contrast (60 HU) around a global threshold.
    pub fn around(threshold: HuThreshold) -> Self {
        Self {
            around: threshold,
            leeway_hu: LEEWAY_HU,
            window_mm: WINDOW_MM,
            contrast_hu: CONTRAST_HU,
        }
    }

    /// The window's side in mm: a box of voxels, one voxel at least, 255 at most each way.
    ///
    /// # Errors
    /// [`SegmentError::Window`] unless it is a number above 0.
    pub fn with_window_mm(self, window_mm: f64) -> Result<Self, SegmentError> {
        if window_mm > 0.0 && window_mm.is_finite() {
            Ok(Self { window_mm, ..self })
        } else {
            Err(SegmentError::Window(window_mm))
        }
    }

    /// How far a voxel's threshold may lie from the global one.
    ///
    /// # Errors
    /// [`SegmentError::Local`] unless it is a number from 0 to 1000, what lies between soft tissue and
    /// dense bone.
    pub fn with_leeway_hu(self, leeway_hu: f64) -> Result<Self, SegmentError> {
        let leeway_hu = SegmentError::local("leeway", leeway_hu)?;
        Ok(Self { leeway_hu, ..self })
    }

    /// The standard deviation in its window from which a voxel's threshold may lie elsewhere.
    ///
    /// # Errors
    /// [`SegmentError::Local`] unless it is a number from 0 to 1000.
    pub fn with_contrast_hu(self, contrast_hu: f64) -> Result<Self, SegmentError> {
        let contrast_hu = SegmentError::local("contrast", contrast_hu)?;
        Ok(Self {
            contrast_hu,
            ..self
        })
    }

    /// The threshold of a voxel (HU) with this around it.
    fn at(&self, Around { mean, variance }: Around) -> f64 {
        let around = self.around.hu();
        if variance >= self.contrast_hu * self.contrast_hu {
            mean.max(around - self.leeway_hu)
                .min(around + self.leeway_hu)
        } else {
            around
        }
    }

    /// Half of the window's sides in voxels, along slices, rows and columns.
    fn radius(&self, volume: &Volume) -> [usize; 3] {
        let [x, y, z] = volume.geometry().spacing_mm();
        [z, y, x].map(|step| {
            let voxels = self.window_mm / (2.0 * step);
            (voxels.round().min(MAX_RADIUS as f64)) as usize
        })
    }
}

/// Bone by a threshold that follows the mean around each voxel, within the leeway, where there is
/// contrast, and is the global one elsewhere.
///
/// Thin bone in soft tissue, whose mean is low, keeps voxels that the global threshold loses;
/// gaps between dense bones, whose mean is high, stay open longer. Near the volume's border the
/// window is what is left of it. Values that are no numbers are air.
///
/// Limits: the mask's outline is no longer at one HU; noise is let in where the mean is low, so
/// keep the leeway well above it, or keep the [`largest_component`](crate::largest_component).
///
/// # Errors
/// [`SegmentError::Cancelled`].
pub fn local_threshold(
    volume: &Volume,
    settings: LocalThreshold,
    task: &Task,
) -> Result<Mask, SegmentError> {
    let radius = settings.radius(volume);
    let voxels = match volume.voxels() {
        Voxels::I16(hu) => {
            let is_bone = |hu: i16, around| f64::from(hu) > settings.at(around);
            over_windows(hu, &WHOLE, radius, is_bone, task)
        }
        Voxels::F32(hu) => {
            let is_bone = |hu: f32, around| f64::from(hu) > settings.at(around);
            over_windows(hu, &COUNTED, radius, is_bone, task)
        }
    }?;
    Ok(Mask {
        voxels,
        geometry: volume.geometry().clone(),
    })
}

/// The volume with each value as far above or below the global threshold as it was above or below
/// the voxel's own: what a global threshold makes of it, [`local_threshold`] makes of `volume`, and
/// the surface between voxels of it follows the local one.
///
/// Limits: those of [`local_threshold`]. Whole values stay whole, away from the threshold.
///
/// # Errors
/// [`SegmentError::Cancelled`].
#[expect(
    clippy::missing_panics_doc,
    reason = "there are as many voxels as before"
)]
pub fn level_to_threshold(
    volume: &Volume,
    settings: LocalThreshold,
    task: &Task,
) -> Result<Volume, SegmentError> {
    let radius = settings.radius(volume);
    let global = settings.around.hu();
    let voxels = match volume.voxels() {
        Voxels::I16(hu) => {
            let moved = |hu: i16, around| {
                let above = f64::from(hu) - settings.at(around);
                let away = if above > 0.0 {
                    above.ceil()
                } else {
                    above.floor()
                };
                // A conversion to 16 bits ends at their range.
                (global.floor() + away) as i16
            };
            Voxels::I16(over_windows(hu, &WHOLE, radius, moved, task)?)
        }
        Voxels::F32(hu) => {
            let moved = |hu: f32, around| {
                let above = f64::from(hu) - settings.at(around);
                (global + above) as f32
            };
            Voxels::F32(over_windows(hu, &COUNTED, radius, moved, task)?)
        }
    };
    let level = Volume::new(voxels, volume.geometry().clone());
    Ok(level.expect("as many voxels as before: anything else is a bug"))
}

const WHOLE: Counted<fn(i16) -> i64> = Counted { whole, parts: 1.0 };
const COUNTED: Counted<fn(f32) -> i64> = Counted {
    whole: sixteenths,
    parts: SIXTEENTHS,
};

fn whole(hu: i16) -> i64 {
    i64::from(hu)
}

/// Parts of a HU in which floating-point voxels are counted.
const SIXTEENTHS: f64 = 16.0;

fn sixteenths(hu: f32) -> i64 {
    if hu.is_nan() {
        return -1000 * SIXTEENTHS as i64;
    }
    let range = f64::from(i16::MIN)..=f64::from(i16::MAX);
    (f64::from(hu).clamp(*range.start(), *range.end()) * SIXTEENTHS).round() as i64
}

#[cfg(test)]
mod tests {
    use super::windows::window;
    use super::*;
    use bonemesh_volume::{Affine, Geometry};
    use ndarray::{Array3, Axis, Slice};
    use proptest::prelude::*;

    fn volume(voxels: Voxels, spacing: [f64; 3]) -> Volume {
        let [x, y, z] = spacing;
        let affine = Affine::from_axes([x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z], [0.0; 3]);
        let geometry = Geometry::new(voxels.shape(), affine).unwrap();
        Volume::new(voxels, geometry).unwrap()
    }

    fn settings(hu: f64) -> LocalThreshold {
        LocalThreshold::around(HuThreshold::new(hu).unwrap())
    }

    fn bone(volume: &Volume, settings: LocalThreshold) -> Array3<bool> {
        local_threshold(volume, settings, &Task::default())
            .unwrap()
            .voxels
    }

    /// The same without running sums.
    fn slow(hu: &Array3<i16>, radius: [usize; 3], settings: LocalThreshold) -> Array3<bool> {
        let (slices, rows, columns) = hu.dim();
        Array3::from_shape_fn(hu.raw_dim(), |(k, j, i)| {
            let mut around = hu.view();
            for (axis, (at, n)) in [(k, slices), (j, rows), (i, columns)]
                .into_iter()
                .enumerate()
            {
                around.slice_axis_inplace(Axis(axis), Slice::from(window(at, radius[axis], n)));
            }
            let n = around.len() as f64;
            let mean = around.iter().map(|v| f64::from(*v)).sum::<f64>() / n;
            let square = around.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>() / n;
            let variance = square - mean * mean;
            f64::from(hu[[k, j, i]]) > settings.at(Around { mean, variance })
        })
    }

    #[test]
    fn thin_bone_that_a_global_threshold_loses_is_kept() {
        // A wall of one voxel that the scanner's blur has taken to 280 HU, in soft tissue.
        let hu =
            Array3::from_shape_fn([12, 30, 30], |(_, _, i)| if i == 15 { 280_i16 } else { 40 });
        let volume = volume(Voxels::I16(hu), [1.0; 3]);
        let found = bone(&volume, settings(350.0).with_window_mm(5.0).unwrap());
        assert_eq!(found.iter().filter(|b| **b).count(), 12 * 30);
        assert!(found[[6, 15, 15]]);
        let without = settings(350.0).with_leeway_hu(0.0).unwrap();
        assert!(!bone(&volume, without).iter().any(|b| *b));
    }

    #[test]
    fn flat_ground_has_the_global_threshold() {
        for (hu, is_bone) in [(349, false), (351, true)] {
            let volume = volume(Voxels::I16(Array3::from_elem([4, 5, 6], hu)), [1.0; 3]);
            assert!(bone(&volume, settings(350.0)).iter().all(|b| *b == is_bone));
        }
    }

    #[test]
    fn settings_that_mean_nothing_are_refused() {
        for mm in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(settings(350.0).with_window_mm(mm).is_err());
        }
        assert!(settings(350.0).with_leeway_hu(-1.0).is_err());
        assert!(settings(350.0).with_contrast_hu(f64::NAN).is_err());
    }

    #[test]
    fn values_that_are_no_numbers_are_air() {
        let hu = Array3::from_shape_fn([3, 3, 3], |(_, _, i)| [f32::NAN, f32::INFINITY, 40.0][i]);
        let found = bone(&volume(Voxels::F32(hu), [1.0; 3]), settings(350.0));
        assert!(found.indexed_iter().all(|((_, _, i), b)| *b == (i == 1)));
    }

    proptest! {
        #[test]
        fn running_sums_are_the_sums(
            values in prop::collection::vec(-1024_i16..3072, 600),
            rows in 1_usize..8,
            columns in 1_usize..8,
            radius in prop::array::uniform3(0_usize..6),
        ) {
            let shape = [600 / (rows * columns), rows, columns];
            let used = shape.iter().product();
            let hu = Array3::from_shape_vec(shape, values[..used].to_vec()).unwrap();
            // Spacings that make the window of 20 mm as many voxels wide as is wanted.
            let spacing = radius.map(|r| if r == 0 { 50.0 } else { 10.0 / r as f64 });
            let settings = settings(350.0).with_window_mm(20.0).unwrap();
            let [z, y, x] = spacing;
            let float = Voxels::F32(hu.mapv(f32::from));
            let expected = slow(&hu, radius, settings);
            prop_assert_eq!(&bone(&volume(Voxels::I16(hu.clone()), [x, y, z]), settings), &expected);
            let float = volume(float, [x, y, z]);
            prop_assert_eq!(&bone(&float, settings), &expected);
            let task = Task::default();
            let global = HuThreshold::new(350.0).unwrap();
            for given in [&volume(Voxels::I16(hu), [x, y, z]), &float] {
                let level = level_to_threshold(given, settings, &task).unwrap();
                // All bone or none is refused.
                if let Ok(mask) = crate::threshold(&level, global, &task) {
                    prop_assert_eq!(&mask.voxels, &expected);
                }
            }
        }
    }
}
