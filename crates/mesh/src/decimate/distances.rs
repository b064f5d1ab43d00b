//! How far the given mesh and a result are from one another, compared with the error bound.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::TriangleTree;
use crate::distance::{Near, is_near};
use crate::stars::Stars;
use crate::vector::Vector;

/// Triangles or vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 10;

/// The two surfaces.
pub(super) struct Pair<'a> {
    pub(super) given: &'a TriangleTree<'a>,
    pub(super) result: &'a TriangleTree<'a>,
    /// Of the result.
    pub(super) stars: &'a Stars,
    /// For each vertex of the given mesh the one of the result that stands for it.
    pub(super) standing: &'a [u32],
    /// Vertices of the result around which it is not as it was before; all of them if not given.
    pub(super) is_new: Option<&'a [bool]>,
    pub(super) error_mm: f64,
}

impl Pair<'_> {
    /// Vertices of the result that stand for triangles of the given mesh that are not wholly near it.
    ///
    /// Most are near the triangles at these vertices, where no search is needed. `is_near_others` says
    /// for which that is not so, and is brought up to date.
    pub(super) fn far_given(
        &self,
        is_near_others: &mut [bool],
        task: &Task,
    ) -> Result<Vec<u32>, Cancelled> {
        let given = self.given.mesh();
        task.begin("compare", given.triangles().len());
        let chunks = given.triangles().par_chunks(STRIDE);
        let far = chunks.zip(is_near_others.par_chunks_mut(STRIDE));
        let far = far.map(|(triangles, is_near_others)| {
            let mut near = Near::new(self.result, self.error_mm);
            let (mut far, mut star, mut beside) = (Vec::new(), Vec::new(), Vec::new());
            for (triangle, is_near_others) in triangles.iter().zip(is_near_others) {
                let standing = triangle.map(|v| self.standing[v as usize]);
                if !*is_near_others && !standing.iter().any(|v| self.is_new(*v)) {
                    continue;
                }
                beside.clear();
                for (number, vertex) in standing.into_iter().enumerate() {
                    self.stars.at(vertex, &mut star);
                    let is_met = |t: &[u32; 3]| standing[..number].iter().any(|v| t.contains(v));
                    let others = star.iter().filter(|t| !is_met(t));
                    beside.extend(others.map(|t| self.result.mesh().corners_mm(*t)));
                }
                let corners = given.corners_mm(*triangle);
                *is_near_others = !is_near(corners, &beside, self.error_mm);
                if *is_near_others && !near.holds_triangle(corners) {
                    far.extend(standing);
                }
            }
            task.advance(triangles.len())?;
            Ok(far)
        });
        Ok(far.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Vertices of the result at triangles with a corner, an edge's middle or a centre far from the
    /// given mesh.
    pub(super) fn far_result(&self, task: &Task) -> Result<Vec<u32>, Cancelled> {
        let result = self.result.mesh();
        task.begin("compare", result.triangles().len());
        let far = result.triangles().par_chunks(STRIDE).map(|chunk| {
            let mut near = Near::new(self.given, self.error_mm);
            let new = chunk.iter().filter(|t| t.iter().any(|v| self.is_new(*v)));
            let far = new.filter(|t| {
                let points = probes(result.corners_mm(**t));
                !points.into_iter().all(|point| near.holds_point(point))
            });
            let vertices: Vec<u32> = far.flatten().copied().collect();
            task.advance(chunk.len())?;
            Ok(vertices)
        });
        Ok(far.collect::<Result<Vec<_>, _>>()?.concat())
    }

    fn is_new(&self, vertex: u32) -> bool {
        self.is_new.is_none_or(|is_new| is_new[vertex as usize])
    }
}

/// Where a triangle of the result is held against the given mesh.
fn probes([a, b, c]: [Vector; 3]) -> [Vector; 7] {
    let middle = |p: Vector, q: Vector| [0, 1, 2].map(|axis| f64::midpoint(p[axis], q[axis]));
    let centre = [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
    [a, b, c, middle(a, b), middle(b, c), middle(c, a), centre]
}
