//! The region of interest, with its report.

use std::collections::HashMap;
use std::num::NonZeroUsize;
use std::time::Instant;

use bonemesh_mesh::{HoleLimits, TriangleMesh, face_outward, fill_holes};
use bonemesh_roi::{
    ClearanceMm, Direction, Method, RoiError, Solid, SolidRequest, ThicknessMm, counterpart,
    select_region, select_solid, select_solids,
};
use bonemesh_task::{Task, pool};

use crate::mirror::PlaneChoice;
use crate::region_report::{Mended, RegionReport, SolidReport, ThesisReport};
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
            let solid = solids(mesh, selected, request, false, task)?.pop();
            let (mesh, report) = solid.ok_or(RoiError::NothingCut)?;
            (mesh, None, Some(report))
        };
        RegionResult::of(mesh, thesis, solid, request, &clock, task)
    })
}

/// The same with a solid for each piece of the selection that does not touch the others, the largest piece
/// first. What a report counts of the selection, and the seconds, are those of all of them.
///
/// # Errors
/// As [`select_roi`]; [`Error::NotForMethod`] for the thesis's method, too.
pub fn select_rois(
    mesh: &TriangleMesh,
    selected: &[u32],
    request: &RegionRequest,
    task: &Task,
) -> Result<Vec<RegionResult>, Error> {
    if request.method == Method::Thesis {
        return Err(choices::not_for_region("`separate`", request.method));
    }
    request.refuse_unused()?;
    pool(request.threads)?.install(|| {
        let clock = Instant::now();
        let solids = solids(mesh, selected, request, true, task)?.into_iter();
        let region =
            |(mesh, solid)| RegionResult::of(mesh, None, Some(solid), request, &clock, task);
        solids.map(region).collect()
    })
}

impl RegionResult {
    fn of(
        mesh: TriangleMesh,
        thesis: Option<ThesisReport>,
        solid: Option<SolidReport>,
        request: &RegionRequest,
        clock: &Instant,
        task: &Task,
    ) -> Result<Self, Error> {
        let topology = check(&mesh, task)?;
        let seconds = clock.elapsed().as_secs_f64();
        let report = RegionReport::new(request, thesis, solid, &topology, seconds);
        Ok(Self { mesh, report })
    }
}

/// The solids on the side that is asked for: one, or one for each piece.
fn solids(
    mesh: &TriangleMesh,
    selected: &[u32],
    request: &RegionRequest,
    is_each: bool,
    task: &Task,
) -> Result<Vec<(TriangleMesh, SolidReport)>, Error> {
    let mut solid_request = SolidRequest {
        thickness: request.thickness,
        direction: request.direction,
        clearance: request.clearance,
        with_hidden: request.with_hidden,
    };
    let Some(mirror) = request.mirror else {
        let (solids, mended) = with_mesh_mended(mesh, selected, &solid_request, is_each, task)?;
        let solids = solids.into_iter();
        return Ok(solids
            .map(|solid| SolidReport::of(solid, mended, None))
            .collect());
    };
    let chosen = mirror.plane.choose(mesh, request.threads, task)?;
    // What is given for the selection's side is mirrored for the other.
    if let Direction::Along(direction) = request.direction {
        solid_request.direction = Direction::along(chosen.plane.mirrored_direction(direction))?;
    }
    let other = counterpart(mesh, selected, &chosen.plane, task)?;
    let (solids, mended) = with_mesh_mended(mesh, &other, &solid_request, is_each, task)?;
    let placed = |mut solid: Solid| {
        if mirror.back {
            solid.mesh = solid.mesh.mirrored(&chosen.plane);
        }
        SolidReport::of(solid, mended, Some(chosen.report))
    };
    Ok(solids.into_iter().map(placed).collect())
}

/// Cuts; where the surface is open or does not face one way, joins vertices at one place, turns triangles over
/// and fills the holes first. Gives what of this was done.
fn with_mesh_mended(
    mesh: &TriangleMesh,
    selected: &[u32],
    request: &SolidRequest,
    is_each: bool,
    task: &Task,
) -> Result<(Vec<Solid>, Mended), Error> {
    let cut = |mesh: &TriangleMesh, selected: &[u32]| {
        if is_each {
            select_solids(mesh, selected, request, task)
        } else {
            Ok(vec![select_solid(mesh, selected, request, task)?])
        }
    };
    match cut(mesh, selected) {
        Err(RoiError::Open) => {
            let faced = face_outward(mesh, task)?;
            let filled = fill_holes(&faced.mesh, HoleLimits::default(), task)?;
            let mended = Mended {
                turned_triangles: faced.turned,
                filled_holes: filled.filled,
            };
            let selected = renumbered(selected, mesh, &filled.mesh);
            Ok((cut(&filled.mesh, &selected)?, mended))
        }
        solids => Ok((solids?, Mended::default())),
    }
}

/// The vertices of another mesh that lie where these of the first do, in the 32-bit coordinates of files.
fn renumbered(selected: &[u32], from: &TriangleMesh, to: &TriangleMesh) -> Vec<u32> {
    // Adding 0 makes one zero of the two.
    let key = |place: &[f64; 3]| place.map(|v| (v as f32 + 0.0).to_bits());
    let numbers: HashMap<_, _> = (0_u32..)
        .zip(to.vertices_mm())
        .map(|(number, place)| (key(place), number))
        .collect();
    let places = selected.iter().map(|v| &from.vertices_mm()[*v as usize]);
    places
        .filter_map(|place| numbers.get(&key(place)).copied())
        .collect()
}
