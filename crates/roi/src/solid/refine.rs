//! Smaller triangles where those of the mesh are too large to tell places on them apart.
//!
//! Only how places are looked up gets finer, never what is cut: new vertices lie in the middle of edges, and
//! the surface stays where it is.

use bonemesh_task::{Cancelled, Task};
use rustc_hash::FxHashMap;

use super::patch::Patch;
use super::space::Space;
use bonemesh_mesh::vector::{Vector, length, minus, plus_scaled};

/// Most triangles; beyond, what is left stays as large as it is.
const MOST: usize = 1_000_000;
/// Most halvings of an edge: of 60 m to 1 mm.
const ROUNDS: usize = 16;

impl Patch {
    /// Halves the edges of triangles that touch `space` until none is longer than `longest_mm`.
    pub(super) fn refine(
        &mut self,
        space: &Space,
        longest_mm: f64,
        task: &Task,
    ) -> Result<(), Cancelled> {
        for _ in 0..ROUNDS {
            task.check()?;
            let middles = self.middles(space, longest_mm);
            if middles.is_empty() || self.near.triangles.len() > MOST {
                break;
            }
            self.split(&middles);
        }
        Ok(())
    }

    /// The long edges, each with the vertex that will be its middle.
    fn middles(&mut self, space: &Space, longest_mm: f64) -> FxHashMap<[u32; 2], u32> {
        let mut middles = FxHashMap::default();
        for triangle in &self.near.triangles {
            if !space.touches(triangle.map(|v| self.near.vertices_mm[v as usize])) {
                continue;
            }
            for edge in edges(*triangle) {
                let [a, b] = edge.map(|v| self.near.vertices_mm[v as usize]);
                if length(minus(b, a)) > longest_mm && !middles.contains_key(&edge) {
                    middles.insert(edge, self.near.vertices_mm.len() as u32);
                    self.near.vertices_mm.push(plus_scaled(a, 0.5, minus(b, a)));
                    let [a, b] = edge.map(|v| self.is_selected[v as usize]);
                    self.is_selected.push(a && b);
                }
            }
        }
        middles
    }

    /// Cuts triangles at the middles of their edges.
    fn split(&mut self, middles: &FxHashMap<[u32; 2], u32>) {
        let mut triangles = Vec::with_capacity(2 * self.near.triangles.len());
        let mut has_triangle = Vec::with_capacity(triangles.capacity());
        for (triangle, has) in self.near.triangles.iter().zip(&self.has_triangle) {
            let middle = edges(*triangle).map(|edge| middles.get(&edge).copied());
            push_parts(*triangle, middle, &self.near.vertices_mm, &mut triangles);
            has_triangle.resize(triangles.len(), *has);
        }
        self.near.triangles = triangles;
        self.has_triangle = has_triangle;
    }
}

/// The edges after each corner, each from its lower to its higher number.
fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)])
}

/// The parts of a triangle between the middles of its edges.
fn push_parts(
    triangle: [u32; 3],
    middle: [Option<u32>; 3],
    vertices_mm: &[Vector],
    parts: &mut Vec<[u32; 3]>,
) {
    // Turned so that the edge that differs from the other two is the first.
    let count = middle.iter().flatten().count();
    let single = middle.iter().position(|m| m.is_some() == (count == 1));
    let turn = single.unwrap_or(0);
    let [a, b, c] = [0, 1, 2].map(|i| triangle[(i + turn) % 3]);
    match [0, 1, 2].map(|i| middle[(i + turn) % 3]) {
        [Some(ab), Some(bc), Some(ca)] => {
            parts.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        [None, Some(bc), Some(ca)] => {
            parts.push([ca, bc, c]);
            // The shorter diagonal of what is left.
            let diagonal = |from: u32, to: u32| {
                length(minus(vertices_mm[to as usize], vertices_mm[from as usize]))
            };
            if diagonal(a, bc) <= diagonal(b, ca) {
                parts.extend([[a, b, bc], [a, bc, ca]]);
            } else {
                parts.extend([[a, b, ca], [b, bc, ca]]);
            }
        }
        [Some(ab), None, None] => parts.extend([[a, ab, c], [ab, b, c]]),
        _ => parts.push(triangle),
    }
}

#[cfg(test)]
mod tests {
    use super::super::crop::Neighbourhood;
    use super::*;
    use bonemesh_mesh::{TriangleMesh, check_topology};

    #[test]
    fn a_refined_tetrahedron_is_closed_where_it_was_and_has_short_edges() {
        let vertices_mm = vec![[0.0; 3], [9.0, 0.0, 0.0], [0.0, 7.0, 0.0], [0.0, 0.0, 20.0]];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let near = Neighbourhood {
            of_mesh: (0..4).collect(),
            vertices_mm,
            triangles,
        };
        let mut fine = Patch {
            near,
            has_triangle: vec![true, false, false, false],
            is_selected: vec![true, true, true, false],
        };
        let space = Space {
            low: [-1.0; 3],
            high: [9.0, 9.0, 4.0],
        };
        fine.refine(&space, 1.0, &Task::default()).unwrap();
        let near = &fine.near;
        for triangle in &near.triangles {
            let corners = triangle.map(|v| near.vertices_mm[v as usize]);
            for [from, to] in [[0, 1], [1, 2], [2, 0]] {
                let long = length(minus(corners[to], corners[from])) > 1.0;
                assert!(!long || !space.touches(corners));
            }
        }
        let area: f64 = near
            .triangles
            .iter()
            .zip(&fine.has_triangle)
            .filter(|(_, has)| **has)
            .map(|(t, _)| length(near.facing(*t)) / 2.0)
            .sum();
        assert!((area - 31.5).abs() < 1e-9);
        let selected = fine.is_selected.iter().zip(&near.vertices_mm);
        assert!(selected.filter(|(s, _)| **s).all(|(_, v)| v[2] == 0.0));
        let mesh = TriangleMesh::new(near.vertices_mm.clone(), near.triangles.clone()).unwrap();
        let topology = check_topology(&mesh, &Task::default()).unwrap();
        assert!(topology.watertight && topology.manifold);
        assert!((topology.volume_mm3 - 210.0).abs() < 1e-9);
    }
}
