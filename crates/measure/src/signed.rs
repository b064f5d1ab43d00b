//! How far places are from a surface, and on which side.
//!
//! The side is that of the nearest place's pseudonormal: of a triangle its normal, of an edge the sum of
//! the normals beside it, of a vertex their sum weighted by their angles there.

use bonemesh_mesh::{Nearest, TriangleMesh, TriangleTree};
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::MeasureError;
use bonemesh_mesh::vector::{Vector, cross, dot, length, minus};

/// Places done between two looks at the task.
const BATCH: usize = 512;

/// A surface to which distances are measured.
pub struct Reference<'a> {
    tree: TriangleTree<'a>,
    /// Where each vertex's triangles begin in `triangles`.
    starts: Vec<u32>,
    /// Numbers of triangles, vertex by vertex.
    triangles: Vec<u32>,
}

impl<'a> Reference<'a> {
    /// Sorts the triangles of `mesh`, whose equal vertices should be one
    /// ([`TriangleMesh::merged`]).
    ///
    /// # Errors
    /// [`MeasureError::NoSurface`], or the work was cancelled.
    pub fn new(mesh: &'a TriangleMesh, task: &Task) -> Result<Self, MeasureError> {
        let tree = TriangleTree::new(mesh, task)?;
        if tree.nearest([0.0; 3], f64::INFINITY).is_none() {
            return Err(MeasureError::NoSurface("reference"));
        }
        let mut starts = vec![0_u32; mesh.vertices_mm().len() + 1];
        for vertex in mesh.triangles().iter().flatten() {
            starts[*vertex as usize + 1] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut next = starts.clone();
        let mut triangles = vec![0; 3 * mesh.triangles().len()];
        for (number, triangle) in (0_u32..).zip(mesh.triangles()) {
            for vertex in triangle {
                let at = &mut next[*vertex as usize];
                triangles[*at as usize] = number;
                *at += 1;
            }
        }
        Ok(Self {
            tree: tree.for_far_places(),
            starts,
            triangles,
        })
    }

    /// Distance (mm) of a place to the surface, positive outside; no number of a place that is none.
    pub fn signed_distance_mm(&self, place_mm: [f64; 3]) -> f64 {
        let Some(nearest) = self.tree.nearest(place_mm, f64::INFINITY) else {
            return f64::NAN;
        };
        let away = minus(place_mm, nearest.place_mm);
        let distance = nearest.squared_mm2.sqrt();
        if dot(away, self.pseudonormal(&nearest)) < 0.0 {
            -distance
        } else {
            distance
        }
    }

    fn pseudonormal(&self, nearest: &Nearest) -> Vector {
        let mesh = self.tree.mesh();
        let triangle = mesh.triangles()[nearest.triangle as usize];
        let has_part: Vec<u32> = (0..3)
            .filter(|i| nearest.weights[*i] > 0.0)
            .map(|i| triangle[i])
            .collect();
        match has_part[..] {
            [vertex] => self.sum(vertex, |t| {
                let corner = t.iter().position(|v| *v == vertex);
                corner.map_or(0.0, |corner| angle(mesh.corners_mm(t), corner))
            }),
            [from, to] => self.sum(from, |t| f64::from(u8::from(t.contains(&to)))),
            _ => normal(mesh.corners_mm(triangle)),
        }
    }

    /// The sum of the unit normals of a vertex's triangles, weighted.
    fn sum(&self, vertex: u32, weight: impl Fn([u32; 3]) -> f64) -> Vector {
        let mesh = self.tree.mesh();
        let [first, end] = [vertex, vertex + 1].map(|v| self.starts[v as usize] as usize);
        let mut sum = [0.0; 3];
        for number in &self.triangles[first..end] {
            let triangle = mesh.triangles()[*number as usize];
            let normal = normal(mesh.corners_mm(triangle));
            let size = length(normal);
            if size > 0.0 {
                let weight = weight(triangle) / size;
                (0..3).for_each(|axis| sum[axis] += weight * normal[axis]);
            }
        }
        sum
    }
}

fn normal([a, b, c]: [Vector; 3]) -> Vector {
    cross(minus(b, a), minus(c, a))
}

/// The angle (radians) of a triangle at a corner.
fn angle(corners: [Vector; 3], corner: usize) -> f64 {
    let at = corners[corner];
    let [u, v] = [1, 2].map(|step| minus(corners[(corner + step) % 3], at));
    length(cross(u, v)).atan2(dot(u, v))
}

/// The signed distance (mm) of each place to a surface, positive outside.
///
/// # Errors
/// [`Cancelled`]
pub fn signed_distances(
    places_mm: &[[f64; 3]],
    reference: &Reference<'_>,
    task: &Task,
) -> Result<Vec<f64>, Cancelled> {
    task.begin("distances", places_mm.len());
    let batches: Vec<Vec<f64>> = places_mm
        .par_chunks(BATCH)
        .map(|places| {
            task.advance(places.len())?;
            let distance = |p: &[f64; 3]| reference.signed_distance_mm(*p);
            Ok(places.iter().map(distance).collect())
        })
        .collect::<Result<_, Cancelled>>()?;
    Ok(batches.concat())
}
