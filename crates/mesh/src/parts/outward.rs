//! Surfaces turned so that they face outward.

use bonemesh_task::Task;

use super::Parts;
use super::agree::{pairs, turned_over};
use super::bodies::bodies;
use crate::{MeshError, TriangleMesh};

/// What [`face_outward`] gives.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct FacedOutward {
    /// The same triangles in the same order, in coordinates that a file's 32-bit floats hold.
    pub mesh: TriangleMesh,
    /// How many triangles were turned over.
    pub turned: usize,
}

/// Turns triangles over that face another way than their neighbours, and closed parts that are inside out.
///
/// 1. Where two triangles share an edge that no third one has, they are made to agree; of what hangs together
///    so, the smaller part by area is turned.
/// 2. A closed part that lies in no other and faces inward is turned, and what lies in it follows: the walls of
///    its cavities face inward, what floats in these outward. Everything else in it stays.
///
/// The mesh is taken as its file gives it back ([`TriangleMesh::as_written`]).
/// Edges of three and more triangles say nothing of sides: closed bodies that touch in edges or corners are
/// looked at one by one. Neither does an open part say which way is out: there the larger part decides. The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::NotFinite`] for a coordinate too large for a 32-bit float, [`MeshError::Cancelled`].
pub fn face_outward(mesh: &TriangleMesh, task: &Task) -> Result<FacedOutward, MeshError> {
    let mesh = &mesh.as_written(task)?;
    task.begin("winding", 2 * mesh.triangles().len());
    let pairs = pairs(mesh, task)?;
    let mut is_turned = turned_over(mesh, &pairs, task)?;
    task.advance(mesh.triangles().len())?;
    let agreeing = with_turned(mesh, &is_turned)?;
    let bodies = bodies(&agreeing, &pairs, task)?;
    let parts = Parts::labelled(&agreeing, bodies, task)?;
    let is_wrong: Vec<bool> = (0..parts.known.len()).map(|p| parts.is_wrong(p)).collect();
    for (is_turned, part) in is_turned.iter_mut().zip(&parts.labels.of_triangles) {
        *is_turned ^= is_wrong[*part as usize];
    }
    Ok(FacedOutward {
        mesh: with_turned(mesh, &is_turned)?,
        turned: is_turned.iter().filter(|is_turned| **is_turned).count(),
    })
}

impl Parts<'_> {
    /// Whether a part has to be turned over.
    fn is_wrong(&self, part: usize) -> bool {
        let around: Vec<usize> = self.with_parents(part).collect();
        let [.., outermost] = around[..] else {
            return false;
        };
        let faces_inward = |part: usize| self.known[part].volume_mm3 < 0.0;
        let is_closed = around.iter().all(|part| self.known[*part].is_closed);
        // The outermost outward, in it inward, in that outward, and so on.
        let is_to_face_inward = around.len().is_multiple_of(2);
        is_closed && faces_inward(outermost) && faces_inward(part) != is_to_face_inward
    }
}

fn with_turned(mesh: &TriangleMesh, is_turned: &[bool]) -> Result<TriangleMesh, MeshError> {
    let triangles = mesh.triangles().iter().zip(is_turned);
    let triangles =
        triangles.map(|(&[a, b, c], turned)| if *turned { [a, c, b] } else { [a, b, c] });
    TriangleMesh::new(mesh.vertices_mm().to_vec(), triangles.collect())
}
