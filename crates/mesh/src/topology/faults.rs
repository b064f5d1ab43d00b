//! Where connections are not as they should be.

use bonemesh_task::Task;

use super::vertex::{Incidence, inspect};
use super::{Shape, is_collapsed};
use crate::{MeshError, TriangleMesh};

/// Places that a printer's software would stumble over; all in ascending order.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Faults {
    /// Edges of exactly one triangle, the lower vertex first.
    pub boundary_edges: Vec<[u32; 2]>,
    /// Edges of three or more triangles.
    pub non_manifold_edges: Vec<[u32; 2]>,
    /// Edges of two triangles of which one faces inward.
    pub inconsistent_edges: Vec<[u32; 2]>,
    /// Vertices whose triangles form more than one fan.
    pub non_manifold_vertices: Vec<u32>,
    /// Triangles with two equal corners, or without area.
    pub degenerate_triangles: Vec<u32>,
}

impl Faults {
    /// Notes an edge with so many triangles, `away` of which run along it from its lower vertex.
    pub(super) fn note_edge(&mut self, edge: [u32; 2], triangles: usize, away: usize) {
        match triangles {
            1 => self.boundary_edges.push(edge),
            2 if away == 1 => {}
            2 => self.inconsistent_edges.push(edge),
            _ => self.non_manifold_edges.push(edge),
        }
    }

    /// Adds those of later vertices.
    pub(super) fn append(&mut self, mut later: Self) {
        self.boundary_edges.append(&mut later.boundary_edges);
        self.non_manifold_edges
            .append(&mut later.non_manifold_edges);
        self.inconsistent_edges
            .append(&mut later.inconsistent_edges);
        self.non_manifold_vertices
            .append(&mut later.non_manifold_vertices);
        self.degenerate_triangles
            .append(&mut later.degenerate_triangles);
    }
}

/// Finds what [`crate::check_topology`] counts.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::Cancelled`]
pub fn find_faults(mesh: &TriangleMesh, task: &Task) -> Result<Faults, MeshError> {
    task.begin("check", mesh.vertices_mm().len());
    let (_, mut faults) = inspect(&Incidence::of(mesh), task)?;
    let middle = mesh.bounds_mm().map_or([0.0; 3], |[low, high]| {
        [0, 1, 2].map(|i| f64::midpoint(low[i], high[i]))
    });
    let is_degenerate = |triangle: [u32; 3]| {
        is_collapsed(triangle) || Shape::of(mesh.corners_mm(triangle), middle).is_flat
    };
    faults.degenerate_triangles = (0..)
        .zip(mesh.triangles())
        .filter(|(_, triangle)| is_degenerate(**triangle))
        .map(|(number, _)| number)
        .collect();
    Ok(faults)
}
