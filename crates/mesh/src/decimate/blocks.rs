//! Most of the work, done block by block.
//!
//! 1. `labels`: vertices in blocks that lie together, each with about as many, cut at planes.
//! 2. `Block::steps`: each block collapses its own edges, the cheapest first, several blocks at once. What
//!    touches another block is held.
//! 3. `cheapest`: of all blocks' collapses those stay that the whole would have done first. The run
//!    does them again, block after block.
//!
//! A block fits into the processor's cache, where one mesh of millions does not: that is most of the
//! gain. The blocks depend on the mesh alone, so the result is the same for any number of threads.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::bounds::Hold;
use super::quadric::Quadric;
use super::run::{Run, Step};
use crate::stars::Stars;
use crate::vector::Vector;

/// Most vertices of a block.
const MOST_VERTICES: usize = 1 << 13;
/// Where blocks are cut, in parts of their vertices: other places each time, so that what was held at
/// first is free then.
const CUTS: [f64; 2] = [0.5, 0.39];
/// Triangles left for the whole to choose from, beside those wanted.
const SLACK: f64 = 1.3;
/// Least part of the triangles that one round leaves: with fewer, too many of them would be those along
/// the borders, which stay as fine as they are.
const LEAST_SHARE: f64 = 0.25;
/// Most rounds.
const MOST_ROUNDS: usize = 8;
/// A round that takes fewer triangles away than one in so many is the last.
const WORTH: usize = 20;
/// How much further than the mean a block goes, because others may have more to keep.
const DEPTH: f64 = 0.6;

impl Run<'_> {
    /// Collapses inside blocks, as far as the whole would surely go.
    pub(super) fn collapse_in_blocks(&mut self, end: usize, task: &Task) -> Result<(), Cancelled> {
        for cut in CUTS.into_iter().cycle().take(MOST_ROUNDS) {
            let triangles: Vec<[u32; 3]> = self.stars.triangles().collect();
            let wanted = SLACK * end as f64;
            if triangles.len() < 4 * MOST_VERTICES || wanted >= triangles.len() as f64 {
                return Ok(());
            }
            let blocks = self.blocks(&triangles, cut, task)?;
            let share = match end {
                0 => 0.0,
                _ => LEAST_SHARE.max(wanted / triangles.len() as f64),
            };
            let found = blocks
                .par_iter()
                .map(|block| block.steps(self, DEPTH * share, task))
                .collect::<Result<Vec<_>, Cancelled>>()?;
            let inner: usize = blocks.iter().map(Block::inner).sum();
            let steps = match end {
                0 => usize::MAX,
                _ => ((1.0 - share) * inner as f64 / 2.0) as usize,
            };
            for steps in cheapest(&found, steps) {
                task.check()?;
                for &step in steps {
                    self.apply(step);
                }
            }
            if (triangles.len() - self.stars.alive()) < triangles.len() / WORTH {
                return Ok(());
            }
        }
        Ok(())
    }

    /// The mesh in blocks.
    fn blocks(
        &self,
        triangles: &[[u32; 3]],
        cut: f64,
        task: &Task,
    ) -> Result<Vec<Block>, Cancelled> {
        let labels = labels(&self.vertices_mm, triangles, cut, task)?;
        let mut blocks: Vec<Block> = Vec::new();
        blocks.resize_with(labels.count, Block::default);
        let mut places = vec![0; self.vertices_mm.len()];
        for (vertex, label) in (0..).zip(&labels.of_vertices) {
            if let Some(block) = blocks.get_mut(*label as usize) {
                places[vertex as usize] = block.vertices.len() as u32;
                block.vertices.push(vertex);
                block.holds.push(self.holds[vertex as usize]);
            }
        }
        for triangle in triangles {
            let [a, b, c] = triangle.map(|v| labels.of_vertices[v as usize]);
            if a == b && b == c {
                let inside = triangle.map(|v| places[v as usize]);
                blocks[a as usize].triangles.push(inside);
            } else {
                for (label, vertex) in [a, b, c].into_iter().zip(triangle) {
                    blocks[label as usize].holds[places[*vertex as usize] as usize] = Hold::Star;
                }
            }
        }
        task.check()?;
        Ok(blocks)
    }
}

/// A part of the mesh.
#[derive(Default)]
struct Block {
    /// Its vertices by their numbers in the whole.
    vertices: Vec<u32>,
    /// Vertices by their places in the block.
    triangles: Vec<[u32; 3]>,
    holds: Vec<Hold>,
}

impl Block {
    /// How many triangles are far enough from the borders to go.
    fn inner(&self) -> usize {
        let mut is_beside = vec![false; self.vertices.len()];
        for triangle in &self.triangles {
            if triangle
                .iter()
                .any(|v| self.holds[*v as usize] == Hold::Star)
            {
                for vertex in triangle {
                    is_beside[*vertex as usize] = true;
                }
            }
        }
        let is_inner = |t: &&[u32; 3]| t.iter().all(|v| !is_beside[*v as usize]);
        self.triangles.iter().filter(is_inner).count()
    }

    /// The collapses in the block until this part of its triangles is left, in the whole's numbers.
    fn steps(&self, whole: &Run<'_>, share: f64, task: &Task) -> Result<Vec<Step>, Cancelled> {
        let vertices = self.vertices.iter().map(|&v| v as usize);
        let vertices_mm: Vec<Vector> = vertices.clone().map(|v| whole.vertices_mm[v]).collect();
        let quadrics: Vec<Quadric> = vertices.clone().map(|v| whole.quadrics[v]).collect();
        let points = whole.points.as_ref();
        let mut run = Run {
            holds: &self.holds,
            middle: whole.middle,
            stars: Stars::new(vertices_mm.len(), &self.triangles),
            versions: vec![0; vertices_mm.len()],
            vertices_mm,
            quadrics,
            limits: vertices.map(|v| whole.limits[v]).collect(),
            points: points.map(|points| points.part(&self.vertices)),
            steps: Vec::new(),
        };
        let end = (share * self.triangles.len() as f64) as usize;
        run.collapse(end, None, task)?;
        let named = run.steps.into_iter().map(|step| Step {
            kept: self.vertices[step.kept as usize],
            gone: self.vertices[step.gone as usize],
            ..step
        });
        Ok(named.collect())
    }
}

/// The beginnings of the blocks' steps that together have the lowest costs, about `count`.
///
/// A step that costs less than one before it could not have come without that one, so it counts as much.
fn cheapest(found: &[Vec<Step>], count: usize) -> impl Iterator<Item = &[Step]> {
    let risen = |steps: &[Step]| -> Vec<f32> {
        let mut highest = 0.0_f32;
        let rise = |step: &Step| {
            highest = highest.max(step.cost);
            highest
        };
        steps.iter().map(rise).collect()
    };
    let risen: Vec<Vec<f32>> = found.iter().map(|steps| risen(steps)).collect();
    let mut all = risen.concat();
    let limit = if count < all.len() {
        *all.select_nth_unstable_by(count, f32::total_cmp).1
    } else {
        f32::INFINITY
    };
    found.iter().zip(risen).map(move |(steps, risen)| {
        let kept = risen.partition_point(|cost| *cost < limit);
        &steps[..kept]
    })
}

/// The block of each vertex; `u32::MAX` for those without triangles.
struct Labels {
    of_vertices: Vec<u32>,
    count: usize,
}

/// Cuts the vertices of the triangles along the longest side of their box, again and again.
fn labels(
    vertices_mm: &[Vector],
    triangles: &[[u32; 3]],
    cut: f64,
    task: &Task,
) -> Result<Labels, Cancelled> {
    let mut of_vertices = vec![u32::MAX; vertices_mm.len()];
    for &vertex in triangles.as_flattened() {
        of_vertices[vertex as usize] = 0;
    }
    let used = (0..).zip(&of_vertices).filter(|(_, label)| **label == 0);
    let mut used: Vec<u32> = used.map(|(vertex, _)| vertex).collect();
    let mut parts = vec![used.as_mut_slice()];
    while parts.iter().any(|part| part.len() > MOST_VERTICES) {
        task.check()?;
        let halves = parts.into_par_iter().flat_map_iter(|part| {
            if part.len() <= MOST_VERTICES {
                return [part, &mut []];
            }
            let place = (cut * part.len() as f64) as usize;
            let axis = longest_axis(vertices_mm, part);
            part.select_nth_unstable_by(place, |a, b| {
                let [u, v] = [a, b].map(|v| vertices_mm[*v as usize][axis]);
                u.total_cmp(&v).then(a.cmp(b))
            });
            let (low, high) = part.split_at_mut(place);
            [low, high]
        });
        parts = halves.filter(|part| !part.is_empty()).collect();
    }
    for (label, part) in (0..).zip(&parts) {
        for &vertex in part.iter() {
            of_vertices[vertex as usize] = label;
        }
    }
    let count = parts.len();
    Ok(Labels { of_vertices, count })
}

/// The axis along which some vertices reach furthest.
fn longest_axis(vertices_mm: &[Vector], part: &[u32]) -> usize {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for &vertex in part {
        let place = vertices_mm[vertex as usize];
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    let side = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let longest = (0..3).max_by(|a, b| side[*a].total_cmp(&side[*b]));
    longest.unwrap_or(0)
}
