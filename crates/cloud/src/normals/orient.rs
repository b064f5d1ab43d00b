//! Normals with a side: carried along a tree, then turned away from the body.
//!
//! 1. `Forest::of`: a minimum spanning tree of each connected part of the neighbour graph, where
//!    an edge costs the angle by which two normals disagree.
//! 2. `carry`: along each tree the sign goes from point to point.
//! 3. `turn_outward`: a part faces away from its own middle at its outermost point.
//! 4. `hollows::turn`: a part that lies inside others, an odd number of them, faces inward.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::neighbourhoods::Neighbourhoods;
use super::{dot, hollows, minus};

/// Steps into which costs are sorted; finer ones change nothing that counts.
const COSTS: usize = 1 << 16;
/// Edges or points between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

pub(super) fn oriented(
    points: &[[f64; 3]],
    lines: &[[f64; 3]],
    around: &Neighbourhoods,
    task: &Task,
) -> Result<Vec<[f64; 3]>, Cancelled> {
    task.begin("normals", 4);
    let forest = Forest::of(points, lines, around, task)?;
    task.advance(1)?;
    let mut normals = lines.to_vec();
    let mut parts = carry(points, &mut normals, &forest, task)?;
    task.advance(1)?;
    for part in &parts {
        turn_outward(points, &mut normals, part);
    }
    task.advance(1)?;
    // A stable sort: of equal parts the first comes first.
    parts.sort_by_key(|part| std::cmp::Reverse(part.len()));
    hollows::turn(points, &mut normals, &parts, around, task)?;
    Ok(normals)
}

/// How much two normals disagree, 0 to 2, and whether the second faces the other way.
///
/// The first is reflected at the plane halfway between the points: on an arc, and on the two walls
/// of a plate, that is the second. Edges along the normals cost more, so that signs go along the
/// surface where they can.
fn disagreement(points: &[[f64; 3]], normals: &[[f64; 3]], i: usize, j: usize) -> (f64, bool) {
    let step = minus(points[j], points[i]);
    let squared = dot(step, step);
    let (n, m) = (normals[i], normals[j]);
    if squared == 0.0 {
        return (1.0 - dot(n, m).abs(), dot(n, m) < 0.0);
    }
    let along = dot(n, step);
    let reflected = [0, 1, 2].map(|k| n[k] - 2.0 * along / squared * step[k]);
    let cosine = dot(reflected, m);
    let leaving = along.abs() * dot(m, step).abs() / squared;
    (1.0 - cosine.abs().min(1.0) + leaving, cosine < 0.0)
}

/// The edges of the trees, by point.
struct Forest {
    starts: Vec<usize>,
    ends: Vec<u32>,
}

impl Forest {
    fn of(
        points: &[[f64; 3]],
        lines: &[[f64; 3]],
        around: &Neighbourhoods,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let edges = cheapest_first(points, lines, around, task)?;
        let mut sets: Vec<u32> = (0..points.len() as u32).collect();
        let mut kept = Vec::with_capacity(points.len());
        for chunk in edges.chunks(STRIDE) {
            task.check()?;
            for &[i, j] in chunk {
                let (a, b) = (root(&mut sets, i), root(&mut sets, j));
                if a != b {
                    sets[a.max(b) as usize] = a.min(b);
                    kept.push([i, j]);
                }
            }
        }
        drop(edges);
        let mut starts = vec![0; points.len() + 1];
        for v in kept.as_flattened() {
            starts[*v as usize + 1] += 1;
        }
        for i in 0..points.len() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut ends = vec![0; 2 * kept.len()];
        for &[i, j] in &kept {
            for (from, to) in [(i, j), (j, i)] {
                ends[next[from as usize]] = to;
                next[from as usize] += 1;
            }
        }
        Ok(Self { starts, ends })
    }

    fn from(&self, i: u32) -> &[u32] {
        &self.ends[self.starts[i as usize]..self.starts[i as usize + 1]]
    }
}

/// The edges of the neighbour graph by their cost, ties in the order of points: a counting sort.
fn cheapest_first(
    points: &[[f64; 3]],
    lines: &[[f64; 3]],
    around: &Neighbourhoods,
    task: &Task,
) -> Result<Vec<[u32; 2]>, Cancelled> {
    // The root spreads the small costs, of which there are most.
    let place = |i: usize, j: u32| {
        let (cost, _) = disagreement(points, lines, i, j as usize);
        ((cost / 2.0).sqrt() * (COSTS - 1) as f64) as usize
    };
    let costs: Vec<Vec<u16>> = (0..points.len())
        .into_par_iter()
        .with_min_len(STRIDE / 64)
        .map(|i| {
            task.check()?;
            let of_point = around.of_point(i).iter();
            Ok(of_point
                .map(|&j| place(i, j).min(COSTS - 1) as u16)
                .collect())
        })
        .collect::<Result<_, Cancelled>>()?;
    let mut starts = vec![0usize; COSTS + 1];
    for (i, costs) in costs.iter().enumerate() {
        if i % STRIDE == 0 {
            task.check()?;
        }
        for &c in costs {
            starts[c as usize + 1] += 1;
        }
    }
    for c in 0..COSTS {
        starts[c + 1] += starts[c];
    }
    let mut edges = vec![[0; 2]; around.len()];
    for (i, costs) in costs.iter().enumerate() {
        if i % STRIDE == 0 {
            task.check()?;
        }
        for (&c, &j) in costs.iter().zip(around.of_point(i)) {
            edges[starts[c as usize]] = [i as u32, j];
            starts[c as usize] += 1;
        }
    }
    Ok(edges)
}

/// The lowest point of a set, with shorter ways to it afterwards.
fn root(sets: &mut [u32], mut i: u32) -> u32 {
    while sets[i as usize] != i {
        let above = sets[sets[i as usize] as usize];
        sets[i as usize] = above;
        i = above;
    }
    i
}

/// Makes the normals of each tree agree; returns the trees' points, the first point first.
fn carry(
    points: &[[f64; 3]],
    normals: &mut [[f64; 3]],
    forest: &Forest,
    task: &Task,
) -> Result<Vec<Vec<u32>>, Cancelled> {
    let mut is_done = vec![false; points.len()];
    let mut parts = Vec::new();
    for first in 0..points.len() as u32 {
        if std::mem::replace(&mut is_done[first as usize], true) {
            continue;
        }
        let mut part = vec![first];
        let mut next = 0;
        while let Some(&i) = part.get(next) {
            if next % STRIDE == 0 {
                task.check()?;
            }
            next += 1;
            for &j in forest.from(i) {
                if !std::mem::replace(&mut is_done[j as usize], true) {
                    let (i, j) = (i as usize, j as usize);
                    if disagreement(points, normals, i, j).1 {
                        normals[j] = normals[j].map(|v| -v);
                    }
                    part.push(j as u32);
                }
            }
        }
        parts.push(part);
    }
    Ok(parts)
}

/// Turns a part so that it faces away from its body where that is plainest: of its outermost
/// points along the six axes, at the one whose normal lies best along its axis.
fn turn_outward(points: &[[f64; 3]], normals: &mut [[f64; 3]], part: &[u32]) {
    let mut plainest: f64 = 0.0;
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let height = |i: &u32| sign * points[*i as usize][axis];
            // Of equally far points, the one that faces along the axis best: others may be rims.
            let outermost = part.iter().copied().max_by(|a, b| {
                let along = |i: &u32| normals[*i as usize][axis].abs();
                let by_height = height(a).total_cmp(&height(b));
                by_height.then(along(a).total_cmp(&along(b)))
            });
            let Some(outermost) = outermost else { return };
            let facing = sign * normals[outermost as usize][axis];
            if facing.abs() > plainest.abs() + 1e-9 {
                plainest = facing;
            }
        }
    }
    if plainest < 0.0 {
        flip(normals, part);
    }
}

/// Turns all normals of a part round.
pub(super) fn flip(normals: &mut [[f64; 3]], part: &[u32]) {
    for &i in part {
        normals[i as usize] = normals[i as usize].map(|v| -v);
    }
}
