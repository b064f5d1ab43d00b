//! How two meshes differ.

use std::num::NonZeroUsize;

use bonemesh_measure::{
    EdgeMidpoints, MeasureError, Reference, Spread, compare_surfaces, edge_midpoints,
    residual_volume, signed_distances,
};
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Task, pool};
use serde::Serialize;

use crate::Error;

/// What is asked of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompareSettings {
    /// Places of each surface from which distances are measured.
    pub samples: usize,
    /// Find the residual volume, which takes longest.
    pub residual: bool,
    /// Worker threads; `None` is one per core. The result does not depend on it.
    pub threads: Option<NonZeroUsize>,
}

impl Default for CompareSettings {
    fn default() -> Self {
        Self {
            samples: 100_000,
            residual: true,
            threads: None,
        }
    }
}

/// What is said of two meshes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CompareReport {
    /// The largest distance from either surface to the other (symmetric Hausdorff distance).
    pub hausdorff_mm: f64,
    /// Mean distance between the surfaces, of both directions.
    pub mean_mm: f64,
    /// Root mean square of both directions.
    pub rms_mm: f64,
    /// 95 % of both surfaces are at most so far from the other.
    pub p95_mm: f64,
    /// From the mesh to the reference, positive outside the reference.
    pub to_reference: SpreadReport,
    /// From the reference to the mesh, positive outside the mesh.
    pub from_reference: SpreadReport,
    /// Places of each surface from which distances were measured.
    pub samples: usize,
    /// The published comparison; `None` where the meshes have no slices in common.
    pub edge_midpoints: Option<EdgeMidpointReport>,
    /// Volume of the mesh; this and those below are `None` if a mesh is not closed or they were not asked for.
    pub volume_mm3: Option<f64>,
    /// Volume of the reference.
    pub reference_volume_mm3: Option<f64>,
    /// Volume that is in both.
    pub common_volume_mm3: Option<f64>,
    /// Volume that is in exactly one: union less intersection.
    pub residual_volume_mm3: Option<f64>,
    /// Why something is missing.
    pub warnings: Vec<String>,
}

/// Distances in a few numbers (mm).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpreadReport {
    /// Mean.
    pub mean_mm: f64,
    /// Root of the mean square.
    pub rms_mm: f64,
    /// 95 % are at most this.
    pub p95_mm: f64,
    /// The largest.
    pub max_mm: f64,
    /// Mean with signs.
    pub signed_mean_mm: f64,
}

impl From<Spread> for SpreadReport {
    fn from(spread: Spread) -> Self {
        Self {
            mean_mm: spread.mean_mm,
            rms_mm: spread.rms_mm,
            p95_mm: spread.p95_mm,
            max_mm: spread.max_mm,
            signed_mean_mm: spread.signed_mean_mm,
        }
    }
}

/// The published comparison at the middles of edges.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EdgeMidpointReport {
    /// Mean of all distances.
    pub overall_mm: f64,
    /// Mean over the edges of the mean of each.
    pub midpoint_mm: f64,
    /// Edges with a vertex of the reference in range.
    pub edges: usize,
}

impl EdgeMidpointReport {
    fn of(found: &EdgeMidpoints) -> Option<Self> {
        (!found.edges.is_empty()).then_some(Self {
            overall_mm: found.overall_mm,
            midpoint_mm: found.midpoint_mm,
            edges: found.edges.len(),
        })
    }
}

/// What [`compare`] gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// In numbers.
    pub report: CompareReport,
    /// Signed distances (mm) of places on the mesh to the reference, which lie evenly by area.
    pub signed_mm: Vec<f64>,
}

/// Compares two meshes in the same space.
///
/// # Errors
/// [`Error::Measure`] for a mesh without a surface, or [`Error::is_cancelled`]. A mesh that is not
/// closed has no residual volume, which a warning says.
pub fn compare(
    mesh: &TriangleMesh,
    reference: &TriangleMesh,
    settings: CompareSettings,
    task: &Task,
) -> Result<Compared, Error> {
    pool(settings.threads)?.install(|| {
        let found = compare_surfaces(mesh, reference, settings.samples, task)?;
        let midpoints = edge_midpoints(mesh, reference, task)?;
        let mut warnings = Vec::new();
        let volumes = if settings.residual {
            match residual_volume(mesh, reference, task) {
                Ok(volumes) => Some(volumes),
                Err(e @ (MeasureError::Open(_) | MeasureError::Boolean(_))) => {
                    warnings.push(e.to_string());
                    None
                }
                Err(e) => return Err(e.into()),
            }
        } else {
            None
        };
        let report = CompareReport {
            hausdorff_mm: found.hausdorff_mm,
            mean_mm: found.mean_mm,
            rms_mm: found.rms_mm,
            p95_mm: found.p95_mm,
            to_reference: found.to_reference.into(),
            from_reference: found.from_reference.into(),
            samples: found.signed_mm.len(),
            edge_midpoints: EdgeMidpointReport::of(&midpoints),
            volume_mm3: volumes.map(|v| v.mesh_mm3),
            reference_volume_mm3: volumes.map(|v| v.reference_mm3),
            common_volume_mm3: volumes.map(|v| v.common_mm3),
            residual_volume_mm3: volumes.map(|v| v.residual_mm3),
            warnings,
        };
        Ok(Compared {
            report,
            signed_mm: found.signed_mm,
        })
    })
}

/// The signed distance (mm) of each vertex of a mesh, or of each point of a cloud, to the surface of a
/// reference, positive outside: what a heat map shows.
///
/// # Errors
/// [`Error::Measure`] for a reference without a surface, or [`Error::is_cancelled`].
pub fn distances_to(
    places_mm: &[[f64; 3]],
    reference: &TriangleMesh,
    threads: Option<NonZeroUsize>,
    task: &Task,
) -> Result<Vec<f64>, Error> {
    pool(threads)?.install(|| {
        let merged = reference.merged(task)?;
        let reference = Reference::new(&merged, task)?;
        Ok(signed_distances(places_mm, &reference, task)?)
    })
}
