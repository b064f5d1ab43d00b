//! How near a plate comes to the bone that it lies on.

use bonemesh_mesh::{TriangleMesh, TriangleTree};
use bonemesh_task::Task;
use rayon::prelude::*;

use super::crop::Neighbourhood;
use super::space::Space;
use crate::RoiError;

/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 10;

/// The least distance (mm) between a plate and the bone, at the vertices of both; `None` where it is `within_mm`
/// or more.
pub(super) fn least_gap_mm(
    plate: &TriangleMesh,
    bone: &TriangleMesh,
    within_mm: f64,
    task: &Task,
) -> Result<Option<f64>, RoiError> {
    let Some(space) = Space::of(plate.vertices_mm().iter().copied()) else {
        return Ok(None);
    };
    let near = Neighbourhood::around(bone, &space.wider(within_mm), task)?;
    let near = TriangleMesh::new(near.vertices_mm, near.triangles)?;
    let gaps = [
        one_way(plate, &near, within_mm, task)?,
        one_way(&near, plate, within_mm, task)?,
    ];
    Ok(gaps.into_iter().flatten().reduce(f64::min))
}

fn one_way(
    from: &TriangleMesh,
    to: &TriangleMesh,
    within_mm: f64,
    task: &Task,
) -> Result<Option<f64>, RoiError> {
    let tree = TriangleTree::new(to, task)?;
    let batches = from.vertices_mm().par_chunks(STRIDE).map(|places| {
        task.check()?;
        let gaps = places.iter().filter_map(|p| tree.nearest(*p, within_mm));
        Ok(gaps.map(|found| found.squared_mm2.sqrt()).reduce(f64::min))
    });
    let batches = batches.collect::<Result<Vec<Option<f64>>, RoiError>>()?;
    Ok(batches.into_iter().flatten().reduce(f64::min))
}
