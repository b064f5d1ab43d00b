//! What is cut out with, as surfaces.

use bonemesh_mesh::smooth;
use bonemesh_surface::level_surface;
use bonemesh_task::Task;

use super::below::Below;
use super::boolean::Body;
use super::lattice::Lattice;
use super::straight::Straight;
use crate::RoiError;

/// How far, in steps, smoothing may move the sides.
const SMOOTH_STEPS: f64 = 0.6;

/// How places belong to the patch.
pub(super) enum Cutter<'a> {
    /// By the nearest place of it.
    Below(Box<Below<'a>>),
    /// Straight along one direction.
    Straight(Straight<'a>),
}

impl Cutter<'_> {
    /// The two bodies of which it is the common part: what is inside of its sides, and what is between its
    /// lid and its bottom.
    ///
    /// # Errors
    /// [`RoiError::NothingCut`] where one has no inside, or the work was cancelled.
    pub(super) fn bodies(&self, lattice: &Lattice, task: &Task) -> Result<[Body; 2], RoiError> {
        let fields = match self {
            Self::Below(below) => below.fields(lattice, task),
            Self::Straight(straight) => straight.fields(lattice, task),
        }?;
        let surface = |values: &[f32]| {
            let surface = level_surface(values, lattice.shape, &lattice.affine(), task)?;
            surface.ok_or(RoiError::NothingCut)
        };
        let mut sides = surface(&fields.sides)?;
        if let Self::Below(_) = self {
            // Below a rough patch nearest places jump, and the sides are rough with them.
            sides = smooth(&sides, SMOOTH_STEPS * lattice.step_mm, task)?.mesh;
        }
        Ok([Body::of(sides), Body::of(surface(&fields.between)?)])
    }
}
