//! Where a plane cuts a surface.
//!
//! 1. `above`: how far each vertex lies above the plane. One in the plane counts as above it, so each
//!    triangle is cut in two edges or in none, whatever lies in the plane, and the lines of a closed
//!    surface are closed.
//! 2. `cuts`: the edges in which each triangle is cut, the one where it goes down first: then the
//!    body is on the left, seen against the normal.
//! 3. `partners`: the ends of cuts that meet in an edge, two by two.
//! 4. `Walk`: from end to partner, until the line closes or ends.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::vector::{Vector, minus};
use crate::{Plane, TriangleMesh};

/// Triangles or vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 15;

/// What is smaller is rounding: coordinates come as 32-bit numbers.
const SMALLEST_MM: f64 = 1e-9;

/// An end of a cut that meets no other: the rim of an open surface.
const NONE: u32 = u32::MAX;

/// A line along which a plane cuts a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Its points (mm) in order; no two that follow one another are equal.
    pub points_mm: Vec<[f64; 3]>,
    /// The last point is followed by the first; otherwise the surface is open there.
    pub is_closed: bool,
}

/// Cuts the surface along the plane.
///
/// Of a closed surface all lines are closed. Seen against the normal they run counter-clockwise around
/// the body and clockwise around what is hollow, where triangles face outward. Vertices in the plane
/// count as just above it: a body that only touches the plane from above has no line there, one that
/// stands on it from below has its rim. Lines that have shrunk to a point are left out. What is
/// open, non-manifold or wrongly turned gives lines too, closed or not.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`Cancelled`]
pub fn section(mesh: &TriangleMesh, plane: &Plane, task: &Task) -> Result<Vec<Outline>, Cancelled> {
    task.begin("section", mesh.vertices_mm().len() + mesh.triangles().len());
    let above = above(mesh, plane, task)?;
    let cuts = cuts(mesh, &above, task)?;
    let partners = partners(&cuts);
    let point = |edge: [u32; 2]| crossing(mesh, &above, edge);
    Ok(Walk::new(&cuts, &partners).outlines(point))
}

fn above(mesh: &TriangleMesh, plane: &Plane, task: &Task) -> Result<Vec<f64>, Cancelled> {
    let vertices = mesh.vertices_mm();
    let mut above = vec![0.0; vertices.len()];
    above
        .par_chunks_mut(STRIDE)
        .zip(vertices.par_chunks(STRIDE))
        .try_for_each(|(above, vertices)| {
            for (above, vertex) in above.iter_mut().zip(vertices) {
                *above = plane.above_mm(*vertex);
            }
            task.advance(vertices.len())
        })?;
    Ok(above)
}

/// The edges, lower vertex first, in which triangles are cut: where they go down, where they go up.
fn cuts(mesh: &TriangleMesh, above: &[f64], task: &Task) -> Result<Vec<[[u32; 2]; 2]>, Cancelled> {
    let is_above = |vertex: u32| above[vertex as usize] >= 0.0;
    let cut = |&[a, b, c]: &[u32; 3]| {
        let (mut down, mut up) = (None, None);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let edge = Some([from.min(to), from.max(to)]);
            match (is_above(from), is_above(to)) {
                (true, false) => down = edge,
                (false, true) => up = edge,
                _ => {}
            }
        }
        // In one and the same edge a triangle with two equal corners is cut: it has no other side.
        down.zip(up)
            .filter(|(down, up)| down != up)
            .map(|(down, up)| [down, up])
    };
    let chunks: Result<Vec<Vec<_>>, Cancelled> = mesh
        .triangles()
        .par_chunks(STRIDE)
        .map(|triangles| {
            task.advance(triangles.len())?;
            Ok(triangles.iter().filter_map(cut).collect())
        })
        .collect();
    Ok(chunks?.concat())
}

/// For each end (twice the number of its cut, and 1 more for the second edge) the end that it meets.
///
/// Where more than two meet, as along a non-manifold edge, ends go with beginnings in the order of
/// their triangles; what is left over, where triangles are wrongly turned, two by two.
fn partners(cuts: &[[[u32; 2]; 2]]) -> Vec<u32> {
    let mut ends: Vec<([u32; 2], u32)> = cuts
        .iter()
        .flatten()
        .zip(0..)
        .map(|(edge, end)| (*edge, end))
        .collect();
    ends.par_sort_unstable();
    let mut partners = vec![NONE; ends.len()];
    let mut join = |a: u32, b: u32| {
        partners[a as usize] = b;
        partners[b as usize] = a;
    };
    for meeting in ends.chunk_by(|a, b| a.0 == b.0) {
        let of_kind = |kind: u32| {
            meeting
                .iter()
                .map(|(_, end)| *end)
                .filter(move |e| e % 2 == kind)
        };
        let (begins, stops) = (of_kind(0), of_kind(1));
        let both = begins.clone().count().min(stops.clone().count());
        for (a, b) in begins.clone().zip(stops.clone()) {
            join(a, b);
        }
        let rest: Vec<u32> = begins.skip(both).chain(stops.skip(both)).collect();
        for pair in rest.chunks_exact(2) {
            join(pair[0], pair[1]);
        }
    }
    partners
}

/// Where an edge passes through the plane.
fn crossing(mesh: &TriangleMesh, above: &[f64], [low, high]: [u32; 2]) -> Vector {
    let [a, b] = [low, high].map(|vertex| mesh.vertices_mm()[vertex as usize]);
    let [of_a, of_b] = [low, high].map(|vertex| above[vertex as usize]);
    let part = of_a / (of_a - of_b);
    // From the nearer end, so that an end in the plane is met exactly.
    if part <= 0.5 {
        [0, 1, 2].map(|axis| a[axis] + part * (b[axis] - a[axis]))
    } else {
        let part = of_b / (of_b - of_a);
        [0, 1, 2].map(|axis| b[axis] + part * (a[axis] - b[axis]))
    }
}

/// Whether a line has shrunk to one point but for rounding.
fn is_point(points_mm: &[Vector]) -> bool {
    let near = |point: &Vector| {
        let from_first = minus(*point, points_mm[0]);
        from_first.iter().all(|c| c.abs() < SMALLEST_MM)
    };
    points_mm.iter().all(near)
}

/// The way along the cuts.
struct Walk<'a> {
    cuts: &'a [[[u32; 2]; 2]],
    partners: &'a [u32],
    is_walked: Vec<bool>,
}

impl<'a> Walk<'a> {
    fn new(cuts: &'a [[[u32; 2]; 2]], partners: &'a [u32]) -> Self {
        Self {
            cuts,
            partners,
            is_walked: vec![false; cuts.len()],
        }
    }

    fn outlines(mut self, point: impl Fn([u32; 2]) -> Vector) -> Vec<Outline> {
        let mut outlines = Vec::new();
        // Open lines first, from their loose ends, those that begin there before those that stop.
        let loose = |kind: usize| move |end: &usize| end % 2 == kind;
        let ends = || (0..self.partners.len()).filter(|end| self.partners[*end] == NONE);
        let starts: Vec<usize> = ends()
            .filter(loose(0))
            .chain(ends().filter(loose(1)))
            .chain((0..self.cuts.len()).map(|cut| 2 * cut))
            .collect();
        for start in starts {
            if self.is_walked[start / 2] {
                continue;
            }
            let (edges, is_closed) = self.from(start);
            let mut points_mm: Vec<Vector> = edges.into_iter().map(&point).collect();
            points_mm.dedup();
            if is_closed && points_mm.first() == points_mm.last() {
                points_mm.pop();
            }
            let fewest = if is_closed { 3 } else { 2 };
            if points_mm.len() >= fewest && !is_point(&points_mm) {
                outlines.push(Outline {
                    points_mm,
                    is_closed,
                });
            }
        }
        outlines
    }

    /// The edges met from one end on, and whether the way came back to it.
    fn from(&mut self, start: usize) -> (Vec<[u32; 2]>, bool) {
        let edge = |end: usize| self.cuts[end / 2][end % 2];
        let mut edges = vec![edge(start)];
        let mut end = start;
        loop {
            self.is_walked[end / 2] = true;
            let far = end ^ 1;
            let next = self.partners[far];
            if next == NONE {
                edges.push(edge(far));
                return (edges, false);
            }
            if next as usize == start {
                return (edges, true);
            }
            edges.push(edge(far));
            end = next as usize;
        }
    }
}
