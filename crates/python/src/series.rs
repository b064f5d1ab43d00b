//! The series of a folder, and a series as a volume.

use std::path::PathBuf;

use pyo3::prelude::*;

use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::options::{Choice, Threads};
use crate::volume::Volume;

/// A series of CT slices that makes one volume: what is known before any pixel is decoded.
#[pyclass(frozen, get_all, module = "bonemesh")]
pub(crate) struct Series {
    /// Number in its folder, 1 is the largest.
    number: usize,
    /// `SeriesInstanceUID`.
    uid: String,
    /// What the scanner's operator called it.
    description: String,
    /// `CT`, or empty where the files do not say.
    modality: String,
    /// Slices of the volume, missing ones included.
    slices: usize,
    /// Slices that the files hold.
    slices_found: usize,
    /// Pixels in a column.
    rows: usize,
    /// Pixels in a row.
    columns: usize,
    /// Distance between columns, between rows, and between slices along their normal (mm).
    spacing_mm: (f64, f64, f64),
    /// Plane, tilt, and where columns, rows and slices are counted to, in words.
    orientation: String,
    /// How the files hold the pixels.
    transfer_syntax: String,
    /// Memory that the volume takes (bytes).
    estimated_memory_bytes: u64,
    /// What a user should know: missing, uneven, doubled or cut-off slices, and the like.
    warnings: Vec<String>,
    /// The files, in the order of their slices.
    files: Vec<PathBuf>,
}

#[pymethods]
impl Series {
    fn __repr__(&self) -> String {
        let Self {
            number,
            slices,
            rows,
            columns,
            description,
            ..
        } = self;
        format!(
            "<bonemesh.Series {number}, {slices} slices of {rows} x {columns}, {description:?}>"
        )
    }
}

impl From<bonemesh::Series> for Series {
    fn from(series: bonemesh::Series) -> Self {
        Self {
            number: series.number,
            uid: series.uid,
            description: series.description,
            modality: series.modality,
            slices: series.slices,
            slices_found: series.slices_found,
            rows: series.rows,
            columns: series.columns,
            spacing_mm: series.spacing_mm.into(),
            orientation: series.orientation,
            transfer_syntax: series.transfer_syntax,
            estimated_memory_bytes: series.estimated_memory_bytes,
            warnings: series.warnings,
            files: series.files,
        }
    }
}

/// A file or folder that is in no series.
#[pyclass(frozen, get_all, module = "bonemesh")]
pub(crate) struct LeftOut {
    /// The file or folder.
    path: PathBuf,
    /// Why it was left out.
    reason: String,
}

#[pymethods]
impl LeftOut {
    fn __repr__(&self) -> String {
        format!(
            "<bonemesh.LeftOut {}: {}>",
            self.path.display(),
            self.reason
        )
    }
}

/// What a folder holds.
#[pyclass(frozen, get_all, module = "bonemesh")]
pub(crate) struct Scan {
    /// The series, largest first.
    series: Vec<Py<Series>>,
    /// Files and folders that are in no series, with the reason.
    left_out: Vec<Py<LeftOut>>,
}

#[pymethods]
impl Scan {
    fn __repr__(&self) -> String {
        let (series, left_out) = (self.series.len(), self.left_out.len());
        format!("<bonemesh.Scan, {series} series, {left_out} left out>")
    }
}

/// Look through a folder and its sub-folders for CT series, by content and not by name.
///
/// Only headers are read. The answer also lists what is in no series, and why.
#[pyfunction]
#[pyo3(signature = (path, *, threads=None, progress=None, cancel=None))]
pub(crate) fn scan(
    py: Python<'_>,
    path: PathBuf,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Scan> {
    let watch = Watch::new(py, progress, cancel)?;
    let threads = Threads::count(threads);
    let found = detached(py, watch, move |task| {
        Ok(bonemesh::pool(threads)?.install(|| bonemesh::find_series(&path, task))?)
    })?;
    let series = found
        .series
        .into_iter()
        .map(|s| Py::new(py, Series::from(s)));
    let left_out = found.left_out.into_iter().map(|l| {
        let (path, reason) = (l.path, l.reason);
        Py::new(py, LeftOut { path, reason })
    });
    Ok(Scan {
        series: series.collect::<PyResult<_>>()?,
        left_out: left_out.collect::<PyResult<_>>()?,
    })
}

/// The CT series in a folder and its sub-folders, largest first: `scan(path).series`.
#[pyfunction]
#[pyo3(signature = (path, *, threads=None, progress=None, cancel=None))]
pub(crate) fn find_series(
    py: Python<'_>,
    path: PathBuf,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Vec<Py<Series>>> {
    Ok(scan(py, path, threads, progress, cancel)?.series)
}

/// Read a series of a folder as a `Volume`.
///
/// `series` is its UID or its number (1 is the largest); None takes the only plausible one and
/// refuses to guess between several.
#[pyfunction]
#[pyo3(signature = (path, series=None, *, threads=None, progress=None, cancel=None))]
pub(crate) fn read_series(
    py: Python<'_>,
    path: PathBuf,
    series: Option<Choice>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Volume> {
    let watch = Watch::new(py, progress, cancel)?;
    let (choice, threads) = (series.map(|s| s.0), Threads::count(threads));
    detached(py, watch, move |task| {
        bonemesh::pool(threads)?.install(|| {
            let scan = bonemesh::find_series(&path, task)?;
            let (volume, warnings) = bonemesh::read_series(scan.choose(choice.as_ref())?, task)?;
            Ok(Volume::of(volume, warnings))
        })
    })
}
