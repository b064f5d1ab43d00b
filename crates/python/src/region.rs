//! The region of interest.

use bonemesh::{RegionRequest, RoiMethod, ThicknessMm};
use pyo3::prelude::*;

use crate::arrays::Input;
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::mesh::Mesh;
use crate::options::Threads;

/// Take the region under selected vertices out of a mesh, as a mesh of its own.
#[pyfunction]
#[pyo3(signature = (mesh, selected_vertices, *, thickness_mm, method="thesis", threads=None, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn select_roi(
    py: Python<'_>,
    mesh: &Mesh,
    selected_vertices: &Bound<'_, PyAny>,
    thickness_mm: f64,
    method: &str,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let watch = Watch::new(py, progress, cancel)?;
    let selected = Input::new("selected_vertices", selected_vertices)?.indices()?;
    let request = RegionRequest {
        thickness: ThicknessMm::new(thickness_mm).map_err(|e| errors::unusable(py, e))?,
        method: method
            .parse::<RoiMethod>()
            .map_err(|e| errors::unusable(py, e))?,
        threads: Threads::count(threads),
    };
    let parts = mesh.parts();
    detached(py, watch, move |task| {
        let region = bonemesh::select_roi(&parts.mesh()?, &selected, &request, task)?;
        Mesh::of(region.mesh, &region.report)
    })
}
