//! Method `thesis`: what lies behind the selection, slice by slice.
//!
//! 1. `normal`: one direction into the bone from the selection's own points.
//! 2. `surround`: vertices near a selected one and on its inner side.
//! 3. `layers`: which level of the mesh is the inner side of which level of the selection.
//! 4. `cover`: of the surround, what lies behind the selection seen along the normal.
//!
//! The published text moves the vertices so that their centroid is the origin. All steps but the
//! sign of the normal use differences only, so nothing is moved here: the centroid is subtracted
//! where the sign is decided, and levels stay equal to the bit.
//!
//! Where the text leaves room, this is how it is read:
//! - The selection is taken in the order of the mesh, each vertex once: "first" means lowest index.
//! - Of two levels equally near to the mean, the lower one gives the first point.
//! - The second point is the one of largest x (or z) among those that differ from the first in x
//!   or in y.
//! - The largest component of the normal is the one of largest absolute value; of equals, x before
//!   y before z.
//! - With one level selected, each inner level corresponds to it.
//! - "Equal x" is that of the surround point and the outer points before their projection: after
//!   it, a tilted normal would make no two equal. The nearest neighbours, and the special cases of
//!   two, one and no outer points, are then those of this group.
//! - A slice step is the median distance of successive levels of the mesh.
//! - "Between" includes both ends.
//!
//! `oracle` spells the text out without any search structure; tests compare the two.

mod cover;
mod layers;
mod levels;
mod normal;
#[cfg(test)]
mod oracle;
mod surround;

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;

use crate::selection::Selection;
use crate::{RoiError, ThicknessMm};
use cover::Cover;
use levels::Levels;

/// What was found behind a selection.
#[derive(Debug, PartialEq)]
pub(crate) struct Behind {
    /// Vertices of the mesh, ascending, none of them selected.
    pub(crate) kept: Vec<u32>,
    /// Unit normal into the bone.
    pub(crate) normal: [f64; 3],
}

/// The patch that was selected, and the direction from it into the bone.
struct Patch<'a> {
    vertices_mm: &'a [[f64; 3]],
    selection: &'a Selection,
    /// The selection's own levels.
    levels: Levels,
    thickness_mm: f64,
    normal: [f64; 3],
    /// `thickness_mm` along the normal.
    shift: [f64; 3],
}

impl Patch<'_> {
    /// Whether all selected vertices have the same z.
    fn is_one_level(&self) -> bool {
        self.levels.z_mm().len() == 1
    }

    /// The selected vertices (mm) in the order of the mesh.
    fn points(&self) -> impl Iterator<Item = [f64; 3]> {
        let indices = self.selection.indices().iter();
        indices.map(|&vertex| self.vertices_mm[vertex as usize])
    }

    /// The highest z that the projected selection reaches.
    fn projected_top(&self) -> f64 {
        self.levels.top() + self.shift[2]
    }
}

/// Finds the vertices behind the selection on a mesh made of slices.
///
/// # Errors
/// [`RoiError::NoLevels`], [`RoiError::NoSecondPoint`], [`RoiError::NoNormal`] or
/// [`RoiError::Cancelled`].
pub(crate) fn find_behind(
    mesh: &TriangleMesh,
    selection: &Selection,
    thickness: ThicknessMm,
    task: &Task,
) -> Result<Behind, RoiError> {
    let levels = Levels::of(mesh.vertices_mm().iter().map(|v| v[2]));
    if !levels.are_slices() {
        return Err(RoiError::NoLevels {
            vertices: mesh.vertices_mm().len(),
            levels: levels.z_mm().len(),
        });
    }
    find_behind_on(mesh, &levels, selection, thickness, task)
}

/// [`find_behind`] without the question whether the levels are slices.
fn find_behind_on(
    mesh: &TriangleMesh,
    levels: &Levels,
    selection: &Selection,
    thickness: ThicknessMm,
    task: &Task,
) -> Result<Behind, RoiError> {
    let vertices_mm = mesh.vertices_mm();
    let own_z = selection
        .indices()
        .iter()
        .map(|&v| vertices_mm[v as usize][2]);
    let own_levels = Levels::of(own_z);
    let normal = normal::of_selection(mesh, selection, &own_levels)?;
    let patch = Patch {
        vertices_mm,
        selection,
        levels: own_levels,
        thickness_mm: thickness.mm(),
        normal,
        shift: normal.map(|component| thickness.mm() * component),
    };
    let surround = surround::of_patch(&patch, task)?;
    let layers = layers::pairs(&patch, levels);
    let mut outer = vec![Vec::new(); patch.levels.z_mm().len()];
    for point in patch.points() {
        let level = patch.levels.place_of(point[2]);
        outer[level.expect("a selected point is on no level, which is a bug")].push(point);
    }
    let covers: Vec<Cover> = outer
        .iter()
        .map(|points| Cover::of_points(&patch, points, levels.step_mm()))
        .collect();
    let kept = surround
        .into_iter()
        .filter(|&vertex| {
            let point = vertices_mm[vertex as usize];
            let outer = layers.outer_of(point[2]);
            outer.is_some_and(|outer| covers[outer].contains(point))
        })
        .collect();
    Ok(Behind { kept, normal })
}
