//! What lies below the patch, or on it, along the surface's own normals.

use bonemesh_task::Task;

use super::fields::{Fields, Inside};
use super::lattice::{COARSE, Lattice};
use super::sheet::Lookup;
use crate::RoiError;
use bonemesh_mesh::vector::Vector;

/// What is inside, by depth below the patch.
pub(super) struct Below<'a> {
    pub(super) sheet: Lookup<'a>,
    /// Where it begins (mm), below 0 above the patch.
    pub(super) top_mm: f64,
    /// Where it ends (mm) at the latest.
    pub(super) bottom_mm: f64,
    /// The bone that it must keep a distance (mm) from.
    pub(super) kept_off: Option<(Lookup<'a>, f64)>,
}

impl Below<'_> {
    pub(super) fn fields(&self, lattice: &Lattice, task: &Task) -> Result<Fields, RoiError> {
        let diagonal_mm = 3.0_f64.sqrt() * lattice.step_mm * COARSE as f64;
        let within_mm = self.bottom_mm.max(-self.top_mm) + 2.0 * lattice.step_mm + diagonal_mm;
        let inside = |place| self.inside(place, within_mm, lattice.step_mm);
        Ok(Fields::of(lattice, inside, task)?)
    }

    fn inside(&self, place: Vector, within_mm: f64, step_mm: f64) -> Option<Inside> {
        let seen = self.sheet.see(place, within_mm)?;
        let depth = seen.depth_mm;
        let bottom_mm = seen.bottom_mm.min(self.bottom_mm);
        let between = (depth - self.top_mm).min(bottom_mm - depth);
        let between = match &self.kept_off {
            // Next to the inside the value decides where between nodes the surface is.
            Some((bone, distance_mm)) if between > -2.0 * step_mm => {
                let seen = bone.see(place, within_mm);
                let above = seen.map_or(within_mm, |seen| -seen.depth_mm);
                between.min(above - distance_mm)
            }
            _ => between,
        };
        Some([seen.inside_mm, between])
    }
}
