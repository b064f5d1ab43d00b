//! The part of a cut that belongs to the patch, as a file would hold it.

use bonemesh_mesh::{Sets, TriangleMesh, TriangleTree, check_topology, find_intersections};
use bonemesh_task::Task;

use super::boolean::{Body, Source};
use super::mend::{Places, mended};
use crate::RoiError;
use crate::vector::Vector;

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

/// Keeps what hangs together with the patch. `is_front`: by the triangles of the bone, which of them are
/// the patch's.
pub(super) fn at_patch((cut, sources): (Body, Vec<Source>), is_front: &[bool]) -> Body {
    let mut sets = Sets::new(cut.vertices_mm.len());
    for &[a, b, c] in &cut.triangles {
        sets.join(a, b);
        sets.join(b, c);
    }
    let mut is_kept = vec![false; cut.vertices_mm.len()];
    for (triangle, source) in cut.triangles.iter().zip(&sources) {
        if matches!(source, Source::First(t) if is_front[*t as usize]) {
            is_kept[sets.lowest(triangle[0]) as usize] = true;
        }
    }
    let Body {
        vertices_mm,
        mut triangles,
    } = cut;
    triangles.retain(|t| is_kept[sets.lowest(t[0]) as usize]);
    Body {
        vertices_mm,
        triangles,
    }
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
