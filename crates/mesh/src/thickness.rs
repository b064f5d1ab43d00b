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

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::tree::{Ray, Start, TriangleTree, first_hit};
use crate::vector::{Vector, cross, dot, minus, plus_scaled, unit};
use crate::{MeshError, TriangleMesh};

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
    /// Thickness (mm) in the middle of each triangle; infinite where nothing lies opposite.
    pub at_triangle_mm: Vec<f64>,
    /// Where it is smallest; `None` if nothing lies opposite anywhere.
    pub thinnest: Option<Thinnest>,
}

/// The place where a wall is thinnest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thinnest {
    /// The thickness.
    pub thickness_mm: f64,
    /// A vertex, or the middle of a triangle.
    pub place_mm: [f64; 3],
}

/// Measures how far it is from each vertex, and from the middle of each triangle, through the body to
/// the other side.
///
/// The mesh should be closed, outward, and without two vertices at one place
/// ([`TriangleMesh::merged`]): inward is what lies against the triangles' normals. The thickness is
/// the least length of seven rays, along the inward normal and at 15 degrees around it, that end at
/// a triangle which faces the other way to within 60 degrees; from a triangle, whose normal does not
/// lean, of one.
///
/// Limits: at the corner of a body with few triangles the normal points along a diagonal, and the
/// thickness of that vertex is as long. Towards an edge sharper than 60 degrees a body thins out
/// to nothing, and so do the numbers; they say nothing of how strong it is. Where triangles pass
/// through one another, the nearest of them ends the ray.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::Cancelled`]
pub fn wall_thickness(tree: &TriangleTree<'_>, task: &Task) -> Result<WallThickness, MeshError> {
    let mesh = tree.mesh();
    let (vertices, triangles) = (mesh.vertices_mm(), mesh.triangles());
    task.begin("wall thickness", vertices.len() + triangles.len());
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
    let mut at_triangle_mm = vec![f64::INFINITY; triangles.len()];
    at_triangle_mm
        .par_chunks_mut(STRIDE)
        .enumerate()
        .try_for_each(|(chunk, thickness)| {
            for (triangle, thickness) in (chunk * STRIDE..).zip(thickness.iter_mut()) {
                *thickness = at_triangle(tree, triangle as u32);
            }
            task.advance(thickness.len())
        })?;
    let at_vertices = vertices.iter().copied().zip(&at_vertex_mm);
    let middles = triangles.iter().map(|t| middle(mesh.corners_mm(*t)));
    let all = at_vertices.chain(middles.zip(&at_triangle_mm));
    let finite = all.filter(|(_, thickness)| thickness.is_finite());
    // The first of equal ones.
    let thinnest = finite.min_by(|(_, a), (_, b)| a.total_cmp(b));
    let thinnest = thinnest.map(|(place_mm, thickness_mm)| Thinnest {
        thickness_mm: *thickness_mm,
        place_mm,
    });
    Ok(WallThickness {
        at_vertex_mm,
        at_triangle_mm,
        thinnest,
    })
}

/// The same at some of the vertices (mm), in their order.
///
/// # Errors
/// [`MeshError::Cancelled`]
pub fn wall_thickness_at(
    tree: &TriangleTree<'_>,
    vertices: &[u32],
    task: &Task,
) -> Result<Vec<f64>, MeshError> {
    task.begin("wall thickness", vertices.len());
    let normals = inward_normals(tree.mesh(), task)?;
    let thickness = |vertex: &u32| {
        let inward = unit(normals[*vertex as usize]);
        inward.map_or(f64::INFINITY, |inward| at_vertex(tree, *vertex, inward))
    };
    let chunks = vertices.par_chunks(STRIDE).map(|vertices| {
        task.advance(vertices.len())?;
        Ok(vertices.iter().map(thickness).collect())
    });
    let chunks: Result<Vec<Vec<f64>>, Cancelled> = chunks.collect();
    Ok(chunks?.concat())
}

/// The middle of a triangle.
fn middle([a, b, c]: [Vector; 3]) -> Vector {
    [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0)
}

/// The length of the ray from the middle of a triangle straight into the body.
fn at_triangle(tree: &TriangleTree<'_>, triangle: u32) -> f64 {
    let mesh = tree.mesh();
    let triangle = mesh.triangles()[triangle as usize];
    let corners = mesh.corners_mm(triangle);
    let [a, b, c] = corners;
    let Some(inward) = unit(cross(minus(c, a), minus(b, a))) else {
        return f64::INFINITY;
    };
    let ray = Ray::new(middle(corners), inward, Start::Triangle(triangle));
    let hit = first_hit(tree, &ray, f64::INFINITY);
    let opposite = hit.filter(|hit| is_opposite(mesh, hit.triangle, inward));
    opposite.map_or(f64::INFINITY, |hit| hit.distance_mm)
}

/// The least length of the rays from one vertex into the body.
fn at_vertex(tree: &TriangleTree<'_>, vertex: u32, inward: Vector) -> f64 {
    let origin = tree.mesh().vertices_mm()[vertex as usize];
    let mut least = f64::INFINITY;
    for direction in cone(inward) {
        let ray = Ray::new(origin, direction, Start::Vertex(vertex));
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
