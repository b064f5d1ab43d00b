//! The body that is cut out with, as a surface.

use bonemesh_mesh::TriangleMesh;
use bonemesh_surface::level_surface;
use bonemesh_task::Task;

use super::below::Below;
use super::lattice::Lattice;
use super::straight::Straight;
use crate::RoiError;

/// How places belong to the patch.
pub(super) enum Cutter<'a> {
    /// By the nearest place of it.
    Below(Below<'a>),
    /// Straight along one direction.
    Straight(Straight<'a>),
}

impl Cutter<'_> {
    /// Its surface, closed and outward-oriented.
    ///
    /// # Errors
    /// [`RoiError::NothingCut`] where it has no inside, or the work was cancelled.
    pub(super) fn surface(&self, lattice: &Lattice, task: &Task) -> Result<TriangleMesh, RoiError> {
        let values = match self {
            Self::Below(below) => below.values(lattice, task),
            Self::Straight(straight) => straight.values(lattice, task),
        }?;
        level_surface(&values, lattice.shape, &lattice.affine(), task)?.ok_or(RoiError::NothingCut)
    }
}
