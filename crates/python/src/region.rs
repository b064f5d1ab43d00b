//! The region of interest.

use bonemesh::{
    ClearanceMm, Direction, Mirror, RegionRequest, RegionResult, RoiMethod, ThicknessMm,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::arrays::Input;
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::mesh::Mesh;
use crate::mirror::{Choice, plain};
use crate::options::Threads;

/// Take the region under selected vertices out of a mesh, as a `Mesh` of its own.
///
/// - `selected_vertices`: indices into `mesh.vertices`, in any order.
/// - `thickness_mm`: how deep the region reaches below the selection, or how thick a plate is.
/// - `method`: "solid", the bone under the selection, cut out: closed, printable, its front the mesh's
///   own triangles; or "thesis", slice by slice along one normal; the mesh must consist of slices.
/// - `direction` of a solid: "normal", along the surface's own normals to the far side of the bone;
///   "through", straight through all that lies behind; "outward", the plate that lies on the bone; or
///   three numbers, straight along this direction to the far side.
/// - `clearance_mm`: the gap between bone and plate, 0.2 if None.
/// - `hidden`: take selected pieces, too, that lie hidden behind others.
/// - `mirror`: take what lies on the other side of a plane in place of the selection; "auto" (the mesh's
///   own plane of symmetry), "x", "y", "z" (across that axis, through the middle of the mesh's box),
///   `(nx, ny, nz, d)` or three places.
/// - `mirror_back`: put what was taken from the other side where the selection is.
/// - `separate`: one solid for each piece of the selection that does not touch the others, as a list, the
///   largest piece first.
///
/// `Mesh.report` says what was done, as `bonemesh roi --json` prints it.
#[pyfunction]
#[pyo3(signature = (mesh, selected_vertices, *, thickness_mm, method="solid", direction=None, clearance_mm=None, hidden=false, mirror=None, mirror_back=false, separate=false, threads=None, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments, clippy::fn_params_excessive_bools)] // keyword arguments, as Python has them
pub(crate) fn select_roi(
    py: Python<'_>,
    mesh: &Mesh,
    selected_vertices: &Bound<'_, PyAny>,
    thickness_mm: f64,
    method: &str,
    direction: Option<Towards>,
    clearance_mm: Option<f64>,
    hidden: bool,
    mirror: Option<Choice>,
    mirror_back: bool,
    separate: bool,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Regions> {
    let watch = Watch::new(py, progress, cancel)?;
    let selected = Input::new("selected_vertices", selected_vertices)?.indices()?;
    if mirror_back && mirror.is_none() {
        let message = "mirror_back means nothing without mirror; give a plane, such as \"auto\"";
        return Err(errors::argument(py, message));
    }
    let clearance = clearance_mm.map(ClearanceMm::new).transpose();
    let request = RegionRequest {
        thickness: ThicknessMm::new(thickness_mm).map_err(|e| errors::unusable(py, e))?,
        method: method
            .parse::<RoiMethod>()
            .map_err(|e| errors::unusable(py, e))?,
        direction: direction.map_or(Direction::Normal, |towards| towards.0),
        clearance: clearance
            .map_err(|e| errors::unusable(py, e))?
            .unwrap_or_default(),
        with_hidden: hidden,
        mirror: mirror.map(|plane| Mirror {
            plane: plane.0,
            back: mirror_back,
        }),
        threads: Threads::count(threads),
    };
    let parts = mesh.parts();
    detached(py, watch, move |task| {
        let of = |region: RegionResult| Mesh::of(region.mesh, &region.report);
        if separate {
            let regions = bonemesh::select_rois(&parts.mesh()?, &selected, &request, task)?;
            let regions: Result<Vec<Mesh>, _> = regions.into_iter().map(of).collect();
            return Ok(Regions::Each(regions?));
        }
        let region = bonemesh::select_roi(&parts.mesh()?, &selected, &request, task)?;
        Ok(Regions::All(of(region)?))
    })
}

/// One mesh of the whole selection, or one of each piece.
#[derive(IntoPyObject)]
pub(crate) enum Regions {
    All(Mesh),
    Each(Vec<Mesh>),
}

/// The thickness (mm) of the bone under selected vertices: a dict with min, median and max, or None where
/// nothing lies opposite within 40 mm.
#[pyfunction]
#[pyo3(signature = (mesh, selected_vertices, *, progress=None, cancel=None))]
pub(crate) fn local_thickness<'py>(
    py: Python<'py>,
    mesh: &Mesh,
    selected_vertices: &Bound<'_, PyAny>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let watch = Watch::new(py, progress, cancel)?;
    let selected = Input::new("selected_vertices", selected_vertices)?.indices()?;
    let parts = mesh.parts();
    let found = detached(py, watch, move |task| {
        Ok(bonemesh::local_thickness(&parts.mesh()?, &selected, task)?)
    })?;
    found
        .map(|found| {
            let dict = PyDict::new(py);
            dict.set_item("min_mm", found.least_mm)?;
            dict.set_item("median_mm", found.median_mm)?;
            dict.set_item("max_mm", found.largest_mm)?;
            Ok(dict)
        })
        .transpose()
}

/// Which way a solid is cut: a name or three numbers.
pub(crate) struct Towards(Direction);

impl FromPyObject<'_, '_> for Towards {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let py = value.py();
        let direction = if value.is_instance_of::<PyString>() {
            value.extract::<String>()?.parse()
        } else {
            match plain(&value)?.extract::<[f64; 3]>() {
                Ok(numbers) => Direction::along(numbers),
                Err(_) => value.repr()?.to_string().parse(),
            }
        };
        direction.map(Self).map_err(|e| errors::unusable(py, e))
    }
}
