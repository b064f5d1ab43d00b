//! How thick the body is at each vertex of its surface.
//!
//! 1. `inward_normals`: against the mean normal of the triangles at a vertex, weighted by their
//!    angles there, which does not depend on how the surface is cut into triangles.
//! 2. `Cone::around`: the inward normal and six directions at 15 degrees to it.
//! 3. `ray::first_hit`: along each, the nearest triangle that is not the vertex's own; it counts if
//!    it lies opposite, its outward normal within 60 degrees of the inward one.
//!
//! The least of the lengths that count is the thickness. One ray alone would overstate a wall wherever
//! the normal leans, and would see nothing where it slips out; the mean or median of a wide cone
//! (the shape diameter function) overstates every wall, since leaning rays are longer. The least of
//! a narrow cone is exact for a wall with parallel sides even if normals lean by up to 15 degrees,
//! and at most 3.5 % below the diameter of a ball or a rod. Without the third step's condition a
//! leaning ray would take the side of a block, next to its edge, for the far side of a thin wall. The
//! largest ball that touches the vertex from inside would be the cleaner definition, but is nothing
//! at every convex edge.

mod ray;

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::tree::TriangleTree;
use crate::vector::{Vector, cross, dot, minus, plus_scaled, unit};
use crate::{MeshError, TriangleMesh};
use ray::{Ray, first_hit};

/// Cosine and sine of the angle between the cone's rim and its axis: 15 degrees.
const RIM: (f64, f64) = (0.965_925_826_289_068_3, 0.258_819_045_102_520_74);
/// Cosines and sines of the places of the six rays around the rim.
const AROUND: [(f64, f64); 6] = {
    const HALF_ROOT_3: f64 = 0.866_025_403_784_438_6;
    [
        (1.0, 0.0),
        (0.5, HALF_ROOT_3),
        (-0.5, HALF_ROOT_3),
        (-1.0, 0.0),
        (-0.5, -HALF_ROOT_3),
        (0.5, -HALF_ROOT_3),
    ]
};
/// Cosine of the angle between a vertex's inward normal and the outward normal of what lies opposite.
const OPPOSITE: f64 = 0.5;
/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 9;
/// Triangles done between two looks at the cancel switch.
const TRIANGLE_STRIDE: usize = 1 << 16;

/// What [`wall_thickness`] measures.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct WallThickness {
    /// Thickness (mm) at each vertex; infinite where nothing lies opposite, as at unused vertices.
    pub at_vertex_mm: Vec<f64>,
    /// The vertex (its number) with the smallest thickness, the first of equal ones; `None` if all
    /// are infinite.
    pub thinnest_vertex: Option<u32>,
}

impl WallThickness {
    /// The smallest thickness (mm).
    pub fn thinnest_mm(&self) -> Option<f64> {
        self.thinnest_vertex
            .map(|vertex| self.at_vertex_mm[vertex as usize])
    }
}

/// Measures how far it is from each vertex through the body to the other side.
///
/// The mesh should be closed, outward, and without two vertices at one place
/// ([`TriangleMesh::merged`]): inward is what lies against the triangles' normals. The thickness is
/// the least length of seven rays, along the inward normal and at 15 degrees around it, that end at
/// a triangle which faces the other way to within 60 degrees.
///
/// Limits: it is measured at vertices only. Towards an edge sharper than 60 degrees a body thins out
/// to nothing, and so do the numbers; they say nothing of how strong it is. Where triangles pass
/// through one another, the nearest of them ends the ray.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::Cancelled`]
pub fn wall_thickness(tree: &TriangleTree<'_>, task: &Task) -> Result<WallThickness, MeshError> {
    let mesh = tree.mesh();
    task.begin("wall thickness", mesh.vertices_mm().len());
    let normals = inward_normals(mesh, task)?;
    let mut at_vertex_mm = vec![f64::INFINITY; normals.len()];
    at_vertex_mm
        .par_chunks_mut(STRIDE)
        .enumerate()
        .try_for_each(|(chunk, thickness)| {
            for (vertex, thickness) in (chunk * STRIDE..).zip(thickness.iter_mut()) {
                if let Some(inward) = unit(normals[vertex]) {
                    *thickness = at_vertex(tree, vertex as u32, inward);
                }
            }
            task.advance(thickness.len())
        })?;
    let finite = (0..).zip(&at_vertex_mm).filter(|(_, t)| t.is_finite());
    let thinnest_vertex = finite
        .min_by(|(_, a), (_, b)| a.total_cmp(b))
        .map(|(vertex, _)| vertex);
    Ok(WallThickness {
        at_vertex_mm,
        thinnest_vertex,
    })
}

/// The least length of the rays from one vertex into the body.
fn at_vertex(tree: &TriangleTree<'_>, vertex: u32, inward: Vector) -> f64 {
    let origin = tree.mesh().vertices_mm()[vertex as usize];
    let mut least = f64::INFINITY;
    for direction in cone(inward) {
        let ray = Ray::new(origin, direction, vertex);
        if let Some(hit) = first_hit(tree, &ray, least)
            && is_opposite(tree.mesh(), hit.triangle, inward)
        {
            least = hit.distance_mm;
        }
    }
    least
}

/// Whether a triangle's outward normal points along `inward`, more or less.
fn is_opposite(mesh: &TriangleMesh, triangle: u32, inward: Vector) -> bool {
    let [a, b, c] = mesh.corners_mm(mesh.triangles()[triangle as usize]);
    let outward = unit(cross(minus(b, a), minus(c, a)));
    outward.is_some_and(|outward| dot(outward, inward) >= OPPOSITE)
}

/// The axis and the directions around it, all of length 1.
fn cone(axis: Vector) -> impl Iterator<Item = Vector> {
    // The coordinate axis furthest from this one makes the steadiest right angle.
    let other = if axis[0].abs() < 0.6 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let side = unit(cross(axis, other)).unwrap_or(other);
    let up = cross(axis, side);
    let (cosine, sine) = RIM;
    let rim = AROUND.into_iter().map(move |(along, across)| {
        let direction = plus_scaled([0.0; 3], cosine, axis);
        let direction = plus_scaled(direction, sine * along, side);
        plus_scaled(direction, sine * across, up)
    });
    std::iter::once(axis).chain(rim)
}

/// At each vertex the sum of its triangles' inward unit normals, each times its angle there.
fn inward_normals(mesh: &TriangleMesh, task: &Task) -> Result<Vec<Vector>, Cancelled> {
    let mut sums = vec![[0.0; 3]; mesh.vertices_mm().len()];
    for triangles in mesh.triangles().chunks(TRIANGLE_STRIDE) {
        for &triangle in triangles {
            let corners = mesh.corners_mm(triangle);
            let [a, b, c] = corners;
            let Some(inward) = unit(cross(minus(c, a), minus(b, a))) else {
                continue;
            };
            for (corner, &vertex) in triangle.iter().enumerate() {
                let here = corners[corner];
                let next = minus(corners[(corner + 1) % 3], here);
                let previous = minus(corners[(corner + 2) % 3], here);
                let across = cross(next, previous);
                let angle = dot(across, across).sqrt().atan2(dot(next, previous));
                let sum = &mut sums[vertex as usize];
                *sum = plus_scaled(*sum, angle, inward);
            }
        }
        task.check()?;
    }
    Ok(sums)
}
