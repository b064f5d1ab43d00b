//! Whether a mesh can be printed, and how thick its walls are.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::owned;
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::mesh::Mesh;
use crate::report::dict;

/// Can the mesh be printed: is it watertight, manifold, free of self-intersections, how thin are its walls?
///
/// The dict is what `bonemesh check --json` prints; `printable` is the verdict, `reasons` says why not.
#[pyfunction]
#[pyo3(signature = (mesh, *, progress=None, cancel=None))]
pub(crate) fn check<'py>(
    py: Python<'py>,
    mesh: &Mesh,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyDict>> {
    let watch = Watch::new(py, progress, cancel)?;
    let parts = mesh.parts();
    let report = detached(py, watch, move |task| {
        bonemesh::check(&parts.mesh()?, None, task)
    })?;
    dict(py, &crate::report::json(&report))
}

/// How thick the wall is at each vertex: `(N,) float64`, mm, infinite where nothing lies opposite.
///
/// The mesh should be closed and outward (see `check`).
#[pyfunction]
#[pyo3(signature = (mesh, *, progress=None, cancel=None))]
pub(crate) fn wall_thickness<'py>(
    py: Python<'py>,
    mesh: &Mesh,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let watch = Watch::new(py, progress, cancel)?;
    let parts = mesh.parts();
    let walls = detached(py, watch, move |task| {
        bonemesh::wall_thickness(&parts.mesh()?, task)
    })?;
    owned(py, walls.into())
}
