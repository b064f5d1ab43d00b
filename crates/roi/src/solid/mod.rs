//! The bone under a selected patch as a solid of its own.
//!
//! 1. [`crop`]: what lies around the selection, so that the work does not depend on the size of the mesh.
//! 2. [`patch`]: which triangles were meant.
//! 3. [`outline`]: the patch's outline, smooth, and how far vertices are from it.
//! 4. [`sheet`], [`cutter`]: the body of all places below the patch down to the thickness.
//! 5. [`boolean`]: what bone and cutter have in common.
//! 6. [`finish`]: the part of it at the patch, checked as a file would hold it. Where 32-bit coordinates
//!    make triangles meet, the cutter's lattice is shifted a little and all is done again.

mod boolean;
mod crop;
mod cutter;
mod finish;
mod outline;
mod patch;
mod sheet;

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;
use rustc_hash::FxHashSet;

use self::boolean::{Body, common};
use self::crop::{Neighbourhood, Part, Space};
use self::cutter::{Depths, Lattice, cutter, lid_mm, step_mm};
use self::finish::{Finished, finished};
use self::outline::Outline;
use self::patch::Patch;
use self::sheet::Sheet;
use crate::selection::Selection;
use crate::{RoiError, ThicknessMm};

/// Lattices that are tried.
const TRIES: u32 = 12;
/// How far (mm) around the selection, and around what is cut, is looked at.
const BESIDE_MM: f64 = 3.0;
/// Parts of a step by which the lattice is shifted from try to try: multiples of these never come back.
const SHIFTS: [f64; 3] = [
    0.618_033_988_749_895,
    0.754_877_666_246_693,
    0.819_172_513_396_164,
];

/// The bone under a patch.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Closed, outward-oriented, in coordinates that a file's 32-bit floats hold.
    pub mesh: TriangleMesh,
    /// Area of the selected patch.
    pub patch_mm2: f64,
    /// Pieces of the selection that were left out: crumbs, and those behind the largest.
    pub dropped: usize,
    /// Gaps in the selection that were closed.
    pub closed: usize,
}

/// The bone of `mesh` under the `selected` vertices, down to `thickness` or to the far side of the bone.
///
/// The front are the triangles of the mesh, unchanged but along the outline, which runs smoothly between
/// selected vertices and others; the sides stand upright on the surface; the back is the bone's far side
/// where that is within reach, else as deep as the thickness below the nearest place of the patch. The
/// result is the same for any number of threads and any order of the selection.
///
/// # Errors
/// [`RoiError`]: a selection without a triangle or with an index that the mesh does not have, a surface that
/// is open near the selection, or the work was cancelled.
pub fn select_solid(
    mesh: &TriangleMesh,
    selected: &[u32],
    thickness: ThicknessMm,
    task: &Task,
) -> Result<Solid, RoiError> {
    let selection = &Selection::new(selected, mesh.vertices_mm().len())?;
    let place = |vertex: &u32| mesh.vertices_mm()[*vertex as usize];
    let space = Space::of(selection.indices().iter().map(place)).ok_or(RoiError::NoSelection)?;
    let near = Neighbourhood::around(mesh, &space.wider(2.0 * BESIDE_MM), task)?;
    let is_selected: Vec<bool> = near
        .of_mesh
        .iter()
        .map(|v| selection.contains(*v))
        .collect();
    let patch = Patch::of(&near, &is_selected, task)?;
    let outline = Outline::of(&near, &patch, &is_selected, BESIDE_MM, task)?;
    let sheet = Sheet::of(&near, &outline)?;
    let step_mm = step_mm(patch.area_mm2, thickness.mm());
    let depths = Depths {
        top_mm: -lid_mm(step_mm),
        bottom_mm: thickness.mm(),
    };
    let space = Space::of(sheet.around_patch()).ok_or(RoiError::NothingCut)?;
    let space = space.wider(thickness.mm().max(lid_mm(step_mm)) + step_mm);
    let lookup = sheet.lookup(task)?;
    let around = space.wider(BESIDE_MM);
    let part = Part::of(mesh, &around, task)?;
    let is_front = front(&near, &patch, &part);
    let body = Body {
        vertices_mm: part.vertices_mm,
        triangles: part.triangles,
    };
    for attempt in 0..TRIES {
        let lattice = Lattice::around(space, step_mm, shift(attempt));
        let cutter = cutter(&lookup, &lattice, depths, task)?;
        let (vertices_mm, triangles) = cutter.into_parts();
        let cutter = Body {
            vertices_mm,
            triangles,
        };
        let cut = common(&body, &cutter, task)?;
        match finished(cut, &is_front, task)? {
            Finished::Sound(mesh) => {
                return Ok(Solid {
                    mesh,
                    patch_mm2: patch.area_mm2,
                    dropped: patch.dropped,
                    closed: patch.closed,
                });
            }
            Finished::Meets => {}
        }
    }
    Err(RoiError::NoSound { tries: TRIES })
}

/// Where the lattice of a try begins, in parts of a step.
fn shift(attempt: u32) -> [f64; 3] {
    SHIFTS.map(|part| (f64::from(attempt + 1) * part).fract())
}

/// Which triangles of a part of the mesh are the patch's.
fn front(near: &Neighbourhood, patch: &Patch, part: &Part) -> Vec<bool> {
    let triangles = near.triangles.iter().zip(&patch.has_triangle);
    let patch: FxHashSet<[Option<u32>; 3]> = triangles
        .filter(|(_, has)| **has)
        .map(|(t, _)| t.map(|v| Some(near.of_mesh[v as usize])))
        .collect();
    let triangles = part.triangles.iter();
    let whole = triangles.map(|t| t.map(|v| part.of_mesh[v as usize]));
    whole.map(|t| patch.contains(&t)).collect()
}
