//! How far a reshaped surface is from the one before it.

use bonemesh_mesh::{TriangleMesh, TriangleTree, check_topology};
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::Error;

/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 12;

/// The furthest that a vertex of `given` is from the surface `left`; `None` if there is no surface.
pub(super) fn largest_distance_mm(
    given: &TriangleMesh,
    left: &TriangleMesh,
    task: &Task,
) -> Result<Option<f64>, Error> {
    let tree = TriangleTree::new(left, task)?;
    task.begin("deviation", given.vertices_mm().len());
    let chunks = given.vertices_mm().par_chunks(STRIDE).map(|places| {
        task.advance(places.len())?;
        let distances = places
            .iter()
            .filter_map(|place| tree.nearest(*place, f64::INFINITY));
        Ok(distances
            .map(|nearest| nearest.squared_mm2.sqrt())
            .reduce(f64::max))
    });
    let largest: Vec<Option<f64>> = chunks.collect::<Result<_, Cancelled>>()?;
    Ok(largest.into_iter().flatten().reduce(f64::max))
}

/// By how much the volume of a closed mesh changed.
pub(super) fn volume_change_percent(
    before: &TriangleMesh,
    after: &TriangleMesh,
    task: &Task,
) -> Result<Option<f64>, Error> {
    let before = check_topology(before, task)?;
    let after = check_topology(after, task)?;
    let is_known = before.watertight && after.watertight && before.volume_mm3 != 0.0;
    let ratio = after.volume_mm3 / before.volume_mm3;
    Ok(is_known.then_some(100.0 * (ratio - 1.0)))
}
