//! How far points lie from the bone of a phantom.

use std::sync::Arc;

use bonemesh_phantom::{BoneSurface, Nearest, Phantom, PhantomError};
use ndarray::Array1;
use numpy::{Element, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Input, owned, rows};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::options::{self, Threads};

/// Points of a surface asked for at once.
const MOST_SAMPLES: i128 = 100_000_000;

/// The bone surface of a phantom that is a body: what a mesh of it is measured against.
///
/// `name` is "sphere-shell", "tube", "femur", "box-with-hole" or "head".
#[pyclass(frozen, module = "bonemesh")]
pub(crate) struct PhantomSurface {
    surface: Arc<BoneSurface>,
    name: &'static str,
}

#[pymethods]
impl PhantomSurface {
    #[new]
    fn new(py: Python<'_>, name: &str) -> PyResult<Self> {
        let phantom: Phantom = name
            .parse()
            .map_err(|e: PhantomError| errors::unusable(py, e))?;
        let surface = BoneSurface::of(phantom).ok_or_else(|| {
            let message = format!(
                "{name} is drawn in pixels and has no surface in mm; choose a phantom that is a body, such as tube"
            );
            errors::argument(py, &message)
        })?;
        Ok(Self {
            surface: Arc::new(surface),
            name: phantom.name(),
        })
    }

    /// Names of the parts of the surface, which `nearest` numbers.
    #[getter]
    fn structures(&self) -> Vec<&'static str> {
        self.surface.structures()
    }

    /// The nearest point of the surface to each of `points` `(N, 3)`, mm: a dict of arrays.
    ///
    /// - `distance_mm`: how far it is, negative for points in bone; right to 0.005 mm up to 1 mm.
    /// - `point_mm`, `normal`: the nearest point, and the direction out of the bone there.
    /// - `crease`: whether the surface turns by more than 25 degrees within `crease_mm` of it.
    /// - `wall_mm`, `gap_mm`: bone straight below it, and the way to the next bone; 20 at most.
    /// - `air_mm`: the way straight out to air, 20 at most; `outside_hu`: what touches the bone there.
    /// - `structure`: number of the part of the surface, see `structures`.
    #[pyo3(signature = (points, *, crease_mm=1.2, threads=None, progress=None, cancel=None))]
    #[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
    fn nearest<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        crease_mm: f64,
        threads: Option<Threads>,
        progress: Option<Py<PyAny>>,
        cancel: Option<&Cancel>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let watch = Watch::new(py, progress, cancel)?;
        let points = Input::new("points", points)?.vectors()?;
        if !(crease_mm > 0.0 && crease_mm <= 20.0) {
            let message = format!("crease_mm is {crease_mm}; give a length above 0 and up to 20");
            return Err(errors::argument(py, &message));
        }
        let (surface, threads) = (Arc::clone(&self.surface), Threads::count(threads));
        let found = detached(py, watch, move |task| {
            let pool = bonemesh::pool(threads)?;
            Ok(pool.install(|| surface.nearest_of_all(&points, crease_mm, task))?)
        })?;
        let answer = PyDict::new(py);
        answer.set_item("distance_mm", column(py, &found, |n| n.distance_mm)?)?;
        answer.set_item("point_mm", triples(py, &found, |n| n.point_mm)?)?;
        answer.set_item("normal", triples(py, &found, |n| n.normal)?)?;
        answer.set_item("crease", column(py, &found, |n| n.crease)?)?;
        answer.set_item("wall_mm", column(py, &found, |n| n.wall_mm)?)?;
        answer.set_item("gap_mm", column(py, &found, |n| n.gap_mm)?)?;
        answer.set_item("air_mm", column(py, &found, |n| n.air_mm)?)?;
        answer.set_item("outside_hu", column(py, &found, |n| n.outside_hu)?)?;
        answer.set_item("structure", column(py, &found, |n| n.structure as u32)?)?;
        Ok(answer)
    }

    /// `count` points of the surface, each place as likely as any other: `(count, 3) float64`, mm.
    #[pyo3(signature = (count, *, seed=0, threads=None, progress=None, cancel=None))]
    fn samples<'py>(
        &self,
        py: Python<'py>,
        count: &Bound<'py, PyAny>,
        seed: i128,
        threads: Option<Threads>,
        progress: Option<Py<PyAny>>,
        cancel: Option<&Cancel>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let watch = Watch::new(py, progress, cancel)?;
        let remedy = "give a whole number up to 100 million";
        let count = options::whole("count", &count.as_borrowed(), 0..=MOST_SAMPLES, remedy)?;
        let seed = options::seed(py, seed)?;
        let (surface, threads) = (Arc::clone(&self.surface), Threads::count(threads));
        let points = detached(py, watch, move |task| {
            let pool = bonemesh::pool(threads)?;
            Ok(pool.install(|| surface.samples(count as usize, seed, task))?)
        })?;
        owned(py, rows(points))
    }

    /// Volume of the bone in mm3, from cubes of `cell_mm`; with 0.25 right to 0.05 percent.
    #[pyo3(signature = (*, cell_mm=0.25, threads=None, progress=None, cancel=None))]
    fn volume_mm3(
        &self,
        py: Python<'_>,
        cell_mm: f64,
        threads: Option<Threads>,
        progress: Option<Py<PyAny>>,
        cancel: Option<&Cancel>,
    ) -> PyResult<f64> {
        let watch = Watch::new(py, progress, cancel)?;
        if !(0.05..=100.0).contains(&cell_mm) {
            let message = format!("cell_mm is {cell_mm}; give a length from 0.05 to 100");
            return Err(errors::argument(py, &message));
        }
        let (surface, threads) = (Arc::clone(&self.surface), Threads::count(threads));
        detached(py, watch, move |task| {
            let pool = bonemesh::pool(threads)?;
            Ok(pool.install(|| surface.volume_mm3(cell_mm, task))?)
        })
    }

    fn __repr__(&self) -> String {
        format!("<bonemesh.PhantomSurface of {}>", self.name)
    }
}

/// One number of each answer.
fn column<'py, T: Element>(
    py: Python<'py>,
    found: &[Nearest],
    of: impl Fn(&Nearest) -> T,
) -> PyResult<Bound<'py, numpy::PyArray1<T>>> {
    owned(py, found.iter().map(of).collect::<Array1<T>>())
}

/// One point or direction of each answer.
fn triples<'py>(
    py: Python<'py>,
    found: &[Nearest],
    of: impl Fn(&Nearest) -> [f64; 3],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    owned(py, rows(found.iter().map(of).collect()))
}
