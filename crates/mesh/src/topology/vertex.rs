//! Edges and fans, seen from each vertex.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::faults::Faults;
use super::sets::Sets;
use super::{STRIDE, is_collapsed};
use crate::TriangleMesh;

/// The triangles at each vertex, as the two other corners in the triangle's direction of turn.
pub(crate) struct Incidence {
    /// Where each vertex's entries begin; one more than there are vertices.
    starts: Vec<usize>,
    /// `[next, previous]` of a vertex in one of its triangles.
    others: Vec<[u32; 2]>,
}

impl Incidence {
    /// Sorts the corners of all triangles by vertex (counting sort); collapsed triangles are left out.
    pub(crate) fn of(mesh: &TriangleMesh) -> Self {
        let triangles = || mesh.triangles().iter().filter(|t| !is_collapsed(**t));
        let mut starts = vec![0; mesh.vertices_mm().len() + 1];
        for &vertex in triangles().flatten() {
            starts[vertex as usize + 1] += 1;
        }
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        let mut next = starts.clone();
        let mut others = vec![[0; 2]; starts[starts.len() - 1]];
        for &[a, b, c] in triangles() {
            for (vertex, pair) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                let place = &mut next[vertex as usize];
                others[*place] = pair;
                *place += 1;
            }
        }
        Self { starts, others }
    }

    /// How many vertices there are.
    pub(crate) fn vertices(&self) -> usize {
        self.starts.len() - 1
    }

    /// The entries `[next, previous]` of one vertex.
    pub(crate) fn at(&self, vertex: usize) -> &[[u32; 2]] {
        &self.others[self.starts[vertex]..self.starts[vertex + 1]]
    }
}

/// Counts over all vertices.
#[derive(Clone, Copy, Default)]
pub(super) struct Counts {
    pub(super) used_vertices: usize,
    pub(super) edges: usize,
    pub(super) boundary_edges: usize,
    pub(super) non_manifold_edges: usize,
    pub(super) non_manifold_vertices: usize,
    pub(super) inconsistent_edges: usize,
    /// Edges with more triangles running one way than the other.
    pub(super) unbalanced_edges: usize,
}

impl Counts {
    /// Whether there is no non-manifold edge or vertex.
    pub(super) fn is_manifold(&self) -> bool {
        self.non_manifold_edges == 0 && self.non_manifold_vertices == 0
    }

    fn plus(self, other: Self) -> Self {
        Self {
            used_vertices: self.used_vertices + other.used_vertices,
            edges: self.edges + other.edges,
            boundary_edges: self.boundary_edges + other.boundary_edges,
            non_manifold_edges: self.non_manifold_edges + other.non_manifold_edges,
            non_manifold_vertices: self.non_manifold_vertices + other.non_manifold_vertices,
            inconsistent_edges: self.inconsistent_edges + other.inconsistent_edges,
            unbalanced_edges: self.unbalanced_edges + other.unbalanced_edges,
        }
    }
}

/// Looks at every vertex: what there is, and where it is not as it should be.
pub(super) fn inspect(incidence: &Incidence, task: &Task) -> Result<(Counts, Faults), Cancelled> {
    let vertices = incidence.vertices();
    let chunks: Result<Vec<(Counts, Faults)>, Cancelled> = (0..vertices.div_ceil(STRIDE))
        .into_par_iter()
        .map(|chunk| {
            let range = chunk * STRIDE..vertices.min((chunk + 1) * STRIDE);
            let (mut counts, mut faults) = (Counts::default(), Faults::default());
            let mut spokes = Spokes::default();
            let done = range.len();
            for vertex in range {
                spokes.count(
                    vertex as u32,
                    incidence.at(vertex),
                    &mut counts,
                    &mut faults,
                );
            }
            task.advance(done)?;
            Ok((counts, faults))
        })
        .collect();
    let nothing = (Counts::default(), Faults::default());
    Ok(chunks?
        .into_iter()
        .fold(nothing, |(sum, mut all), (counts, faults)| {
            all.append(faults);
            (sum.plus(counts), all)
        }))
}

/// The edges at one vertex; kept from vertex to vertex to save allocations.
#[derive(Default)]
struct Spokes {
    /// Far end of the edge, whether the triangle runs along it away from here, triangle.
    ends: Vec<(u32, bool, u32)>,
    /// The triangles, joined to fans.
    fans: Sets,
}

impl Spokes {
    /// Adds what `vertex` with the triangles `others` shows.
    fn count(
        &mut self,
        vertex: u32,
        others: &[[u32; 2]],
        counts: &mut Counts,
        faults: &mut Faults,
    ) {
        if others.is_empty() {
            return;
        }
        counts.used_vertices += 1;
        self.ends.clear();
        self.fans.reset(others.len());
        for (triangle, &[next, previous]) in (0..).zip(others) {
            self.ends.push((next, true, triangle));
            self.ends.push((previous, false, triangle));
        }
        self.ends.sort_unstable();
        let mut fans = others.len();
        for edge in self.ends.chunk_by(|a, b| a.0 == b.0) {
            for pair in edge.windows(2) {
                fans -= usize::from(self.fans.join(pair[0].2, pair[1].2));
            }
            // Each edge is seen from both its ends and counted at the lower one.
            if vertex < edge[0].0 {
                let away = edge.iter().filter(|end| end.1).count();
                counts.edges += 1;
                counts.boundary_edges += usize::from(edge.len() == 1);
                counts.non_manifold_edges += usize::from(edge.len() > 2);
                counts.inconsistent_edges += usize::from(edge.len() == 2 && away != 1);
                counts.unbalanced_edges += usize::from(2 * away != edge.len());
                faults.note_edge([vertex, edge[0].0], edge.len(), away);
            }
        }
        if fans > 1 {
            counts.non_manifold_vertices += 1;
            faults.non_manifold_vertices.push(vertex);
        }
    }
}
