//! How a phantom is scanned.

use bonemesh_volume::{Affine, Geometry};

use crate::vector::{Vec3, add, scale, sub};
use crate::{Orientation, PhantomError};

/// Voxels of more than that do not fit the memory of usual computers.
const MOST_VOXELS: f64 = 2e9;

/// Grid, blur and noise of a scan.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanSettings {
    /// Columns of a slice.
    pub columns: usize,
    /// Rows of a slice.
    pub rows: usize,
    /// Slices.
    pub slices: usize,
    /// Distance between columns and between rows, in mm.
    pub pixel_mm: [f64; 2],
    /// Step from slice to slice along the slice direction, and slice thickness, in mm.
    pub slice_mm: f64,
    /// Patient position (LPS, mm) of the middle of the grid.
    pub centre_mm: [f64; 3],
    /// Directions of the grid.
    pub orientation: Orientation,
    /// Standard deviation of the Gaussian point-spread function in the slice, in pixels.
    pub psf_px: f64,
    /// Standard deviation of the noise, in HU.
    pub noise_hu: f64,
    /// Seed of the noise.
    pub seed: u64,
}

impl ScanSettings {
    /// The same field of view with pixels and slices `factor` times as long.
    #[must_use]
    pub fn coarser(&self, factor: f64) -> Self {
        let fewer = |n: usize| ((n as f64 / factor).round() as usize).max(1);
        Self {
            columns: fewer(self.columns),
            rows: fewer(self.rows),
            slices: fewer(self.slices),
            pixel_mm: self.pixel_mm.map(|p| p * factor),
            slice_mm: self.slice_mm * factor,
            ..self.clone()
        }
    }

    /// The same field of view, up to a voxel, with pixels of `pixel_mm` and slices of `slice_mm`.
    #[must_use]
    pub fn with_voxels(&self, pixel_mm: f64, slice_mm: f64) -> Self {
        let as_long =
            |n: usize, old: f64, new: f64| ((n as f64 * old / new).ceil() as usize).max(1);
        Self {
            columns: as_long(self.columns, self.pixel_mm[0], pixel_mm),
            rows: as_long(self.rows, self.pixel_mm[1], pixel_mm),
            slices: as_long(self.slices, self.slice_mm, slice_mm),
            pixel_mm: [pixel_mm; 2],
            slice_mm,
            ..self.clone()
        }
    }

    /// The same scan without blur and noise.
    #[must_use]
    pub fn ideal(&self) -> Self {
        Self {
            psf_px: 0.0,
            noise_hu: 0.0,
            ..self.clone()
        }
    }

    /// Grid of voxel centres in the patient.
    ///
    /// # Errors
    /// [`PhantomError::Setting`] for a length, blur or noise that makes no scan,
    /// [`PhantomError::Volume`] for a matrix without voxels.
    pub fn geometry(&self) -> Result<Geometry, PhantomError> {
        self.check()?;
        let o = &self.orientation;
        let steps: [Vec3; 3] = [
            scale(o.column_direction, self.pixel_mm[0]),
            scale(o.row_direction, self.pixel_mm[1]),
            scale(o.slice_direction, self.slice_mm),
        ];
        let half = [self.columns, self.rows, self.slices].map(|n| (n as f64 - 1.0) / 2.0);
        let to_corner = (0..3).fold([0.0; 3], |sum, i| add(sum, scale(steps[i], half[i])));
        let origin = sub(self.centre_mm, to_corner);
        let affine = Affine::from_axes(steps[0], steps[1], steps[2], origin);
        Ok(Geometry::new(
            [self.slices, self.rows, self.columns],
            affine,
        )?)
    }

    fn check(&self) -> Result<(), PhantomError> {
        self.orientation.check()?;
        let lengths = [
            ("pixel_mm", self.pixel_mm[0]),
            ("pixel_mm", self.pixel_mm[1]),
            ("slice_mm", self.slice_mm),
        ];
        for (setting, value) in lengths {
            if !(value > 0.0 && value <= 1000.0) {
                let allowed = "above 0 and at most 1000";
                return Err(PhantomError::Setting {
                    setting,
                    value,
                    allowed,
                });
            }
        }
        for (setting, value, most, allowed) in [
            ("psf_px", self.psf_px, 50.0, "between 0 and 50"),
            ("noise_hu", self.noise_hu, 1000.0, "between 0 and 1000"),
        ] {
            if !(0.0..=most).contains(&value) {
                return Err(PhantomError::Setting {
                    setting,
                    value,
                    allowed,
                });
            }
        }
        let voxels = [self.columns, self.rows, self.slices].map(|n| n as f64);
        let voxels: f64 = voxels.iter().product();
        if voxels > MOST_VOXELS {
            return Err(PhantomError::Setting {
                setting: "number of voxels",
                value: voxels,
                allowed: "at most 2000000000: take larger pixels or thicker slices",
            });
        }
        Ok(())
    }
}
