//! The published comparison of meshes that are made of slices: at the middles of edges.
//!
//! 1. `edges_in_slices`: edges of the compared mesh whose ends have equal z, each once.
//! 2. `Level`: the reference's vertices of that z.
//! 3. For each edge: of the ten of them nearest to its middle, those within half its length; their
//!    distances, in the plane, to the line through the edge.
//!
//! The published program let an edge with none in range repeat the distances of the one before it, which
//! its text does not mean: such an edge is left out.

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

/// The reference's vertices that an edge looks at.
const NEAREST: usize = 10;
/// Edges done between two looks at the task.
const BATCH: usize = 1024;

type Place = [f64; 2];

/// What the comparison finds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EdgeMidpoints {
    /// Mean (mm) of all distances.
    pub overall_mm: f64,
    /// Mean (mm) over all edges of the mean of each.
    pub midpoint_mm: f64,
    /// The edges with a vertex in range, by z and the numbers of their ends.
    pub edges: Vec<EdgeMidpoint>,
}

/// What it finds of one edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeMidpoint {
    /// Middle of the edge.
    pub middle_mm: [f64; 3],
    /// Mean of its distances.
    pub mean_mm: f64,
    /// How many there are.
    pub count: usize,
}

/// Compares a mesh made of slices with a reference in the same ones.
///
/// Equal vertices of each count once. Where no edge has a vertex of the reference in range, such as where
/// the slices are not common or lie aslant, there are no edges and both means are 0.
///
/// # Errors
/// [`Cancelled`]
pub fn edge_midpoints(
    mesh: &TriangleMesh,
    reference: &TriangleMesh,
    task: &Task,
) -> Result<EdgeMidpoints, Cancelled> {
    let mesh = mesh.merged(task)?;
    let levels = levels(&reference.merged(task)?.compacted());
    let edges = edges_in_slices(&mesh);
    task.begin("edge midpoints", edges.len());
    let batches: Vec<Vec<(EdgeMidpoint, f64)>> = edges
        .par_chunks(BATCH)
        .map(|edges| {
            task.advance(edges.len())?;
            let ends = edges
                .iter()
                .map(|edge| edge.map(|v| mesh.vertices_mm()[v as usize]));
            Ok(ends.filter_map(|ends| measured(ends, &levels)).collect())
        })
        .collect::<Result<_, Cancelled>>()?;
    let found = batches.concat();
    let distances: usize = found.iter().map(|(edge, _)| edge.count).sum();
    let sum = |of: fn(&(EdgeMidpoint, f64)) -> f64| found.iter().map(of).sum::<f64>();
    Ok(EdgeMidpoints {
        overall_mm: sum(|(_, distances)| *distances) / distances.max(1) as f64,
        midpoint_mm: sum(|(edge, _)| edge.mean_mm) / found.len().max(1) as f64,
        edges: found.into_iter().map(|(edge, _)| edge).collect(),
    })
}

/// The edges whose ends have equal z, each once, by z and numbers.
fn edges_in_slices(mesh: &TriangleMesh) -> Vec<[u32; 2]> {
    // Adding zero makes -0 and 0, which are the same height, the same value.
    let height = |v: u32| mesh.vertices_mm()[v as usize][2] + 0.0;
    let sides = mesh
        .triangles()
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let level = |[a, b]: &[u32; 2]| a != b && height(*a).total_cmp(&height(*b)).is_eq();
    let mut edges: Vec<[u32; 2]> = sides
        .filter(level)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    edges.sort_unstable_by(|x, y| height(x[0]).total_cmp(&height(y[0])).then(x.cmp(y)));
    edges.dedup();
    edges
}

/// The vertices of one z, by x.
struct Level {
    z: f64,
    /// Places with their numbers.
    places: Vec<(Place, usize)>,
}

/// All vertices by rising z.
fn levels(mesh: &TriangleMesh) -> Vec<Level> {
    let vertices = mesh.vertices_mm().iter();
    let mut sorted: Vec<([f64; 3], usize)> =
        vertices.map(|v| v.map(|c| c + 0.0)).zip(0..).collect();
    let order = |a: &[f64; 3], b: &[f64; 3]| a[2].total_cmp(&b[2]).then(a[0].total_cmp(&b[0]));
    sorted.sort_by(|(a, _), (b, _)| order(a, b));
    let same = |a: &([f64; 3], usize), b: &([f64; 3], usize)| a.0[2].total_cmp(&b.0[2]).is_eq();
    let level = |vertices: &[([f64; 3], usize)]| Level {
        z: vertices[0].0[2],
        places: vertices
            .iter()
            .map(|([x, y, _], n)| ([*x, *y], *n))
            .collect(),
    };
    sorted.chunk_by(same).map(level).collect()
}

/// One edge and the sum of its distances, if it has any.
fn measured([a, b]: [[f64; 3]; 2], levels: &[Level]) -> Option<(EdgeMidpoint, f64)> {
    let level = levels
        .binary_search_by(|level| level.z.total_cmp(&(a[2] + 0.0)))
        .ok()?;
    let places = &levels[level].places;
    let middle = [f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1])];
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0].hypot(along[1]);
    // The ends themselves are in range, whatever rounding makes of their distance.
    let reach = 0.5 * length * (1.0 + 1e-9);
    let first = places.partition_point(|(p, _)| p[0] < middle[0] - reach);
    let mut near: Vec<(f64, usize, Place)> = places[first..]
        .iter()
        .take_while(|(p, _)| p[0] <= middle[0] + reach)
        .map(|(p, number)| ((p[0] - middle[0]).hypot(p[1] - middle[1]), *number, *p))
        .filter(|(away, ..)| *away <= reach)
        .collect();
    near.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    near.truncate(NEAREST);
    let to_line = |p: &Place| ((p[0] - a[0]) * along[1] - (p[1] - a[1]) * along[0]).abs() / length;
    let sum: f64 = near.iter().map(|(.., p)| to_line(p)).sum();
    (!near.is_empty()).then(|| {
        let edge = EdgeMidpoint {
            middle_mm: [middle[0], middle[1], a[2]],
            mean_mm: sum / near.len() as f64,
            count: near.len(),
        };
        (edge, sum)
    })
}
