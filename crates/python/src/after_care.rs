//! What is done to finished meshes: holes, islands, cavities, smoothing, fewer triangles.

use bonemesh::{AfterCare, Cavities, Decimation, Holes, Islands};
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::mesh::Mesh;

/// Which islands are kept: "largest", the least volume in mm3, or places in mm.
#[derive(Clone)]
pub(crate) struct Kept(pub(crate) Islands);

/// Which cavities are filled: "all", or the largest volume in mm3.
#[derive(Clone, Copy)]
pub(crate) struct Filled(pub(crate) Cavities);

/// Which holes are filled: "all", or the longest extent in mm.
#[derive(Clone, Copy)]
pub(crate) struct Closed(pub(crate) Holes);

impl FromPyObject<'_, '_> for Kept {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        if let Ok(places) = value.extract::<Vec<[f64; 3]>>() {
            return Ok(Self(Islands::At(places)));
        }
        let mm3 = word_or_number(value, "largest", "islands", "volume in mm3")?;
        Ok(Self(mm3.map_or(Islands::Largest, Islands::AtLeastMm3)))
    }
}

impl FromPyObject<'_, '_> for Filled {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let mm3 = word_or_number(value, "all", "cavities", "volume in mm3")?;
        Ok(Self(mm3.map_or(Cavities::All, Cavities::AtMostMm3)))
    }
}

impl FromPyObject<'_, '_> for Closed {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let mm = word_or_number(value, "all", "holes", "length in mm")?;
        Ok(Self(mm.map_or(Holes::All, Holes::AtMostMm)))
    }
}

/// A number, or `None` for the word.
fn word_or_number(
    value: Borrowed<'_, '_, PyAny>,
    word: &str,
    name: &str,
    unit: &str,
) -> PyResult<Option<f64>> {
    if !value.is_instance_of::<PyString>() {
        return value.extract().map(Some);
    }
    let text = value.extract::<String>()?;
    if text == word {
        return Ok(None);
    }
    let message = format!("{name} is '{text}'; give \"{word}\" or a {unit}");
    Err(errors::argument(value.py(), &message))
}

/// The mesh after `care`; its report says what was done.
fn cared_for(
    py: Python<'_>,
    mesh: &Mesh,
    care: AfterCare,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let watch = Watch::new(py, progress, cancel)?;
    let parts = mesh.parts();
    detached(py, watch, move |task| {
        let (mesh, report) = bonemesh::care_for(parts.mesh()?, &care, task)?;
        Mesh::of(mesh, &report)
    })
}

/// Fill "all" holes of an open mesh, or those no longer than a length in mm, with triangles over their
/// rims. A hole that cannot be filled soundly stays: `report["largest_left_holes"]` says where and why.
#[pyfunction]
#[pyo3(signature = (mesh, *, holes=Closed(Holes::All), progress=None, cancel=None))]
pub(crate) fn fill_holes(
    py: Python<'_>,
    mesh: &Mesh,
    holes: Closed,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let care = AfterCare {
        holes: Some(holes.0),
        ..AfterCare::default()
    };
    cared_for(py, mesh, care, progress, cancel)
}

/// Take out triangles without area, and those that lie on others with the same corners, without opening the
/// surface. `report["removed_degenerate"]` and `report["removed_doubled"]` count them.
#[pyfunction]
#[pyo3(signature = (mesh, *, progress=None, cancel=None))]
pub(crate) fn clean(
    py: Python<'_>,
    mesh: &Mesh,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let care = AfterCare {
        clean: true,
        ..AfterCare::default()
    };
    cared_for(py, mesh, care, progress, cancel)
}

/// Turn over triangles that face another way than their neighbours, and closed parts that are inside out.
#[pyfunction]
#[pyo3(signature = (mesh, *, progress=None, cancel=None))]
pub(crate) fn face_outward(
    py: Python<'_>,
    mesh: &Mesh,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let care = AfterCare {
        face_outward: true,
        ..AfterCare::default()
    };
    cared_for(py, mesh, care, progress, cancel)
}

/// Keep the "largest" island, all of at least a volume in mm3, or the bones at a list of places (mm),
/// each with its cavities.
#[pyfunction]
#[pyo3(signature = (mesh, *, islands, progress=None, cancel=None))]
pub(crate) fn keep_islands(
    py: Python<'_>,
    mesh: &Mesh,
    islands: Kept,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let care = AfterCare {
        islands: Some(islands.0),
        ..AfterCare::default()
    };
    cared_for(py, mesh, care, progress, cancel)
}

/// Fill "all" cavities inside the bone, or those of at most a volume in mm3, with what floats in them.
#[pyfunction]
#[pyo3(signature = (mesh, *, cavities=Filled(Cavities::All), progress=None, cancel=None))]
pub(crate) fn fill_cavities(
    py: Python<'_>,
    mesh: &Mesh,
    cavities: Filled,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let care = AfterCare {
        cavities: Some(cavities.0),
        ..AfterCare::default()
    };
    cared_for(py, mesh, care, progress, cancel)
}

/// Smooth without shrinking; no vertex moves further than `tolerance_mm`, and a mesh that passes
/// through itself nowhere still does not.
#[pyfunction]
#[pyo3(signature = (mesh, *, tolerance_mm, progress=None, cancel=None))]
pub(crate) fn smooth(
    py: Python<'_>,
    mesh: &Mesh,
    tolerance_mm: f64,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let care = AfterCare {
        smooth_mm: Some(tolerance_mm),
        ..AfterCare::default()
    };
    cared_for(py, mesh, care, progress, cancel)
}

/// Take triangles away where that moves the surface least: until `triangles` are left, or as long as
/// it moves no further than `error_mm`. A closed manifold stays one and does not pass through itself.
#[pyfunction]
#[pyo3(signature = (mesh, *, triangles=None, error_mm=None, progress=None, cancel=None))]
pub(crate) fn decimate(
    py: Python<'_>,
    mesh: &Mesh,
    triangles: Option<usize>,
    error_mm: Option<f64>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    if triangles.is_none() && error_mm.is_none() {
        let message = "neither triangles nor error_mm is given; give at least one of them";
        return Err(errors::argument(py, message));
    }
    let care = AfterCare {
        decimation: Decimation {
            triangles,
            error_mm,
        },
        ..AfterCare::default()
    };
    cared_for(py, mesh, care, progress, cancel)
}
