//! The patch's outline, smooth, and how far vertices are from it along the surface.
//!
//! 1. `normals`: which way the surface faces, on the patch as the patch alone says, so that a patch that ends
//!    at a rim does not bend round it. Neighbours that face apart are not of one side, and no mean goes
//!    from one to the other.
//! 2. `share`: how much of the patch there is at each vertex, 1 inside and 0 outside, blurred over a few
//!    edges (`blurred`). Where it is a half is the outline: so it runs between selected and other
//!    vertices, not along the teeth of the triangles.
//! 3. `segments`: the outline's pieces across triangles.
//! 4. `spread`: from there to all other vertices within reach, from neighbour to neighbour. Outside it goes
//!    on only where the surface still faces about as it does at the outline: around a rim begins another
//!    side.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::crop::Neighbourhood;
use super::patch::Patch;
use bonemesh_mesh::vector::{Vector, dot, length, minus, plus_scaled, unit_or_zero};

/// Means over neighbours that blur the shares.
const BLURS: usize = 8;
/// Means over neighbours that smooth the normals.
const SMOOTHINGS: usize = 8;
/// Steps towards the neighbours and away from them, and how many pairs of them.
const STEPS: [f64; 2] = [0.5, -0.53];
const ROUNDS: usize = 12;
/// A half of the patch.
const HALF: f64 = 0.5;
/// Cosine of the most that the surface turns from the outline outward, and from neighbour to neighbour.
const SAME_SIDE: f64 = 0.5;
/// Where a whole body is selected there is no outline, and all is far inside of it.
const FAR_INSIDE_MM: f64 = 1e3;
/// Vertices done between two looks at the cancel switch, and at least by one worker.
const STRIDE: usize = 1 << 12;

/// The patch and what is around it, as far as a cut reaches.
pub(super) struct Outline {
    /// How far (mm) each vertex is inside of the outline, below 0 outside; no number where a cut does not
    /// reach.
    pub(super) inside_mm: Vec<f64>,
    /// Outward directions of length 1, smoothed.
    pub(super) normals: Vec<Vector>,
    /// Places of the vertices on a smoother surface. Below a rough one the nearest places crowd at what
    /// sticks out inward.
    pub(super) smooth_mm: Vec<Vector>,
}

impl Outline {
    /// Reaches so far outside of the outline.
    pub(super) fn of(patch: &Patch, reach_mm: f64, task: &Task) -> Result<Self, Cancelled> {
        let near = &patch.near;
        let neighbours = Neighbours::of(near);
        let normals = normals(patch, &neighbours);
        let neighbours = neighbours.kept(|a, b| dot(normals[a], normals[b]) > SAME_SIDE);
        task.check()?;
        let sharp = sharp(patch, &neighbours);
        let share = {
            let mut share = sharp.clone();
            for _ in 0..BLURS {
                share = neighbours.means(&share, |a, b| a + b, |sum, n| sum / n);
            }
            // Of a few triangles a blur would leave nothing.
            let inside = |share: &[f64]| share.iter().filter(|s| **s > HALF).count();
            if 2 * inside(&share) < inside(&sharp) {
                sharp
            } else {
                share
            }
        };
        task.check()?;
        let mut inside_mm = spread(near, &neighbours, &normals, &share, reach_mm, task)?;
        for (inside, share) in inside_mm.iter_mut().zip(&share) {
            if inside.is_nan() && *share > HALF {
                *inside = FAR_INSIDE_MM;
            }
        }
        Ok(Self {
            inside_mm,
            normals,
            smooth_mm: smoothed(near, &neighbours, task)?,
        })
    }
}

/// 1 at the corners of the patch's triangles and at selected vertices of the same side beside them, which are
/// the tips of its teeth, else 0.
fn sharp(patch: &Patch, neighbours: &Neighbours) -> Vec<f64> {
    let Patch {
        near,
        has_triangle,
        is_selected,
    } = patch;
    let mut share = vec![0.0; near.vertices_mm.len()];
    let triangles = near.triangles.iter().zip(has_triangle);
    for (triangle, _) in triangles.filter(|(_, has)| **has) {
        for vertex in triangle {
            share[*vertex as usize] = 1.0;
        }
    }
    let is_tip = |v: usize| {
        let beside = || neighbours.at(v).iter().any(|n| share[*n as usize] > 0.0);
        is_selected[v] && share[v] == 0.0 && beside()
    };
    let tips: Vec<usize> = (0..share.len()).filter(|v| is_tip(*v)).collect();
    for tip in tips {
        share[tip] = 1.0;
    }
    share
}

/// Who is joined to whom by an edge of one side, most twice.
struct Neighbours {
    starts: Vec<u32>,
    of: Vec<u32>,
}

impl Neighbours {
    fn of(near: &Neighbourhood) -> Self {
        let mut starts = vec![0_u32; near.vertices_mm.len() + 1];
        for vertex in near.triangles.as_flattened() {
            starts[*vertex as usize + 1] += 2;
        }
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        let mut ends = starts.clone();
        let mut of = vec![0; 6 * near.triangles.len()];
        for &[a, b, c] in &near.triangles {
            for [vertex, next, last] in [[a, b, c], [b, c, a], [c, a, b]] {
                let end = &mut ends[vertex as usize];
                of[*end as usize] = next;
                of[*end as usize + 1] = last;
                *end += 2;
            }
        }
        Self { starts, of }
    }

    /// Without those of which each is not kept for the other.
    fn kept(&self, is_kept: impl Fn(usize, usize) -> bool) -> Self {
        let mut of = Vec::with_capacity(self.of.len());
        let mut starts = Vec::with_capacity(self.starts.len());
        for vertex in 0..self.starts.len() - 1 {
            starts.push(of.len() as u32);
            let around = self.at(vertex).iter();
            of.extend(around.filter(|other| is_kept(vertex, **other as usize)));
        }
        starts.push(of.len() as u32);
        Self { starts, of }
    }

    fn at(&self, vertex: usize) -> &[u32] {
        &self.of[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// Means of values over each vertex and its neighbours.
    fn means<T: Copy + Send + Sync>(
        &self,
        values: &[T],
        plus: impl Fn(T, T) -> T + Sync,
        part: impl Fn(T, f64) -> T + Sync,
    ) -> Vec<T> {
        let mean = |vertex: usize| {
            let around = self.at(vertex);
            let others = around.iter().map(|v| values[*v as usize]);
            // Each neighbour counts twice, so does the vertex itself.
            let sum = others.fold(plus(values[vertex], values[vertex]), &plus);
            part(sum, around.len() as f64 + 2.0)
        };
        let vertices = 0..values.len();
        let means = vertices.into_par_iter().with_min_len(STRIDE).map(mean);
        means.collect()
    }
}

/// The vertices after pairs of steps that do not shrink (Taubin 1995).
fn smoothed(
    near: &Neighbourhood,
    neighbours: &Neighbours,
    task: &Task,
) -> Result<Vec<Vector>, Cancelled> {
    let mut places = near.vertices_mm.clone();
    for step in STEPS.into_iter().cycle().take(2 * ROUNDS) {
        task.check()?;
        let part = |sum: Vector, n: f64| sum.map(|component| component / n);
        let means = neighbours.means(&places, |a, b| plus_scaled(a, 1.0, b), part);
        for (place, mean) in places.iter_mut().zip(means) {
            *place = plus_scaled(*place, step, minus(mean, *place));
        }
    }
    Ok(places)
}

/// Outward directions, weighted with areas and smoothed, on the patch and beside it on their own.
fn normals(patch: &Patch, neighbours: &Neighbours) -> Vec<Vector> {
    let near = &patch.near;
    let mut normals = vec![[0.0; 3]; near.vertices_mm.len()];
    let mut is_of_patch = vec![false; normals.len()];
    let mut add = |is_patch: bool| {
        let triangles = near.triangles.iter().zip(&patch.has_triangle);
        for (triangle, _) in triangles.filter(|(_, has)| **has == is_patch) {
            let facing = near.facing(*triangle);
            for &vertex in triangle {
                let vertex = vertex as usize;
                is_of_patch[vertex] |= is_patch;
                if is_of_patch[vertex] == is_patch {
                    normals[vertex] = plus_scaled(normals[vertex], 1.0, facing);
                }
            }
        }
    };
    add(true);
    add(false);
    let within = neighbours.kept(|a, b| is_of_patch[a] == is_of_patch[b]);
    for _ in 0..SMOOTHINGS {
        let part = |sum: Vector, n: f64| sum.map(|component| component / n);
        normals = within.means(&normals, |a, b| plus_scaled(a, 1.0, b), part);
    }
    normals.into_iter().map(unit_or_zero).collect()
}

/// A piece of the outline, across one triangle.
struct Segment {
    from: Vector,
    to: Vector,
    /// Which way the surface faces there, smoothed.
    normal: Vector,
}

impl Segment {
    /// How far (mm) a place is from it.
    fn away_mm(&self, place: Vector) -> f64 {
        let (along, there) = (minus(self.to, self.from), minus(place, self.from));
        let squared = dot(along, along);
        let part = if squared > 0.0 {
            (dot(there, along) / squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        length(minus(there, along.map(|component| part * component)))
    }
}

/// The outline, piece by piece, with the triangle that each piece crosses.
fn segments(near: &Neighbourhood, share: &[f64], normals: &[Vector]) -> Vec<([u32; 3], Segment)> {
    let mut segments = Vec::new();
    for triangle in &near.triangles {
        let is_inside = triangle.map(|v| share[v as usize] > HALF);
        let crossings: Vec<Vector> = [[0, 1], [1, 2], [2, 0]]
            .into_iter()
            .filter(|[i, j]| is_inside[*i] != is_inside[*j])
            .map(|edge| {
                let [a, b] = edge.map(|corner| triangle[corner] as usize);
                let part = (HALF - share[a]) / (share[b] - share[a]);
                let along = minus(near.vertices_mm[b], near.vertices_mm[a]);
                plus_scaled(near.vertices_mm[a], part, along)
            })
            .collect();
        if let [from, to] = crossings[..] {
            // As the inside says: the outside may be around a rim.
            let inner = triangle.iter().zip(is_inside).filter(|(_, inside)| *inside);
            let sum = inner.fold([0.0; 3], |sum, (v, _)| {
                plus_scaled(sum, 1.0, normals[*v as usize])
            });
            let normal = unit_or_zero(sum);
            segments.push((*triangle, Segment { from, to, normal }));
        }
    }
    segments
}

/// Distances (mm) from the outline, below 0 outside: inside everywhere, outside within reach.
///
/// Each vertex takes the nearest of the segments that its neighbours are nearest to, in the order of these
/// distances (after Dijkstra 1959).
fn spread(
    near: &Neighbourhood,
    neighbours: &Neighbours,
    normals: &[Vector],
    share: &[f64],
    reach_mm: f64,
    task: &Task,
) -> Result<Vec<f64>, Cancelled> {
    let segments = segments(near, share, normals);
    let mut away_mm = vec![f64::INFINITY; near.vertices_mm.len()];
    // Lengths from 0 up are in the order of their bits.
    let mut offers: BinaryHeap<Reverse<(u64, u32, u32)>> = BinaryHeap::new();
    for (number, (triangle, segment)) in (0..).zip(&segments) {
        // Around a rim begins another side.
        let is_beyond = |v: u32| {
            share[v as usize] <= HALF && dot(normals[v as usize], segment.normal) <= SAME_SIDE
        };
        for vertex in triangle.iter().copied().filter(|v| !is_beyond(*v)) {
            let away = segment.away_mm(near.vertices_mm[vertex as usize]);
            offers.push(Reverse((away.to_bits(), vertex, number)));
        }
    }
    let mut looked = 0;
    while let Some(Reverse((bits, vertex, number))) = offers.pop() {
        looked += 1;
        if looked % STRIDE == 0 {
            task.check()?;
        }
        let (here, away) = (vertex as usize, f64::from_bits(bits));
        if away >= away_mm[here] {
            continue;
        }
        away_mm[here] = away;
        let segment = &segments[number as usize].1;
        let is_inside = share[here] > HALF;
        for &other in neighbours.at(here) {
            let there = other as usize;
            let far = segment.away_mm(near.vertices_mm[there]);
            let is_reached = (share[there] > HALF) == is_inside
                && (is_inside
                    || far <= reach_mm && dot(normals[there], segment.normal) > SAME_SIDE);
            if is_reached && far < away_mm[there] {
                offers.push(Reverse((far.to_bits(), other, number)));
            }
        }
    }
    let signed = |(away, share): (f64, &f64)| match (away.is_finite(), *share > HALF) {
        (true, true) => away,
        (true, false) => -away,
        (false, _) => f64::NAN,
    };
    Ok(away_mm.into_iter().zip(share).map(signed).collect())
}
