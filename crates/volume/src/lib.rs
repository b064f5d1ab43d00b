//! A CT volume in Hounsfield units that knows where in the patient each voxel lies.
//!
//! A [`Volume`] is an array indexed `[slice, row, column]` and a [`Geometry`]: the affine map
//! from voxel indices `(column, row, slice)`, which count voxel *centres*, to the patient frame
//! (DICOM LPS: x to the left, y to the back, z to the head; millimetres).
//!
//! [`Volume::in_patient_order`] turns and flips the axes so that work done slice by slice does not
//! depend on how the voxels were stored.
//!
//! [`Geometry::slice_plane`] and [`Volume::slice`] take axial, coronal and sagittal pictures.
//!
//! [`Histogram`] counts how often each value occurs, padding apart.
//!
//! [`Volume::coarsened`] takes voxels together for a quick look, and keeps thin bone.
//!
//! Limits: slices are parallel and evenly spaced; readers resample what is not. Shear (gantry
//! tilt), oblique planes, unequal spacings and left-handed index orders are all ordinary affines.
//!
//! ```
//! use bonemesh_volume::{Affine, Geometry, Volume, Voxels};
//! use ndarray::Array3;
//!
//! let affine = Affine::from_axes([0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 2.0], [-10.0, -10.0, 5.0]);
//! let geometry = Geometry::new([3, 4, 4], affine)?;
//! let volume = Volume::new(Voxels::I16(Array3::from_elem([3, 4, 4], -1000)), geometry)?;
//! assert_eq!(volume.geometry().patient_from_voxel().apply([2.0, 0.0, 1.0]), [-9.0, -10.0, 7.0]);
//! # Ok::<(), bonemesh_volume::VolumeError>(())
//! ```

mod affine;
mod coarse;
mod crop;
mod geometry;
mod histogram;
mod order;
mod orientation;
mod planes;
mod slice;

pub use affine::Affine;
pub use crop::{CropBox, CropError};
pub use geometry::Geometry;
pub use histogram::Histogram;
use ndarray::{Array3, s};
pub use planes::{Anatomical, SlicePlane};
pub use slice::Window;

/// What is wrong with a volume's parts.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VolumeError {
    /// A side without voxels, or more voxels than an index can count.
    #[error(
        "a volume of {0:?} (slices, rows, columns) voxels cannot be used; every side needs at least one and at most 65535"
    )]
    Size([usize; 3]),
    /// The affine is not finite or flattens space.
    #[error(
        "the voxel-to-patient map is degenerate (determinant {0}); spacing and orientation must be finite and not zero"
    )]
    Degenerate(f64),
    /// Array and geometry disagree.
    #[error(
        "the array has {array:?} (slices, rows, columns) voxels but the geometry says {geometry:?}"
    )]
    Shape {
        /// Shape of the voxel array.
        array: [usize; 3],
        /// Shape that the geometry was made for.
        geometry: [usize; 3],
    },
    /// No window.
    #[error(
        "a window of {width_hu} HU around {centre_hu} HU shows nothing; give a centre and a width above 0"
    )]
    Window {
        /// Its middle.
        centre_hu: f64,
        /// From black to white.
        width_hu: f64,
    },
    /// The crop box leaves nothing.
    #[error(transparent)]
    Crop(#[from] CropError),
}

/// Hounsfield units `[slice, row, column]`: 16-bit where the rescaled values are whole
/// numbers that fit, floating point otherwise.
#[derive(Clone, Debug, PartialEq)]
pub enum Voxels {
    /// Whole Hounsfield units.
    I16(Array3<i16>),
    /// Fractional Hounsfield units, or values beyond 16 bits.
    F32(Array3<f32>),
}

impl Voxels {
    /// Slices, rows, columns.
    pub fn shape(&self) -> [usize; 3] {
        let (k, j, i) = match self {
            Self::I16(a) => a.dim(),
            Self::F32(a) => a.dim(),
        };
        [k, j, i]
    }
}

/// A CT volume: Hounsfield units and their place in the patient.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    voxels: Voxels,
    geometry: Geometry,
}

impl Volume {
    /// Joins voxels and geometry.
    ///
    /// # Errors
    /// [`VolumeError::Shape`] when their shapes differ.
    pub fn new(voxels: Voxels, geometry: Geometry) -> Result<Self, VolumeError> {
        if voxels.shape() != geometry.shape() {
            return Err(VolumeError::Shape {
                array: voxels.shape(),
                geometry: geometry.shape(),
            });
        }
        Ok(Self { voxels, geometry })
    }

    /// Hounsfield units `[slice, row, column]`.
    pub fn voxels(&self) -> &Voxels {
        &self.voxels
    }

    /// Shape and place in the patient.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Hounsfield units and geometry, taken apart.
    pub fn into_parts(self) -> (Voxels, Geometry) {
        (self.voxels, self.geometry)
    }

    /// The voxels inside `crop`, at the same place in the patient.
    ///
    /// # Errors
    /// [`VolumeError::Crop`] when the box leaves nothing or reaches outside.
    pub fn cropped(&self, crop: &CropBox) -> Result<Self, VolumeError> {
        let geometry = self.geometry.cropped(crop)?;
        let window = s![crop.slices.clone(), crop.rows.clone(), crop.columns.clone()];
        let voxels = match &self.voxels {
            Voxels::I16(a) => Voxels::I16(a.slice(window).to_owned()),
            Voxels::F32(a) => Voxels::F32(a.slice(window).to_owned()),
        };
        Self::new(voxels, geometry)
    }

    /// Smallest and largest Hounsfield unit.
    pub fn hu_range(&self) -> (f64, f64) {
        fn range<T: Copy + Into<f64>>(a: &Array3<T>) -> (f64, f64) {
            a.iter()
                .map(|v| (*v).into())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v: f64| {
                    (low.min(v), high.max(v))
                })
        }
        match &self.voxels {
            Voxels::I16(a) => range(a),
            Voxels::F32(a) => range(a),
        }
    }
}

#[cfg(test)]
#[allow(
    clippy::float_cmp,
    reason = "the numbers are chosen so that no step rounds"
)]
mod tests {
    use super::*;

    fn volume() -> Volume {
        let affine = Affine::from_axes(
            [0.0, 0.5, 0.0],
            [0.25, 0.0, 0.0],
            [0.0, 0.1, 2.0],
            [1.0, 2.0, 3.0],
        );
        let geometry = Geometry::new([3, 4, 5], affine).unwrap();
        let voxels = Array3::from_shape_fn([3, 4, 5], |(k, j, i)| (100 * k + 10 * j + i) as i16);
        Volume::new(Voxels::I16(voxels), geometry).unwrap()
    }

    #[test]
    fn cropping_keeps_every_voxel_at_its_place_in_the_patient() {
        let whole = volume();
        let part = whole.cropped(&"1:4,2:4,1:3".parse().unwrap()).unwrap();
        let Voxels::I16(hu) = part.voxels() else {
            unreachable!()
        };
        assert_eq!(hu[[0, 0, 0]], 121);
        assert_eq!(
            part.geometry().patient_from_voxel().apply([0.0, 0.0, 0.0]),
            whole.geometry().patient_from_voxel().apply([1.0, 2.0, 1.0])
        );
    }

    #[test]
    fn a_crop_that_reaches_outside_is_refused() {
        let crop: CropBox = "0:6,0:4,0:3".parse().unwrap();
        assert!(volume().cropped(&crop).is_err());
    }

    #[test]
    fn the_range_spans_all_voxels() {
        assert_eq!(volume().hu_range(), (0.0, 234.0));
    }
}
