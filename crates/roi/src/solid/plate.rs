//! The plate that lies on the bone and keeps off it.

use bonemesh_mesh::vector::Vector;
use bonemesh_mesh::{TriangleMesh, TriangleTree, least_distance};
use bonemesh_task::Task;
use rustc_hash::FxHashSet;

use super::crop::Neighbourhood;
use super::cut::Cut;
use super::space::Space;
use crate::RoiError;

/// How often a plate is cut that comes nearer to the bone than its clearance.
const TRIES: u32 = 6;
/// How much nearer, in parts of the clearance, counts as no nearer.
const LEEWAY: f64 = 0.05;
/// How much farther off, in steps, it is tried at least where it enters the bone.
const LEAST_STEPS: f64 = 0.15;

/// The plate that comes nowhere nearer to the bone than its clearance, as far as a few tries find one, and how
/// near it comes (mm) if nearer: 0 if it touches the bone.
///
/// Between the nodes of its lattice a plate comes nearer to ridges; so much farther off it is cut again.
pub(super) fn plate(
    mut cut: Cut<'_>,
    mesh: &TriangleMesh,
    is_patch: &FxHashSet<[u32; 3]>,
    task: &Task,
) -> Result<(TriangleMesh, Option<f64>), RoiError> {
    let clearance_mm = cut.request.clearance.mm();
    let mut tries = 1;
    loop {
        let plate = cut.clone().sound(mesh, is_patch, task)?;
        let gap_mm = gap_mm(&plate, mesh, clearance_mm, task)?;
        let Some(gap_mm) = gap_mm.filter(|gap_mm| *gap_mm <= (1.0 - LEEWAY) * clearance_mm) else {
            return Ok((plate, None));
        };
        if tries == TRIES {
            return Ok((plate, Some(gap_mm)));
        }
        let enters = gap_mm <= 0.0;
        let least_mm = if enters {
            LEAST_STEPS * cut.step_mm
        } else {
            0.0
        };
        cut.margin_mm += least_mm.max(clearance_mm - gap_mm);
        tries += 1;
    }
}

/// The least distance (mm) of a plate from the bone; `None` where it is more than `within_mm`.
fn gap_mm(
    plate: &TriangleMesh,
    bone: &TriangleMesh,
    within_mm: f64,
    task: &Task,
) -> Result<Option<f64>, RoiError> {
    let places = plate.vertices_mm().iter().copied();
    let Some(space) = Space::of(places) else {
        return Ok(None);
    };
    let near = Neighbourhood::around(bone, &space.wider(within_mm), task)?;
    let near = TriangleMesh::new(near.vertices_mm, near.triangles)?;
    let near = TriangleTree::new(&near, task)?;
    Ok(least_distance(plate, &near, within_mm, task)?)
}

/// Whether most of the places lie above the patch: what lies below it is beyond the far side of thin bone.
pub(super) fn is_above(places: &[Vector], depth_mm: impl Fn(Vector) -> f64) -> bool {
    let above = places
        .iter()
        .filter(|place| depth_mm(**place) < 0.0)
        .count();
    2 * above > places.len()
}
