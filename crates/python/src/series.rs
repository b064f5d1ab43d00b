//! The series of a folder, and a series as a volume.

use std::path::PathBuf;

use bonemesh::{Contents, SeriesReport, Source};
use ndarray::arr2;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::owned;
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::options::{Choice, Threads};
use crate::report::{dict, json};
use crate::volume::Volume;

/// A series of CT slices that makes one volume: what is known before any pixel is decoded.
#[pyclass(frozen, module = "bonemesh")]
pub(crate) struct Series(SeriesReport);

#[pymethods]
impl Series {
    /// Number in its folder, 1 is the largest.
    #[getter]
    fn number(&self) -> usize {
        self.0.number
    }

    /// `SeriesInstanceUID`; empty where the files have none.
    #[getter]
    fn uid(&self) -> &str {
        &self.0.uid
    }

    /// What the scanner's operator called it.
    #[getter]
    fn description(&self) -> &str {
        &self.0.description
    }

    /// `CT`, or empty where the files do not say.
    #[getter]
    fn modality(&self) -> &str {
        &self.0.modality
    }

    /// Slices of the volume, missing ones included.
    #[getter]
    fn slices(&self) -> usize {
        self.0.slices
    }

    /// Slices that the files hold.
    #[getter]
    fn slices_found(&self) -> usize {
        self.0.slices_found
    }

    /// Pixels in a column.
    #[getter]
    fn rows(&self) -> usize {
        self.0.rows
    }

    /// Pixels in a row.
    #[getter]
    fn columns(&self) -> usize {
        self.0.columns
    }

    /// Distance between columns, between rows, and between slices along their normal (mm).
    #[getter]
    fn spacing_mm(&self) -> (f64, f64, f64) {
        self.0.spacing_mm.into()
    }

    /// `(4, 4) float64`: `(column, row, slice, 1)` of a voxel to its centre in the patient (LPS, mm).
    #[getter]
    fn patient_from_voxel<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        owned(py, arr2(&self.0.patient_from_voxel))
    }

    /// Plane, tilt, and where columns, rows and slices are counted to, in words.
    #[getter]
    fn orientation(&self) -> &str {
        &self.0.orientation
    }

    /// Angle between the slices' normal and the line along which they are stacked (degrees).
    #[getter]
    fn tilt_degrees(&self) -> f64 {
        self.0.tilt_degrees
    }

    /// Where each slice found lies along the slices' normal (mm), ascending.
    #[getter]
    fn slice_positions_mm(&self) -> Vec<f64> {
        self.0.slice_positions_mm.clone()
    }

    /// Where slices are missing or wide apart: position of the slice before (mm), and how many lack.
    #[getter]
    fn gaps(&self) -> Vec<(f64, usize)> {
        self.0
            .gaps
            .iter()
            .map(|g| (g.after_mm, g.missing))
            .collect()
    }

    /// Whether the distances differ so that reading resamples the slices evenly.
    #[getter]
    fn is_resampled(&self) -> bool {
        self.0.is_resampled
    }

    /// Files that were dropped because the same slice is there already.
    #[getter]
    fn duplicates(&self) -> Vec<String> {
        self.0.duplicates.clone()
    }

    /// How the files hold the pixels.
    #[getter]
    fn transfer_syntax(&self) -> &str {
        &self.0.transfer_syntax
    }

    /// Memory that the volume takes (bytes).
    #[getter]
    fn estimated_memory_bytes(&self) -> u64 {
        self.0.estimated_memory_bytes
    }

    /// Smallest and largest value (HU); None as long as no pixel was decoded.
    #[getter]
    fn hu_range(&self) -> Option<(f64, f64)> {
        self.0.hu_range.map(Into::into)
    }

    /// What a user should know: missing, uneven, doubled or cut-off slices, and the like.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings.clone()
    }

    /// The files, in the order of their slices.
    #[getter]
    fn files(&self) -> Vec<PathBuf> {
        self.0.files.clone()
    }

    /// The whole report in words, a line for each subject, as `bonemesh info` prints it.
    #[getter]
    fn lines(&self) -> Vec<String> {
        self.0.lines()
    }

    /// The whole report as a dict, as `bonemesh info --json` prints it.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dict(py, &json(&self.0))
    }

    fn __repr__(&self) -> String {
        let SeriesReport {
            number,
            slices,
            rows,
            columns,
            description,
            ..
        } = &self.0;
        format!(
            "<bonemesh.Series {number}, {slices} slices of {rows} x {columns}, {description:?}>"
        )
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
    /// Number of the series that is most likely meant: the largest.
    recommended: usize,
    /// Numbers of the others that could be meant as well.
    alternatives: Vec<usize>,
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

impl Scan {
    fn of(py: Python<'_>, contents: Contents) -> PyResult<Self> {
        let series = contents.series.into_iter().map(|s| Py::new(py, Series(s)));
        let left_out = contents.left_out.into_iter().map(|l| {
            let (path, reason) = (l.path, l.reason);
            Py::new(py, LeftOut { path, reason })
        });
        Ok(Self {
            recommended: contents.recommended,
            alternatives: contents.alternatives,
            series: series.collect::<PyResult<_>>()?,
            left_out: left_out.collect::<PyResult<_>>()?,
        })
    }
}

/// Look through a folder and its sub-folders for CT series, by content and not by name.
///
/// `path` may also be one file: multi-frame DICOM, NIfTI or NRRD. Only headers are read, unless
/// `pixels` asks for the range of the values. With `one_series`, all slices that fit together are
/// one series, whatever UIDs they name. The answer also lists what is in no series, and why.
#[pyfunction]
#[pyo3(signature = (
    path, *, one_series=false, pixels=false, threads=None, progress=None, cancel=None
))]
pub(crate) fn scan(
    py: Python<'_>,
    path: PathBuf,
    one_series: bool,
    pixels: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Scan> {
    let watch = Watch::new(py, progress, cancel)?;
    let threads = Threads::count(threads);
    let contents = detached(py, watch, move |task| {
        bonemesh::pool(threads)?.install(|| {
            let source = Source::open(&path, one_series, task)?;
            if pixels {
                source.decoded_contents(task)
            } else {
                Ok(source.contents().clone())
            }
        })
    })?;
    Scan::of(py, contents)
}

/// The CT series in a folder and its sub-folders, largest first: `scan(path).series`.
#[pyfunction]
#[pyo3(signature = (path, *, one_series=false, threads=None, progress=None, cancel=None))]
pub(crate) fn find_series(
    py: Python<'_>,
    path: PathBuf,
    one_series: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Vec<Py<Series>>> {
    Ok(scan(py, path, one_series, false, threads, progress, cancel)?.series)
}

/// Read a series of a folder, or a file with a whole volume, as a `Volume`.
///
/// `series` is its UID or its number (1 is the largest); None takes the only plausible one and
/// refuses to guess between several. `one_series` as in `scan`.
#[pyfunction]
#[pyo3(signature = (
    path, series=None, *, one_series=false, threads=None, progress=None, cancel=None
))]
pub(crate) fn read_series(
    py: Python<'_>,
    path: PathBuf,
    series: Option<Choice>,
    one_series: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Volume> {
    let watch = Watch::new(py, progress, cancel)?;
    let (choice, threads) = (series.map(|s| s.0), Threads::count(threads));
    detached(py, watch, move |task| {
        bonemesh::pool(threads)?.install(|| {
            let source = Source::open(&path, one_series, task)?;
            let reading = source.read(choice.as_ref(), task)?;
            Ok(Volume::of(reading.volume, reading.series.warnings))
        })
    })
}
