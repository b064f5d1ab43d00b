//! Edges collapse, the cheapest first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::bounds::{Bounds, Hold};
use super::collapse::Surroundings;
use super::points::Points;
use super::quadric::Quadric;
use crate::TriangleMesh;
use crate::stars::Stars;
use crate::vector::{Vector, dot, minus};

/// Collapses or triangles between two looks at the cancel switch.
const STRIDE: usize = 1 << 12;
/// A tier is this part of all edges.
const TIERS: usize = 8;
/// What the length of an edge adds to its cost, so that short edges go first where all is flat.
const LENGTH_COST: f64 = 1e-6;
/// Part of a vertex's limit that the mean distance to the planes it stands for may reach: with more,
/// much is found to be too far and done again; with less, triangles stay that could go.
const TYPICAL: f64 = 0.5;
/// The version of a vertex that is gone; no other comes near it.
const GONE: u32 = u32::MAX / 2;

/// One collapse, as it was done.
#[derive(Clone, Copy)]
pub(super) struct Step {
    pub(super) kept: u32,
    pub(super) gone: u32,
    pub(super) place: Vector,
    /// What it cost, as in its entry.
    pub(super) cost: f32,
}

/// A mesh on its way to fewer triangles.
pub(super) struct Run<'a> {
    pub(super) holds: &'a [Hold],
    /// What quadrics take as the origin, so that digits are not lost.
    pub(super) middle: Vector,
    pub(super) vertices_mm: Vec<Vector>,
    pub(super) stars: Stars,
    pub(super) quadrics: Vec<Quadric>,
    /// How often each vertex has changed.
    pub(super) versions: Vec<u32>,
    /// How far (mm2, squared) the surface may come away from what each vertex stands for.
    pub(super) limits: Vec<f64>,
    /// What each vertex stands for, where there are limits.
    pub(super) points: Option<Points>,
    pub(super) steps: Vec<Step>,
}

impl<'a> Run<'a> {
    pub(super) fn new(
        mesh: &TriangleMesh,
        stars: Stars,
        bounds: &'a Bounds,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let vertices_mm = mesh.vertices_mm().to_vec();
        let middle = mesh.bounds_mm().map_or([0.0; 3], |[low, high]| {
            [0, 1, 2].map(|axis| f64::midpoint(low[axis], high[axis]))
        });
        let mut quadrics = vec![Quadric::default(); vertices_mm.len()];
        let chunks = quadrics.par_chunks_mut(STRIDE).enumerate();
        chunks.try_for_each(|(chunk, quadrics)| {
            let mut star = Vec::new();
            for (vertex, quadric) in ((chunk * STRIDE) as u32..).zip(quadrics) {
                stars.at(vertex, &mut star);
                for &triangle in &star {
                    let corners = mesh.corners_mm(triangle).map(|c| minus(c, middle));
                    *quadric = quadric.plus(&Quadric::of(corners));
                }
            }
            task.check()
        })?;
        Ok(Self {
            holds: &bounds.holds,
            middle,
            versions: vec![0; vertices_mm.len()],
            points: (bounds.error_mm).map(|_| Points::new(vertices_mm.clone())),
            limits: bounds.limits.clone(),
            vertices_mm,
            stars,
            quadrics,
            steps: Vec::new(),
        })
    }

    /// Does the steps of an earlier run again, except those that narrower bounds forbid, and those where
    /// the surroundings therefore differ. Gives the vertices for which that is so.
    pub(super) fn repeat(
        &mut self,
        steps: &[Step],
        is_narrower: &[bool],
        task: &Task,
    ) -> Result<Vec<bool>, Cancelled> {
        let mut other = Others::new(self.holds.len());
        for (vertex, hold) in (0..).zip(self.holds) {
            if is_narrower[vertex as usize] && *hold == Hold::Star {
                other.add(vertex, &self.stars);
            }
        }
        let mut is_narrower = is_narrower.to_vec();
        let mut surroundings = Surroundings::default();
        for (number, &step) in steps.iter().enumerate() {
            if number % STRIDE == 0 {
                task.check()?;
            }
            let ends = [step.kept, step.gone];
            let is_asked = ends.iter().any(|v| is_narrower[*v as usize]);
            let is_allowed = |run: &Self, surroundings: &mut Surroundings| {
                let entry = run.entry(step.kept, step.gone);
                entry.is_some_and(|entry| run.allowed(entry, surroundings).is_some())
            };
            if other.are_near(ends) || is_asked && !is_allowed(self, &mut surroundings) {
                for vertex in ends {
                    other.add(vertex, &self.stars);
                }
            } else {
                is_narrower[step.kept as usize] = is_asked;
                self.apply(step);
            }
        }
        Ok(other.is_other)
    }

    /// Collapses edges until the end is reached or none can be collapsed any more; if `at` is given,
    /// looks only at edges with one of those vertices.
    pub(super) fn collapse(
        &mut self,
        end: usize,
        at: Option<&[bool]>,
        task: &Task,
    ) -> Result<(), Cancelled> {
        loop {
            let before = self.steps.len();
            self.sweep(end, at, task)?;
            // What was refused may be possible now; a last handful is not worth another sweep.
            let done = self.steps.len() - before;
            if self.stars.alive() <= end || done <= self.stars.alive() / 1000 {
                return Ok(());
            }
        }
    }

    /// Looks at each edge once, and again when one of its ends has changed.
    fn sweep(&mut self, end: usize, at: Option<&[bool]>, task: &Task) -> Result<(), Cancelled> {
        let mut known = self.edges(at, task)?;
        while !known.is_empty() && self.stars.alive() > end {
            // In tiers of rising cost, so that the heap stays small: the order is the same.
            let tier = known[known.len() / TIERS];
            let begun = known.partition_point(|entry| *entry <= tier);
            let mut later = known.split_off(begun);
            self.tier(&known, tier, &mut later, end, task)?;
            later.retain(|entry| self.is_current(*entry));
            // Most of it is in order already, which this sort makes use of.
            later.par_sort();
            known = later;
        }
        Ok(())
    }

    /// Collapses all edges up to `last`; those that come up and cost more go to `later`.
    fn tier(
        &mut self,
        known: &[u128],
        last: u128,
        later: &mut Vec<u128>,
        end: usize,
        task: &Task,
    ) -> Result<(), Cancelled> {
        let mut known = known.iter().copied().peekable();
        let mut changed: BinaryHeap<Reverse<u128>> = BinaryHeap::new();
        let mut surroundings = Surroundings::default();
        let mut star = Vec::new();
        let mut looked = 0;
        while self.stars.alive() > end {
            let next = match (known.peek(), changed.peek()) {
                (Some(a), Some(Reverse(b))) if b < a => changed.pop().map(|c| c.0),
                (None, _) => changed.pop().map(|c| c.0),
                _ => known.next(),
            };
            let Some(entry) = next else { break };
            looked += 1;
            if looked % STRIDE == 0 {
                task.check()?;
            }
            if !self.is_current(entry) {
                continue;
            }
            let Some(step) = self.allowed(entry, &mut surroundings) else {
                continue;
            };
            self.apply(step);
            task.advance(2)?;
            self.stars.at(step.kept, &mut star);
            let beside = star.iter().map(|t| t[1]);
            for entry in beside.filter_map(|v| self.entry(step.kept, v)) {
                if entry <= last {
                    changed.push(Reverse(entry));
                } else {
                    later.push(entry);
                }
            }
        }
        Ok(())
    }

    /// Whether neither end of an edge has changed since its entry was made.
    fn is_current(&self, entry: u128) -> bool {
        let [u, v] = ends(entry);
        entry as u32 == self.stamp(u, v)
    }

    /// All edges that may be worth collapsing, the cheapest first.
    fn edges(&self, at: Option<&[bool]>, task: &Task) -> Result<Vec<u128>, Cancelled> {
        let triangles: Vec<[u32; 3]> = self.stars.triangles().collect();
        let chunks = triangles
            .par_chunks(STRIDE)
            .map(|triangles| {
                let edges = triangles
                    .iter()
                    .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
                // Where both triangles of an edge face the same way, each runs along it once.
                let is_asked = |v: u32| at.is_none_or(|at| at[v as usize]);
                let edges = edges.filter(|&[u, v]| u < v && (is_asked(u) || is_asked(v)));
                let entries: Vec<u128> = edges.filter_map(|[u, v]| self.entry(u, v)).collect();
                task.check()?;
                Ok(entries)
            })
            .collect::<Result<Vec<_>, Cancelled>>()?;
        let mut entries = chunks.concat();
        entries.par_sort_unstable();
        Ok(entries)
    }

    /// An edge's place in the order: cost, ends, and how often the ends had changed.
    fn entry(&self, u: u32, v: u32) -> Option<u128> {
        let (u, v) = (u.min(v), u.max(v));
        let (_, cost, weight) = self.best(u, v)?;
        if cost > TYPICAL * TYPICAL * self.limit(u, v) * weight {
            return None;
        }
        let edge = minus(self.vertices_mm[u as usize], self.vertices_mm[v as usize]);
        let cost = (cost + LENGTH_COST * weight * dot(edge, edge)) as f32;
        // Singles from 0 up are in the order of their bits.
        let [cost, u128_u, u128_v] = [cost.to_bits(), u, v].map(u128::from);
        Some(cost << 96 | u128_u << 64 | u128_v << 32 | u128::from(self.stamp(u, v)))
    }

    /// How far (mm2, squared) the surface may come away from what these two stand for.
    pub(super) fn limit(&self, u: u32, v: u32) -> f64 {
        self.limits[u as usize].min(self.limits[v as usize])
    }

    fn stamp(&self, u: u32, v: u32) -> u32 {
        self.versions[u as usize].wrapping_add(self.versions[v as usize])
    }

    /// The best place for both ends, and its quadric's sum and weight.
    fn best(&self, u: u32, v: u32) -> Option<(Vector, f64, f64)> {
        let quadric = self.quadrics[u as usize].plus(&self.quadrics[v as usize]);
        let [p, q] = [u, v].map(|v| self.vertices_mm[v as usize]);
        let at = |place: Vector| (place, quadric.at(minus(place, self.middle)), quadric.weight);
        match [u, v].map(|v| self.holds[v as usize]) {
            [Hold::Place, Hold::Free] => Some(at(p)),
            [Hold::Free, Hold::Place] => Some(at(q)),
            [Hold::Free, Hold::Free] => {
                let middle = [0, 1, 2].map(|axis| f64::midpoint(p[axis], q[axis]));
                let least = quadric.least_near(minus(middle, self.middle));
                let least = [0, 1, 2].map(|axis| single(least[axis] + self.middle[axis]));
                let (edge, away) = (minus(p, q), minus(least, middle));
                if dot(away, away) <= dot(edge, edge) {
                    return Some(at(least));
                }
                let all = [p, q, middle.map(single)].map(at);
                all.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))
            }
            _ => None,
        }
    }

    /// The collapse of an edge, if the surface stays sound.
    fn allowed(&self, entry: u128, surroundings: &mut Surroundings) -> Option<Step> {
        let [u, v] = ends(entry);
        let (place, _, _) = self.best(u, v)?;
        let cost = f32::from_bits((entry >> 96) as u32);
        let (kept, gone) = match self.holds[v as usize] {
            Hold::Free => (u, v),
            _ => (v, u),
        };
        surroundings.load(&self.stars, kept, gone);
        let is_held = |v: u32| self.holds[v as usize] == Hold::Star;
        (surroundings.keeps_topology(kept, gone)
            && !surroundings.around().any(is_held)
            && surroundings.keeps_shape(&self.vertices_mm, [kept, gone], place)
            && self.stays_near(surroundings, [kept, gone], place))
        .then_some(Step {
            kept,
            gone,
            place,
            cost,
        })
    }

    pub(super) fn apply(&mut self, step: Step) {
        let [kept, gone] = [step.kept as usize, step.gone as usize];
        self.stars.collapse(step.kept, step.gone);
        self.quadrics[kept] = self.quadrics[kept].plus(&self.quadrics[gone]);
        self.limits[kept] = self.limits[kept].min(self.limits[gone]);
        if let Some(points) = &mut self.points {
            points.join(step.kept, step.gone);
        }
        self.vertices_mm[kept] = step.place;
        self.versions[kept] += 1;
        self.versions[gone] = GONE;
        self.steps.push(step);
    }

    /// For each of some vertices the limit (mm2, squared) that would just have allowed what it
    /// stands for.
    pub(super) fn reached(&self, vertices: &[u32]) -> FxHashMap<u32, f64> {
        let reached = |&vertex: &u32| {
            let quadric = &self.quadrics[vertex as usize];
            let place = minus(self.vertices_mm[vertex as usize], self.middle);
            let weight = quadric.weight.max(f64::MIN_POSITIVE);
            (vertex, quadric.at(place) / (TYPICAL * TYPICAL * weight))
        };
        vertices.iter().map(reached).collect()
    }

    /// For each vertex of the given mesh the one that stands for it now.
    pub(super) fn standing(&self) -> Vec<u32> {
        let mut standing: Vec<u32> = (0..self.vertices_mm.len() as u32).collect();
        // Whoever a vertex collapsed into only went later.
        for step in self.steps.iter().rev() {
            standing[step.gone as usize] = standing[step.kept as usize];
        }
        standing
    }
}

/// Vertices that are not as they were in an earlier run.
struct Others {
    is_other: Vec<bool>,
    /// Whether a vertex is one or has one as its neighbour. None of them goes, so none is lost.
    is_near: Vec<bool>,
    star: Vec<[u32; 3]>,
}

impl Others {
    fn new(vertices: usize) -> Self {
        Self {
            is_other: vec![false; vertices],
            is_near: vec![false; vertices],
            star: Vec::new(),
        }
    }

    fn add(&mut self, vertex: u32, stars: &Stars) {
        if !std::mem::replace(&mut self.is_other[vertex as usize], true) {
            stars.at(vertex, &mut self.star);
            for near in self.star.as_flattened() {
                self.is_near[*near as usize] = true;
            }
        }
    }

    fn are_near(&self, vertices: [u32; 2]) -> bool {
        vertices.iter().any(|v| self.is_near[*v as usize])
    }
}

/// The ends of an entry's edge.
fn ends(entry: u128) -> [u32; 2] {
    [(entry >> 64) as u32, (entry >> 32) as u32]
}

/// The nearest number that a file can hold.
fn single(value: f64) -> f64 {
    f64::from(value as f32)
}
