//! A threshold of its own for every voxel, from the values around it.
//!
//! 1. `Planes::of_slice`: the sums of the values, and of their squares, over the slices of the
//!    window, for each pixel: a slice enters, another leaves;
//! 2. `Planes::over_rows` and `over_columns`: the same along both directions of the slice, so the
//!    work does not depend on the size of the window;
//! 3. `LocalThreshold::is_bone`: mean and spread of the window give the voxel's threshold.
//!
//! Sums are whole numbers (floating-point voxels are taken in sixteenths of a HU), so where a
//! piece of work begins does not show.
//!
//! Sources: J. Bernsen, "Dynamic thresholding of grey-level images", ICPR 1986, for a threshold
//! that only holds where there is contrast; J. H. Waarsing, J. S. Day, H. Weinans, "An improved
//! segmentation method for in vivo `µCT` imaging", Journal of Bone and Mineral Research 19(10),
//! 2004, for local thresholds on bone.

use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};
use ndarray::parallel::prelude::*;
use ndarray::{Array3, Axis};

use crate::{HuThreshold, Mask, SegmentError};

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

    /// How far a voxel's threshold may lie from the global one, and the standard deviation in
    /// its window from which it may do so.
    ///
    /// # Errors
    /// [`SegmentError::Local`] unless both are numbers from 0.
    pub fn with_leeway_hu(self, leeway_hu: f64, contrast_hu: f64) -> Result<Self, SegmentError> {
        if leeway_hu >= 0.0
            && leeway_hu.is_finite()
            && contrast_hu >= 0.0
            && contrast_hu.is_finite()
        {
            Ok(Self {
                leeway_hu,
                contrast_hu,
                ..self
            })
        } else {
            Err(SegmentError::Local {
                leeway_hu,
                contrast_hu,
            })
        }
    }

    /// Whether a voxel of `hu` is bone, `mean` and `variance` being those of its window.
    fn is_bone(&self, hu: f64, mean: f64, variance: f64) -> bool {
        let around = self.around.hu();
        let threshold = if variance >= self.contrast_hu * self.contrast_hu {
            mean.max(around - self.leeway_hu)
                .min(around + self.leeway_hu)
        } else {
            around
        };
        hu > threshold
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
    let geometry = volume.geometry();
    let [x, y, z] = geometry.spacing_mm();
    let radius = [z, y, x].map(|step| {
        let voxels = settings.window_mm / (2.0 * step);
        (voxels.round().min(MAX_RADIUS as f64)) as usize
    });
    let voxels = match volume.voxels() {
        Voxels::I16(hu) => marked(hu, i64::from, 1.0, radius, settings, task),
        Voxels::F32(hu) => marked(hu, sixteenths, SIXTEENTHS, radius, settings, task),
    }?;
    Ok(Mask {
        voxels,
        geometry: geometry.clone(),
    })
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

/// Slices that are worked on with one set of sums.
const PIECE: usize = 16;

fn marked<T: Copy + Sync>(
    hu: &Array3<T>,
    whole: impl Fn(T) -> i64 + Sync,
    unit: f64,
    radius: [usize; 3],
    settings: LocalThreshold,
    task: &Task,
) -> Result<Array3<bool>, SegmentError> {
    let mut voxels = Array3::from_elem(hu.raw_dim(), false);
    let (slices, rows, columns) = hu.dim();
    task.begin("local threshold", slices);
    voxels
        .axis_chunks_iter_mut(Axis(0), PIECE)
        .into_par_iter()
        .enumerate()
        .try_for_each(|(piece, mut voxels)| -> Result<(), SegmentError> {
            let mut sums = Sums::new(rows, columns);
            let first = piece * PIECE;
            let mut held = first.saturating_sub(radius[0])..first.saturating_sub(radius[0]);
            for (slice, mut bone) in (first..).zip(voxels.outer_iter_mut()) {
                let window = window(slice, radius[0], slices);
                while held.start < window.start {
                    sums.add(
                        hu.index_axis(Axis(0), held.start).iter().map(|v| whole(*v)),
                        -1,
                    );
                    held.start += 1;
                }
                while held.end < window.end {
                    task.check()?;
                    sums.add(
                        hu.index_axis(Axis(0), held.end).iter().map(|v| whole(*v)),
                        1,
                    );
                    held.end += 1;
                }
                sums.over_rows(radius[1]);
                for (row, (mut bone, hu)) in bone
                    .outer_iter_mut()
                    .zip(hu.index_axis(Axis(0), slice).outer_iter())
                    .enumerate()
                {
                    let rows = window_len(row, radius[1], rows) * window.len();
                    sums.over_columns(row, radius[2], rows, unit);
                    let around = sums.mean.iter().zip(&sums.variance);
                    for ((bone, hu), (mean, variance)) in bone.iter_mut().zip(hu).zip(around) {
                        let hu = whole(*hu) as f64 / unit;
                        *bone = settings.is_bone(hu, *mean, *variance);
                    }
                }
                task.advance(1)?;
            }
            Ok(())
        })?;
    Ok(voxels)
}

/// What is left inside `0..n` of the window around `at`.
fn window(at: usize, radius: usize, n: usize) -> std::ops::Range<usize> {
    at.saturating_sub(radius)..(at + radius + 1).min(n)
}

fn window_len(at: usize, radius: usize, n: usize) -> usize {
    window(at, radius, n).len()
}

/// Running sums of the values and of their squares.
struct Sums {
    rows: usize,
    columns: usize,
    /// Over the slices of the window.
    slices: Vec<[i64; 2]>,
    /// Over its slices and rows.
    boxes: Vec<[i64; 2]>,
    mean: Vec<f64>,
    variance: Vec<f64>,
}

impl Sums {
    fn new(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            slices: vec![[0; 2]; rows * columns],
            boxes: vec![[0; 2]; rows * columns],
            mean: vec![0.0; columns],
            variance: vec![0.0; columns],
        }
    }

    /// Adds a slice to the sums, or with `sign` -1 takes it away.
    fn add(&mut self, values: impl Iterator<Item = i64>, sign: i64) {
        for (sums, value) in self.slices.iter_mut().zip(values) {
            sums[0] += sign * value;
            sums[1] += sign * value * value;
        }
    }

    /// Sums over rows too.
    fn over_rows(&mut self, radius: usize) {
        let columns = self.columns;
        let line = |row: usize| row * columns..(row + 1) * columns;
        let mut running = vec![[0_i64; 2]; columns];
        let mut held = 0..0;
        for row in 0..self.rows {
            let window = window(row, radius, self.rows);
            for entering in held.end..window.end {
                plus(&mut running, &self.slices[line(entering)], 1);
            }
            for leaving in held.start..window.start {
                plus(&mut running, &self.slices[line(leaving)], -1);
            }
            held = window;
            self.boxes[line(row)].copy_from_slice(&running);
        }
    }

    /// Mean and variance in the windows of one row, `lines` of which lie above one another.
    fn over_columns(&mut self, row: usize, radius: usize, lines: usize, unit: f64) {
        let boxes = &self.boxes[row * self.columns..(row + 1) * self.columns];
        let (mut running, mut held) = ([0_i64; 2], 0..0);
        for column in 0..self.columns {
            let window = window(column, radius, self.columns);
            for entering in &boxes[held.end..window.end] {
                running = [0, 1].map(|s| running[s] + entering[s]);
            }
            for leaving in &boxes[held.start..window.start] {
                running = [0, 1].map(|s| running[s] - leaving[s]);
            }
            let voxels = (lines * window.len()) as f64;
            held = window;
            let mean = running[0] as f64 / voxels;
            let variance = (running[1] as f64 / voxels - mean * mean).max(0.0);
            self.mean[column] = mean / unit;
            self.variance[column] = variance / (unit * unit);
        }
    }
}

fn plus(sums: &mut [[i64; 2]], line: &[[i64; 2]], sign: i64) {
    for (sum, value) in sums.iter_mut().zip(line) {
        sum[0] += sign * value[0];
        sum[1] += sign * value[1];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bonemesh_volume::{Affine, Geometry};
    use ndarray::Slice;
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
            settings.is_bone(f64::from(hu[[k, j, i]]), mean, square - mean * mean)
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
        let without = settings(350.0).with_leeway_hu(0.0, 60.0).unwrap();
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
        assert!(settings(350.0).with_leeway_hu(-1.0, 0.0).is_err());
        assert!(settings(350.0).with_leeway_hu(1.0, f64::NAN).is_err());
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
            prop_assert_eq!(&bone(&volume(Voxels::I16(hu), [x, y, z]), settings), &expected);
            prop_assert_eq!(&bone(&volume(float, [x, y, z]), settings), &expected);
        }
    }
}
