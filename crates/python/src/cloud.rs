//! Point clouds and their neighbourhoods.

use bonemesh::{Error, Frame, PointCloud, Settings};
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::arrays::{Input, owned, rows};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::lattice::{Spacing, point_set};
use crate::options::{self, Threads, Threshold};
use crate::volume::Volume;

/// One point for each edge pixel of the bone, `(N, 3) float64` in mm, by slice, row and column.
///
/// `threshold_hu` is a number, "auto" or the name of a preset, as in `render`. `frame` is "patient" (DICOM LPS, pixel centres) or "image", the published method's: x = column
/// dx - dx/2, y = row dy - dy/2, z = slice location.
#[pyfunction]
#[pyo3(signature = (
    volume, *, threshold_hu=Threshold::skull(), sigma=1.0, frame="patient", threads=None, progress=None,
    cancel=None
))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn point_cloud<'py>(
    py: Python<'py>,
    volume: &Volume,
    threshold_hu: Threshold,
    sigma: f64,
    frame: &str,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let watch = Watch::new(py, progress, cancel)?;
    let frame = match frame {
        "patient" => Frame::Patient,
        "image" => Frame::Image,
        other => {
            let message = format!("frame is {other:?}; give \"patient\" or \"image\"");
            return Err(errors::argument(py, &message));
        }
    };
    let mut settings = Settings {
        canny: options::canny(py, sigma, None)?,
        threads: Threads::count(threads),
        ..Settings::default()
    };
    settings = settings.with_threshold(threshold_hu.0);
    let volume = volume.shared();
    let cloud = detached(py, watch, move |task| {
        bonemesh::point_cloud(&volume, &settings, frame, task)
    })?;
    owned(py, rows(cloud.points_mm().to_vec()))
}

/// Mean over all points of the mean distance to the `k` nearest neighbours (mm).
///
/// With `include_self` the point itself, at distance 0, is one of the `k`; without it, its distance
/// is left out of the mean, which then has `k - 1` terms. Fewer points than `k`: all there are.
/// `spacing_mm` as in `tetrahedralize`.
#[pyfunction]
#[pyo3(signature = (
    points, *, k=100, include_self=true, spacing_mm=None, threads=None, progress=None, cancel=None
))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn mean_neighbour_distance(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    k: i128,
    include_self: bool,
    spacing_mm: Option<Spacing>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<f64> {
    let watch = Watch::new(py, progress, cancel)?;
    let k = usize::try_from(k)
        .map_err(|_| errors::argument(py, &format!("k is {k}; give a number of neighbours")))?;
    let cloud = cloud(points, spacing_mm)?;
    let threads = Threads::count(threads);
    detached(py, watch, move |task| {
        let pool = bonemesh::pool(threads)?;
        let mean = || bonemesh::mean_neighbour_distance(&cloud, k, include_self, task);
        Ok(pool.install(mean)?)
    })
}

/// The cloud of an array of points: see [`point_set`].
pub(crate) fn cloud(points: &Bound<'_, PyAny>, spacing: Option<Spacing>) -> PyResult<PointCloud> {
    let input = Input::new("points", points)?;
    let cloud = point_set(&input, spacing)?
        .into_cloud()
        .map_err(Error::from);
    cloud.map_err(|e| errors::raised(points.py(), &e))
}
