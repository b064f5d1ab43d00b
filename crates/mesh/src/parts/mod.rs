//! Parts of a mesh that share no vertex: islands of bone, and the cavities in them.
//!
//! 1. `Parts::of`: triangles joined to parts, their volumes, and which part lies in which
//!    (`inside`).
//! 2. [`keep_islands`] or [`fill_cavities`] decide which parts go, [`face_outward`] which are turned over.

mod agree;
mod bodies;
mod inside;
mod label;
mod outward;

pub use outward::{FacedOutward, face_outward};

use bonemesh_task::Task;

use crate::distance::squared_distance;
use crate::vector::Vector;
use crate::{MeshError, TriangleMesh};
use label::{Labels, Part};
use rayon::prelude::*;

/// A place that is further than this outside the box of a mesh belongs to none of its islands.
const BESIDE_MM: f64 = 10.0;

/// Which islands [`keep_islands`] keeps.
#[derive(Clone, Debug, PartialEq)]
pub enum Islands {
    /// The one with the largest volume.
    Largest,
    /// All of at least this volume (mm3), their cavities counted in.
    AtLeastMm3(f64),
    /// Those nearest to these places (mm): the bone that a place is in or on, or beside.
    At(Vec<[f64; 3]>),
}

/// A part that is gone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RemovedPart {
    /// The volume (mm3) that it enclosed; of an open part, a guess.
    pub volume_mm3: f64,
    /// How many triangles it had.
    pub triangles: usize,
    /// Whether it was the wall of a cavity; otherwise it was an island.
    pub is_cavity: bool,
}

/// What [`keep_islands`] and [`fill_cavities`] give.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Kept {
    /// The mesh that is left; triangles and vertices in the order they had.
    pub mesh: TriangleMesh,
    /// What is gone, the largest first.
    pub removed: Vec<RemovedPart>,
}

/// Keeps the islands that are large enough, each with its cavities.
///
/// An island is a part that shares no vertex with the rest. A closed part that faces inward and lies in
/// an outward one is a cavity of the innermost such part and stays or goes with it; what floats in a
/// cavity is an island of its own. Which part lies in which is decided exactly, for parts that do
/// not pass through one another. The volume of an open part is that between its triangles and the
/// middle of its box: a guess.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::Volume`] for a volume that is none, [`MeshError::FarPlace`] for a place that is not
/// near the mesh, [`MeshError::Cancelled`].
pub fn keep_islands(mesh: &TriangleMesh, keep: &Islands, task: &Task) -> Result<Kept, MeshError> {
    if let Islands::AtLeastMm3(least) = keep {
        MeshError::volume(*least)?;
    }
    let parts = Parts::of(mesh, task)?;
    let is_kept: Vec<bool> = match keep {
        Islands::AtLeastMm3(least) => {
            let parts = parts.known.iter();
            parts.map(|part| part.volume_mm3.abs() >= *least).collect()
        }
        Islands::Largest => {
            let islands = parts
                .known
                .iter()
                .enumerate()
                .filter(|(_, part)| !part.is_cavity);
            // The first of equals.
            let largest = islands
                .rev()
                .max_by(|(_, a), (_, b)| a.volume_mm3.abs().total_cmp(&b.volume_mm3.abs()));
            let largest = largest.map(|(number, _)| number);
            (0..parts.known.len()).map(|n| Some(n) == largest).collect()
        }
        Islands::At(places_mm) => {
            let mut is_kept = vec![false; parts.known.len()];
            for &place_mm in places_mm {
                task.check()?;
                if let Some(part) = parts.island_at(place_mm)? {
                    is_kept[part] = true;
                }
            }
            is_kept
        }
    };
    let is_kept = parts
        .known
        .iter()
        .enumerate()
        .map(|(number, part)| match part.parent {
            Some(parent) if part.is_cavity => is_kept[parent as usize],
            _ => is_kept[number],
        });
    let is_kept: Vec<bool> = is_kept.collect();
    parts.only(&is_kept)
}

/// An island, as [`take_islands`] shows it.
pub struct Island<'a> {
    /// Its own volume (mm3), below 0 if it faces inward; of an open one, a guess.
    pub volume_mm3: f64,
    mesh: &'a TriangleMesh,
    triangles: &'a [u32],
}

impl Island<'_> {
    /// How many triangles it has.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Never: an island has triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The numbers of its triangles.
    pub fn numbers(&self) -> &[u32] {
        self.triangles
    }

    /// The corners (mm) of its triangles, one in `stride`.
    pub fn triangles_mm(&self, stride: usize) -> impl Iterator<Item = [[f64; 3]; 3]> {
        let numbers = self.triangles.iter().step_by(stride.max(1));
        numbers.map(|&number| self.mesh.corners_mm(self.mesh.triangles()[number as usize]))
    }
}

/// Takes away the islands that `are_taken` says, each with all that lies in it.
///
/// It is shown the islands and answers for each whether it goes. The result is the same for any
/// number of threads.
///
/// # Errors
/// [`MeshError::Cancelled`], and what `are_taken` answers with.
pub fn take_islands<E: From<MeshError>>(
    mesh: &TriangleMesh,
    are_taken: impl FnOnce(&[Island<'_>]) -> Result<Vec<bool>, E>,
    task: &Task,
) -> Result<Kept, E> {
    let parts = Parts::of(mesh, task)?;
    let by_part = parts.labels.triangles_of_parts();
    let numbers: Vec<usize> = (0..parts.known.len())
        .filter(|&number| !parts.known[number].is_cavity)
        .collect();
    let islands: Vec<Island<'_>> = numbers
        .iter()
        .map(|&number| Island {
            volume_mm3: parts.known[number].volume_mm3,
            mesh,
            triangles: by_part.of(number),
        })
        .collect();
    let mut is_taken = vec![false; parts.known.len()];
    for (number, taken) in numbers.into_iter().zip(are_taken(&islands)?) {
        is_taken[number] = taken;
    }
    let is_kept: Vec<bool> = (0..parts.known.len())
        .map(|part| !parts.with_parents(part).any(|part| is_taken[part]))
        .collect();
    Ok(parts.only(&is_kept)?)
}

/// Fills cavities: takes away closed parts that face inward inside an outward one, of at most
/// `at_most_mm3` or all, with everything that floats in them.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::Volume`] for a volume that is none, [`MeshError::Cancelled`].
pub fn fill_cavities(
    mesh: &TriangleMesh,
    at_most_mm3: Option<f64>,
    task: &Task,
) -> Result<Kept, MeshError> {
    let most = at_most_mm3.map_or(Ok(f64::INFINITY), MeshError::volume)?;
    let parts = Parts::of(mesh, task)?;
    let is_filled = |part: usize| {
        let part = &parts.known[part];
        part.is_cavity && part.volume_mm3.abs() <= most
    };
    let is_kept: Vec<bool> = (0..parts.known.len())
        .map(|part| !parts.with_parents(part).any(is_filled))
        .collect();
    parts.only(&is_kept)
}

/// How the closed parts of a mesh lie in one another, where that makes no sense.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Nesting {
    /// Parts that face inward but lie in none that faces outward.
    pub inside_out: usize,
    /// Parts that face outward and lie in the material of another: counted twice in the volume.
    pub doubled: usize,
    /// Cavities.
    pub cavities: usize,
}

/// Looks how the closed parts of a mesh lie in one another.
///
/// # Errors
/// [`MeshError::Cancelled`]
pub fn check_nesting(mesh: &TriangleMesh, task: &Task) -> Result<Nesting, MeshError> {
    let parts = Parts::of(mesh, task)?;
    let mut nesting = Nesting::default();
    for part in parts.known.iter().filter(|part| part.is_closed) {
        let parent = part.parent.map(|parent| &parts.known[parent as usize]);
        let is_inward = part.volume_mm3 < 0.0;
        nesting.cavities += usize::from(part.is_cavity);
        nesting.inside_out += usize::from(is_inward && !part.is_cavity);
        let is_in_material = parent.is_some_and(|parent| parent.volume_mm3 > 0.0);
        nesting.doubled += usize::from(!is_inward && is_in_material);
    }
    Ok(nesting)
}

/// A mesh in parts.
struct Parts<'a> {
    mesh: &'a TriangleMesh,
    /// The part of each triangle.
    labels: Labels,
    known: Vec<Part>,
}

impl<'a> Parts<'a> {
    fn of(mesh: &'a TriangleMesh, task: &Task) -> Result<Self, MeshError> {
        task.begin("parts", mesh.triangles().len());
        let labels = Labels::of(mesh, task)?;
        Self::labelled(mesh, labels, task)
    }

    fn labelled(mesh: &'a TriangleMesh, labels: Labels, task: &Task) -> Result<Self, MeshError> {
        let mut parts = labels.parts(mesh, task)?;
        if parts.len() > 1 {
            inside::find_parents(mesh, &labels, &mut parts, task)?;
        }
        Ok(Self {
            mesh,
            labels,
            known: parts,
        })
    }

    /// The island whose surface, or that of a cavity in it, is nearest to a place.
    fn island_at(&self, place_mm: Vector) -> Result<Option<usize>, MeshError> {
        let Some([low, high]) = self.mesh.bounds_mm() else {
            return Ok(None);
        };
        let is_near = |axis: usize| {
            let range = low[axis] - BESIDE_MM..=high[axis] + BESIDE_MM;
            range.contains(&place_mm[axis])
        };
        if !(0..3).all(is_near) {
            return Err(MeshError::FarPlace {
                place_mm,
                bounds_mm: [low, high],
            });
        }
        let squared = |triangle: &[u32; 3]| {
            let corners = self.mesh.corners_mm(*triangle);
            squared_distance(place_mm, corners)
        };
        // Of equals the one with the lower number.
        let nearest = (self.mesh.triangles().par_iter().map(squared))
            .zip(&self.labels.of_triangles)
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(b.1)));
        Ok(
            nearest.map(|(_, &number)| match self.known[number as usize] {
                Part {
                    is_cavity: true,
                    parent: Some(parent),
                    ..
                } => parent as usize,
                _ => number as usize,
            }),
        )
    }

    /// A part, what it lies in, and so on.
    fn with_parents(&self, part: usize) -> impl Iterator<Item = usize> {
        // A parent encloses more than its child, so this ends.
        std::iter::successors(Some(part), |&part| {
            self.known[part].parent.map(|parent| parent as usize)
        })
    }

    /// The mesh of some parts, and what the others were.
    fn only(&self, is_kept: &[bool]) -> Result<Kept, MeshError> {
        let mut removed: Vec<RemovedPart> = self
            .known
            .iter()
            .zip(is_kept)
            .filter(|(_, is_kept)| !**is_kept)
            .map(|(part, _)| RemovedPart {
                volume_mm3: part.volume_mm3.abs(),
                triangles: part.triangles,
                is_cavity: part.is_cavity,
            })
            .collect();
        if removed.is_empty() {
            let mesh = self.mesh.clone();
            return Ok(Kept { mesh, removed });
        }
        removed.sort_by(|a, b| b.volume_mm3.total_cmp(&a.volume_mm3));
        let labelled = self.mesh.triangles().iter().zip(&self.labels.of_triangles);
        let kept = labelled.filter(|(_, part)| is_kept[**part as usize]);
        let triangles = kept.map(|(triangle, _)| *triangle).collect();
        let mesh = TriangleMesh::new(self.mesh.vertices_mm().to_vec(), triangles)?.compacted();
        Ok(Kept { mesh, removed })
    }
}
