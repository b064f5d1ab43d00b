//! Lines along which a plane cuts a mesh.

use bonemesh::{Outline, Plane};
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::arrays::{owned, rows};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::mesh::Mesh;
use crate::mirror::plain;

/// The lines along which a plane cuts a mesh: each `(N, 3) float64`, mm; a closed one ends where it begins.
///
/// - `point`, `normal`: a place in the plane (mm) and the direction that stands on it.
///
/// Of a closed mesh all lines are closed. Seen against the normal they run counter-clockwise around the
/// body and clockwise around what is hollow. Vertices in the plane count as just above it.
#[pyfunction]
#[pyo3(signature = (mesh, point, normal, *, progress=None, cancel=None))]
pub(crate) fn section<'py>(
    py: Python<'py>,
    mesh: &Mesh,
    point: &Bound<'py, PyAny>,
    normal: &Bound<'py, PyAny>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
    let watch = Watch::new(py, progress, cancel)?;
    let (point, normal) = (vector("point", point)?, vector("normal", normal)?);
    let offset = (0..3).map(|axis| point[axis] * normal[axis]).sum();
    let plane = Plane::new(normal, offset).map_err(|e| errors::unusable(py, e))?;
    let parts = mesh.parts();
    let outlines = detached(py, watch, move |task| {
        bonemesh::pool(None)?.install(|| Ok(bonemesh::section(parts.kept_mesh()?, &plane, task)?))
    })?;
    let lines = outlines
        .into_iter()
        .map(|outline| owned(py, rows(ended(outline))));
    lines.collect()
}

/// The points of a line; of a closed one with the first at the end again.
fn ended(outline: Outline) -> Vec<[f64; 3]> {
    let mut points_mm = outline.points_mm;
    if outline.is_closed {
        points_mm.extend(points_mm.first().copied());
    }
    points_mm
}

/// Three finite numbers.
fn vector(name: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    let numbers = plain(value)?.extract::<[f64; 3]>().ok();
    let numbers = numbers.filter(|numbers| numbers.iter().all(|c| c.is_finite()));
    numbers.map_or_else(
        || {
            let message = format!("{name} is {}; give three numbers x, y, z", value.repr()?);
            Err(errors::argument(value.py(), &message))
        },
        Ok,
    )
}
