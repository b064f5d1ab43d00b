//! What is done to a finished mesh: triangles that are no surface, winding, holes, islands, cavities, smoothing, fewer triangles.

use std::time::Instant;

use bonemesh_mesh::{
    Decimation, HoleLeft, HoleLimits, HoleReason, HolesFilled, Islands, Kept, TriangleMesh,
    TriangleTree, check_topology, clean, decimate, face_outward, fill_cavities, fill_holes,
    keep_islands, smooth,
};
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;
use serde::Serialize;

use crate::Error;
use crate::render::Rendered;
use crate::report::check;

/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 12;

/// Which cavities are filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cavities {
    /// All: medullary canals, sinuses, pores.
    All,
    /// Those of at most this volume (mm3).
    AtMostMm3(f64),
}

/// Which holes are filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Holes {
    /// All.
    All,
    /// Those whose box along the axes has no side longer than this (mm).
    AtMostMm(f64),
}

/// What is done to a finished mesh, in the order of the fields; by default nothing.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct AfterCare {
    /// Whether triangles without area and those given twice are taken out. Meshes that are rendered have none.
    pub clean: bool,
    /// Whether triangles that face another way than their neighbours, and parts that are inside out, are
    /// turned over. Meshes that are rendered have none.
    pub face_outward: bool,
    /// Which holes are filled; `None` fills none.
    pub holes: Option<Holes>,
    /// Which islands are kept; `None` keeps all, but of an isosurface or labelled one that is
    /// rendered leaves out specks, of less than 1 mm3 and 8 voxels.
    pub islands: Option<Islands>,
    /// Which cavities are filled; `None` fills none.
    pub cavities: Option<Cavities>,
    /// Smooths, and moves no vertex further than this (mm); `None` does not smooth.
    pub smooth_mm: Option<f64>,
    /// Takes triangles away until there are this many, or as far as an error bound allows.
    pub decimation: Decimation,
}

/// What [`care_for`] did.
#[derive(Clone, Debug, PartialEq, Default, Serialize)]
pub struct AfterCareReport {
    /// Triangles without area that were taken out.
    pub removed_degenerate: usize,
    /// Triangles taken out because others have the same corners.
    pub removed_doubled: usize,
    /// Triangles turned over; `None` if none were to be.
    pub turned_triangles: Option<usize>,
    /// Holes filled; `None` if none were to be.
    pub filled_holes: Option<usize>,
    /// Holes that are still there after filling.
    pub left_holes: Option<usize>,
    /// The largest of them, at most [`MOST_NAMED`].
    pub largest_left_holes: Vec<LeftHole>,
    /// Islands taken away.
    pub removed_islands: usize,
    /// Their volume, cavities counted in.
    pub removed_islands_mm3: f64,
    /// Cavities filled, and those that went with their islands.
    pub removed_cavities: usize,
    /// Their volume.
    pub removed_cavities_mm3: f64,
    /// The furthest that smoothing moved a vertex; `None` without smoothing.
    pub largest_move_mm: Option<f64>,
    /// Vertices that smoothing left in place, because the surface would have passed through itself.
    pub put_back_vertices: Option<usize>,
    /// Triangles that decimation took away; `None` without decimation.
    pub removed_triangles: Option<usize>,
    /// The number of triangles that was asked for, if there are more.
    pub missed_triangles: Option<usize>,
    /// Vertices that decimation left alone with their triangles, because the surface would have
    /// passed through itself or left the error bound.
    pub held_vertices: Option<usize>,
    /// The furthest that a vertex which decimation was given is from the surface it left; `None` without
    /// decimation.
    pub largest_distance_mm: Option<f64>,
    /// By how much smoothing and decimation changed the volume; `None` without them or of an open mesh.
    pub volume_change_percent: Option<f64>,
    /// Seconds that it took.
    pub seconds: f64,
}

/// Holes that a report names one by one.
pub const MOST_NAMED: usize = 20;

/// A hole that is still there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftHole {
    /// How many edges its rim has.
    pub edges: usize,
    /// The longest side of its box along the axes.
    pub extent_mm: f64,
    /// The middle of that box.
    pub place_mm: [f64; 3],
    /// Why it is still there, in a few words.
    pub reason: &'static str,
}

impl From<&HoleLeft> for LeftHole {
    fn from(left: &HoleLeft) -> Self {
        Self {
            edges: left.edges,
            extent_mm: left.extent_mm,
            place_mm: left.place_mm,
            reason: match left.reason {
                HoleReason::TooLarge => "larger than asked for",
                HoleReason::NoLoop => {
                    "its rim is no closed loop: triangles are turned over or the edge is non-manifold"
                }
                HoleReason::Blocked => "the surface is in the way",
                _ => "it cannot be filled",
            },
        }
    }
}

impl AfterCare {
    /// Whether nothing is to be done.
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }

    /// Whether the surface is moved.
    fn reshapes(&self) -> bool {
        self.smooth_mm.is_some() || self.decimation != Decimation::default()
    }

    /// Refuses what cannot be done to any mesh, before long work begins.
    ///
    /// # Errors
    /// [`Error::Mesh`] for a number of triangles or a length that is none.
    pub fn check(&self) -> Result<(), Error> {
        Ok(self.decimation.check()?)
    }
}

/// Does to `mesh` what `care` asks for.
///
/// # Errors
/// [`Error::NoIslandLeft`], [`Error::Mesh`] for a value that is no length or volume, or a
/// cancelled task.
pub fn care_for(
    mesh: TriangleMesh,
    care: &AfterCare,
    task: &Task,
) -> Result<(TriangleMesh, AfterCareReport), Error> {
    let clock = Instant::now();
    care.check()?;
    let mut report = AfterCareReport::default();
    let mut mesh = mesh;
    if care.clean {
        let cleaned = clean(&mesh, task)?;
        report.removed_degenerate = cleaned.degenerate;
        report.removed_doubled = cleaned.doubled;
        mesh = cleaned.mesh;
    }
    if care.face_outward {
        let faced = face_outward(&mesh, task)?;
        report.turned_triangles = Some(faced.turned);
        mesh = faced.mesh;
    }
    if let Some(holes) = care.holes {
        let limits = HoleLimits {
            at_most_mm: match holes {
                Holes::All => None,
                Holes::AtMostMm(most) => Some(most),
            },
            at_most_edges: None,
        };
        mesh = report.with_lids(fill_holes(&mesh, limits, task)?);
        if care.face_outward {
            // Of an open part it is not known which way is out.
            let faced = face_outward(&mesh, task)?;
            report.turned_triangles = report.turned_triangles.max(Some(faced.turned));
            mesh = faced.mesh;
        }
    }
    if let Some(islands) = &care.islands {
        let had_triangles = !mesh.triangles().is_empty();
        let kept = keep_islands(&mesh, islands, task)?;
        if had_triangles && kept.mesh.triangles().is_empty() {
            let largest_mm3 = kept.removed.first().map_or(0.0, |part| part.volume_mm3);
            return Err(Error::NoIslandLeft { largest_mm3 });
        }
        mesh = report.without(kept);
    }
    if let Some(cavities) = care.cavities {
        let most = match cavities {
            Cavities::All => None,
            Cavities::AtMostMm3(most) => Some(most),
        };
        mesh = report.without(fill_cavities(&mesh, most, task)?);
    }
    let before = care.reshapes().then(|| mesh.clone());
    if let Some(tolerance_mm) = care.smooth_mm {
        let smoothed = smooth(&mesh, tolerance_mm, task)?;
        report.largest_move_mm = Some(smoothed.largest_move_mm);
        report.put_back_vertices = Some(smoothed.put_back);
        mesh = smoothed.mesh;
    }
    if care.decimation != Decimation::default() {
        let decimated = decimate(&mesh, care.decimation, task)?;
        let left = decimated.mesh.triangles().len();
        report.removed_triangles = Some(mesh.triangles().len() - left);
        report.missed_triangles = care.decimation.triangles.filter(|wanted| left > *wanted);
        report.held_vertices = Some(decimated.held_vertices);
        report.largest_distance_mm = largest_distance_mm(&mesh, &decimated.mesh, task)?;
        mesh = decimated.mesh;
    }
    if let Some(before) = before {
        report.volume_change_percent = volume_change_percent(&before, &mesh, task)?;
    }
    report.seconds = clock.elapsed().as_secs_f64();
    Ok((mesh, report))
}

impl AfterCareReport {
    /// Notes which holes are filled and gives the mesh without them.
    fn with_lids(&mut self, filled: HolesFilled) -> TriangleMesh {
        self.filled_holes = Some(filled.filled);
        self.left_holes = Some(filled.left.len());
        self.largest_left_holes = filled
            .left
            .iter()
            .take(MOST_NAMED)
            .map(LeftHole::from)
            .collect();
        filled.mesh
    }

    /// Notes what is gone and gives what is left.
    fn without(&mut self, kept: Kept) -> TriangleMesh {
        for part in &kept.removed {
            if part.is_cavity {
                self.removed_cavities += 1;
                self.removed_cavities_mm3 += part.volume_mm3;
            } else {
                self.removed_islands += 1;
                self.removed_islands_mm3 += part.volume_mm3;
            }
        }
        kept.mesh
    }
}

/// The furthest that a vertex of `given` is from the surface `left`; `None` if there is no surface.
fn largest_distance_mm(
    given: &TriangleMesh,
    left: &TriangleMesh,
    task: &Task,
) -> Result<Option<f64>, Error> {
    let tree = TriangleTree::new(left, task)?;
    task.begin("deviation", given.vertices_mm().len());
    let chunks = given.vertices_mm().par_chunks(STRIDE).map(|places| {
        task.advance(places.len())?;
        let distances = places
            .iter()
            .filter_map(|place| tree.nearest(*place, f64::INFINITY));
        Ok(distances
            .map(|nearest| nearest.squared_mm2.sqrt())
            .reduce(f64::max))
    });
    let largest: Vec<Option<f64>> = chunks.collect::<Result<_, Cancelled>>()?;
    Ok(largest.into_iter().flatten().reduce(f64::max))
}

/// By how much the volume of a closed mesh changed.
fn volume_change_percent(
    before: &TriangleMesh,
    after: &TriangleMesh,
    task: &Task,
) -> Result<Option<f64>, Error> {
    let before = check_topology(before, task)?;
    let after = check_topology(after, task)?;
    let is_known = before.watertight && after.watertight && before.volume_mm3 != 0.0;
    let ratio = after.volume_mm3 / before.volume_mm3;
    Ok(is_known.then_some(100.0 * (ratio - 1.0)))
}

/// The rendered mesh after `care`, its report brought up to date.
pub(crate) fn cared_for(
    rendered: Rendered,
    care: &AfterCare,
    task: &Task,
) -> Result<Rendered, Error> {
    if care.is_nothing() {
        return Ok(rendered);
    }
    let Rendered { mesh, mut report } = rendered;
    let (mesh, done) = care_for(mesh, care, task)?;
    let topology = check(&mesh, task)?;
    report.vertices = topology.vertices;
    report.triangles = topology.triangles;
    report.watertight = topology.watertight;
    report.manifold = topology.manifold;
    report.components = topology.components;
    report.cavities = topology.cavities;
    report.volume_mm3 = topology.volume_mm3;
    report.seconds.total += done.seconds;
    report.after_care = Some(done);
    Ok(Rendered { mesh, report })
}

/// `largest`, a volume in mm3, or places in mm.
///
/// # Errors
/// One line that says what to write instead.
pub(crate) fn islands(text: &str) -> Result<Islands, String> {
    if text.contains([',', ';']) {
        let places: Result<Vec<[f64; 3]>, String> = text.split(';').map(place).collect();
        return places.map(Islands::At);
    }
    match text {
        "largest" => Ok(Islands::Largest),
        _ => volume(text, "largest` or a place `X,Y,Z").map(Islands::AtLeastMm3),
    }
}

/// Three coordinates in mm.
fn place(text: &str) -> Result<[f64; 3], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    let place = numbers.ok().and_then(|numbers| numbers.try_into().ok());
    place
        .filter(|place: &[f64; 3]| place.iter().all(|mm| mm.is_finite()))
        .ok_or_else(|| format!("`{text}` is no place; write X,Y,Z in mm, for example 0,-90,40"))
}

/// `all`, or a volume in mm3.
///
/// # Errors
/// One line that says what to write instead.
pub(crate) fn cavities(text: &str) -> Result<Cavities, String> {
    match text {
        "all" => Ok(Cavities::All),
        _ => volume(text, "all").map(Cavities::AtMostMm3),
    }
}

/// `all`, or a length in mm.
///
/// # Errors
/// One line that says what to write instead.
pub(crate) fn holes(text: &str) -> Result<Holes, String> {
    match text.parse() {
        _ if text == "all" => Ok(Holes::All),
        Ok(most) if (0.0..=f64::MAX).contains(&most) => Ok(Holes::AtMostMm(most)),
        _ => Err(format!(
            "`{text}` is no length; write a number of mm, or `all`"
        )),
    }
}

fn volume(text: &str, word: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=f64::MAX).contains(&value) => Ok(value),
        _ => Err(format!(
            "`{text}` is no volume; write a number of mm3, or `{word}`"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron, 9 mm and 3 mm long, that lacks one side each.
    fn open_tetrahedra() -> TriangleMesh {
        let corners = |at: f64, size: f64| {
            [
                [at, 0.0, 0.0],
                [at + size, 0.0, 0.0],
                [at, size, 0.0],
                [at, 0.0, size],
            ]
        };
        let vertices = [corners(0.0, 9.0), corners(20.0, 3.0)].concat();
        let sides = [[0, 2, 1], [0, 1, 3], [0, 3, 2]];
        let triangles = [0, 4].map(|first| sides.map(|side| side.map(|v| v + first)));
        TriangleMesh::new(vertices, triangles.concat()).expect("the numbers are those of vertices")
    }

    #[test]
    fn holes_are_filled_up_to_a_length_and_the_report_names_the_others() {
        for (text, filled) in [("all", 2), ("5", 1), ("0.5", 0)] {
            let care = AfterCare {
                holes: Some(holes(text).expect("it is a length")),
                ..AfterCare::default()
            };
            let cared = care_for(open_tetrahedra(), &care, &Task::default());
            let (mesh, report) = cared.expect("the length is one");
            assert_eq!(mesh.triangles().len(), 6 + filled);
            assert_eq!(report.filled_holes, Some(filled));
            assert_eq!(report.left_holes, Some(2 - filled));
            assert_eq!(report.largest_left_holes.len(), 2 - filled);
            let reasons = report.largest_left_holes.iter().map(|left| left.reason);
            assert!(
                reasons
                    .into_iter()
                    .all(|why| why == "larger than asked for")
            );
        }
    }

    #[test]
    fn what_is_no_length_of_holes_is_refused_with_a_remedy() {
        for text in ["", "every", "-1", "nan", "inf"] {
            let message = holes(text).expect_err("it is no length");
            assert!(message.contains("or `all`"), "{message}");
        }
    }
}
