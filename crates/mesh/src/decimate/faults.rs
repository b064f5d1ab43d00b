//! What is wrong with a result.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::distance::Near;
use crate::vector::Vector;
use crate::{MeshError, TriangleMesh, TriangleTree, find_intersections};

/// Triangles or vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 10;

/// A result beside the mesh it was made of.
pub(super) struct Comparison<'a> {
    pub(super) given: &'a TriangleMesh,
    pub(super) result: &'a TriangleMesh,
    /// For each vertex of the given mesh the one of the result that stands for it.
    pub(super) standing: &'a [u32],
}

impl Comparison<'_> {
    /// Vertices of the result at triangles that meet, or around which the two surfaces are further
    /// apart than `error_mm`.
    pub(super) fn faulty_vertices(
        &self,
        error_mm: Option<f64>,
        task: &Task,
    ) -> Result<Vec<bool>, MeshError> {
        let mut is_faulty = vec![false; self.result.vertices_mm().len()];
        let tree = TriangleTree::new(self.result, task)?;
        let found = find_intersections(&tree, usize::MAX, task)?;
        let meeting = found.pairs.iter().flat_map(|pair| pair.triangles);
        let mut faulty: Vec<u32> = meeting
            .flat_map(|number| self.result.triangles()[number as usize])
            .collect();
        if let Some(error_mm) = error_mm {
            faulty.extend(self.far_from(&tree, error_mm, task)?);
            let given = TriangleTree::new(self.given, task)?;
            faulty.extend(self.far_out(&given, error_mm, task)?);
        }
        for vertex in faulty {
            is_faulty[vertex as usize] = true;
        }
        Ok(is_faulty)
    }

    /// Vertices standing for triangles of the given mesh that are not wholly near the result.
    fn far_from(
        &self,
        result: &TriangleTree<'_>,
        error_mm: f64,
        task: &Task,
    ) -> Result<Vec<u32>, Cancelled> {
        task.begin("compare", self.given.triangles().len());
        let far = self.given.triangles().par_chunks(STRIDE).map(|triangles| {
            let mut near = Near::new(result, error_mm);
            let far = triangles
                .iter()
                .filter(|t| !near.holds_triangle(self.given.corners_mm(**t)));
            let standing = far.flatten().map(|&v| self.standing[v as usize]);
            let standing: Vec<u32> = standing.collect();
            task.advance(triangles.len())?;
            Ok(standing)
        });
        Ok(far.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// Vertices of triangles of the result with a corner, an edge's middle or a centre far from the
    /// given mesh.
    fn far_out(
        &self,
        given: &TriangleTree<'_>,
        error_mm: f64,
        task: &Task,
    ) -> Result<Vec<u32>, Cancelled> {
        task.begin("compare", self.result.triangles().len());
        let far = self.result.triangles().par_chunks(STRIDE).map(|triangles| {
            let mut near = Near::new(given, error_mm);
            let far = triangles.iter().filter(|t| {
                let points = probes(self.result.corners_mm(**t));
                !points.into_iter().all(|point| near.holds_point(point))
            });
            let vertices: Vec<u32> = far.flatten().copied().collect();
            task.advance(triangles.len())?;
            Ok(vertices)
        });
        Ok(far.collect::<Result<Vec<_>, _>>()?.concat())
    }
}

/// Where a triangle of the result is held against the given mesh.
fn probes([a, b, c]: [Vector; 3]) -> [Vector; 7] {
    let middle = |p: Vector, q: Vector| [0, 1, 2].map(|axis| f64::midpoint(p[axis], q[axis]));
    let centre = [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
    [a, b, c, middle(a, b), middle(b, c), middle(c, a), centre]
}
