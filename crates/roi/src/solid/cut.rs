//! The cut itself: from the patch, as places are looked up on it, to a sound solid.

use bonemesh_mesh::{TriangleMesh, TriangleTree, check_topology};
use bonemesh_task::Task;
use rustc_hash::FxHashSet;

use super::below::Below;
use super::boolean::{Body, Stock};
use super::crop::Part;
use super::cutter::Cutter;
use super::far_side::end_at_far_side;
use super::finish::{Finished, finished};
use super::lattice::{Frame, Lattice, affordable_mm};
use super::plate::is_above;
use super::sheet::Sheet;
use super::shells::{at_patch, without_crumbs};
use super::space::Space;
use super::straight::Straight;
use super::{BESIDE_MM, BULGE};
use crate::{Direction, RoiError, SolidRequest};
use bonemesh_mesh::vector::{Vector, cross, dot, minus, plus_scaled};

/// Places of the cutter that are tried.
const TRIES: u32 = 12;
/// How far (mm, and steps) beyond what is cut the bone is closed with lids: farther than the lattice goes.
const LID_MM: f64 = 0.5;
const LID_BEYOND_STEPS: f64 = 4.0;
/// How far (steps, and mm at least) the lid lies above the smoothed patch, so that all of the bone's surface
/// lies below it.
const LID_STEPS: f64 = 1.5;
const LEAST_LID_MM: f64 = 0.8;
/// How far (mm) the smoothed patch may lie outside of the bone, where a plate keeps its distance.
const SMOOTHED_MM: f64 = 1.0;
/// How far (mm) the cutter is moved from try to try, at most: less than a scan can tell.
const MOVE_MM: f64 = 0.02;
/// Parts of that by which it is moved along each axis: multiples of these never come back.
const SHIFTS: [f64; 3] = [
    0.618_033_988_749_895,
    0.754_877_666_246_693,
    0.819_172_513_396_164,
];

/// What is known before the bone is looked at.
#[derive(Clone)]
pub(super) struct Cut<'a> {
    pub(super) request: &'a SolidRequest,
    pub(super) step_mm: f64,
    /// The patch's mean direction into the bone.
    pub(super) inward: Vector,
    pub(super) sheet: Sheet,
    /// How much farther (mm) than its clearance a plate is kept off the bone.
    pub(super) margin_mm: f64,
}

impl Cut<'_> {
    /// The first sound solid of several places of the cutter.
    pub(super) fn sound(
        mut self,
        mesh: &TriangleMesh,
        is_patch: &FxHashSet<[u32; 3]>,
        task: &Task,
    ) -> Result<TriangleMesh, RoiError> {
        let direction = self.request.direction;
        let frame = self.straight().map_or(Frame::PATIENT, Frame::along);
        let space = self.space(mesh, frame).ok_or(RoiError::NothingCut)?;
        self.step_mm = affordable_mm(&space, self.step_mm);
        let around = self.space(mesh, Frame::PATIENT);
        let around = around.ok_or(RoiError::NothingCut)?;
        let part = Part::of(mesh, &around.wider(self.beside_mm()), task)?;
        let is_front = part.is_of(is_patch);
        let bone = TriangleMesh::new(part.vertices_mm, part.triangles)?;
        let lattice = Lattice::around(frame, space, self.step_mm);
        let (stock, cutter) = if direction == Direction::Outward {
            refuse_unsound(&bone, task)?;
            let [sides, between] = self.bodies(&bone, &lattice, task)?;
            (Stock::of(sides, task)?, between)
        } else {
            let body = Body::of(bone.clone());
            // The first has hardly work for more than one thread.
            let (stock, cutter) = rayon::join(
                || Stock::of(body, task),
                || -> Result<Body, RoiError> {
                    let [sides, between] = self.bodies(&bone, &lattice, task)?;
                    Ok(Stock::of(sides, task)?.common(&between, 0, task)?.0)
                },
            );
            let stock = stock?;
            // Of an open surface, which is refused before, that would say nothing.
            if is_inside_out(&bone) {
                return Err(RoiError::NothingCut);
            }
            (stock, cutter?)
        };
        for attempt in 0..TRIES {
            let cut = stock.common(&cutter.moved(shift_mm(attempt)), attempt, task)?;
            let cut = match direction {
                Direction::Normal | Direction::Along(_) => at_patch(cut, &is_front, task)?,
                // Behind hollows it does not hang together with the patch.
                Direction::Through => cut.0,
                Direction::Outward => self.on_patch(cut.0, task)?,
            };
            if let Finished::Sound(mesh) = finished(cut, bone.vertices_mm(), task)? {
                return Ok(mesh);
            }
        }
        Err(RoiError::NoSound { tries: TRIES })
    }

    /// The two bodies of which the cutter is the common part. `bone`: all of it near.
    fn bodies(
        &mut self,
        bone: &TriangleMesh,
        lattice: &Lattice,
        task: &Task,
    ) -> Result<[Body; 2], RoiError> {
        let (straight, thickness_mm) = (self.straight(), self.request.thickness.mm());
        if let Direction::Normal | Direction::Along(_) = self.request.direction {
            let tree = TriangleTree::new(bone, task)?;
            end_at_far_side(&mut self.sheet, &tree, straight, thickness_mm, task)?;
        }
        let is_plate = self.request.direction == Direction::Outward;
        let whole = is_plate.then(|| Sheet::whole(bone.clone()));
        let cutter = self.cutter(whole.as_ref(), task)?;
        cutter.bodies(lattice, task)
    }

    /// Those of a plate's bodies that lie on the patch, without crumbs.
    fn on_patch(&self, cut: Body, task: &Task) -> Result<Body, RoiError> {
        let sheet = self.sheet.lookup(task)?;
        let depth_mm = |place| {
            let seen = sheet.see(place, f64::INFINITY);
            seen.map_or(0.0, |seen| seen.depth_mm)
        };
        without_crumbs(cut, |places| is_above(places, depth_mm), task)
    }

    /// How far (mm) beyond what is cut the bone is closed with lids.
    fn beside_mm(&self) -> f64 {
        let beside_mm = LID_MM.max(LID_BEYOND_STEPS * self.step_mm);
        if self.request.direction == Direction::Outward {
            BESIDE_MM.max(beside_mm)
        } else {
            beside_mm
        }
    }

    fn kept_off_mm(&self) -> f64 {
        self.request.clearance.mm() + self.margin_mm
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
        LEAST_LID_MM.max(LID_STEPS * self.step_mm)
    }

    /// The box, in a frame, that all that is cut lies in.
    fn space(&self, mesh: &TriangleMesh, frame: Frame) -> Option<Space> {
        let thickness_mm = self.request.thickness.mm();
        let [top_mm, bottom_mm] = match self.request.direction {
            Direction::Outward => [thickness_mm + self.kept_off_mm(), 0.0],
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
        let space = Space::of(ends)?.wider(bulge_mm);
        let space = match self.request.direction {
            Direction::Outward => space,
            // Where there is no bone a thickness need not reach.
            _ => space.common(&Space::of(corners(mesh)?.map(|c| frame.of(c)))?),
        };
        Some(space.wider(2.0 * self.step_mm))
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
            return Ok(Cutter::Below(Box::new(Below {
                sheet,
                top_mm: -self.lid_mm(),
                bottom_mm: thickness_mm,
                kept_off: None,
            })));
        };
        let kept_off_mm = self.kept_off_mm();
        Ok(Cutter::Below(Box::new(Below {
            sheet,
            top_mm: -(kept_off_mm + thickness_mm),
            bottom_mm: SMOOTHED_MM,
            kept_off: Some((whole.lookup(task)?, kept_off_mm)),
        })))
    }
}

/// Refuses bone that says nowhere which way is out: a plate takes no boolean with it that would.
fn refuse_unsound(bone: &TriangleMesh, task: &Task) -> Result<(), RoiError> {
    let topology = check_topology(bone, task)?;
    if !topology.watertight || topology.inconsistent_edges > 0 {
        return Err(RoiError::Open);
    }
    if is_inside_out(bone) {
        return Err(RoiError::NothingCut);
    }
    Ok(())
}

/// Whether a closed surface has its inside outside.
pub(crate) fn is_inside_out(mesh: &TriangleMesh) -> bool {
    let Some([from, _]) = mesh.bounds_mm() else {
        return false;
    };
    let parts = mesh.triangles().iter().map(|triangle| {
        let [a, b, c] = mesh.corners_mm(*triangle).map(|corner| minus(corner, from));
        dot(a, cross(b, c))
    });
    parts.sum::<f64>() < 0.0
}

/// The corners of a mesh's box.
fn corners(mesh: &TriangleMesh) -> Option<[Vector; 8]> {
    let ends = mesh.bounds_mm()?;
    let corner = |c: usize| [ends[c & 1][0], ends[c >> 1 & 1][1], ends[c >> 2][2]];
    Some([0, 1, 2, 3, 4, 5, 6, 7].map(corner))
}

/// How far (mm) the cutter is moved for a try; not at all for the first.
fn shift_mm(attempt: u32) -> [f64; 3] {
    SHIFTS.map(|part| {
        let turn = (f64::from(attempt) * part).fract();
        MOVE_MM * if turn > 0.5 { turn - 1.0 } else { turn }
    })
}
