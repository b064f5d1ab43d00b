//! The bone under a selected patch as a solid of its own.
//!
//! 1. [`crop`]: what lies around the selection, so that the work does not depend on the size of the mesh.
//! 2. [`patch`]: which triangles were meant.
//! 3. [`refine`], [`outline`]: the patch's outline, smooth, and how far vertices are from it.
//! 4. [`sheet`]: the patch and what is around it, as places are looked up; [`far_side`]: how deep the bone
//!    below it is.
//! 5. [`cutter`]: the body of all places that belong to the patch, [`below`] it or [`straight`] behind it, on
//!    the nodes of a [`lattice`].
//! 6. [`boolean`]: what bone and cutter have in common.
//! 7. [`finish`]: the part of it at the patch, checked as a file would hold it. Where 32-bit coordinates
//!    make triangles meet, the cutter is moved by microns and cuts again.

mod below;
mod boolean;
mod crop;
mod cutter;
mod far_side;
mod finish;
mod flaps;
mod lattice;
mod outline;
mod patch;
mod refine;
mod sheet;
mod straight;

use bonemesh_mesh::{TriangleMesh, TriangleTree};
use bonemesh_task::Task;
use rustc_hash::FxHashSet;

use self::below::Below;
use self::boolean::{Body, Bone};
pub(crate) use self::crop::{Neighbourhood, Space};
pub(crate) use self::lattice::Frame;
pub(crate) use self::straight::covered;

use self::crop::Part;
use self::cutter::Cutter;
use self::far_side::end_at_far_side;
use self::finish::{Finished, at_patch, finished};
use self::lattice::{Lattice, affordable_mm, step_mm};
use self::outline::Outline;
use self::patch::Patch;
use self::refine::Fine;
use self::sheet::Sheet;
use self::straight::Straight;
use crate::selection::Selection;
use crate::vector::{Vector, plus_scaled};
use crate::{ClearanceMm, Direction, RoiError, ThicknessMm};

/// Places of the cutter that are tried.
const TRIES: u32 = 12;
/// How far (mm) around the selection, and around a plate, is looked at.
const BESIDE_MM: f64 = 3.0;
/// How far (mm, and steps) beyond what is cut the bone is closed with lids: farther than the lattice goes.
const LID_MM: f64 = 0.5;
const LID_BEYOND_STEPS: f64 = 4.0;
/// Steps that the lid lies above the patch, so that nothing of it lies in the bone's surface.
const LID_STEPS: f64 = 2.5;
/// Longest edges, in steps, of triangles that places are looked up on.
const EDGE_STEPS: f64 = 3.0;
/// At least so many of them in the patch's width, and so many beside it.
const EDGES_IN_WIDTH: f64 = 6.0;
const EDGES_BESIDE: f64 = 6.0;
/// Least distance, in steps, from the outline to the middle of a patch.
const LEAST_WIDTH_STEPS: f64 = 1.5;
/// How far (mm) the smoothed patch may lie outside of the bone, where a plate keeps its distance.
const SMOOTHED_MM: f64 = 1.0;
/// How far what is cut bulges, in parts of the thickness: at a crease, between what lies below its two sides.
const BULGE: f64 = 0.3;
/// How far (mm) the cutter is moved from try to try, at most: less than a scan can tell.
const MOVE_MM: f64 = 0.02;
/// Parts of that by which it is moved along each axis: multiples of these never come back.
const SHIFTS: [f64; 3] = [
    0.618_033_988_749_895,
    0.754_877_666_246_693,
    0.819_172_513_396_164,
];

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
}

/// The bone of `mesh` under the `selected` vertices, down to the thickness or to the far side of the bone; or
/// the plate of that thickness on it.
///
/// The front are the triangles of the mesh, unchanged but along the outline, which runs smoothly between
/// selected vertices and others; the sides stand upright on the surface, or lie along a straight direction;
/// the back is the bone's far side where that is within reach, else as deep as the thickness below the
/// nearest place of the patch, or straight behind it. A plate keeps its clearance from all bone near, and its
/// outer side follows the patch smoothed. The result is the same for any number of threads and any order of
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
    let place = |vertex: &u32| mesh.vertices_mm()[*vertex as usize];
    let space = Space::of(selection.indices().iter().map(place)).ok_or(RoiError::NoSelection)?;
    let near = Neighbourhood::around(mesh, &space.wider(2.0 * BESIDE_MM), task)?;
    let of_mesh = near.of_mesh.iter();
    let is_selected: Vec<bool> = of_mesh.map(|v| selection.contains(*v)).collect();
    let view = request.direction.given();
    let patch = Patch::of(&near, &is_selected, view, request.with_hidden, task)?;
    let inward = patch.inward(&near);
    let step_mm = step_mm(patch.area_mm2, request.thickness.mm());
    let is_patch = whole_triangles(&near, &patch);
    let fine = Fine {
        near,
        has_triangle: patch.has_triangle,
        is_selected,
    };
    let space = fine.patch_space().ok_or(RoiError::NothingCut)?;
    let mut fine = fine.restricted(&space.wider(2.0 * BESIDE_MM));
    let longest_mm = (EDGE_STEPS * step_mm).min(patch.area_mm2.sqrt() / EDGES_IN_WIDTH);
    fine.refine(&space.wider(EDGES_BESIDE * longest_mm), longest_mm);
    let outline = Outline::of(&fine, BESIDE_MM, task)?;
    let sheet = Sheet::of(&fine.near, &outline, request.thickness.mm())?;
    let width_mm = sheet.inside_mm.iter().copied().fold(0.0, f64::max);
    if width_mm < LEAST_WIDTH_STEPS * step_mm {
        return Err(RoiError::TooSmall {
            area_mm2: patch.area_mm2,
        });
    }
    let cut = Cut {
        request,
        step_mm,
        inward,
        sheet,
    };
    Ok(Solid {
        mesh: cut.sound(mesh, &is_patch, task)?,
        selected: selection.indices().len(),
        patch_mm2: patch.area_mm2,
        inward,
        dropped: patch.dropped,
        closed: patch.closed,
    })
}

/// The patch's triangles as the whole mesh numbers them.
fn whole_triangles(near: &Neighbourhood, patch: &Patch) -> FxHashSet<[u32; 3]> {
    let triangles = near.triangles.iter().zip(&patch.has_triangle);
    let own = triangles.filter(|(_, has)| **has);
    own.map(|(t, _)| t.map(|v| near.of_mesh[v as usize]))
        .collect()
}

/// What is known before the bone is looked at.
struct Cut<'a> {
    request: &'a SolidRequest,
    step_mm: f64,
    /// The patch's mean direction into the bone.
    inward: Vector,
    sheet: Sheet,
}

impl Cut<'_> {
    /// The first sound solid of several lattices.
    fn sound(
        mut self,
        mesh: &TriangleMesh,
        is_patch: &FxHashSet<[u32; 3]>,
        task: &Task,
    ) -> Result<TriangleMesh, RoiError> {
        let straight = self.straight();
        let frame = straight.map_or(Frame::PATIENT, Frame::along);
        let space = self.space(frame).ok_or(RoiError::NothingCut)?;
        self.step_mm = affordable_mm(&space, self.step_mm);
        let around = self.space(Frame::PATIENT).ok_or(RoiError::NothingCut)?;
        let is_plate = self.request.direction == Direction::Outward;
        let beside_mm = LID_MM.max(LID_BEYOND_STEPS * self.step_mm);
        let beside_mm = if is_plate {
            BESIDE_MM.max(beside_mm)
        } else {
            beside_mm
        };
        let part = Part::of(mesh, &around.wider(beside_mm), task)?;
        let is_front = part.is_of(is_patch);
        let bone = TriangleMesh::new(part.vertices_mm, part.triangles)?;
        if matches!(
            self.request.direction,
            Direction::Normal | Direction::Along(_)
        ) {
            let tree = TriangleTree::new(&bone, task)?;
            let thickness_mm = self.request.thickness.mm();
            end_at_far_side(&mut self.sheet, &tree, straight, thickness_mm, task)?;
        }
        let whole = is_plate.then(|| Sheet::whole(bone.clone()));
        let cutter = self.cutter(whole.as_ref(), task)?;
        let bone = (!is_plate).then(|| Bone::of(&Body::of(bone))).transpose()?;
        let lattice = Lattice::around(frame, space, self.step_mm);
        let cutter = Body::of(cutter.surface(&lattice, task)?);
        for attempt in 0..TRIES {
            let cutter = cutter.moved(shift_mm(attempt));
            let cut = match &bone {
                None => cutter,
                // Behind hollows it does not hang together with the patch.
                Some(bone) if self.request.direction == Direction::Through => {
                    bone.common(&cutter, attempt, task)?.0
                }
                Some(bone) => at_patch(bone.common(&cutter, attempt, task)?, &is_front),
            };
            if let Finished::Sound(mesh) = finished(cut, task)? {
                return Ok(mesh);
            }
        }
        Err(RoiError::NoSound { tries: TRIES })
    }

    /// The one direction of a straight cut.
    fn straight(&self) -> Option<Vector> {
        match self.request.direction {
            Direction::Through => Some(self.inward),
            Direction::Along(direction) => Some(direction),
            Direction::Normal | Direction::Outward => None,
        }
    }

    fn lid_mm(&self) -> f64 {
        LID_STEPS * self.step_mm
    }

    /// The box, in a frame, that all that is cut lies in.
    fn space(&self, frame: Frame) -> Option<Space> {
        let thickness_mm = self.request.thickness.mm();
        let [top_mm, bottom_mm] = match self.request.direction {
            Direction::Outward => [thickness_mm + self.request.clearance.mm(), 0.0],
            _ => [self.lid_mm(), thickness_mm],
        };
        let straight = self.straight();
        // Along normals it bulges beyond what lies below the vertices.
        let bulge_mm = if straight.is_some() {
            0.0
        } else {
            BULGE * thickness_mm
        };
        let ends = self.sheet.around_patch().flat_map(|(place, normal)| {
            let outward = straight.map_or(normal, |direction| direction.map(|v| -v));
            [top_mm, -bottom_mm].map(|mm| frame.of(plus_scaled(place, mm, outward)))
        });
        Some(Space::of(ends)?.wider(bulge_mm + 2.0 * self.step_mm))
    }

    /// `whole`: all of the bone near, for a plate that keeps off it.
    fn cutter<'s>(&'s self, whole: Option<&'s Sheet>, task: &Task) -> Result<Cutter<'s>, RoiError> {
        let thickness_mm = self.request.thickness.mm();
        if self.straight().is_some() {
            return Ok(Cutter::Straight(Straight {
                sheet: &self.sheet,
                top_mm: -self.lid_mm(),
            }));
        }
        let sheet = self.sheet.lookup(task)?;
        let Some(whole) = whole else {
            return Ok(Cutter::Below(Below {
                sheet,
                top_mm: -self.lid_mm(),
                bottom_mm: thickness_mm,
                kept_off: None,
            }));
        };
        let clearance_mm = self.request.clearance.mm();
        Ok(Cutter::Below(Below {
            sheet,
            top_mm: -(clearance_mm + thickness_mm),
            bottom_mm: SMOOTHED_MM,
            kept_off: Some((whole.lookup(task)?, clearance_mm)),
        }))
    }
}

/// How far (mm) the cutter is moved for a try; not at all for the first.
fn shift_mm(attempt: u32) -> [f64; 3] {
    SHIFTS.map(|part| {
        let turn = (f64::from(attempt) * part).fract();
        MOVE_MM * if turn > 0.5 { turn - 1.0 } else { turn }
    })
}
