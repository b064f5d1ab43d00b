//! The region of interest, with its report.

use std::num::NonZeroUsize;
use std::time::Instant;

use bonemesh_mesh::TriangleMesh;
use bonemesh_roi::{Method, ThicknessMm, select_region};
use bonemesh_task::{Task, pool};

use crate::Error;
use crate::report::{RegionReport, check};

/// What a user chooses for one region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionRequest {
    /// How deep the region reaches below the selection.
    pub thickness: ThicknessMm,
    /// How the region is found.
    pub method: Method,
    /// Worker threads; `None` is one per core. The result does not depend on it.
    pub threads: Option<NonZeroUsize>,
}

/// A region as its own mesh, and what is to be said of it.
#[derive(Clone, Debug)]
pub struct RegionResult {
    /// The region, in the frame of the mesh it was taken from.
    pub mesh: TriangleMesh,
    /// Counts, topology, time.
    pub report: RegionReport,
}

/// Takes the region under the `selected` vertices out of `mesh` as a mesh of its own.
///
/// # Errors
/// [`Error::Roi`] when the selection, the thickness or the mesh does not allow it.
pub fn select_roi(
    mesh: &TriangleMesh,
    selected: &[u32],
    request: &RegionRequest,
    task: &Task,
) -> Result<RegionResult, Error> {
    pool(request.threads)?.install(|| {
        let clock = Instant::now();
        let region = select_region(mesh, selected, request.thickness, request.method, task)?;
        let topology = check(&region.mesh, task)?;
        let seconds = clock.elapsed().as_secs_f64();
        let report = RegionReport::new(
            &region,
            request.method.name(),
            request.thickness.mm(),
            &topology,
            seconds,
        );
        Ok(RegionResult {
            mesh: region.mesh,
            report,
        })
    })
}
