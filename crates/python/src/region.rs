//! The region of interest.

use bonemesh::{RegionRequest, RoiMethod, ThicknessMm};
use pyo3::prelude::*;

use crate::arrays::Input;
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::mesh::Mesh;
use crate::options::Threads;

/// Take the region under selected vertices out of a mesh, as a `Mesh` of its own.
///
/// - `selected_vertices`: indices into `mesh.vertices`, in any order.
/// - `thickness_mm`: how deep the region reaches below the selection.
/// - `method`: "thesis", slice by slice along one normal; the mesh must consist of slices.
///
/// `Mesh.report` says how many points were found behind the selection, and the rest as
/// `bonemesh roi --json` prints it.
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
