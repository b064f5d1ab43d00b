//! The topology of a mesh.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::mesh::Mesh;
use crate::report::dict;

/// What can be said of a mesh: is it watertight, manifold, of how many parts, how large?
///
/// The dict is what `bonemesh check --json` prints.
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
    let report = detached(py, watch, move |task| bonemesh::check(&parts.mesh()?, task))?;
    dict(py, &crate::report::json(&report))
}
