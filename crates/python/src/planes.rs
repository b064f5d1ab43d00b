//! Where pictures of a volume lie.

use ndarray::arr2;
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::arrays::owned;

/// The pictures that can be taken along one normal of a volume; pixels are square.
///
/// Axial ones are seen from the feet and coronal ones from the front, with the patient's left on the
/// right side; sagittal ones from the left, with the front on the left side.
#[pyclass(frozen, module = "bonemesh")]
pub(crate) struct SlicePlane(pub(crate) bonemesh::SlicePlane);

#[pymethods]
impl SlicePlane {
    /// "axial", "coronal" or "sagittal".
    #[getter]
    fn name(&self) -> &'static str {
        self.0.anatomical.name()
    }

    /// `(4, 4) float64`: `(right, up, position, 1)`, mm from the picture's middle and along the normal, to
    /// the patient (LPS, mm). Positions rise to the head, the back or the left.
    #[getter]
    fn patient_from_plane<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        owned(py, arr2(&self.0.patient_from_plane.matrix()))
    }

    /// Side of a pixel.
    #[getter]
    fn pixel_mm(&self) -> f64 {
        self.0.pixel_mm
    }

    /// Rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        self.0.shape.into()
    }

    /// Positions of the outermost voxels' centres, the lower first.
    #[getter]
    fn positions_mm(&self) -> (f64, f64) {
        self.0.positions_mm.into()
    }

    /// From one slice of voxels to the next.
    #[getter]
    fn step_mm(&self) -> f64 {
        self.0.step_mm
    }

    fn __repr__(&self) -> String {
        let ([rows, columns], [low, high]) = (self.0.shape, self.0.positions_mm);
        format!(
            "<bonemesh.SlicePlane, {}, {rows} x {columns} pixels of {:.3} mm, {low:.3} to {high:.3} mm>",
            self.name(),
            self.0.pixel_mm
        )
    }
}

impl SlicePlane {
    /// The plane of the library.
    pub(crate) fn of(plane: bonemesh::SlicePlane) -> Self {
        Self(plane)
    }
}
