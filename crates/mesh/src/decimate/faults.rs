//! What is wrong with a result.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;
use rustc_hash::FxHashSet;

use crate::distance::Near;
use crate::exact::{has_area, meet};
use crate::tree::Bounds;
use crate::vector::Vector;
use crate::{MeshError, TriangleMesh, TriangleTree, find_intersections};

/// Triangles or vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 10;

/// Results, one after another, beside the mesh they are made of.
///
/// A later result differs from the one before in few places, and distances are measured there alone.
pub(super) struct Comparison<'a> {
    given: &'a TriangleMesh,
    /// The error bound (mm) and the given mesh by place.
    bound: Option<(f64, TriangleTree<'a>)>,
    before: Option<TriangleMesh>,
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
            given,
            bound,
            before: None,
        })
    }

    /// Vertices of the result at triangles that meet, or around which the two surfaces are further
    /// apart than the bound. What was far apart before and is as it was may be left out: its vertices are
    /// held by now.
    ///
    /// `standing`: for each vertex of the given mesh the one of the result that stands for it.
    pub(super) fn faulty_vertices(
        &self,
        result: &TriangleMesh,
        standing: &[u32],
        task: &Task,
    ) -> Result<Vec<bool>, MeshError> {
        let mut is_faulty = vec![false; result.vertices_mm().len()];
        let tree = TriangleTree::new(result, task)?;
        let before = self.before.as_ref();
        let new = before.map(|before| only_in(result, before));
        let mut faulty: Vec<u32> = if let Some(new) = &new {
            meeting(&tree, new, task)?
        } else {
            let found = find_intersections(&tree, usize::MAX, task)?;
            let triangles = found.pairs.iter().flat_map(|pair| pair.triangles);
            let corners = triangles.flat_map(|number| result.triangles()[number as usize]);
            corners.collect()
        };
        if let Some((error_mm, given)) = &self.bound {
            let lost = match &self.before {
                Some(before) => Some(part(before, &only_in(before, result))?),
                None => None,
            };
            let new = match &new {
                Some(new) => part(result, new)?,
                None => result.clone(),
            };
            let lost = match &lost {
                Some(lost) => Some(TriangleTree::new(lost, task)?),
                None => None,
            };
            faulty.extend(self.far_from(&tree, lost.as_ref(), standing, *error_mm, task)?);
            faulty.extend(far_out(&new, given, *error_mm, task)?);
        }
        for vertex in faulty {
            is_faulty[vertex as usize] = true;
        }
        Ok(is_faulty)
    }

    /// The next result is compared with this one.
    pub(super) fn remember(&mut self, result: TriangleMesh) {
        self.before = Some(result);
    }

    /// Vertices standing for triangles of the given mesh that are not wholly near the result; if
    /// `lost` is given, only of those that may have been near what is in it.
    fn far_from(
        &self,
        result: &TriangleTree<'_>,
        lost: Option<&TriangleTree<'_>>,
        standing: &[u32],
        error_mm: f64,
        task: &Task,
    ) -> Result<Vec<u32>, Cancelled> {
        task.begin("compare", self.given.triangles().len());
        let far = self.given.triangles().par_chunks(STRIDE).map(|triangles| {
            let mut near = Near::new(result, error_mm);
            let mut near_lost = lost.map(|lost| Near::new(lost, error_mm));
            let far = triangles.iter().filter(|triangle| {
                let corners = self.given.corners_mm(**triangle);
                let is_asked = near_lost.as_mut().is_none_or(|lost| lost.reaches(&corners));
                is_asked && !near.holds_triangle(corners)
            });
            let standing = far.flatten().map(|&v| standing[v as usize]);
            let standing: Vec<u32> = standing.collect();
            task.advance(triangles.len())?;
            Ok(standing)
        });
        Ok(far.collect::<Result<Vec<_>, _>>()?.concat())
    }
}

/// Vertices of triangles with a corner, an edge's middle or a centre far from the given mesh.
fn far_out(
    triangles: &TriangleMesh,
    given: &TriangleTree<'_>,
    error_mm: f64,
    task: &Task,
) -> Result<Vec<u32>, Cancelled> {
    task.begin("compare", triangles.triangles().len());
    let far = triangles.triangles().par_chunks(STRIDE).map(|chunk| {
        let mut near = Near::new(given, error_mm);
        let far = chunk.iter().filter(|t| {
            let points = probes(triangles.corners_mm(**t));
            !points.into_iter().all(|point| near.holds_point(point))
        });
        let vertices: Vec<u32> = far.flatten().copied().collect();
        task.advance(chunk.len())?;
        Ok(vertices)
    });
    Ok(far.collect::<Result<Vec<_>, _>>()?.concat())
}

/// Corners of triangles that meet, as far as one of the two is among the `new`.
fn meeting(tree: &TriangleTree<'_>, new: &[u32], task: &Task) -> Result<Vec<u32>, Cancelled> {
    let triangles = tree.mesh().triangles();
    task.begin("intersections", new.len());
    let found = new.par_chunks(STRIDE).map(|chunk| {
        let (mut found, mut stack) = (Vec::new(), Vec::new());
        for &number in chunk {
            let corners = tree.mesh().corners_mm(triangles[number as usize]);
            if !has_area(&corners) {
                continue;
            }
            tree.visit_touching(&Bounds::of(&corners), &mut stack, |slot| {
                if slot.triangle != number && meet(&corners, &tree.corners_mm(slot)) {
                    found.extend(triangles[number as usize]);
                    found.extend(triangles[slot.triangle as usize]);
                }
            });
        }
        task.advance(chunk.len())?;
        Ok(found)
    });
    Ok(found.collect::<Result<Vec<_>, _>>()?.concat())
}

/// The numbers of the triangles of one result that the other, with the same vertices in part at other
/// places, has not.
fn only_in(of: &TriangleMesh, other: &TriangleMesh) -> Vec<u32> {
    let turned = |[a, b, c]: [u32; 3]| match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    };
    let others = other.triangles().iter().map(|t| turned(*t));
    let others: FxHashSet<[u32; 3]> = others.collect();
    let is_only = |triangle: [u32; 3]| {
        !others.contains(&turned(triangle)) || of.corners_mm(triangle) != other.corners_mm(triangle)
    };
    let numbered = (0..).zip(of.triangles());
    let only = numbered.filter(|(_, triangle)| is_only(**triangle));
    only.map(|(number, _)| number).collect()
}

/// Some triangles of a mesh, with all its vertices.
fn part(of: &TriangleMesh, numbers: &[u32]) -> Result<TriangleMesh, MeshError> {
    let triangles = numbers.iter().map(|n| of.triangles()[*n as usize]);
    TriangleMesh::new(of.vertices_mm().to_vec(), triangles.collect())
}

/// Where a triangle of the result is held against the given mesh.
fn probes([a, b, c]: [Vector; 3]) -> [Vector; 7] {
    let middle = |p: Vector, q: Vector| [0, 1, 2].map(|axis| f64::midpoint(p[axis], q[axis]));
    let centre = [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
    [a, b, c, middle(a, b), middle(b, c), middle(c, a), centre]
}
