//! Who is joined to whom.

use bonemesh_task::{Cancelled, Task};

use crate::TriangleMesh;
use crate::stars::Stars;
use crate::vector::Vector;

/// The neighbours of each vertex that may move.
pub(super) struct Neighbours {
    /// Where each vertex's neighbours begin; one more than there are vertices.
    starts: Vec<usize>,
    others: Vec<u32>,
}

impl Neighbours {
    pub(super) fn of(mesh: &TriangleMesh, task: &Task) -> Result<Self, Cancelled> {
        let stars = Stars::new(mesh.vertices_mm().len(), mesh.triangles());
        let is_closed = stars.closed_fans(task)?;
        let mut starts = Vec::with_capacity(is_closed.len() + 1);
        let mut others = Vec::with_capacity(3 * mesh.triangles().len());
        let mut star = Vec::new();
        starts.push(0);
        for (vertex, is_closed) in (0..).zip(is_closed) {
            if is_closed {
                stars.at(vertex, &mut star);
                others.extend(star.iter().map(|triangle| triangle[1]));
            }
            starts.push(others.len());
        }
        Ok(Self { starts, others })
    }

    /// The mean place of a vertex's neighbours; `None` for one that stays.
    pub(super) fn middle(&self, vertex: usize, places: &[Vector]) -> Option<Vector> {
        let others = &self.others[self.starts[vertex]..self.starts[vertex + 1]];
        let sum = others.iter().fold([0.0; 3], |sum, other| {
            let place = places[*other as usize];
            [0, 1, 2].map(|axis| sum[axis] + place[axis])
        });
        (!others.is_empty()).then(|| sum.map(|s| s / others.len() as f64))
    }
}
