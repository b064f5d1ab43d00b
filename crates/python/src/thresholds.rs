//! Histograms, the thresholds they suggest, and the pieces of a mask.

use std::num::NonZeroU16;

use bonemesh::{
    Affine, Connectivity, Error, Geometry, HistogramRequest, Mask, connected_components, multi_otsu,
};
use ndarray::{Array1, Array3};
use numpy::{PyArray1, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::arrays::{Input, owned};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::options::{Crop, Threads};
use crate::volume::Volume;

/// How often each Hounsfield value occurs; it never changes.
///
/// Bin `b` holds the values above `edges_hu[b]` up to and including `edges_hu[b + 1]`, so the bins
/// from an edge on hold exactly the bone of a threshold at that edge. Values below -1024 HU are
/// padding and in no bin.
#[pyclass(frozen, module = "bonemesh")]
pub(crate) struct Histogram(bonemesh::Histogram);

#[pymethods]
impl Histogram {
    /// Voxels in each bin, `(N,) uint64`.
    #[getter]
    fn counts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u64>>> {
        owned(py, Array1::from(self.0.counts().to_vec()))
    }

    /// Edges of the bins in HU, `(N + 1,) float64`.
    #[getter]
    fn edges_hu<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        owned(py, Array1::from(self.0.edges_hu()))
    }

    /// Voxels in all bins.
    #[getter]
    fn voxels(&self) -> u64 {
        self.0.voxels()
    }

    /// Voxels below -1024 HU.
    #[getter]
    fn padding(&self) -> u64 {
        self.0.padding()
    }

    /// Voxels beyond 32767 HU.
    #[getter]
    fn beyond(&self) -> u64 {
        self.0.beyond()
    }

    /// Otsu's thresholds between 2 to 5 classes, rising, exact for these bins (Liao et al. 2001).
    ///
    /// Voxels are parted as scikit-image's `threshold_otsu` and `threshold_multiotsu` part them;
    /// where several thresholds part them alike, the one in the middle is given.
    #[pyo3(signature = (classes=2))]
    fn otsu(&self, py: Python<'_>, classes: i128) -> PyResult<Vec<f64>> {
        let classes = usize::try_from(classes).unwrap_or(0);
        let found = multi_otsu(&self.0, classes).map_err(|e| errors::raised(py, &e.into()))?;
        Ok(found.into_iter().map(bonemesh::HuThreshold::hu).collect())
    }

    fn __repr__(&self) -> String {
        format!(
            "<bonemesh.Histogram, {} voxels in {} bins of {} HU>",
            self.0.voxels(),
            self.0.counts().len(),
            self.0.width_hu()
        )
    }
}

/// Count how often each Hounsfield value occurs in a volume, in bins of `bin_hu` HU.
#[pyfunction]
#[pyo3(signature = (volume, *, bin_hu=10, crop=None, threads=None, progress=None, cancel=None))]
pub(crate) fn histogram(
    py: Python<'_>,
    volume: &Volume,
    bin_hu: i128,
    crop: Option<Crop>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Histogram> {
    let watch = Watch::new(py, progress, cancel)?;
    let width = u16::try_from(bin_hu).ok().and_then(NonZeroU16::new);
    let width = width.ok_or_else(|| {
        let remedy = "give a whole number from 1 to 65535";
        errors::argument(py, &format!("bin_hu is {bin_hu}; {remedy}"))
    })?;
    let (volume, threads) = (volume.shared(), Threads::count(threads));
    detached(py, watch, move |task| {
        bonemesh::pool(threads)?.install(|| {
            let cropped = crop.map(|crop| volume.cropped(&crop.0)).transpose()?;
            let part = cropped.as_ref().unwrap_or(&volume);
            Ok(Histogram(bonemesh::Histogram::of(part, width, task)?))
        })
    })
}

/// Thresholds for the bone in a volume: those found in it, then those of the literature.
///
/// Each is a dict with `name`, `threshold_hu`, `recommended` (the one that "auto" takes),
/// `voxels_above`, `reason` and `source`, as `bonemesh histogram --json` prints them.
#[pyfunction]
#[pyo3(signature = (volume, *, crop=None, threads=None, progress=None, cancel=None))]
pub(crate) fn suggest_thresholds<'py>(
    py: Python<'py>,
    volume: &Volume,
    crop: Option<Crop>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyList>> {
    let watch = Watch::new(py, progress, cancel)?;
    let request = HistogramRequest {
        crop: crop.map(|c| c.0),
        threads: Threads::count(threads),
        ..HistogramRequest::default()
    };
    let volume = volume.shared();
    let report = detached(py, watch, move |task| {
        bonemesh::histogram_of(&volume, &request, task)
    })?;
    let suggestions = crate::report::json(&report.suggestions);
    let value = py.import("json")?.call_method1("loads", (suggestions,))?;
    Ok(value.cast_into::<PyList>()?)
}

/// Number the connected pieces of a mask `[slice, row, column]`: `uint32` of the same shape, 0
/// where the mask is false, else 1, 2, .. in the order of the pieces' first voxels.
///
/// `connectivity` is 6 (faces) or 26 (faces, edges and corners).
#[pyfunction]
#[pyo3(signature = (mask, *, connectivity=26, threads=None, progress=None, cancel=None))]
pub(crate) fn label_components<'py>(
    py: Python<'py>,
    mask: &Bound<'py, PyAny>,
    connectivity: i128,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyArray3<u32>>> {
    let watch = Watch::new(py, progress, cancel)?;
    let connectivity = match connectivity {
        6 => Connectivity::Faces,
        26 => Connectivity::Corners,
        other => {
            let message = format!("connectivity is {other}; give 6 or 26");
            return Err(errors::argument(py, &message));
        }
    };
    let mask = mask_of(py, &Input::new("mask", mask)?)?;
    let threads = Threads::count(threads);
    let labels: Array3<u32> = detached(py, watch, move |task| {
        bonemesh::pool(threads)?.install(|| {
            let components = connected_components(&mask, connectivity, task)?;
            Ok::<_, Error>(components.labels())
        })
    })?;
    owned(py, labels)
}

fn mask_of(py: Python<'_>, input: &Input<'_>) -> PyResult<Mask> {
    let [slices, rows, columns] = *input.shape() else {
        return Err(input.refuse("give a mask [slice, row, column] of bool"));
    };
    if !input.is_bool() {
        return Err(input.refuse("give a mask [slice, row, column] of bool"));
    }
    // Not read as `bool`: memory of that name may hold other bytes than 0 and 1.
    let voxels = input.read("uint8", |v: &[u8]| v.iter().map(|v| *v != 0).collect())?;
    let shape = [slices, rows, columns];
    let voxels = Array3::from_shape_vec(shape, voxels)
        .expect("as many voxels as the shape says: anything else is a bug");
    // What is connected does not depend on where in the patient the voxels lie.
    let unit = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
    let geometry = Geometry::new(shape, unit).map_err(|e| errors::unusable(py, e))?;
    Ok(Mask { voxels, geometry })
}
