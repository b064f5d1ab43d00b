//! Pictures of a volume along a plane.

use bonemesh_task::{Cancelled, Task};
use ndarray::{Array2, Array3};

use crate::{SlicePlane, Volume, VolumeError, Voxels};

/// Part of a voxel that rounding may carry a place out of the volume.
const ROUNDING: f64 = 1e-6;

/// Which Hounsfield units are black and which are white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    centre_hu: f64,
    width_hu: f64,
}

impl Window {
    /// Grey in the middle at `centre_hu`, from black to white over `width_hu`.
    ///
    /// # Errors
    /// [`VolumeError::Window`] unless both are finite and the width is above 0.
    pub fn new(centre_hu: f64, width_hu: f64) -> Result<Self, VolumeError> {
        if centre_hu.is_finite() && width_hu.is_finite() && width_hu > 0.0 {
            Ok(Self {
                centre_hu,
                width_hu,
            })
        } else {
            Err(VolumeError::Window {
                centre_hu,
                width_hu,
            })
        }
    }

    /// 0 (black) to 255 (white); what is no number is black.
    pub fn grey(&self, hu: f32) -> u8 {
        let part = (f64::from(hu) - self.centre_hu) / self.width_hu + 0.5;
        (255.0 * part).round() as u8
    }
}

impl Volume {
    /// Hounsfield units `[row, column]` of the picture at `position_mm` along the normal of `plane`
    /// (see [`crate::Geometry::slice_plane`]), the top row first; no number where nothing was measured.
    ///
    /// Between voxel centres values are interpolated linearly; at them they are the voxels' own.
    ///
    /// # Errors
    /// [`Cancelled`]
    pub fn slice(
        &self,
        plane: &SlicePlane,
        position_mm: f64,
        task: &Task,
    ) -> Result<Array2<f32>, Cancelled> {
        match &self.voxels {
            Voxels::I16(hu) => self.sampled(hu, plane, position_mm, task),
            Voxels::F32(hu) => self.sampled(hu, plane, position_mm, task),
        }
    }

    fn sampled<T: Copy + Into<f64>>(
        &self,
        hu: &Array3<T>,
        plane: &SlicePlane,
        position_mm: f64,
        task: &Task,
    ) -> Result<Array2<f32>, Cancelled> {
        let voxel_from_patient = self.geometry.patient_from_voxel().inverse();
        let voxel_from_patient =
            voxel_from_patient.expect("a sound grid has an inverse; otherwise this is a bug");
        let [rows, columns] = plane.shape;
        let mut picture = Array2::from_elem((rows, columns), f32::NAN);
        // A pixel's centre from the picture's middle, in mm.
        let from_middle = |index: usize, pixels: usize| {
            (index as f64 + 0.5 - 0.5 * pixels as f64) * plane.pixel_mm
        };
        let step = plane
            .patient_from_plane
            .apply_vector([plane.pixel_mm, 0.0, 0.0]);
        let step = voxel_from_patient.apply_vector(step);
        task.begin("slice", rows);
        for (row, mut pixels) in picture.outer_iter_mut().enumerate() {
            let first = [
                from_middle(0, columns),
                -from_middle(row, rows),
                position_mm,
            ];
            let first = voxel_from_patient.apply(plane.patient_from_plane.apply(first));
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let index = [0, 1, 2].map(|axis| first[axis] + column as f64 * step[axis]);
                if let Some(value) = interpolated(hu, index) {
                    *pixel = value as f32;
                }
            }
            task.advance(1)?;
        }
        Ok(picture)
    }
}

/// The value at voxel index `(column, row, slice)`; the outermost voxels reach half a voxel outward.
fn interpolated<T: Copy + Into<f64>>(hu: &Array3<T>, index: [f64; 3]) -> Option<f64> {
    let (slices, rows, columns) = hu.dim();
    let mut low = [0_usize; 3];
    let mut high = [0_usize; 3];
    let mut part = [0.0; 3];
    for (axis, count) in [columns, rows, slices].into_iter().enumerate() {
        let last = count as f64 - 1.0;
        let place = index[axis];
        if !(place >= -0.5 - ROUNDING && place <= last + 0.5 + ROUNDING) {
            return None;
        }
        let place = place.clamp(0.0, last);
        low[axis] = place as usize;
        high[axis] = (low[axis] + 1).min(count - 1);
        part[axis] = place - low[axis] as f64;
    }
    let at = |k: usize, j: usize, i: usize| -> f64 { hu[[k, j, i]].into() };
    // What is not blended is not looked at: a voxel that is no number stays where it is.
    let mix = |a: f64, b: f64, t: f64| if t == 0.0 { a } else { a + t * (b - a) };
    let line = |k: usize, j: usize| mix(at(k, j, low[0]), at(k, j, high[0]), part[0]);
    let sheet = |k: usize| mix(line(k, low[1]), line(k, high[1]), part[1]);
    Some(mix(sheet(low[2]), sheet(high[2]), part[2]))
}

#[cfg(test)]
#[allow(
    clippy::float_cmp,
    reason = "the numbers are chosen so that no step rounds"
)]
mod tests {
    use super::*;
    use crate::{Affine, Anatomical, Geometry};

    /// Values that name their voxel: 100 slice + 10 row + column.
    fn volume(affine: Affine) -> Volume {
        let voxels = Array3::from_shape_fn([3, 4, 5], |(k, j, i)| (100 * k + 10 * j + i) as i16);
        Volume::new(
            Voxels::I16(voxels),
            Geometry::new([3, 4, 5], affine).unwrap(),
        )
        .unwrap()
    }

    fn straight() -> Affine {
        Affine::from_axes(
            [0.5, 0.0, 0.0],
            [0.0, 0.5, 0.0],
            [0.0, 0.0, 1.5],
            [-3.0, 7.0, 40.0],
        )
    }

    fn slice(volume: &Volume, anatomical: Anatomical, position_mm: f64) -> Array2<f32> {
        let plane = volume.geometry().slice_plane(anatomical);
        volume.slice(&plane, position_mm, &Task::default()).unwrap()
    }

    #[test]
    fn an_axial_picture_is_the_slice_itself_with_the_front_on_top() {
        let volume = volume(straight());
        let picture = slice(&volume, Anatomical::Axial, 41.5);
        assert_eq!(picture.dim(), (4, 5));
        // The first row of voxels is furthest to the front; columns run to the left.
        assert_eq!(picture.row(0).to_vec(), [100.0, 101.0, 102.0, 103.0, 104.0]);
        assert_eq!(picture.row(3).to_vec(), [130.0, 131.0, 132.0, 133.0, 134.0]);
    }

    #[test]
    fn coronal_and_sagittal_pictures_have_the_head_on_top() {
        let volume = volume(straight());
        let coronal = slice(&volume, Anatomical::Coronal, 8.0);
        assert_eq!(coronal.dim(), (9, 5));
        // The middle of each slice's three rows; the outer half slices repeat the outermost.
        assert_eq!(coronal[[1, 0]], 220.0);
        assert_eq!(coronal[[7, 4]], 24.0);
        assert_eq!(coronal[[0, 2]], coronal[[1, 2]]);
        assert!((coronal[[2, 0]] - (220.0 - 100.0 / 3.0)).abs() < 1e-4);
        let sagittal = slice(&volume, Anatomical::Sagittal, -1.0);
        assert_eq!(sagittal.dim(), (9, 4));
        assert_eq!(sagittal[[1, 0]], 204.0);
        assert_eq!(sagittal[[7, 3]], 34.0);
    }

    #[test]
    fn the_patients_left_is_on_the_right_however_voxels_were_stored() {
        // Columns to the right, slices to the feet: the same patient, turned in storage.
        let turned = Affine::from_axes(
            [-0.5, 0.0, 0.0],
            [0.0, 0.5, 0.0],
            [0.0, 0.0, -1.5],
            [-1.0, 7.0, 43.0],
        );
        let (a, b) = (volume(straight()), volume(turned));
        let (a, b) = (
            slice(&a, Anatomical::Axial, 40.0),
            slice(&b, Anatomical::Axial, 40.0),
        );
        assert_eq!(a[[0, 0]], 0.0);
        assert_eq!(b.row(0).to_vec(), [204.0, 203.0, 202.0, 201.0, 200.0]);
    }

    #[test]
    fn between_slices_values_are_interpolated_and_outside_there_are_none() {
        let volume = volume(straight());
        let between = slice(&volume, Anatomical::Axial, 40.75);
        assert!((between[[2, 3]] - 73.0).abs() < 1e-4);
        assert!(
            slice(&volume, Anatomical::Axial, 39.0)
                .iter()
                .all(|v| v.is_nan())
        );
        assert!(
            slice(&volume, Anatomical::Axial, 39.3)
                .iter()
                .all(|v| !v.is_nan())
        );
    }

    #[test]
    fn a_tilted_stack_shows_each_voxel_at_its_place_in_the_patient() {
        let (s, c) = 15.0_f64.to_radians().sin_cos();
        let affine = Affine::from_axes(
            [0.5, 0.0, 0.0],
            [0.0, 0.5 * c, -0.5 * s],
            [0.0, 0.0, 1.5],
            [0.0; 3],
        );
        let volume = volume(affine);
        for anatomical in Anatomical::ALL {
            let plane = volume.geometry().slice_plane(anatomical);
            let inverse = plane.patient_from_plane.inverse().unwrap();
            let place = inverse.apply(affine.apply([2.0, 1.0, 1.0]));
            let picture = slice(&volume, anatomical, place[2]);
            let [rows, columns] = plane.shape.map(|n| n as f64);
            let column = place[0] / plane.pixel_mm + 0.5 * columns;
            let row = 0.5 * rows - place[1] / plane.pixel_mm;
            // Values rise by 100 a slice: half a pixel is at most 17 of them and 5 for a row.
            let found = picture[[row as usize, column as usize]];
            assert!((found - 112.0).abs() < 25.0, "{anatomical:?}: {found}");
        }
    }

    #[test]
    fn a_window_is_black_below_and_white_above() {
        let window = Window::new(400.0, 1000.0).unwrap();
        let greys = [-3000.0, -100.0, 400.0, 900.0, 5000.0].map(|hu| window.grey(hu));
        assert_eq!(greys, [0, 0, 128, 255, 255]);
        assert_eq!(window.grey(f32::NAN), 0);
        for (centre_hu, width_hu) in [(0.0, 0.0), (0.0, -1.0), (f64::NAN, 1.0)] {
            assert!(Window::new(centre_hu, width_hu).is_err());
        }
    }
}
