//! Bodies of known shape.

use std::path::PathBuf;

use bonemesh_phantom::{Orientation, Phantom, PhantomError, ScanSettings};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::options::{self, Threads};
use crate::volume::Volume;

/// What can be changed of a phantom's own scan.
#[derive(Clone, Copy)]
struct Changes<'a> {
    coarser: f64,
    pixel_mm: Option<f64>,
    slice_mm: Option<f64>,
    orientation: Option<&'a str>,
    psf_px: Option<f64>,
    noise_hu: Option<f64>,
    seed: Option<i128>,
}

/// Scan a phantom: a body of known shape as a CT `Volume`.
///
/// - `name`: "line", "cylinder", "cube", "two-cubes", "cube-with-hole" and "curved" are drawn in
///   pixels; "sphere-shell", "tube", "femur", "box-with-hole" and "head" are bodies in mm.
/// - `coarser`: voxels this many times as long over the same field of view.
/// - `pixel_mm`, `slice_mm`: other lengths of the voxels instead, over the same field of view.
/// - `orientation`: "axial", "reversed", "sagittal", "coronal", "oblique", "tilted", "feet-first",
///   "prone", "decubitus-left", "decubitus-right".
/// - `psf_px`, `noise_hu`, `seed`: blur in pixels, noise in HU and its seed; None is as usual.
#[pyfunction]
#[pyo3(signature = (name, *, coarser=1.0, pixel_mm=None, slice_mm=None, orientation=None, psf_px=None, noise_hu=None, seed=None, threads=None, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn phantom(
    py: Python<'_>,
    name: &str,
    coarser: f64,
    pixel_mm: Option<f64>,
    slice_mm: Option<f64>,
    orientation: Option<&str>,
    psf_px: Option<f64>,
    noise_hu: Option<f64>,
    seed: Option<i128>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Volume> {
    let watch = Watch::new(py, progress, cancel)?;
    let changes = Changes {
        coarser,
        pixel_mm,
        slice_mm,
        orientation,
        psf_px,
        noise_hu,
        seed,
    };
    let (phantom, settings) = chosen(py, name, changes)?;
    let threads = Threads::count(threads);
    detached(py, watch, move |task| {
        let pool = bonemesh::pool(threads)?;
        let volume = pool.install(|| bonemesh_phantom::scan(phantom, &settings, task))?;
        Ok(Volume::of(volume, Vec::new()))
    })
}

/// Scan a phantom and write it as a DICOM CT series, with the truth about it beside the series.
///
/// `path` is a folder to make; the answer names its `series` folder, `files` and `truth` (JSON).
/// The other arguments are those of `phantom`.
#[pyfunction]
#[pyo3(signature = (name, path, *, coarser=1.0, pixel_mm=None, slice_mm=None, orientation=None, psf_px=None, noise_hu=None, seed=None, threads=None, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn write_phantom<'py>(
    py: Python<'py>,
    name: &str,
    path: PathBuf,
    coarser: f64,
    pixel_mm: Option<f64>,
    slice_mm: Option<f64>,
    orientation: Option<&str>,
    psf_px: Option<f64>,
    noise_hu: Option<f64>,
    seed: Option<i128>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyDict>> {
    let watch = Watch::new(py, progress, cancel)?;
    let changes = Changes {
        coarser,
        pixel_mm,
        slice_mm,
        orientation,
        psf_px,
        noise_hu,
        seed,
    };
    let (phantom, settings) = chosen(py, name, changes)?;
    let threads = Threads::count(threads);
    let written = detached(py, watch, move |task| {
        let pool = bonemesh::pool(threads)?;
        Ok(pool.install(|| bonemesh_phantom::write_phantom(phantom, &path, &settings, task))?)
    })?;
    let places = PyDict::new(py);
    places.set_item("series", written.series)?;
    places.set_item("files", written.files)?;
    places.set_item("truth", written.truth)?;
    Ok(places)
}

/// The phantom called `name` and how it is scanned.
fn chosen(py: Python<'_>, name: &str, changes: Changes<'_>) -> PyResult<(Phantom, ScanSettings)> {
    let unusable = |e: PhantomError| errors::unusable(py, e);
    let phantom: Phantom = name.parse().map_err(unusable)?;
    if !(changes.coarser >= 0.1 && changes.coarser <= 100.0) {
        let message = format!(
            "coarser is {}; give a number from 0.1 to 100, 1 for the usual grid",
            changes.coarser
        );
        return Err(errors::argument(py, &message));
    }
    let mut settings = phantom.settings().coarser(changes.coarser);
    let lengths = [
        ("pixel_mm", changes.pixel_mm.unwrap_or(settings.pixel_mm[0])),
        ("slice_mm", changes.slice_mm.unwrap_or(settings.slice_mm)),
    ];
    for (name, length) in lengths {
        if !(0.05..=100.0).contains(&length) {
            let message = format!("{name} is {length}; give a number from 0.05 to 100");
            return Err(errors::argument(py, &message));
        }
    }
    if changes.pixel_mm.is_some() || changes.slice_mm.is_some() {
        settings = settings.with_voxels(lengths[0].1, lengths[1].1);
    }
    if let Some(orientation) = changes.orientation {
        settings.orientation = orientation.parse::<Orientation>().map_err(unusable)?;
    }
    settings.psf_px = changes.psf_px.unwrap_or(settings.psf_px);
    settings.noise_hu = changes.noise_hu.unwrap_or(settings.noise_hu);
    if let Some(seed) = changes.seed {
        settings.seed = options::seed(py, seed)?;
    }
    settings.geometry().map_err(unusable)?;
    Ok((phantom, settings))
}
