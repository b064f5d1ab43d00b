//! From a folder or a volume to the mesh of its bone.

use std::path::PathBuf;
use std::sync::Arc;

use bonemesh::{AfterCare, AlphaRule, Decimation, Error, Method, Rendered, Settings, Task};
use pyo3::prelude::*;

use crate::after_care::{Closed, Filled, Kept};
use crate::cancel::Cancel;
use crate::detach::{Watch, detached};
use crate::errors;
use crate::mesh::Mesh;
use crate::options::{self, Alpha, Choice, Crop, Threads, Threshold};
use crate::sampling;
use crate::volume::Volume;

/// What is rendered.
enum Source {
    Folder(PathBuf),
    Volume(Arc<bonemesh::Volume>),
}

/// Names of the methods that `render` has, in the order in which they are offered.
#[pyfunction]
pub(crate) fn methods() -> Vec<&'static str> {
    Method::ALL.map(Method::name).to_vec()
}

/// Make the surface of the bone in a CT folder or volume: `Mesh` in patient millimetres (LPS).
///
/// - `threshold_hu`: bone is strictly above it; 350 suits skulls, 600 the cortical bone of limbs.
///   "auto" finds it in the volume (or "edges", "multi-otsu", "otsu", each in its way), a name ("skull",
///   "cortical", "thin-bone", "teeth") takes it from the literature; `report["threshold_reason"]` says how.
/// - `local_leeway_hu`: lets the threshold follow the mean around each voxel by up to so many HU, such
///   as 150, which keeps thin bone and narrow gaps and lets in more noise; None holds it everywhere.
/// - `method`: "isosurface", the closed surface between voxels; "labelled", the closed boundary of
///   Delaunay tetrahedra, each bone or not by what lies in it, for thick slices; or "alpha", the
///   published method, the boundary of the Delaunay tetrahedra of edge points with a circumradius up
///   to alpha. For study, with limits that the library's docs name: "ball-pivoting", "poisson",
///   "tetrahedra" (their convex hull), "planar". None takes "isosurface", or "alpha" with `alpha_mm`
///   or `sample_percent`.
/// - `sigma`: Canny's smoothing in pixels.
/// - `series`: UID or number (1 is the largest) where a folder holds several.
/// - `one_series`: all slices that fit together are one series, whatever UIDs they name.
/// - `crop`: "I0:I1,J0:J1,K0:K1" or three pairs: columns, rows, slices, from 0, ends not included.
/// - `sample_percent`, `sampler`, `seed`: use only a part of the points, as `sample` does; None uses all, but with
///   "thesis-targeted", which has percentages of its own.
/// - `alpha_mm`: largest circumradius; None takes the mean distance to 100 neighbours, "auto" the one
///   with which the mesh has the volume of the bone's voxels (`report["alpha_coefficient"]`).
/// - `radii_mm`: of ball pivoting; None takes 3 and 6 times the mean distance to the nearest point.
/// - `depth`, `scale`: Poisson's cube has 2**depth cells a side (3 to 8) and is `scale` times as
///   large as the points.
/// - `true_edges`: an isosurface or labelled one lies at the true edges of the bone, else where
///   the grey equals the threshold.
/// - `keep_table`: keeps the scanner's table and headrest, which an isosurface and a labelled one
///   leave out where they touch no bone (`report["left_out_table"]`).
/// - `damp_metal`: damps the streaks of metal before anything else is done; `report["metal"]` tells of
///   metal either way, None if there is none.
/// - `holes`: "all", or the longest extent (mm) of the holes filled; None fills none.
/// - `islands`: "largest", the least volume (mm3) of the islands kept, or a list of places (mm, x y z)
///   whose bones are kept; None keeps all but specks of an isosurface or a labelled one, of less than 1 mm3 (`report["left_out_specks"]`).
/// - `cavities`: "all", or the largest volume (mm3) of the cavities filled; None fills none.
/// - `smooth_mm`: smooth and move no vertex further than this; None does not smooth.
/// - `triangles`, `decimate_mm`: take triangles away until so many are left, or as long as the surface
///   moves no further than this.
/// - `threads`: worker threads; None is one a core. The result does not depend on it.
/// - `progress`: called as `progress(stage, fraction)` on this thread.
/// - `cancel`: a `Cancel` that stops the work.
///
/// `Mesh.report` has counts, topology, volume and seconds, as `bonemesh render --json` prints them.
#[pyfunction]
#[pyo3(signature = (
    path_or_volume, *, threshold_hu=Threshold::skull(), local_leeway_hu=None, method=None, sigma=1.0, series=None,
    one_series=false, crop=None, sample_percent=None, sampler="uniform", seed=0, alpha_mm=None, radii_mm=None, depth=8, scale=1.1, true_edges=true, keep_table=false, damp_metal=false, holes=None, islands=None,
    cavities=None, smooth_mm=None, triangles=None, decimate_mm=None, threads=None, progress=None,
    cancel=None
))]
#[allow(clippy::too_many_arguments, clippy::fn_params_excessive_bools)] // keyword arguments, as Python has them
pub(crate) fn render(
    py: Python<'_>,
    path_or_volume: &Bound<'_, PyAny>,
    threshold_hu: Threshold,
    local_leeway_hu: Option<f64>,
    method: Option<&str>,
    sigma: f64,
    series: Option<Choice>,
    one_series: bool,
    crop: Option<Crop>,
    sample_percent: Option<f64>,
    sampler: &str,
    seed: i128,
    alpha_mm: Option<Alpha>,
    radii_mm: Option<Vec<f64>>,
    depth: i128,
    scale: f64,
    true_edges: bool,
    keep_table: bool,
    damp_metal: bool,
    holes: Option<Closed>,
    islands: Option<Kept>,
    cavities: Option<Filled>,
    smooth_mm: Option<f64>,
    triangles: Option<usize>,
    decimate_mm: Option<f64>,
    threads: Option<Threads>,
    progress: Option<Py<PyAny>>,
    cancel: Option<&Cancel>,
) -> PyResult<Mesh> {
    let watch = Watch::new(py, progress, cancel)?;
    let sampling = sampling::chosen(py, sampler, sample_percent, seed, None)?;
    let mut settings = Settings {
        local_leeway_hu,
        canny: options::canny(py, sigma, None)?,
        method: match method {
            Some(name) => name.parse().map_err(|e| errors::unusable(py, e))?,
            None => Method::unless_named(alpha_mm.is_some() || sampling.is_some()),
        },
        alpha_mm: alpha_mm.and_then(Alpha::mm),
        alpha_rule: match alpha_mm {
            Some(Alpha::Auto) => AlphaRule::BoneVolume,
            _ => AlphaRule::default(),
        },
        radii_mm,
        depth: options::depth(py, depth)?,
        scale,
        true_edges,
        leave_out_table: !keep_table,
        damp_metal,
        crop: crop.map(|c| c.0),
        series: series.map(|s| s.0),
        one_series,
        after_care: AfterCare {
            clean: false,
            face_outward: false,
            holes: holes.map(|h| h.0),
            islands: islands.map(|i| i.0),
            cavities: cavities.map(|c| c.0),
            smooth_mm,
            decimation: Decimation {
                triangles,
                error_mm: decimate_mm,
            },
        },
        sampling,
        threads: Threads::count(threads),
        ..Settings::default()
    };
    settings = settings.with_threshold(threshold_hu.0);
    let source = source(path_or_volume, &settings)?;
    detached(py, watch, move |task| {
        let rendered = source.render(&settings, task)?;
        Mesh::of(rendered.mesh, &rendered.report)
    })
}

impl Source {
    fn render(&self, settings: &Settings, task: &Task) -> Result<Rendered, Error> {
        match self {
            Self::Folder(path) => bonemesh::render(path, settings, task),
            Self::Volume(volume) => bonemesh::render_volume(volume, settings, task),
        }
    }
}

fn source(value: &Bound<'_, PyAny>, settings: &Settings) -> PyResult<Source> {
    let py = value.py();
    if let Ok(volume) = value.cast::<Volume>() {
        if settings.series.is_some() || settings.one_series {
            let message = "series and one_series speak of a folder; leave them out with a volume";
            return Err(errors::argument(py, message));
        }
        return Ok(Source::Volume(volume.get().shared()));
    }
    value.extract::<PathBuf>().map(Source::Folder).map_err(|_| {
        let kind = value
            .get_type()
            .name()
            .map(|n| n.to_string())
            .unwrap_or_default();
        let remedy = "give the path of a CT folder or file, or a bonemesh.Volume";
        errors::argument(py, &format!("path_or_volume is {kind}; {remedy}"))
    })
}
