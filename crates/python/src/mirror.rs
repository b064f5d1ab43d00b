//! Planes, and meshes mirrored in them.

use bonemesh::{Plane, PlaneChoice};
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::mesh::Mesh;
use crate::options::Threads;

/// Mirror a mesh in a plane; what was outside stays outside.
///
/// - `plane`: `(nx, ny, nz, d)`, the places p with n · p = d in mm; three places; "x", "y" or "z", across
///   that axis of the patient through the middle of the mesh's box; or "auto", the mesh's own plane of
///   symmetry.
///
/// `Mesh.report` has the plane.
#[pyfunction]
#[pyo3(signature = (mesh, plane, *, threads=None, progress=None, cancel=None))]
pub(crate) fn mirror(
    py: Python<'_>,
    mesh: &Mesh,
    plane: Choice,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let watch = Watch::new(py, progress, cancel)?;
    let parts = mesh.parts();
    let threads = Threads::count(threads);
    detached(py, watch, move |task| {
        let mesh = parts.mesh()?;
        let chosen = plane.0.choose(&mesh, threads, task)?;
        Mesh::of(mesh.mirrored(&chosen.plane), &chosen.report)
    })
}

/// The plane in which a mesh is most like its mirror image: `(nx, ny, nz, d)`, the places p with
/// n · p = d in mm.
#[pyfunction]
#[pyo3(signature = (mesh, *, threads=None, progress=None, cancel=None))]
pub(crate) fn symmetry_plane(
    py: Python<'_>,
    mesh: &Mesh,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<(f64, f64, f64, f64)> {
    let watch = Watch::new(py, progress, cancel)?;
    let parts = mesh.parts();
    let threads = Threads::count(threads);
    let chosen = detached(py, watch, move |task| {
        PlaneChoice::Auto.choose(&parts.mesh()?, threads, task)
    })?;
    let [x, y, z] = chosen.report.normal;
    Ok((x, y, z, chosen.report.offset_mm))
}

/// A plane: a name, four numbers or three places.
#[derive(Clone, Copy)]
pub(crate) struct Choice(pub(crate) PlaneChoice);

impl FromPyObject<'_, '_> for Choice {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let py = value.py();
        let refused = |reason: String| errors::argument(py, &reason);
        if value.is_instance_of::<PyString>() {
            let choice = value.extract::<String>()?.parse();
            return choice.map(Self).map_err(refused);
        }
        let plain = plain(&value)?;
        let plane = if let Ok([x, y, z, offset]) = plain.extract::<[f64; 4]>() {
            Plane::new([x, y, z], offset)
        } else if let Ok(places) = plain.extract::<[[f64; 3]; 3]>() {
            Plane::through(places)
        } else {
            let what = value.repr().map(|r| r.to_string()).unwrap_or_default();
            return Err(refused(format!(
                "the plane is {what}; give \"auto\", \"x\", \"y\", \"z\", (nx, ny, nz, d) or three places (x, y, z)"
            )));
        };
        let plane = plane.map_err(|e| refused(e.to_string()))?;
        Ok(Self(PlaneChoice::Given(plane)))
    }
}

/// The value as lists of numbers, if it is an array.
pub(crate) fn plain<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    if value.hasattr("tolist")? {
        value.call_method0("tolist")
    } else {
        Ok(value.clone())
    }
}
