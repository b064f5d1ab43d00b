//! The bone under a selected patch as a solid of its own.
//!
//! 1. [`crop`]: what lies around the selection, so that the work does not depend on the size of the mesh.
//! 2. [`patch`]: which triangles were meant, by their [`pieces`], without [`flaps`].
//! 3. [`refine`], [`outline`]: the patch's outline, smooth, and how far vertices are from it.
//! 4. [`sheet`]: the patch and what is around it, as places are looked up.
//! 5. [`cut`]: the rest. [`far_side`]: how deep the bone below the patch is.
//! 6. [`cutter`]: the body of all places that belong to the patch, [`below`] it or [`straight`] behind it, as
//!    the common part of two whose [`fields`] are known on the nodes of a [`lattice`].
//! 7. [`boolean`]: what bone and cutter have in common; [`shells`]: what of it lies at the patch.
//! 8. [`plate`]: what lies on the bone instead, and keeps its clearance.
//! 9. [`finish`]: checked as a file would hold it. Where 32-bit coordinates make triangles meet, slivers are
//!    collapsed ([`mend`]) or, if that is not enough, the cutter is moved by microns and cuts again.

mod below;
mod boolean;
mod crop;
mod cut;
mod cutter;
mod far_side;
mod fields;
mod finish;
mod flaps;
mod lattice;
mod mend;
mod outline;
mod patch;
mod pieces;
mod plate;
mod refine;
mod sheet;
mod shells;
mod space;
mod straight;

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;
use rayon::prelude::*;

pub(crate) use self::crop::Neighbourhood;
pub(crate) use self::cut::is_inside_out;
pub(crate) use self::lattice::Frame;
pub(crate) use self::space::Space;
pub(crate) use self::straight::covered;

use self::cut::Cut;
use self::lattice::{affordable_mm, step_mm};
use self::outline::Outline;
use self::patch::{Meant, Patch};
use self::plate::plate;
use self::sheet::Sheet;
use crate::selection::Selection;
use crate::{ClearanceMm, Direction, RoiError, ThicknessMm};
use bonemesh_mesh::vector::Vector;

/// How far (mm) around the selection, and around a plate, is looked at.
const BESIDE_MM: f64 = 3.0;
/// How far what is cut bulges, in parts of the thickness: at a crease, between what lies below its two sides.
const BULGE: f64 = 0.3;
/// Longest edges, in steps, of triangles that places are looked up on.
const EDGE_STEPS: f64 = 3.0;
/// At least so many of them in the patch's width, and so many beside it.
const EDGES_IN_WIDTH: f64 = 6.0;
const EDGES_BESIDE: f64 = 6.0;
/// Largest step (mm) of a plate, or its clearance if that is more: else it would pass over ridges of the bone.
const PLATE_STEP_MM: f64 = 0.5;
/// Least thickness, and least distance from the outline to the middle of a patch, in steps.
const LEAST_STEPS: f64 = 1.5;

/// What a solid is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidRequest {
    /// How deep it is cut, or how thick a plate is.
    pub thickness: ThicknessMm,
    /// Which way.
    pub direction: Direction,
    /// The gap between bone and plate; only for [`Direction::Outward`].
    pub clearance: ClearanceMm,
    /// Whether selected pieces that are hidden behind others count, too.
    pub with_hidden: bool,
}

impl SolidRequest {
    /// Along the normals, with no hidden pieces.
    pub fn new(thickness: ThicknessMm) -> Self {
        Self {
            thickness,
            direction: Direction::default(),
            clearance: ClearanceMm::default(),
            with_hidden: false,
        }
    }

    /// How far (mm) from the patch something is cut.
    fn reach_mm(&self) -> f64 {
        let clearance_mm = match self.direction {
            Direction::Outward => self.clearance.mm(),
            _ => 0.0,
        };
        self.thickness.mm() + clearance_mm
    }
}

/// The bone under a patch, or the plate on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Closed, outward-oriented, in coordinates that a file's 32-bit floats hold.
    pub mesh: TriangleMesh,
    /// Distinct selected vertices.
    pub selected: usize,
    /// Area of the selected patch.
    pub patch_mm2: f64,
    /// Mean direction from the patch into the bone, of length 1.
    pub inward: [f64; 3],
    /// Pieces of the selection that were left out: crumbs, and those behind the largest.
    pub dropped: usize,
    /// Gaps in the selection that were closed.
    pub closed: usize,
    /// How near a plate comes to the bone (mm), if nearer than its clearance.
    pub gap_mm: Option<f64>,
}

/// The bone of `mesh` under the `selected` vertices, down to the thickness or to the far side of the bone; or
/// the plate of that thickness on it.
///
/// The front are the triangles of the mesh, unchanged but along the outline, which runs smoothly between
/// selected vertices and others; the sides stand upright on the surface, or lie along a straight direction;
/// the back is the bone's far side where that is within reach, else as deep as the thickness below the
/// nearest place of the patch, or straight behind it. A plate keeps its clearance from all bone near
/// ([`Solid::gap_mm`] says where that was not to be had), and its outer side follows the patch smoothed. The result is the same for any number of threads and any order of
/// the selection.
///
/// # Errors
/// [`RoiError`]: a selection without a triangle or with an index that the mesh does not have, a surface that
/// is open near the selection, or the work was cancelled.
pub fn select_solid(
    mesh: &TriangleMesh,
    selected: &[u32],
    request: &SolidRequest,
    task: &Task,
) -> Result<Solid, RoiError> {
    let selection = &Selection::new(selected, mesh.vertices_mm().len())?;
    let meant = meant(mesh, selection, request, task)?;
    let inward = meant.patch.inward();
    // What lies farther apart than what is cut bulges has nothing to do with one another.
    let reach_mm = BESIDE_MM + request.reach_mm() * (1.0 + BULGE);
    let parts = meant.patch.parts(Some(reach_mm), 2.0 * BESIDE_MM);
    let solids = cut_each(mesh, &parts, request, Some(inward), task)?;
    let dropped = meant.dropped + parts.len() - solids.len();
    let gap_mm = solids.iter().filter_map(|solid| solid.gap_mm);
    let gap_mm = gap_mm.reduce(f64::min);
    Ok(Solid {
        mesh: TriangleMesh::together(solids.iter().map(|solid| &solid.mesh))?,
        selected: selection.indices().len(),
        patch_mm2: meant.patch.area_mm2(),
        inward,
        dropped,
        closed: meant.closed,
        gap_mm,
    })
}

/// The same with a solid for each piece of the patch that does not touch the others, the largest piece first.
///
/// What is counted of the selection is counted of all of it. A piece too narrow to cut anything out counts as
/// dropped.
///
/// # Errors
/// As [`select_solid`].
pub fn select_solids(
    mesh: &TriangleMesh,
    selected: &[u32],
    request: &SolidRequest,
    task: &Task,
) -> Result<Vec<Solid>, RoiError> {
    let selection = &Selection::new(selected, mesh.vertices_mm().len())?;
    let meant = meant(mesh, selection, request, task)?;
    let parts = meant.patch.parts(None, 2.0 * BESIDE_MM);
    let mut solids = cut_each(mesh, &parts, request, None, task)?;
    let dropped = meant.dropped + parts.len() - solids.len();
    for solid in &mut solids {
        solid.selected = selection.indices().len();
        solid.dropped = dropped;
        solid.closed = meant.closed;
    }
    Ok(solids)
}

fn meant(
    mesh: &TriangleMesh,
    selection: &Selection,
    request: &SolidRequest,
    task: &Task,
) -> Result<Meant, RoiError> {
    let place = |vertex: &u32| mesh.vertices_mm()[*vertex as usize];
    let space = Space::of(selection.indices().iter().map(place)).ok_or(RoiError::NoSelection)?;
    let near = Neighbourhood::around(mesh, &space.wider(2.0 * BESIDE_MM), task)?;
    let view = request.direction.given();
    Meant::of(
        near,
        selection,
        view,
        request.with_hidden,
        2.0 * BESIDE_MM,
        task,
    )
}

/// The solid of each part that is wide enough for one and has bone below it.
///
/// `inward`: the direction into the bone of all of them, else each has its own.
fn cut_each(
    mesh: &TriangleMesh,
    parts: &[Patch],
    request: &SolidRequest,
    inward: Option<Vector>,
    task: &Task,
) -> Result<Vec<Solid>, RoiError> {
    let cut = |part: &Patch| {
        let inward = inward.unwrap_or_else(|| part.inward());
        cut_out(mesh, part, request, inward, task)
    };
    let cuts: Vec<Result<Solid, RoiError>> = parts.par_iter().map(cut).collect();
    let mut solids = Vec::new();
    let mut nothing = parts.is_empty().then_some(RoiError::NothingCut);
    for solid in cuts {
        match solid {
            Err(error @ (RoiError::TooSmall { .. } | RoiError::NothingCut)) => {
                nothing.get_or_insert(error);
            }
            solid => solids.push(solid?),
        }
    }
    match nothing {
        Some(error) if solids.is_empty() => Err(error),
        _ => Ok(solids),
    }
}

/// The solid under a patch; nothing is counted of the selection.
fn cut_out(
    mesh: &TriangleMesh,
    patch: &Patch,
    request: &SolidRequest,
    inward: Vector,
    task: &Task,
) -> Result<Solid, RoiError> {
    let space = patch.space().ok_or(RoiError::NothingCut)?;
    let (area_mm2, is_patch) = (patch.area_mm2(), patch.of_mesh());
    let thickness_mm = request.thickness.mm();
    let step_mm = fitting_step_mm(mesh, &space, area_mm2, request)?;
    let mut fine = patch.clone();
    let longest_mm = (EDGE_STEPS * step_mm).min(area_mm2.sqrt() / EDGES_IN_WIDTH);
    fine.refine(&space.wider(EDGES_BESIDE * longest_mm), longest_mm, task)?;
    let outline = Outline::of(&fine, BESIDE_MM, task)?;
    let sheet = Sheet::of(&fine.near, &outline, thickness_mm)?;
    let width_mm = sheet.inside_mm.iter().copied().fold(0.0, f64::max);
    if width_mm < LEAST_STEPS * step_mm {
        return Err(RoiError::TooSmall { area_mm2 });
    }
    let cut = Cut {
        request,
        step_mm,
        inward,
        sheet,
        margin_mm: 0.0,
    };
    let (cut, gap_mm) = match request.direction {
        Direction::Outward => plate(cut, mesh, &is_patch, task)?,
        _ => (cut.sound(mesh, &is_patch, task)?, None),
    };
    Ok(Solid {
        mesh: cut,
        selected: 0,
        patch_mm2: area_mm2,
        inward,
        dropped: 0,
        closed: 0,
        gap_mm,
    })
}

/// How far apart the nodes are for a patch of that box and area, where so thin a cut can be told at all.
fn fitting_step_mm(
    mesh: &TriangleMesh,
    space: &Space,
    area_mm2: f64,
    request: &SolidRequest,
) -> Result<f64, RoiError> {
    let thickness_mm = request.thickness.mm();
    let cut_space = match (request.direction, mesh.bounds_mm()) {
        (Direction::Normal | Direction::Through | Direction::Along(_), Some([low, high])) => {
            space.wider(thickness_mm).common(&Space { low, high })
        }
        _ => space.wider(request.reach_mm()),
    };
    let mut step_mm = step_mm(area_mm2, thickness_mm);
    if request.direction == Direction::Outward {
        step_mm = step_mm.min(request.clearance.mm().max(PLATE_STEP_MM));
    }
    let step_mm = affordable_mm(&cut_space, step_mm);
    let least_mm = LEAST_STEPS * step_mm;
    if thickness_mm < least_mm {
        return Err(RoiError::TooThin {
            thickness_mm,
            area_mm2,
            // As many hundredths as it is said with.
            least_mm: (100.0 * least_mm).ceil() / 100.0,
        });
    }
    Ok(step_mm)
}
