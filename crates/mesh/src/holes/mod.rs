//! Holes closed with triangles over their rims.
//!
//! 1. `Rims::of`: edges of one triangle, followed to loops (`rims`).
//! 2. `cover`: each loop gets the triangulation with the least bend, then the least area
//!    (`triangulate`); long loops are cut along short chords first (`divide`). Triangles that would meet
//!    the surface, exactly, are forbidden and the rest is tried again.
//! 3. `Proposals::kept`: covers of different holes that get in each other's way are tried again one
//!    after the other, on the surface with those that came first.

mod around;
mod cover;
mod divide;
mod rims;
mod triangulate;

use bonemesh_task::Task;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::tree::TriangleTree;
use crate::{MeshError, TriangleMesh, find_intersections};
use cover::{Edge, edge};
use rims::{Loop, Rims};

/// How often holes that get in each other's way are tried again.
const MOST_ROUNDS: usize = 16;
/// Loops done by one thread between two reports of progress.
const STRIDE: usize = 16;

/// Which holes [`fill_holes`] fills; by default all.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct HoleLimits {
    /// Holes with more edges around them stay.
    pub at_most_edges: Option<usize>,
    /// Holes whose box along the axes has a longer side (mm) stay.
    pub at_most_mm: Option<f64>,
}

/// Why a hole is still there.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HoleReason {
    /// It is larger than the limits.
    TooLarge,
    /// Its rim is no closed loop with triangles that all face one way: it ends at a non-manifold
    /// edge, or triangles beside it are turned over, as on a Moebius strip.
    NoLoop,
    /// No triangles over its rim were found that make no edge non-manifold and do not meet the surface.
    Blocked,
}

/// A hole that is still there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoleLeft {
    /// How many edges its rim has.
    pub edges: usize,
    /// The longest side (mm) of its box along the axes.
    pub extent_mm: f64,
    /// The middle (mm) of that box.
    pub place_mm: [f64; 3],
    /// Why it is still there.
    pub reason: HoleReason,
}

/// What [`fill_holes`] gives.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct HolesFilled {
    /// The mesh, in coordinates that a file's 32-bit floats hold; new triangles come last.
    pub mesh: TriangleMesh,
    /// How many holes were filled.
    pub filled: usize,
    /// Holes that are still there, the largest first.
    pub left: Vec<HoleLeft>,
}

/// Fills holes with triangles over their rims; no vertex is added or moved, no triangle taken away.
///
/// The mesh is taken as its file gives it back ([`TriangleMesh::as_written`]). A hole is a loop of edges
/// of one triangle each; loops that touch in a vertex are filled apart. Each gets, of all
/// triangulations of its rim, the one whose largest bend is least, and of those the one of least area;
/// a rim of more than 160 edges is cut along short chords first. New triangles face as
/// those around the hole do. They make no edge non-manifold and meet, exactly, no other triangle:
/// a hole that cannot be filled so stays, and so do faults that the mesh has elsewhere.
///
/// Limits: what was in the hole is not guessed, a large cover is flat; and a surface that should have an
/// opening, like a bowl of one layer, gets a lid.
///
/// Barequet and Sharir, *Filling gaps in the boundary of a polyhedron*, CAGD 1995; the bend as the
/// first measure: Liepa, *Filling holes in meshes*, SGP 2003.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::Length`] for a limit that is no length, [`MeshError::NotFinite`] for a
/// coordinate too large for a 32-bit float, [`MeshError::Cancelled`].
pub fn fill_holes(
    mesh: &TriangleMesh,
    limits: HoleLimits,
    task: &Task,
) -> Result<HolesFilled, MeshError> {
    let most_mm = limits.at_most_mm.map_or(Ok(f64::INFINITY), |mm| {
        MeshError::length("largest hole", mm)
    })?;
    let most_edges = limits.at_most_edges.unwrap_or(usize::MAX);
    let mut mesh = mesh.as_written(task)?;
    task.begin("find holes", mesh.vertices_mm().len());
    let rims = Rims::of(&mesh, task)?;
    let mut left: Vec<HoleLeft> = rims
        .open
        .iter()
        .map(|rim| stays(&mesh, rim, HoleReason::NoLoop))
        .collect();
    let mut waiting = Vec::new();
    for rim in rims.loops {
        let hole = stays(&mesh, &rim, HoleReason::TooLarge);
        if rim.len() > most_edges || hole.extent_mm > most_mm {
            left.push(hole);
        } else {
            waiting.push(rim);
        }
    }
    let mut filled = 0;
    let mut edges = FxHashSet::default();
    for round in 0.. {
        if waiting.is_empty() {
            break;
        }
        if round == 0 {
            edges = edges_between(&mesh, &waiting);
        }
        let proposals = propose(&mesh, waiting, &edges, task)?;
        let blocked = |rim: &Loop| stays(&mesh, rim, HoleReason::Blocked);
        left.extend(proposals.failed.iter().map(blocked));
        let (kept, again) = proposals.kept(&mesh, task)?;
        filled += kept.len();
        waiting = again;
        if round + 1 == MOST_ROUNDS {
            left.extend(waiting.drain(..).map(|rim| blocked(&rim)));
        }
        let (vertices_mm, mut triangles) = mesh.into_parts();
        for triangle in kept.into_iter().flatten() {
            edges.extend(around_triangle(triangle));
            triangles.push(triangle);
        }
        mesh = TriangleMesh::new(vertices_mm, triangles)?;
    }
    left.sort_by(|a, b| b.extent_mm.total_cmp(&a.extent_mm));
    Ok(HolesFilled { mesh, filled, left })
}

/// A hole that stays.
fn stays(mesh: &TriangleMesh, rim: &Loop, reason: HoleReason) -> HoleLeft {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for vertex in rim.iter().flat_map(|rim| [rim.from, rim.to]) {
        let place = mesh.vertices_mm()[vertex as usize];
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    let sides = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    HoleLeft {
        edges: rim.len(),
        extent_mm: sides.into_iter().fold(0.0, f64::max),
        place_mm: [0, 1, 2].map(|axis| f64::midpoint(low[axis], high[axis])),
        reason,
    }
}

/// The edges of the mesh between vertices of these rims: chords may not be among them.
fn edges_between(mesh: &TriangleMesh, rims: &[Loop]) -> FxHashSet<Edge> {
    let mut is_on_rim = vec![false; mesh.vertices_mm().len()];
    for rim in rims.iter().flatten() {
        is_on_rim[rim.from as usize] = true;
    }
    let edges = mesh.triangles().iter().flat_map(|t| around_triangle(*t));
    edges
        .filter(|[u, v]| is_on_rim[*u as usize] && is_on_rim[*v as usize])
        .collect()
}

fn around_triangle([a, b, c]: [u32; 3]) -> [Edge; 3] {
    [edge(a, b), edge(b, c), edge(c, a)]
}

/// The triangles over one hole.
type Cover = Vec<[u32; 3]>;

/// Covers found side by side.
struct Proposals {
    /// Rims, each with its triangles.
    found: Vec<(Loop, Cover)>,
    /// Rims without a cover.
    failed: Vec<Loop>,
}

/// Looks for a cover of each rim on the mesh as it is.
fn propose(
    mesh: &TriangleMesh,
    rims: Vec<Loop>,
    edges: &FxHashSet<Edge>,
    task: &Task,
) -> Result<Proposals, MeshError> {
    let tree = TriangleTree::new(mesh, task)?;
    task.begin("fill holes", rims.len());
    let covers = rims.par_chunks(STRIDE).map(|rims| {
        let covers = rims.iter().map(|rim| {
            let cover = cover::cover(&tree, rim, edges, task)?;
            task.advance(1)?;
            Ok(cover)
        });
        covers.collect::<Result<Vec<_>, MeshError>>()
    });
    let covers = covers.collect::<Result<Vec<_>, _>>()?.concat();
    let (mut found, mut failed) = (Vec::new(), Vec::new());
    for (rim, cover) in rims.into_iter().zip(covers) {
        match cover {
            Some(cover) => found.push((rim, cover)),
            None => failed.push(rim),
        }
    }
    Ok(Proposals { found, failed })
}

impl Proposals {
    /// The covers that are in nobody's way, and the rims of the others. The first is always kept.
    fn kept(self, mesh: &TriangleMesh, task: &Task) -> Result<(Vec<Cover>, Vec<Loop>), MeshError> {
        let mut is_late = vec![false; self.found.len()];
        let mut owners: FxHashMap<Edge, usize> = FxHashMap::default();
        let mut owner_of = Vec::new();
        for (number, (rim, cover)) in self.found.iter().enumerate() {
            let rim: FxHashSet<Edge> = rim.iter().map(|rim| edge(rim.from, rim.to)).collect();
            for &triangle in cover {
                owner_of.push(number);
                let inner = around_triangle(triangle);
                for chord in inner.into_iter().filter(|edge| !rim.contains(edge)) {
                    is_late[number] |= *owners.entry(chord).or_insert(number) != number;
                }
            }
        }
        let all = self.found.iter().flat_map(|(_, cover)| cover).copied();
        let all = TriangleMesh::new(mesh.vertices_mm().to_vec(), all.collect())?;
        let tree = TriangleTree::new(&all, task)?;
        for pair in find_intersections(&tree, usize::MAX, task)?.pairs {
            let [a, b] = pair.triangles.map(|triangle| owner_of[triangle as usize]);
            // Within one hole it has been looked at.
            if a != b {
                is_late[a.max(b)] = true;
            }
        }
        let (mut kept, mut again) = (Vec::new(), Vec::new());
        for ((rim, cover), is_late) in self.found.into_iter().zip(is_late) {
            if is_late {
                again.push(rim);
            } else {
                kept.push(cover);
            }
        }
        Ok((kept, again))
    }
}
