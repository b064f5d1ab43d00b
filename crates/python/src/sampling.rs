//! Samples of a cloud, and how alike its normals are.

use std::num::NonZeroUsize;

use bonemesh::{NormalsIn, Percent, Sampler, Sampling, SimilarityRanges};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays::owned;
use crate::cancel::Cancel;
use crate::cloud::cloud;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::lattice::Spacing;
use crate::options::{self, Threads};

/// More neighbours or pixels than any cloud has a use for.
const MOST: i128 = u32::MAX as i128;

/// Indices of the points to keep of a cloud, `(K,) uint32`, ascending.
///
/// - `percent`: above 0 and at most 100; exactly so many are kept, but for "thesis-uniform", which rounds
///   down within every ten, and "thesis-targeted", which takes none.
/// - `sampler`: "uniform", at even steps along each contour; "targeted", denser where contours bend; "random",
///   decided by `seed`; "thesis-uniform" and "thesis-targeted", the published ones.
/// - `grid_px`, `cutoffs`, `percentages`: of "thesis-targeted": cells of so many pixels a side (10); the
///   similarities of normals from which its four ranges begin (0, 0.4, 0.6, 0.8); the percentages kept of them, of the
///   highest range first (10, 25, 50, 75).
/// - `spacing_mm` as in `tetrahedralize`.
#[pyfunction]
#[pyo3(signature = (
    points, *, percent=None, sampler="uniform", seed=0, spacing_mm=None, grid_px=None, cutoffs=None,
    percentages=None, threads=None, progress=None, cancel=None
))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn sample<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    percent: Option<f64>,
    sampler: &str,
    seed: i128,
    spacing_mm: Option<Spacing>,
    grid_px: Option<i128>,
    cutoffs: Option<[f64; 4]>,
    percentages: Option<[f64; 4]>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Bound<'py, PyArray1<u32>>> {
    let watch = Watch::new(py, progress, cancel)?;
    let ranges = ranges(py, grid_px, cutoffs, percentages)?;
    let chosen = chosen(py, sampler, percent, seed, ranges)?;
    let sampling = chosen.ok_or_else(|| {
        let message = "percent is None; give a number above 0 and up to 100";
        errors::argument(py, message)
    })?;
    let cloud = cloud(points, spacing_mm)?;
    let threads = Threads::count(threads);
    let kept = detached(py, watch, move |task| {
        let pool = bonemesh::pool(threads)?;
        Ok(pool.install(|| bonemesh::sample(&cloud, &sampling, task))?)
    })?;
    owned(py, kept.into())
}

/// How many cells of "thesis-targeted", each of one slice, have a similarity in each of the four ranges, the lowest
/// first.
///
/// The arguments are those of `sample`.
#[pyfunction]
#[pyo3(signature = (
    points, *, grid_px=None, cutoffs=None, spacing_mm=None, threads=None, progress=None, cancel=None
))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn similarity_ranges(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    grid_px: Option<i128>,
    cutoffs: Option<[f64; 4]>,
    spacing_mm: Option<Spacing>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<[usize; 4]> {
    let watch = Watch::new(py, progress, cancel)?;
    let ranges = ranges(py, grid_px, cutoffs, None)?.unwrap_or_default();
    let cloud = cloud(points, spacing_mm)?;
    let threads = Threads::count(threads);
    detached(py, watch, move |task| {
        let pool = bonemesh::pool(threads)?;
        Ok(pool.install(|| bonemesh::count_ranges(&cloud, &ranges, task))?)
    })
}

/// How alike the normals of points are that share a slice: 1 for a straight line.
///
/// The mean over all ordered pairs of 1 - angle / (largest angle there can be). `normals` is "plane": in the plane of the
/// slice, without a sign, from 5 neighbours; or "space": as published, from 30 neighbours, where the slice's own normal
/// comes out, up or down by chance. `neighbours`, the point itself included, changes their number.
#[pyfunction]
#[pyo3(signature = (
    points, *, normals="plane", neighbours=None, spacing_mm=None, threads=None, progress=None, cancel=None
))]
#[allow(clippy::too_many_arguments)] // keyword arguments, as Python has them
pub(crate) fn normal_similarity(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    normals: &str,
    neighbours: Option<i128>,
    spacing_mm: Option<Spacing>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<f64> {
    let watch = Watch::new(py, progress, cancel)?;
    let kind = match normals {
        "plane" => NormalsIn::Plane,
        "space" => NormalsIn::Space,
        other => {
            let message = format!("normals is {other:?}; give \"plane\" or \"space\"");
            return Err(errors::argument(py, &message));
        }
    };
    let neighbours = match neighbours {
        None => None,
        Some(count) if (1..=MOST).contains(&count) => NonZeroUsize::new(count as usize),
        Some(count) => {
            let message = format!("neighbours is {count}; give a whole number from 1, or None");
            return Err(errors::argument(py, &message));
        }
    };
    let cloud = cloud(points, spacing_mm)?;
    let threads = Threads::count(threads);
    detached(py, watch, move |task| {
        let pool = bonemesh::pool(threads)?;
        let similarity = || bonemesh::normal_similarity(&cloud, kind, neighbours, task);
        Ok(pool.install(similarity)?)
    })
}

/// A sampler and what was said beside it; `None` where all points are kept.
pub(crate) fn chosen(
    py: Python<'_>,
    sampler: &str,
    percent: Option<f64>,
    seed: i128,
    ranges: Option<SimilarityRanges>,
) -> PyResult<Option<Sampling>> {
    let percent = percent.map(Percent::new).transpose();
    let percent = percent.map_err(|e| errors::unusable(py, e))?;
    let sampler: Sampler = sampler.parse().map_err(|e| errors::unusable(py, e))?;
    let seed = options::seed(py, seed)?;
    let chosen = Sampling::chosen(sampler, percent, seed, ranges);
    chosen.map_err(|e| errors::unusable(py, e))
}

/// The ranges of "thesis-targeted", if anything is said of them.
fn ranges(
    py: Python<'_>,
    grid_px: Option<i128>,
    cutoffs: Option<[f64; 4]>,
    percentages: Option<[f64; 4]>,
) -> PyResult<Option<SimilarityRanges>> {
    if (grid_px, cutoffs, percentages) == (None, None, None) {
        return Ok(None);
    }
    let grid_px = match grid_px {
        None => SimilarityRanges::GRID_PX,
        Some(pixels) if (1..=MOST).contains(&pixels) => pixels as u32,
        Some(pixels) => {
            let message = format!("grid_px is {pixels}; give a whole number of pixels from 1");
            return Err(errors::argument(py, &message));
        }
    };
    let ranges = SimilarityRanges::new(
        grid_px,
        cutoffs.unwrap_or(SimilarityRanges::CUTOFFS),
        percentages.unwrap_or(SimilarityRanges::PERCENTAGES),
    );
    ranges.map(Some).map_err(|e| errors::unusable(py, e))
}
