//! Shape of a voxel grid and its place in the patient.

use crate::{Affine, CropBox, VolumeError};

/// A grid of `[slices, rows, columns]` voxels and the map of their centres into the patient.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    shape: [usize; 3],
    patient_from_voxel: Affine,
    slice_locations_mm: SliceLocations,
}

/// Slice locations as the scanner counts them: the first slice's, and the step to the next, which
/// is negative where the scanner counts against the order of the slices.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SliceLocations {
    first: f64,
    step: f64,
}

/// Longest side of a grid: DICOM's rows and columns are 16-bit, lattice arithmetic relies on it.
const MAX_SIDE: usize = 65_535;

impl Geometry {
    /// A grid whose voxel `(column, row, slice)` has its centre at `patient_from_voxel` (mm, LPS).
    ///
    /// A slice's location is its distance from the patient origin along the slice normal, unless
    /// [`Geometry::with_slice_locations_mm`] says otherwise.
    ///
    /// # Errors
    /// [`VolumeError::Size`] and [`VolumeError::Degenerate`].
    pub fn new(shape: [usize; 3], patient_from_voxel: Affine) -> Result<Self, VolumeError> {
        if shape.iter().any(|n| *n == 0 || *n > MAX_SIDE) {
            return Err(VolumeError::Size(shape));
        }
        let determinant = patient_from_voxel.determinant();
        let finite = patient_from_voxel
            .matrix()
            .iter()
            .flatten()
            .all(|v| v.is_finite());
        if !finite || determinant == 0.0 || patient_from_voxel.inverse().is_none() {
            return Err(VolumeError::Degenerate(determinant));
        }
        let mut geometry = Self {
            shape,
            patient_from_voxel,
            slice_locations_mm: SliceLocations {
                first: 0.0,
                step: 0.0,
            },
        };
        let (normal, origin) = (geometry.slice_normal(), patient_from_voxel.origin());
        geometry.slice_locations_mm = SliceLocations {
            first: (0..3).map(|i| normal[i] * origin[i]).sum(),
            step: geometry.spacing_mm()[2],
        };
        Ok(geometry)
    }

    /// The same grid with the slice locations (mm) as the scanner wrote them: the first slice's
    /// and the step to the next; a step that is not finite or 0 is no location and changes nothing.
    #[must_use]
    pub fn with_slice_locations_mm(mut self, first: f64, step: f64) -> Self {
        if first.is_finite() && step.is_finite() && step != 0.0 {
            self.slice_locations_mm = SliceLocations { first, step };
        }
        self
    }

    /// Slices, rows, columns.
    pub fn shape(&self) -> [usize; 3] {
        self.shape
    }

    /// Voxel indices `(column, row, slice)` to patient millimetres (LPS), voxel centres.
    pub fn patient_from_voxel(&self) -> &Affine {
        &self.patient_from_voxel
    }

    /// Distance between columns, between rows, and between slices along the normal, in mm.
    pub fn spacing_mm(&self) -> [f64; 3] {
        let [dx, dy, _] = self.patient_from_voxel.spacing();
        let (normal, step) = (self.slice_normal(), self.patient_from_voxel.axis(2));
        [dx, dy, (0..3).map(|i| normal[i] * step[i]).sum()]
    }

    /// Unit normal of the slices, on the side to which slice numbers grow.
    pub fn slice_normal(&self) -> [f64; 3] {
        let (u, v) = (
            self.patient_from_voxel.axis(0),
            self.patient_from_voxel.axis(1),
        );
        let n = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
        let sign = self.patient_from_voxel.determinant().signum();
        n.map(|c| c / length * sign)
    }

    /// Voxel indices to the *image frame*: `x = column dx - dx/2`, `y = row dy - dy/2`,
    /// `z` = slice location; mm. Rows and columns are taken as orthogonal and tilt is left out:
    /// this is the frame of the published method, kept for comparison with it.
    pub fn image_from_voxel(&self) -> Affine {
        let [dx, dy, _] = self.spacing_mm();
        let SliceLocations { first, step } = self.slice_locations_mm;
        Affine::from_axes(
            [dx, 0.0, 0.0],
            [0.0, dy, 0.0],
            [0.0, 0.0, step],
            [-dx / 2.0, -dy / 2.0, first],
        )
    }

    /// The part inside `crop`, at the same place in the patient.
    ///
    /// # Errors
    /// [`VolumeError::Crop`].
    pub fn cropped(&self, crop: &CropBox) -> Result<Self, VolumeError> {
        crop.check(self.shape)?;
        let start = [
            crop.columns.start as f64,
            crop.rows.start as f64,
            crop.slices.start as f64,
        ];
        Ok(Self {
            shape: [crop.slices.len(), crop.rows.len(), crop.columns.len()],
            patient_from_voxel: self.patient_from_voxel.shifted(start),
            slice_locations_mm: SliceLocations {
                first: self.slice_locations_mm.first + start[2] * self.slice_locations_mm.step,
                ..self.slice_locations_mm
            },
        })
    }
}

#[cfg(test)]
#[allow(
    clippy::float_cmp,
    reason = "the numbers are chosen so that no step rounds"
)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_stack_keeps_its_slice_distance_along_the_normal() {
        let tilt = 15.0_f64.to_radians();
        let affine = Affine::from_axes(
            [0.5, 0.0, 0.0],
            [0.0, 0.5 * tilt.cos(), -0.5 * tilt.sin()],
            [0.0, 0.0, 2.0],
            [0.0; 3],
        );
        let spacing = Geometry::new([4, 4, 4], affine).unwrap().spacing_mm();
        assert!((spacing[2] - 2.0 * tilt.cos()).abs() < 1e-12);
    }

    #[test]
    fn the_image_frame_is_the_published_one() {
        let affine = Affine::from_axes(
            [0.4, 0.0, 0.0],
            [0.0, 0.5, 0.0],
            [0.0, 0.0, 2.0],
            [7.0, 8.0, -3.0],
        );
        let geometry = Geometry::new([4, 4, 4], affine).unwrap();
        assert_eq!(
            geometry.image_from_voxel().apply([0.0, 0.0, 1.0]),
            [-0.2, -0.25, -1.0]
        );
    }

    #[test]
    fn locations_may_fall_where_slices_rise() {
        let affine = Affine::from_axes([0.4, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 2.0], [0.0; 3]);
        let geometry = Geometry::new([4, 4, 4], affine)
            .unwrap()
            .with_slice_locations_mm(10.0, -2.0);
        assert_eq!(geometry.image_from_voxel().apply([0.0, 0.0, 1.0])[2], 8.0);
        let part = geometry.cropped(&"0:4,0:4,2:4".parse().unwrap()).unwrap();
        assert_eq!(part.image_from_voxel().apply([0.0; 3])[2], 6.0);
    }

    #[test]
    fn impossible_grids_are_refused() {
        let good = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        assert!(matches!(
            Geometry::new([0, 1, 1], good),
            Err(VolumeError::Size(_))
        ));
        let flat = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3], [0.0; 3]);
        assert!(matches!(
            Geometry::new([1, 1, 1], flat),
            Err(VolumeError::Degenerate(_))
        ));
        let nan = Affine::from_axes(
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [f64::NAN; 3],
        );
        assert!(Geometry::new([1, 1, 1], nan).is_err());
    }
}
