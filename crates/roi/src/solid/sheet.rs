//! The patch and what is around it as a surface that places are looked up on.
//!
//! A place in the bone belongs to the nearest place of the sheet: the distance is its depth, and the
//! sides of the cut stand upright on the surface wherever that curls. Cuts straight along one direction
//! take the sheet as a relief instead ([`super::straight`]).

use bonemesh_mesh::{TriangleMesh, TriangleTree};
use bonemesh_task::Task;

use super::crop::{Neighbourhood, numbered};
use super::outline::Outline;
use crate::RoiError;
use bonemesh_mesh::vector::{Vector, cross, dot, length, minus, plus_scaled, unit_or_zero};

/// A part of a neighbourhood's surface.
#[derive(Clone)]
pub(super) struct Sheet {
    pub(super) mesh: TriangleMesh,
    /// By vertex: how far (mm) inside of the outline, below 0 outside.
    pub(super) inside_mm: Vec<f64>,
    /// By vertex: which way is out.
    pub(super) normals: Vec<Vector>,
    /// By vertex: how deep (mm) is cut.
    pub(super) bottom_mm: Vec<f64>,
    /// By vertex: whether the sheet ends there.
    is_rim: Vec<bool>,
}

/// Where a place is, seen from the sheet.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::struct_field_names, reason = "all are lengths")]
pub(super) struct Seen {
    /// How far (mm) below the sheet, below 0 above it.
    pub(super) depth_mm: f64,
    /// How far (mm) inside of the outline, below 0 outside.
    pub(super) inside_mm: f64,
    /// How deep (mm) is cut there.
    pub(super) bottom_mm: f64,
}

impl Sheet {
    /// The triangles of which all corners are within the outline's reach, all to be cut as deep.
    pub(super) fn of(
        near: &Neighbourhood,
        outline: &Outline,
        bottom_mm: f64,
    ) -> Result<Self, RoiError> {
        let is_reached = |v: &u32| !outline.inside_mm[*v as usize].is_nan();
        let reached = near.triangles.iter().filter(|t| t.iter().all(is_reached));
        let (triangles, members) = numbered(near.vertices_mm.len(), reached.copied());
        let is_rim = rims(members.len(), &triangles);
        let members = || members.iter().map(|v| *v as usize);
        Ok(Self {
            mesh: TriangleMesh::new(members().map(|v| outline.smooth_mm[v]).collect(), triangles)?,
            inside_mm: members().map(|v| outline.inside_mm[v]).collect(),
            normals: members().map(|v| outline.normals[v]).collect(),
            bottom_mm: vec![bottom_mm; is_rim.len()],
            is_rim,
        })
    }

    /// A whole closed surface as it is.
    pub(super) fn whole(mesh: TriangleMesh) -> Self {
        let mut normals = vec![[0.0; 3]; mesh.vertices_mm().len()];
        for triangle in mesh.triangles() {
            let [a, b, c] = mesh.corners_mm(*triangle);
            let facing = unit_or_zero(cross(minus(b, a), minus(c, a)));
            // Weights by angle: the sum tells inside from outside whatever the triangles' shapes.
            for (vertex, [here, next, last]) in
                triangle.iter().zip([[a, b, c], [b, c, a], [c, a, b]])
            {
                let [next, last] = [next, last].map(|end| unit_or_zero(minus(end, here)));
                let angle = dot(next, last).clamp(-1.0, 1.0).acos();
                let normal = &mut normals[*vertex as usize];
                *normal = plus_scaled(*normal, angle, facing);
            }
        }
        let vertices = normals.len();
        Self {
            mesh,
            inside_mm: vec![0.0; vertices],
            normals,
            bottom_mm: vec![0.0; vertices],
            is_rim: vec![false; vertices],
        }
    }

    /// The corners of all triangles that are inside of the outline or crossed by it, each with the way out.
    pub(super) fn around_patch(&self) -> impl Iterator<Item = (Vector, Vector)> + '_ {
        let is_inside = |v: &u32| self.inside_mm[*v as usize] > 0.0;
        let triangles = self.mesh.triangles().iter();
        let crossed = triangles.filter(move |t| t.iter().any(is_inside));
        let corners = crossed.flat_map(|t| t.map(|v| v as usize));
        corners.map(|v| (self.mesh.vertices_mm()[v], self.normals[v]))
    }

    /// The same sheet with its triangles by place.
    pub(super) fn lookup<'a>(&'a self, task: &Task) -> Result<Lookup<'a>, RoiError> {
        Ok(Lookup {
            sheet: self,
            tree: TriangleTree::new(&self.mesh, task)?.for_far_places(),
        })
    }
}

/// A sheet whose nearest places are found quickly.
pub(super) struct Lookup<'a> {
    sheet: &'a Sheet,
    tree: TriangleTree<'a>,
}

impl Lookup<'_> {
    /// What a place is to the sheet, if it is within reach.
    pub(super) fn see(&self, place_mm: Vector, within_mm: f64) -> Option<Seen> {
        let nearest = self.tree.nearest(place_mm, within_mm)?;
        let triangle = self.sheet.mesh.triangles()[nearest.triangle as usize];
        let parts = || triangle.into_iter().zip(nearest.weights);
        let upward = parts().fold([0.0; 3], |sum, (vertex, weight)| {
            plus_scaled(sum, weight, self.sheet.normals[vertex as usize])
        });
        let mean = |values: &[f64]| -> f64 {
            parts()
                .map(|(vertex, weight)| weight * values[vertex as usize])
                .sum()
        };
        let away = minus(place_mm, nearest.place_mm);
        let away_mm = length(away);
        let upward = unit_or_zero(upward);
        let above = dot(away, upward);
        // Beyond the sheet's rim a place is as far outside as it lies beside.
        let is_beyond = parts().all(|(v, weight)| weight == 0.0 || self.sheet.is_rim[v as usize]);
        let beside_mm = if is_beyond {
            length(plus_scaled(away, -above, upward))
        } else {
            0.0
        };
        Some(Seen {
            depth_mm: if above > 0.0 { -away_mm } else { away_mm },
            inside_mm: mean(&self.sheet.inside_mm) - beside_mm,
            bottom_mm: mean(&self.sheet.bottom_mm),
        })
    }
}

/// Vertices of edges with one triangle.
fn rims(vertices: usize, triangles: &[[u32; 3]]) -> Vec<bool> {
    let mut edges: Vec<[u32; 2]> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    edges.sort_unstable();
    let mut is_rim = vec![false; vertices];
    for same in edges.chunk_by(|a, b| a == b) {
        if let [[a, b]] = same {
            is_rim[*a as usize] = true;
            is_rim[*b as usize] = true;
        }
    }
    is_rim
}
