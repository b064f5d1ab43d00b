//! How two meshes differ.

use bonemesh::CompareSettings;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Input, owned};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::mesh::Mesh;
use crate::options::Threads;
use crate::report::dict;

/// More samples than memory has room for.
const MOST_SAMPLES: i128 = 100_000_000;

/// How two meshes in the same space differ, as `bonemesh compare --json` prints it.
///
/// Distances between the surfaces in both directions (`hausdorff_mm`, `mean_mm`, `rms_mm`, `p95_mm`, `to_reference`,
/// `from_reference`) at `samples` places of each, evenly by area; `edge_midpoints`, the published comparison of meshes
/// made of the same slices, None for others; volumes and the `residual_volume_mm3`, union less intersection, None if a mesh
/// is not closed or with `residual=False`.
#[pyfunction]
#[pyo3(signature = (mesh, reference, *, samples=100_000, residual=true, threads=None, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn compare<'py>(
    py: Python<'py>,
    mesh: &Mesh,
    reference: &Mesh,
    samples: i128,
    residual: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyDict>> {
    let watch = Watch::new(py, progress, cancel)?;
    if !(1..=MOST_SAMPLES).contains(&samples) {
        let message = format!("samples is {samples}; give a whole number from 1 to 100000000");
        return Err(errors::argument(py, &message));
    }
    let settings = CompareSettings {
        samples: samples as usize,
        residual,
        threads: Threads::count(threads),
    };
    let (mesh, reference) = (mesh.parts(), reference.parts());
    let report = detached(py, watch, move |task| {
        let compared = bonemesh::compare(&mesh.mesh()?, &reference.mesh()?, settings, task)?;
        Ok(compared.report)
    })?;
    dict(py, &crate::report::json(&report))
}

/// The signed distance (mm) of points to the surface of a mesh, `(N,) float64`, positive outside.
///
/// `points` are the vertices of another mesh, for a heat map, or a cloud, `(N, 3)` in mm.
#[pyfunction]
#[pyo3(signature = (points, reference, *, threads=None, progress=None, cancel=None))]
pub(crate) fn signed_distances<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    reference: &Mesh,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let watch = Watch::new(py, progress, cancel)?;
    let places_mm = Input::new("points", points)?.vectors()?;
    if !places_mm.iter().flatten().all(|c| c.is_finite()) {
        return Err(errors::argument(
            py,
            "points has a coordinate that is no number; give finite ones",
        ));
    }
    let (parts, threads) = (reference.parts(), Threads::count(threads));
    let distances = detached(py, watch, move |task| {
        bonemesh::distances_to(&places_mm, &parts.mesh()?, threads, task)
    })?;
    owned(py, distances.into())
}
