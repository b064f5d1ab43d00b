//! The region of interest, with its report.

use std::num::NonZeroUsize;
use std::time::Instant;

use bonemesh_mesh::{HoleLimits, TriangleMesh, fill_holes};
use bonemesh_roi::{
    ClearanceMm, Direction, Method, RoiError, Solid, SolidRequest, ThicknessMm, counterpart,
    select_region, select_solid,
};
use bonemesh_task::{Task, pool};

use crate::mirror::{ChosenPlane, PlaneChoice};
use crate::region_report::{RegionReport, SolidReport, ThesisReport};
use crate::report::check;
use crate::{Error, choices};

/// What a user chooses for one region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionRequest {
    /// How deep the region reaches below the selection, or how thick a plate is.
    pub thickness: ThicknessMm,
    /// How the region is found.
    pub method: Method,
    /// Which way a solid is cut.
    pub direction: Direction,
    /// The gap between bone and plate.
    pub clearance: ClearanceMm,
    /// Whether selected pieces that are hidden behind others count, too.
    pub with_hidden: bool,
    /// Takes the other side's counterpart of the selection instead.
    pub mirror: Option<Mirror>,
    /// Worker threads; `None` is one per core. The result does not depend on it.
    pub threads: Option<NonZeroUsize>,
}

/// How the other side's counterpart is found, and where it is put.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// The plane between the sides.
    pub plane: PlaneChoice,
    /// Whether the counterpart is mirrored to where the selection is; else it stays where it was taken.
    pub back: bool,
}

impl RegionRequest {
    /// A solid of that thickness, everything else as usual.
    pub fn new(thickness: ThicknessMm) -> Self {
        Self {
            thickness,
            method: Method::default(),
            direction: Direction::default(),
            clearance: ClearanceMm::default(),
            with_hidden: false,
            mirror: None,
            threads: None,
        }
    }

    /// Refuses what says nothing to the method or the direction.
    fn refuse_unused(&self) -> Result<(), Error> {
        let is_thesis = self.method == Method::Thesis;
        let has_clearance = self.clearance != ClearanceMm::default();
        let unused = [
            (
                is_thesis && self.direction != Direction::default(),
                "`direction`",
            ),
            (is_thesis && has_clearance, "`clearance`"),
            (is_thesis && self.with_hidden, "`hidden`"),
            (is_thesis && self.mirror.is_some(), "`mirror`"),
        ];
        if let Some((_, choice)) = unused.into_iter().find(|(is_unused, _)| *is_unused) {
            return Err(choices::not_for_region(choice, self.method));
        }
        if has_clearance && self.direction != Direction::Outward {
            return Err(Error::NoPlate);
        }
        Ok(())
    }
}

/// A region as its own mesh, and what is to be said of it.
#[derive(Clone, Debug)]
pub struct RegionResult {
    /// The region, in the frame of the mesh it was taken from.
    pub mesh: TriangleMesh,
    /// Counts, topology, time.
    pub report: RegionReport,
}

/// Takes the region under the `selected` vertices out of `mesh` as a mesh of its own.
///
/// # Errors
/// [`Error::Roi`] when the selection, the thickness or the mesh does not allow it, [`Error::NotForMethod`] or
/// [`Error::NoPlate`] for choices that do not go together.
pub fn select_roi(
    mesh: &TriangleMesh,
    selected: &[u32],
    request: &RegionRequest,
    task: &Task,
) -> Result<RegionResult, Error> {
    request.refuse_unused()?;
    pool(request.threads)?.install(|| {
        let clock = Instant::now();
        let (mesh, thesis, solid) = if request.method == Method::Thesis {
            let region = select_region(mesh, selected, request.thickness, task)?;
            let report = ThesisReport::new(&region);
            (region.mesh, Some(report), None)
        } else {
            let (mesh, report) = solid_region(mesh, selected, request, task)?;
            (mesh, None, Some(report))
        };
        let topology = check(&mesh, task)?;
        let seconds = clock.elapsed().as_secs_f64();
        let report = RegionReport::new(request, thesis, solid, &topology, seconds);
        Ok(RegionResult { mesh, report })
    })
}

fn solid_region(
    mesh: &TriangleMesh,
    selected: &[u32],
    request: &RegionRequest,
    task: &Task,
) -> Result<(TriangleMesh, SolidReport), Error> {
    let Some(mirror) = request.mirror else {
        let (solid, filled_holes) = solid_with_holes_filled(mesh, selected, request, None, task)?;
        return Ok(SolidReport::of(solid, filled_holes, None));
    };
    let chosen = mirror.plane.choose(mesh, request.threads, task)?;
    let other = counterpart(mesh, selected, &chosen.plane, task)?;
    let (mut solid, filled_holes) =
        solid_with_holes_filled(mesh, &other, request, Some(&chosen), task)?;
    if mirror.back {
        solid.mesh = solid.mesh.mirrored(&chosen.plane);
    }
    Ok(SolidReport::of(solid, filled_holes, Some(chosen.report)))
}

/// Cuts; where the surface is open, fills its holes first. Gives how many these were.
fn solid_with_holes_filled(
    mesh: &TriangleMesh,
    selected: &[u32],
    request: &RegionRequest,
    mirror: Option<&ChosenPlane>,
    task: &Task,
) -> Result<(Solid, usize), Error> {
    // What is given for the selection's side is mirrored for the other.
    let direction = match (request.direction, mirror) {
        (Direction::Along(d), Some(chosen)) => {
            Direction::along(chosen.plane.mirrored_direction(d))?
        }
        (direction, _) => direction,
    };
    let request = SolidRequest {
        thickness: request.thickness,
        direction,
        clearance: request.clearance,
        with_hidden: request.with_hidden,
    };
    match select_solid(mesh, selected, &request, task) {
        Err(RoiError::Open) => {
            let filled = fill_holes(mesh, HoleLimits::default(), task)?;
            // Vertices at one place become one, and then the selection's numbers are others.
            if filled.filled == 0 || filled.mesh.vertices_mm().len() != mesh.vertices_mm().len() {
                return Err(RoiError::Open.into());
            }
            let solid = select_solid(&filled.mesh, selected, &request, task)?;
            Ok((solid, filled.filled))
        }
        solid => Ok((solid?, 0)),
    }
}
