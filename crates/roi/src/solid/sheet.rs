//! The patch and what is around it as a surface that places are looked up on.
//!
//! A place in the bone belongs to the nearest place of the sheet: the distance is its depth, and the
//! sides of the cut stand upright on the surface wherever that curls.

use bonemesh_mesh::{TriangleMesh, TriangleTree};
use bonemesh_task::Task;

use super::crop::Neighbourhood;
use super::outline::Outline;
use crate::RoiError;
use crate::vector::{Vector, dot, length, minus, plus_scaled, unit};

/// A part of a neighbourhood's surface.
pub(super) struct Sheet {
    pub(super) mesh: TriangleMesh,
    /// By vertex: how far (mm) inside of the outline, below 0 outside.
    inside_mm: Vec<f64>,
    /// By vertex: which way is out.
    normals: Vec<Vector>,
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
    /// How far (mm) from the sheet.
    pub(super) away_mm: f64,
}

impl Sheet {
    /// The triangles of which all corners are within the outline's reach.
    pub(super) fn of(near: &Neighbourhood, outline: &Outline) -> Result<Self, RoiError> {
        let is_reached = |v: &u32| !outline.inside_mm[*v as usize].is_nan();
        let mut numbers = vec![u32::MAX; near.vertices_mm.len()];
        let mut members = Vec::new();
        let mut number = |vertex: u32| {
            let number = &mut numbers[vertex as usize];
            if *number == u32::MAX {
                *number = members.len() as u32;
                members.push(vertex as usize);
            }
            *number
        };
        let reached = near.triangles.iter().filter(|t| t.iter().all(is_reached));
        let triangles: Vec<[u32; 3]> = reached.map(|t| t.map(&mut number)).collect();
        let is_rim = rims(members.len(), &triangles);
        let vertices = members.iter().map(|v| outline.smooth_mm[*v]).collect();
        Ok(Self {
            mesh: TriangleMesh::new(vertices, triangles)?,
            inside_mm: members.iter().map(|v| outline.inside_mm[*v]).collect(),
            normals: members.iter().map(|v| outline.normals[*v]).collect(),
            is_rim,
        })
    }

    /// The corners of all triangles that are inside of the outline or crossed by it.
    pub(super) fn around_patch(&self) -> impl Iterator<Item = Vector> + '_ {
        let is_inside = |v: &u32| self.inside_mm[*v as usize] > 0.0;
        let triangles = self.mesh.triangles().iter();
        let crossed = triangles.filter(move |t| t.iter().any(is_inside));
        crossed.flat_map(|t| self.mesh.corners_mm(*t))
    }

    /// The same sheet with its triangles by place.
    pub(super) fn lookup<'a>(&'a self, task: &Task) -> Result<Lookup<'a>, RoiError> {
        Ok(Lookup {
            sheet: self,
            tree: TriangleTree::new(&self.mesh, task)?,
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
        let inside_mm: f64 = parts()
            .map(|(vertex, weight)| weight * self.sheet.inside_mm[vertex as usize])
            .sum();
        let away = minus(place_mm, nearest.place_mm);
        let away_mm = length(away);
        let upward = unit(upward);
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
            inside_mm: inside_mm - beside_mm,
            away_mm,
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
