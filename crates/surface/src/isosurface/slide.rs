//! Smooths the surface by sliding its vertices along the edges between voxels that they lie on.
//!
//! What slides along its edge cannot leave the cubes beside it, and wherever on their edges vertices
//! lie, the triangles of a cube keep to themselves (`cases` says why): so the surface stays as closed
//! and as free of self-intersections as it was, with nothing to check.
//!
//! 1. `Neighbours::of`: who is joined to whom.
//! 2. `filtered`: where the vertices would go if they were free, in pairs of steps that do not shrink.
//! 3. [`slide`]: each vertex goes to where its edge passes that smoother surface.
//!
//! After G. Taubin, *A signal processing approach to fair surface design*, 1995. Everything is in voxels,
//! since means and planes are the same in all frames; only the tolerance needs the spacing.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

type Place = [f32; 3];

/// Steps towards the neighbours and away from them (pass-band 0.11), and how many pairs of them.
const STEPS: [f32; 2] = [0.5, -0.53];
const ROUNDS: usize = 10;
/// The cosine between edge and normal below which a vertex would slide far for little.
const FLAT: f32 = 0.3;
/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 13;

/// How far each vertex would slide on an edge along each axis, in voxels, so that the surface moves
/// hardly further than `tolerance_mm`. The stage is `smooth`.
pub(super) fn slide(
    places: &[Place],
    triangles: &[[u32; 3]],
    spacing_mm: [f32; 3],
    tolerance_mm: f32,
    task: &Task,
) -> Result<Vec<Place>, Cancelled> {
    task.begin("smooth", places.len() * 2 * ROUNDS);
    let neighbours = Neighbours::of(places.len(), triangles);
    task.check()?;
    let smoother = filtered(places, &neighbours, task)?;
    drop(neighbours);
    let normals = normals(&smoother, triangles);
    task.check()?;
    let slides = places.par_iter().zip(&smoother).zip(&normals);
    let slides = slides.map(|((place, smoother), normal)| {
        let in_mm = [0, 1, 2].map(|k| normal[k] / spacing_mm[k]);
        let length = dot(in_mm, in_mm).sqrt();
        if length == 0.0 {
            return [0.0; 3];
        }
        let off_mm = dot(minus(*smoother, *place), *normal) / length;
        let off_mm = off_mm * tolerance_mm / off_mm.hypot(tolerance_mm);
        [0, 1, 2].map(|axis| {
            let cosine = in_mm[axis] / length;
            off_mm * cosine / (cosine * cosine).max(FLAT * FLAT) / spacing_mm[axis]
        })
    });
    Ok(slides.collect())
}

/// Who is joined to whom on a closed manifold: each edge from a vertex belongs to one triangle.
struct Neighbours {
    /// Where each vertex's neighbours begin; one more than there are vertices.
    starts: Vec<u32>,
    others: Vec<u32>,
}

impl Neighbours {
    fn of(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut starts = vec![0u32; vertices + 2];
        for vertex in triangles.as_flattened() {
            starts[*vertex as usize + 2] += 1;
        }
        for vertex in 2..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        // While they are filled, each start but the first is that of the vertex before.
        let mut others = vec![0; 3 * triangles.len()];
        for &[a, b, c] in triangles {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let next = &mut starts[from as usize + 1];
                others[*next as usize] = to;
                *next += 1;
            }
        }
        starts.pop();
        Self { starts, others }
    }

    fn of_vertex(&self, vertex: usize) -> &[u32] {
        &self.others[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}

/// Where free vertices are after all steps.
fn filtered(
    places: &[Place],
    neighbours: &Neighbours,
    task: &Task,
) -> Result<Vec<Place>, Cancelled> {
    let mut places = places.to_vec();
    let mut next = places.clone();
    for step in STEPS.into_iter().cycle().take(2 * ROUNDS) {
        let chunks = next.par_chunks_mut(STRIDE).enumerate();
        chunks.try_for_each(|(chunk, next)| {
            for (vertex, next) in (chunk * STRIDE..).zip(&mut *next) {
                let around = neighbours.of_vertex(vertex);
                let sum = around.iter().fold([0.0; 3], |sum: Place, other| {
                    let place = places[*other as usize];
                    [0, 1, 2].map(|k| sum[k] + place[k])
                });
                let place = places[vertex];
                let part = step / around.len().max(1) as f32;
                *next = [0, 1, 2].map(|k| place[k] + part * sum[k] - step * place[k]);
            }
            task.advance(next.len())
        })?;
        std::mem::swap(&mut places, &mut next);
    }
    Ok(places)
}

/// Normals of vertices, of any length.
fn normals(places: &[Place], triangles: &[[u32; 3]]) -> Vec<Place> {
    let mut normals = vec![[0.0; 3]; places.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|vertex| places[vertex as usize]);
        let normal = cross(minus(b, a), minus(c, a));
        for vertex in triangle {
            let sum = &mut normals[*vertex as usize];
            *sum = [0, 1, 2].map(|k| sum[k] + normal[k]);
        }
    }
    normals
}

fn minus(a: Place, b: Place) -> Place {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: Place, b: Place) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Place, b: Place) -> Place {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
