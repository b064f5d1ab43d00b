//! Delaunay tetrahedra of points, and the surface of the small ones.

use bonemesh::{Points, SurfaceError};
use numpy::PyArray2;
use pyo3::prelude::*;
use serde_json::json;

use crate::arrays::{Input, owned, rows};
use crate::cancel::Cancel;
use crate::cloud::cloud;
use crate::detach::{Watch, detached};
use crate::lattice::{PointSet, Spacing, point_set};
use crate::mesh::Mesh;
use crate::options::Threads;

/// The Delaunay tetrahedra of points, `(M, 4) uint32` indices, each positively oriented.
///
/// Decided exactly, without flat cells. Whole numbers are lattice coordinates with steps of
/// `spacing_mm` (1 without it). Floating-point numbers are free points in mm or, with `spacing_mm`,
/// points on a lattice with these steps, whose ties rounding would hide.
#[pyfunction]
#[pyo3(signature = (points, *, spacing_mm=None, threads=None, progress=None, cancel=None))]
pub(crate) fn tetrahedralize<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    spacing_mm: Option<Spacing>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyArray2<u32>>> {
    let watch = Watch::new(py, progress, cancel)?;
    let points = point_set(&Input::new("points", points)?, spacing_mm)?;
    let threads = Threads::count(threads);
    let cells = detached(py, watch, move |task| {
        let points = match &points {
            PointSet::Free(points_mm) => Points::Free(points_mm),
            PointSet::OnLattice(lattice) => Points::Lattice {
                coordinates: &lattice.coordinates,
                gram: lattice.frame_from_lattice.gram(),
            },
        };
        let found = bonemesh::pool(threads)?.install(|| bonemesh::tetrahedralize(points, task));
        Ok(found.map_err(SurfaceError::from)?.cells)
    })?;
    owned(py, rows(cells))
}

/// The outward surface of the Delaunay tetrahedra whose circumradius is at most `alpha_mm`.
///
/// `spacing_mm` as in `tetrahedralize`.
#[pyfunction]
#[pyo3(signature = (points, alpha_mm, *, spacing_mm=None, threads=None, progress=None, cancel=None))]
pub(crate) fn alpha_surface(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    alpha_mm: f64,
    spacing_mm: Option<Spacing>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let watch = Watch::new(py, progress, cancel)?;
    let cloud = cloud(points, spacing_mm)?;
    let threads = Threads::count(threads);
    detached(py, watch, move |task| {
        bonemesh::pool(threads)?.install(|| {
            let surface = bonemesh::alpha_surface(&cloud, alpha_mm, task)?;
            let topology = bonemesh::check_topology(&surface.mesh, task)?;
            let mut report =
                serde_json::to_value(&topology).expect("a plain report: anything else is a bug");
            report["alpha_mm"] = json!(alpha_mm);
            report["tetrahedra"] = json!(surface.tetrahedra);
            Mesh::of(surface.mesh, &report)
        })
    })
}
