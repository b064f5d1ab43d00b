//! What a mesh's connections say of it.
//!
//! 1. `measure`: area, volume and degenerate triangles, triangle by triangle.
//! 2. `Incidence::of`: which triangles meet at each vertex.
//! 3. `vertex::inspect`: at each vertex, its edges and the fans of its triangles.
//! 4. `components::count`: the corners of each triangle joined to sets.
//!
//! Edges are counted at their lower-numbered vertex, so no table of all edges is needed and the
//! vertices can be looked at in parallel; all results are integers or fixed-order sums.

mod components;
mod faults;
mod sets;
mod vertex;

use bonemesh_task::{Task, chunked_sum};
use rayon::prelude::*;

use crate::vector::{cross, dot, minus};
use crate::{MeshError, TriangleMesh};
pub use faults::{Faults, find_faults};
pub use sets::Sets;
pub(crate) use vertex::Incidence;

/// Triangles or vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// A triangle whose doubled area is below this part of its longest edge squared has none: that is
/// what rounding leaves of three points on a line.
const FLATNESS: f64 = 1e-12;

/// The topology report of a mesh.
///
/// Triangles with two equal corners connect nothing: they are counted as degenerate and otherwise
/// left out. Triangles without area but with three corners are counted as degenerate and take part
/// in everything, because taking them out would open the surface.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Topology {
    /// Vertices, used or not.
    pub vertices: usize,
    /// Vertices that no triangle uses.
    pub unused_vertices: usize,
    /// Triangles, degenerate ones included.
    pub triangles: usize,
    /// Edges of exactly one triangle: the rims of holes.
    pub boundary_edges: usize,
    /// Edges of three or more triangles.
    pub non_manifold_edges: usize,
    /// Vertices whose triangles form more than one fan, joined through shared edges (bow ties).
    pub non_manifold_vertices: usize,
    /// Edges of exactly two triangles that run along them the same way: one faces inward.
    pub inconsistent_edges: usize,
    /// Triangles with two equal corners, or three on a line to within rounding.
    pub degenerate_triangles: usize,
    /// Parts that share no vertex; parts that touch in one vertex are one.
    pub components: usize,
    /// Those of them that face inward: the walls of cavities. 0 unless watertight.
    pub cavities: usize,
    /// The surface is closed and bounds a volume: there are triangles, and each edge has as many
    /// running one way as the other. Closed bodies that touch along an edge are watertight but not
    /// manifold.
    pub watertight: bool,
    /// The surface is a 2-manifold, possibly with a rim: no non-manifold edge or vertex.
    pub manifold: bool,
    /// Enclosed volume, negative if triangles face inward; means nothing unless watertight.
    pub volume_mm3: f64,
    /// Area of all triangles.
    pub area_mm2: f64,
    /// Lowest and highest coordinates of all vertices; `None` without vertices.
    pub bounds_mm: Option<[[f64; 3]; 2]>,
}

/// Looks at every vertex, edge and triangle of a mesh.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::Cancelled`]
pub fn check_topology(mesh: &TriangleMesh, task: &Task) -> Result<Topology, MeshError> {
    task.begin("check", mesh.vertices_mm().len() + mesh.triangles().len());
    let measures = measure(mesh, task)?;
    let incidence = Incidence::of(mesh);
    let (counts, components) = rayon::join(
        || vertex::inspect(&incidence, task),
        || components::count(mesh, &measures.sixfold_volumes, task),
    );
    let ((counts, _), components) = (counts?, components?);
    let watertight = counts.edges > 0 && counts.unbalanced_edges == 0;
    Ok(Topology {
        vertices: mesh.vertices_mm().len(),
        unused_vertices: mesh.vertices_mm().len() - counts.used_vertices,
        triangles: mesh.triangles().len(),
        boundary_edges: counts.boundary_edges,
        non_manifold_edges: counts.non_manifold_edges,
        non_manifold_vertices: counts.non_manifold_vertices,
        inconsistent_edges: counts.inconsistent_edges,
        degenerate_triangles: measures.degenerate,
        components: components.count,
        cavities: if watertight { components.inward } else { 0 },
        watertight,
        manifold: counts.is_manifold(),
        volume_mm3: measures.volume_mm3,
        area_mm2: measures.area_mm2,
        bounds_mm: mesh.bounds_mm(),
    })
}

/// Sums over triangles.
struct Measures {
    area_mm2: f64,
    volume_mm3: f64,
    /// Six times what each triangle adds to the volume.
    sixfold_volumes: Vec<f64>,
    degenerate: usize,
}

/// Area, volume and degenerate triangles.
///
/// The volume is that of the tetrahedra from each triangle to the middle of the bounding box: from
/// the origin, which may be far away, digits would be lost.
fn measure(mesh: &TriangleMesh, task: &Task) -> Result<Measures, MeshError> {
    let Some([low, high]) = mesh.bounds_mm() else {
        return Ok(Measures {
            area_mm2: 0.0,
            volume_mm3: 0.0,
            sixfold_volumes: Vec::new(),
            degenerate: 0,
        });
    };
    let middle = [0, 1, 2].map(|axis| f64::midpoint(low[axis], high[axis]));
    let triangles = mesh.triangles();
    let mut doubled_areas = vec![0.0; triangles.len()];
    let mut sixfold_volumes = vec![0.0; triangles.len()];
    let degenerate = triangles
        .par_chunks(STRIDE)
        .zip(doubled_areas.par_chunks_mut(STRIDE))
        .zip(sixfold_volumes.par_chunks_mut(STRIDE))
        .map(|((triangles, areas), volumes)| {
            let mut degenerate = 0;
            for ((&triangle, area), volume) in triangles.iter().zip(areas).zip(volumes) {
                let shape = Shape::of(mesh.corners_mm(triangle), middle);
                *area = shape.doubled_area;
                *volume = shape.sixfold_volume;
                degenerate += usize::from(is_collapsed(triangle) || shape.is_flat);
            }
            task.advance(triangles.len())?;
            Ok(degenerate)
        })
        .sum::<Result<usize, MeshError>>()?;
    Ok(Measures {
        area_mm2: chunked_sum(&doubled_areas) / 2.0,
        volume_mm3: chunked_sum(&sixfold_volumes) / 6.0,
        sixfold_volumes,
        degenerate,
    })
}

/// Whether two corners are the same vertex.
pub(crate) fn is_collapsed([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// Whether three corners lie in a line, as far as numbers can tell.
pub(crate) fn is_without_area(corners_mm: [[f64; 3]; 3]) -> bool {
    Shape::of(corners_mm, corners_mm[0]).is_flat
}

/// What one triangle adds to the sums.
struct Shape {
    doubled_area: f64,
    sixfold_volume: f64,
    is_flat: bool,
}

impl Shape {
    fn of(corners_mm: [[f64; 3]; 3], middle: [f64; 3]) -> Self {
        let [a, b, c] = corners_mm.map(|corner| minus(corner, middle));
        let (ab, ac, bc) = (minus(b, a), minus(c, a), minus(c, b));
        let normal = cross(ab, ac);
        let doubled_area = dot(normal, normal).sqrt();
        let longest_squared = dot(ab, ab).max(dot(ac, ac)).max(dot(bc, bc));
        Self {
            doubled_area,
            sixfold_volume: dot(a, normal),
            is_flat: doubled_area <= FLATNESS * longest_squared,
        }
    }
}
