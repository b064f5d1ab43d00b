//! The region of interest, with its report.

use std::collections::HashMap;
use std::num::NonZeroUsize;
use std::time::Instant;

use bonemesh_mesh::{
    HoleLimits, TriangleMesh, TriangleTree, check_nesting, clean, face_outward, fill_holes,
    find_intersections,
};
use bonemesh_roi::{
    ClearanceMm, Direction, Method, RoiError, Solid, SolidRequest, ThicknessMm, counterparts,
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
    let solid_request = SolidRequest {
        thickness: request.thickness,
        direction: request.direction,
        clearance: request.clearance,
        with_hidden: request.with_hidden,
    };
    if let Some(mirror) = request.mirror {
        let how = (request.threads, is_each);
        return opposite_solids(mesh, selected, solid_request, mirror, how, task);
    }
    let (solids, mended) = with_mesh_mended(mesh, selected, &solid_request, is_each, task)?;
    let solids = solids.into_iter();
    Ok(solids
        .map(|solid| SolidReport::of(solid, mended, None))
        .collect())
}

/// The solids of the other side's counterpart of the selection, each of its sides cut on its own.
fn opposite_solids(
    mesh: &TriangleMesh,
    selected: &[u32],
    mut request: SolidRequest,
    mirror: Mirror,
    (threads, is_each): (Option<NonZeroUsize>, bool),
    task: &Task,
) -> Result<Vec<(TriangleMesh, SolidReport)>, Error> {
    // Which side is the other, and which way is out there, is told by what triangles face.
    let faced = face_outward(mesh, task)?;
    let selected = match faced.turned {
        0 => selected.to_vec(),
        _ => renumbered(selected, mesh, &faced.mesh),
    };
    let mesh = if faced.turned == 0 { mesh } else { &faced.mesh };
    let chosen = mirror.plane.choose(mesh, threads, task)?;
    // What is given for the selection's side is mirrored for the other.
    if let Direction::Along(direction) = request.direction {
        request.direction = Direction::along(chosen.plane.mirrored_direction(direction))?;
    }
    let plane = &chosen.plane;
    let found = counterparts(mesh, &selected, plane, request.with_hidden, task)?;
    let (solids, mut mended) = of_sides(mesh, &found.sides, &mut request, is_each, task)?;
    mended.turned_triangles += faced.turned;
    let placed = |mut solid: Solid| {
        solid.dropped += found.left_out;
        if mirror.back {
            solid.mesh = solid.mesh.mirrored(&chosen.plane);
        }
        SolidReport::of(solid, mended, Some(chosen.report))
    };
    Ok(solids.into_iter().map(placed).collect())
}

/// Each side cut on its own, as the eye before it means it; all together where solids would meet or hidden pieces
/// count.
fn of_sides(
    mesh: &TriangleMesh,
    sides: &[Vec<u32>],
    request: &mut SolidRequest,
    is_each: bool,
    task: &Task,
) -> Result<(Vec<Solid>, Mended), Error> {
    if sides.len() > 1 && !request.with_hidden {
        let mut solids = Vec::new();
        let mut mended = Mended::default();
        for side in sides {
            let (cut, done) = with_mesh_mended(mesh, side, request, is_each, task)?;
            solids.extend(cut);
            mended = mended.most(done);
        }
        let whole = joined(&solids)?;
        if are_apart(&whole.mesh, task)? {
            let solids = if is_each { solids } else { vec![whole] };
            return Ok((solids, mended));
        }
        // What is hidden was left out with its side.
        request.with_hidden = true;
    }
    let mut all = sides.concat();
    all.sort_unstable();
    all.dedup();
    with_mesh_mended(mesh, &all, request, is_each, task)
}

/// Whether closed parts neither pass through one another nor lie in one another.
fn are_apart(mesh: &TriangleMesh, task: &Task) -> Result<bool, Error> {
    let tree = TriangleTree::new(mesh, task)?;
    Ok(find_intersections(&tree, 1, task)?.count == 0 && check_nesting(mesh, task)?.doubled == 0)
}

/// Several solids as one.
fn joined(solids: &[Solid]) -> Result<Solid, Error> {
    let (first, others) = solids.split_first().ok_or(RoiError::NothingCut)?;
    let mut whole = Solid {
        mesh: TriangleMesh::together(solids.iter().map(|solid| &solid.mesh))?,
        ..first.clone()
    };
    for solid in others {
        whole.selected += solid.selected;
        whole.patch_mm2 += solid.patch_mm2;
        whole.dropped += solid.dropped;
        whole.closed += solid.closed;
        let gaps = [whole.gap_mm, solid.gap_mm].into_iter().flatten();
        whole.gap_mm = gaps.reduce(f64::min);
    }
    Ok(whole)
}

/// Cuts; where that fails as it does on a surface that is open or does not face outward, joins vertices at one
/// place, turns triangles over and fills the holes first. Gives what of this was done.
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
    let failed = match cut(mesh, selected) {
        Err(
            error @ (RoiError::Open
            | RoiError::NothingCut
            | RoiError::FacesAway
            | RoiError::NoSound { .. }
            | RoiError::Cut(_)),
        ) => error,
        solids => return Ok((solids?, Mended::default())),
    };
    let (whole, mended) = mended(mesh, task)?;
    if mended == Mended::default() && !matches!(failed, RoiError::Open) {
        return Err(failed.into());
    }
    let selected = renumbered(selected, mesh, &whole);
    Ok((cut(&whole, &selected)?, mended))
}

/// Without triangles that are no surface, turned to face outward, and without holes.
fn mended(mesh: &TriangleMesh, task: &Task) -> Result<(TriangleMesh, Mended), Error> {
    let cleaned = clean(mesh, task)?;
    let faced = face_outward(&cleaned.mesh, task)?;
    let filled = fill_holes(&faced.mesh, HoleLimits::default(), task)?;
    // Of an open part it is not known which way is out.
    let closed = face_outward(&filled.mesh, task)?;
    let mended = Mended {
        removed_triangles: cleaned.degenerate + cleaned.doubled,
        turned_triangles: faced.turned.max(closed.turned),
        filled_holes: filled.filled,
    };
    Ok((closed.mesh, mended))
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
