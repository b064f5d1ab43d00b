//! The function by conjugate gradients, with a multigrid cycle as a guess in each step.
//!
//! Nodes that are neighbours are to differ as the field says; at each sample the function is to be
//! one half. Beyond the cube nothing is asked, so that a sheet may leave it. The cycle stands for
//! each sample at its nodes alone; the steps of conjugate gradients make up for that.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::grid::{Grid, Place};
use super::samples::Sample;
use super::splat::divergence;

/// How much the samples count beside the field (Kazhdan and Hoppe's weight).
const SCREENING: f64 = 4.0;
/// The error, over that of no function at all, with which to end.
const TOLERANCE: f64 = 1e-4;
/// Most steps; some twenty are enough.
const STEPS: usize = 60;
/// How far each sweep goes: smooths best in space.
const DAMPING: f32 = 6.0 / 7.0;
/// Sweeps before and after the coarser grids.
const SWEEPS: usize = 2;
/// Sweeps on the coarsest grid of 3 nodes a side.
const COARSEST_SWEEPS: usize = 60;

/// What a sample asks for.
struct Held {
    place: Place,
    weight: f32,
}

/// The system of equations.
struct System {
    nodes: usize,
    held: Vec<Held>,
    /// Where each plane of cells begins in `held`.
    planes: Vec<usize>,
    levels: Vec<Level>,
}

/// A grid of the cycle.
struct Level {
    nodes: usize,
    /// How much a difference between neighbours counts.
    stiffness: f32,
    /// How much the value of each node counts.
    hold: Vec<f32>,
}

/// The function at the nodes: near 1 inside, near 0 outside.
pub(super) fn solve(grid: &Grid, samples: &[Sample], task: &Task) -> Result<Vec<f32>, Cancelled> {
    task.begin("solve", STEPS);
    let mut rest = divergence(grid, samples, task)?;
    let system = System::new(grid, samples, task)?;
    for held in &system.held {
        held.spread(grid.nodes, 0.5 * held.weight, &mut rest);
    }
    let mut function = vec![0.0f32; rest.len()];
    let mut guess = system.cycle(&rest, task)?;
    let mut error = dot(&rest, &guess, task)?;
    let enough = error * TOLERANCE * TOLERANCE;
    let mut way = guess;
    for _ in 0..STEPS {
        task.advance(1)?;
        if error <= enough {
            break;
        }
        let image = system.apply(&way, task)?;
        let length = error / dot(&way, &image, task)?;
        step(&mut function, length as f32, &way);
        step(&mut rest, -length as f32, &image);
        drop(image);
        guess = system.cycle(&rest, task)?;
        let before = std::mem::replace(&mut error, dot(&rest, &guess, task)?);
        let part = (error / before) as f32;
        way.par_iter_mut()
            .zip(&guess)
            .for_each(|(w, g)| *w = g + part * *w);
    }
    Ok(function)
}

/// `a += length b`.
fn step(a: &mut [f32], length: f32, b: &[f32]) {
    a.par_iter_mut().zip(b).for_each(|(a, b)| *a += length * b);
}

/// In chunks, so that any number of threads gives the same bits.
fn dot(a: &[f32], b: &[f32], task: &Task) -> Result<f64, Cancelled> {
    task.check()?;
    let sum = |(a, b): (&[f32], &[f32])| -> f64 {
        a.iter()
            .zip(b)
            .map(|(a, b)| f64::from(*a) * f64::from(*b))
            .sum()
    };
    let sums: Vec<f64> = a
        .par_chunks(1 << 14)
        .zip(b.par_chunks(1 << 14))
        .map(sum)
        .collect();
    Ok(sums.iter().sum())
}

impl Held {
    /// Adds `value` to the nodes around, by their weights.
    fn spread(&self, nodes: usize, value: f32, out: &mut [f32]) {
        for upper in [false, true] {
            let first = (self.place.cell[2] as usize + usize::from(upper)) * nodes * nodes;
            for (node, weight) in self.place.corners(nodes, upper) {
                out[first + node] += weight * value;
            }
        }
    }
}

impl System {
    fn new(grid: &Grid, samples: &[Sample], task: &Task) -> Result<Self, Cancelled> {
        let held: Vec<Held> = samples
            .iter()
            .map(|sample| {
                let own_mm = grid.coarser(sample.steps).cell_mm;
                Held {
                    place: sample.on(grid),
                    weight: (SCREENING * sample.area_mm2 / (own_mm * grid.cell_mm)) as f32,
                }
            })
            .collect();
        let plane = |k: usize| held.partition_point(|h| (h.place.cell[2] as usize) < k);
        let planes = (0..=grid.nodes).map(plane).collect();
        let mut hold = vec![0.0; grid.nodes.pow(3)];
        for h in &held {
            h.spread(grid.nodes, h.weight, &mut hold);
        }
        let mut levels = vec![Level {
            nodes: grid.nodes,
            stiffness: 1.0,
            hold,
        }];
        while let Some(last) = levels.last().filter(|l| l.nodes > 3) {
            let nodes = last.nodes / 2 + 1;
            levels.push(Level {
                nodes,
                stiffness: 2.0 * last.stiffness,
                hold: restrict(&last.hold, last.nodes, nodes, task)?,
            });
        }
        Ok(Self {
            nodes: grid.nodes,
            held,
            planes,
            levels,
        })
    }

    /// The equations' left side.
    fn apply(&self, x: &[f32], task: &Task) -> Result<Vec<f32>, Cancelled> {
        let n = self.nodes;
        let mut out = vec![0.0f32; x.len()];
        out.par_chunks_mut(n * n)
            .enumerate()
            .try_for_each(|(k, plane)| {
                task.check()?;
                for (j, row) in plane.chunks_mut(n).enumerate() {
                    differences(x, n, j, k, |i, difference, _| row[i] = difference);
                }
                for upper in [false, true] {
                    let Some(cells) = k.checked_sub(usize::from(upper)) else {
                        continue;
                    };
                    for held in &self.held[self.planes[cells]..self.planes[cells + 1]] {
                        let value = held.weight * held.place.value(n, x);
                        for (node, weight) in held.place.corners(n, upper) {
                            plane[node] += weight * value;
                        }
                    }
                }
                Ok(())
            })?;
        Ok(out)
    }

    /// One multigrid cycle for the right side `b`, from nothing.
    fn cycle(&self, b: &[f32], task: &Task) -> Result<Vec<f32>, Cancelled> {
        cycle(&self.levels, b, task)
    }
}

fn cycle(levels: &[Level], b: &[f32], task: &Task) -> Result<Vec<f32>, Cancelled> {
    let (level, coarser) = levels
        .split_first()
        .expect("a level is left: else this is a bug");
    let Some(next) = coarser.first() else {
        let mut x = vec![0.0; b.len()];
        for _ in 0..COARSEST_SWEEPS {
            x = level.sweep(&x, b, task)?;
        }
        return Ok(x);
    };
    let mut x = vec![0.0; b.len()];
    for _ in 0..SWEEPS {
        x = level.sweep(&x, b, task)?;
    }
    let rest = level.rest(&x, b, task)?;
    let coarse = restrict(&rest, level.nodes, next.nodes, task)?;
    drop(rest);
    let correction = cycle(coarser, &coarse, task)?;
    prolong(&correction, &mut x, level.nodes, task)?;
    for _ in 0..SWEEPS {
        x = level.sweep(&x, b, task)?;
    }
    Ok(x)
}

impl Level {
    /// `x` after one damped step towards the solution at each node.
    fn sweep(&self, x: &[f32], b: &[f32], task: &Task) -> Result<Vec<f32>, Cancelled> {
        self.each(x, task, |node, difference, count| {
            let stiffness = self.stiffness * count + self.hold[node];
            let rest = b[node] - self.stiffness * difference - self.hold[node] * x[node];
            x[node] + DAMPING * rest / stiffness
        })
    }

    /// What is left of the right side.
    fn rest(&self, x: &[f32], b: &[f32], task: &Task) -> Result<Vec<f32>, Cancelled> {
        self.each(x, task, |node, difference, _| {
            b[node] - self.stiffness * difference - self.hold[node] * x[node]
        })
    }

    fn each(
        &self,
        x: &[f32],
        task: &Task,
        value: impl Fn(usize, f32, f32) -> f32 + Sync,
    ) -> Result<Vec<f32>, Cancelled> {
        let n = self.nodes;
        let mut out = vec![0.0f32; x.len()];
        out.par_chunks_mut(n * n)
            .enumerate()
            .try_for_each(|(k, plane)| {
                task.check()?;
                for (j, row) in plane.chunks_mut(n).enumerate() {
                    let first = (k * n + j) * n;
                    differences(x, n, j, k, |i, difference, count| {
                        row[i] = value(first + i, difference, count);
                    });
                }
                Ok(())
            })?;
        Ok(out)
    }
}

/// Calls `found` with each node of a row, the sum of its differences from its neighbours, and how
/// many it has.
#[inline]
fn differences(x: &[f32], n: usize, j: usize, k: usize, mut found: impl FnMut(usize, f32, f32)) {
    let first = (k * n + j) * n;
    let row = &x[first..first + n];
    // Beyond the cube a row stands for its own neighbour, from which it does not differ.
    let beside = |is_there: bool, at: usize| if is_there { &x[at..at + n] } else { row };
    let rows = [
        beside(j > 0, first.wrapping_sub(n)),
        beside(j + 1 < n, first + n),
        beside(k > 0, first.wrapping_sub(n * n)),
        beside(k + 1 < n, first + n * n),
    ];
    let count = [j > 0, j + 1 < n, k > 0, k + 1 < n];
    let count = count.into_iter().filter(|c| *c).count() as f32;
    for i in 0..n {
        let own = row[i];
        let mut sum = 4.0 * own - rows[0][i] - rows[1][i] - rows[2][i] - rows[3][i];
        let mut neighbours = count;
        if i > 0 {
            sum += own - row[i - 1];
            neighbours += 1.0;
        }
        if i + 1 < n {
            sum += own - row[i + 1];
            neighbours += 1.0;
        }
        found(i, sum, neighbours);
    }
}

/// Adds a function on the grid of every second node to one on `n` nodes, linear in between.
pub(super) fn prolong(
    coarse: &[f32],
    fine: &mut [f32],
    n: usize,
    task: &Task,
) -> Result<(), Cancelled> {
    let m = n / 2 + 1;
    let ends = |v: usize| [v / 2, v.div_ceil(2)];
    fine.par_chunks_mut(n * n)
        .enumerate()
        .try_for_each(|(k, plane)| {
            task.check()?;
            for (j, row) in plane.chunks_mut(n).enumerate() {
                let from = |k: usize, j: usize| &coarse[(k * m + j) * m..][..m];
                let ([k0, k1], [j0, j1]) = (ends(k), ends(j));
                let rows = [from(k0, j0), from(k0, j1), from(k1, j0), from(k1, j1)];
                for (i, value) in row.iter_mut().enumerate() {
                    let [i0, i1] = ends(i);
                    let sum: f32 = rows.iter().map(|r| r[i0] + r[i1]).sum();
                    *value += sum / 8.0;
                }
            }
            Ok(())
        })
}

/// The transpose of [`prolong`]: from `n` nodes a side to `m`.
fn restrict(fine: &[f32], n: usize, m: usize, task: &Task) -> Result<Vec<f32>, Cancelled> {
    let mut coarse = vec![0.0f32; m * m * m];
    // A node, and half of those beside it.
    let around = |v: usize| {
        let v = 2 * v;
        let beside = [(v.wrapping_sub(1), 0.5), (v, 1.0), (v + 1, 0.5)];
        beside.into_iter().filter(move |(v, _)| *v < n)
    };
    coarse
        .par_chunks_mut(m * m)
        .enumerate()
        .try_for_each(|(k, plane)| {
            task.check()?;
            for (j, row) in plane.chunks_mut(m).enumerate() {
                for (z, wz) in around(k) {
                    for (y, wy) in around(j) {
                        let from = &fine[(z * n + y) * n..][..n];
                        for (i, value) in row.iter_mut().enumerate() {
                            for (x, wx) in around(i) {
                                *value += wz * wy * wx * from[x];
                            }
                        }
                    }
                }
            }
            Ok(())
        })?;
    Ok(coarse)
}
