//! Coarse surfaces of one scan at any threshold.

use std::sync::Arc;

use bonemesh::HuThreshold;
use ndarray::arr2;
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::arrays::owned;
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::mesh::Mesh;
use crate::options::{Crop, Threads};
use crate::volume::Volume;

/// Coarse volumes of a scan, kept for surfaces at many thresholds; it never changes.
///
/// Making one takes a moment, a surface then some hundredths of a second. Thin bone stays in a coarse
/// volume: bone is shown up to half a coarse voxel thicker on each side. The volume itself is not kept.
#[pyclass(frozen, module = "bonemesh")]
pub(crate) struct Preview(Arc<bonemesh::Preview>);

#[pymethods]
impl Preview {
    #[new]
    #[pyo3(signature = (volume, *, threads=None, progress=None, cancel=None))]
    fn new(
        py: Python<'_>,
        volume: &Volume,
        threads: Option<Threads>,
        progress: Option<Py<PyAny>>,
        cancel: Option<&Cancel>,
    ) -> PyResult<Self> {
        let watch = Watch::new(py, progress, cancel)?;
        let (volume, threads) = (volume.shared(), Threads::count(threads));
        detached(py, watch, move |task| {
            let preview = bonemesh::Preview::of(&volume, threads, task)?;
            Ok(Self(Arc::new(preview)))
        })
    }

    /// Slices, rows and columns of the whole scan.
    #[getter]
    fn shape(&self) -> (usize, usize, usize) {
        self.0.geometry().shape().into()
    }

    /// `(4, 4) float64`: `(column, row, slice, 1)` of the whole scan to the patient (LPS, mm).
    #[getter]
    fn patient_from_voxel<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        owned(py, arr2(&self.0.geometry().patient_from_voxel().matrix()))
    }

    /// The coarse surface of what is above `threshold_hu`: `Mesh` in patient millimetres (LPS).
    ///
    /// `crop` is in voxels of the whole scan, as for `render`. Where a surface would have more
    /// triangles than can be shown at once, it is made of larger voxels: `report["spacing_mm"]`.
    #[pyo3(signature = (threshold_hu, *, crop=None, threads=None, progress=None, cancel=None))]
    fn surface(
        &self,
        py: Python<'_>,
        threshold_hu: f64,
        crop: Option<Crop>,
        threads: Option<Threads>,
        progress: Option<Py<PyAny>>,
        cancel: Option<&Cancel>,
    ) -> PyResult<Mesh> {
        let watch = Watch::new(py, progress, cancel)?;
        let threshold = HuThreshold::new(threshold_hu).map_err(|e| errors::unusable(py, e))?;
        let (preview, threads) = (self.0.clone(), Threads::count(threads));
        detached(py, watch, move |task| {
            let crop = crop.as_ref().map(|crop| &crop.0);
            let surface = preview.surface(threshold, crop, threads, task)?;
            Mesh::of(surface.mesh, &surface.report)
        })
    }

    fn __repr__(&self) -> String {
        let [slices, rows, columns] = self.0.geometry().shape();
        format!("<bonemesh.Preview, {slices} slices of {rows} x {columns}>")
    }
}
