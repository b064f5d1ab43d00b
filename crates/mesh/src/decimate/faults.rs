//! What is wrong with a result.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;
use rustc_hash::FxHashSet;

use super::distances::Pair;
use crate::exact::meet;
use crate::stars::Stars;
use crate::{MeshError, TriangleMesh, TriangleTree, find_intersections};

/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 10;

/// Vertices of a result where something is wrong.
pub(super) struct Faults {
    /// At triangles that meet.
    pub(super) meeting: Vec<u32>,
    /// Around which the two surfaces are further apart than the error bound.
    pub(super) far: Vec<u32>,
}

/// Results, one after another, beside the mesh they are made of.
///
/// A later result differs from the one before in few places, and is looked at there alone.
pub(super) struct Comparison<'a> {
    /// The error bound (mm) and the given mesh by place.
    bound: Option<(f64, TriangleTree<'a>)>,
    before: Option<Before>,
    /// Whether a vertex of the last result is at a fault.
    is_faulty: Vec<bool>,
    /// Whether a triangle of the given mesh is near the last result, but not beside the vertices that
    /// stand for its corners.
    is_near_others: Vec<bool>,
}

/// A result, and for each vertex of the given mesh the one that stands for it.
struct Before {
    result: TriangleMesh,
    standing: Vec<u32>,
}

impl<'a> Comparison<'a> {
    pub(super) fn new(
        given: &'a TriangleMesh,
        error_mm: Option<f64>,
        task: &Task,
    ) -> Result<Self, MeshError> {
        let bound = match error_mm {
            Some(error_mm) => Some((error_mm, TriangleTree::new(given, task)?)),
            None => None,
        };
        Ok(Self {
            is_near_others: vec![false; bound.as_ref().map_or(0, |_| given.triangles().len())],
            is_faulty: vec![false; given.vertices_mm().len()],
            bound,
            before: None,
        })
    }

    /// What is wrong with a result, where it is not as the one before was.
    ///
    /// `stars`: of the result. `standing`: for each vertex of the given mesh the one of the result
    /// that stands for it.
    pub(super) fn faults(
        &mut self,
        result: &TriangleMesh,
        stars: &Stars,
        standing: &[u32],
        task: &Task,
    ) -> Result<Faults, MeshError> {
        let tree = TriangleTree::new(result, task)?;
        let is_new = self.before.take().map(|before| {
            let mut is_new = std::mem::take(&mut self.is_faulty);
            mark_changes(&before, result, standing, &mut is_new);
            is_new
        });
        let is_new = is_new.as_deref();
        let mut faults = Faults {
            meeting: meeting(&tree, is_new, task)?,
            far: Vec::new(),
        };
        if let Some((error_mm, given)) = &self.bound {
            let pair = Pair {
                given,
                result: &tree,
                stars,
                standing,
                is_new,
                error_mm: *error_mm,
            };
            faults.far = pair.far_given(&mut self.is_near_others, task)?;
            faults.far.extend(pair.far_result(task)?);
        }
        self.is_faulty = vec![false; standing.len()];
        for vertex in faults.meeting.iter().chain(&faults.far) {
            self.is_faulty[*vertex as usize] = true;
        }
        Ok(faults)
    }

    /// The next result is compared with this one.
    pub(super) fn remember(&mut self, result: TriangleMesh, standing: Vec<u32>) {
        self.before = Some(Before { result, standing });
    }
}

/// Marks the vertices of a result around which anything is not as it was before.
fn mark_changes(before: &Before, result: &TriangleMesh, standing: &[u32], is_new: &mut [bool]) {
    let gone = only_in(&before.result, result);
    let come = only_in(result, &before.result);
    for vertex in gone.chain(come).flatten() {
        is_new[*vertex as usize] = true;
    }
    for (now, then) in standing.iter().zip(&before.standing) {
        is_new[*now as usize] |= now != then;
    }
}

/// Corners of triangles that meet, as far as one of the two has a vertex where anything `is_new`.
fn meeting(
    tree: &TriangleTree<'_>,
    is_new: Option<&[bool]>,
    task: &Task,
) -> Result<Vec<u32>, MeshError> {
    let triangles = tree.mesh().triangles();
    let Some(is_new) = is_new else {
        let found = find_intersections(tree, usize::MAX, task)?;
        let meeting = found.pairs.iter().flat_map(|pair| pair.triangles);
        return Ok(meeting.flat_map(|t| triangles[t as usize]).collect());
    };
    task.begin("intersections", tree.slots().len());
    let found = tree.slots().par_chunks(STRIDE).map(|slots| {
        let (mut found, mut stack) = (Vec::new(), Vec::new());
        for slot in slots {
            let vertices = triangles[slot.triangle as usize];
            if !vertices.iter().any(|v| is_new[*v as usize]) {
                continue;
            }
            let corners = tree.corners_mm(slot);
            tree.visit_touching(&slot.bounds, &mut stack, |other| {
                if other.triangle != slot.triangle && meet(&corners, &tree.corners_mm(other)) {
                    found.extend(vertices);
                    found.extend(triangles[other.triangle as usize]);
                }
            });
        }
        task.advance(slots.len())?;
        Ok(found)
    });
    Ok(found.collect::<Result<Vec<_>, Cancelled>>()?.concat())
}

/// The triangles of one result that the other, with the same vertices in part at other places, has not.
fn only_in<'a>(
    of: &'a TriangleMesh,
    other: &TriangleMesh,
) -> impl Iterator<Item = &'a [u32; 3]> + use<'a> {
    let turned = |[a, b, c]: [u32; 3]| match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    };
    let bits = |mesh: &TriangleMesh, v: u32| mesh.vertices_mm()[v as usize].map(f64::to_bits);
    let is_same = |v: &u32| bits(of, *v) == bits(other, *v);
    let others = other.triangles().iter().filter(|t| t.iter().all(is_same));
    let others: FxHashSet<[u32; 3]> = others.map(|t| turned(*t)).collect();
    let only = of.triangles().iter();
    only.filter(move |triangle| !others.contains(&turned(**triangle)))
}
