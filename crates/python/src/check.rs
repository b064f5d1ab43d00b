//! Whether a mesh can be printed, and how thick its walls are.

use ndarray::Array1;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{owned, rows};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
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

/// Where a mesh is not fit for printing: arrays by the names of what `check` counts.
///
/// `open_edges`, `non_manifold_edges` and `inconsistent_edges` are `(N, 2)` vertices;
/// `non_manifold_vertices` and `thin_vertices` `(N,)` vertices; `degenerate_triangles` and
/// `intersecting_triangles` `(N,)` triangles: all `uint32`, ascending. Vertices at one place are one; all
/// of them are named.
///
/// - `thinner_than_mm`: walls below it are thin; None looks for none.
#[pyfunction]
#[pyo3(signature = (mesh, *, thinner_than_mm=None, progress=None, cancel=None))]
pub(crate) fn faults<'py>(
    py: Python<'py>,
    mesh: &Mesh,
    thinner_than_mm: Option<f64>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyDict>> {
    let watch = Watch::new(py, progress, cancel)?;
    if let Some(mm) = thinner_than_mm
        && !(mm > 0.0 && mm.is_finite())
    {
        let message = format!("thinner_than_mm is {mm}; give a length above 0, or None");
        return Err(errors::argument(py, &message));
    }
    let parts = mesh.parts();
    let found = detached(py, watch, move |task| {
        bonemesh::find_faults(&parts.mesh()?, thinner_than_mm, task)
    })?;
    let arrays = PyDict::new(py);
    for (name, edges) in [
        ("open_edges", found.open_edges),
        ("non_manifold_edges", found.non_manifold_edges),
        ("inconsistent_edges", found.inconsistent_edges),
    ] {
        arrays.set_item(name, owned(py, rows(edges))?)?;
    }
    for (name, numbers) in [
        ("non_manifold_vertices", found.non_manifold_vertices),
        ("thin_vertices", found.thin_vertices),
        ("degenerate_triangles", found.degenerate_triangles),
        ("intersecting_triangles", found.intersecting_triangles),
    ] {
        arrays.set_item(name, owned(py, Array1::from(numbers))?)?;
    }
    Ok(arrays)
}
