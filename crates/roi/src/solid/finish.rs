//! A cut as a file would hold it.

use bonemesh_mesh::{TriangleMesh, TriangleTree, check_topology, find_intersections};
use bonemesh_task::Task;

use super::boolean::Body;
use super::mend::{Places, mended};
use crate::RoiError;
use bonemesh_mesh::vector::Vector;

/// Rounds of mending.
const MENDS: usize = 6;
/// Pairs of triangles that meet, beyond which it is no matter of a few slivers.
const MOST_MET: usize = 1000;

/// What became of a cut.
pub(super) enum Finished {
    /// Closed, manifold, free of self-intersections.
    Sound(TriangleMesh),
    /// In 32-bit coordinates it is not.
    Meets,
}

/// Rounds to what a file holds, checks that, and mends where triangles meet.
///
/// `own_mm`: the bone's vertices, which stay where they are.
///
/// # Errors
/// [`RoiError::NothingCut`] where there is nothing, or the work was cancelled.
pub(super) fn finished(cut: Body, own_mm: &[Vector], task: &Task) -> Result<Finished, RoiError> {
    if cut.triangles.is_empty() {
        return Err(RoiError::NothingCut);
    }
    let mesh = TriangleMesh::new(cut.vertices_mm, cut.triangles)?.compacted();
    let mut written = mesh.as_written(task)?;
    let mut own = None;
    for _ in 0..MENDS {
        let topology = check_topology(&written, task)?;
        let is_closed =
            topology.watertight && topology.manifold && topology.degenerate_triangles == 0;
        if !is_closed || topology.volume_mm3 <= 0.0 {
            break;
        }
        let tree = TriangleTree::new(&written, task)?;
        let found = find_intersections(&tree, MOST_MET, task)?;
        if found.count == 0 {
            return Ok(Finished::Sound(written));
        }
        let own = own.get_or_insert_with(|| Places::of(own_mm));
        match mended(&written, &found.pairs, own) {
            Some(mesh) if found.count < MOST_MET => written = mesh,
            _ => break,
        }
    }
    Ok(Finished::Meets)
}
