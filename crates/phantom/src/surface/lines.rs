//! Points spread evenly over a surface.

use bonemesh_task::Task;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

use crate::PhantomError;
use crate::shape::Shape;
use crate::vector::{Vec3, add, scale};

/// Lines drawn before it is counted how many points there are.
const AT_ONCE: u64 = 256;
/// Shortest step along a line (mm): shorter pieces of bone are missed.
const STEP: f64 = 0.002;

/// Where random lines pass through the surface of `solid`: lines that meet a ball around it,
/// every one as likely as any other, meet every part of the surface as often as its area says.
pub(super) fn samples(
    solid: &Shape,
    count: usize,
    seed: u64,
    task: &Task,
) -> Result<Vec<Vec3>, PhantomError> {
    let (centre, radius) = solid.around();
    task.begin("samples", count);
    let mut points = Vec::with_capacity(count);
    let mut first = 0;
    // A body without surface would never give a point.
    while points.len() < count && first < 1 << 32 {
        let before = points.len();
        let parts: Vec<Vec<Vec3>> = (first..first + AT_ONCE)
            .into_par_iter()
            .map(|line| passes(solid, centre, radius, seed, line))
            .collect();
        points.extend(parts.into_iter().flatten());
        points.truncate(count);
        task.advance(points.len() - before)?;
        first += AT_ONCE;
    }
    Ok(points)
}

/// Where the line of number `line` passes through the surface.
fn passes(solid: &Shape, centre: Vec3, radius: f64, seed: u64, line: u64) -> Vec<Vec3> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(line);
    let mut uniform = || f64::from(rng.next_u32()) / f64::from(u32::MAX);
    let (z, turn) = (2.0 * uniform() - 1.0, std::f64::consts::TAU * uniform());
    let flat = (1.0 - z * z).max(0.0).sqrt();
    let way = [flat * turn.cos(), flat * turn.sin(), z];
    let (u, v) = super::foot::across(way);
    let (off, angle) = (radius * uniform().sqrt(), std::f64::consts::TAU * uniform());
    let across = add(scale(u, off * angle.cos()), scale(v, off * angle.sin()));
    let middle = add(centre, across);
    let at = |s: f64| add(middle, scale(way, s));
    let mut found = Vec::new();
    let mut s = -radius;
    let mut d = solid.distance(at(s));
    while s < radius {
        let next = s + d.abs().max(STEP);
        let beyond = solid.distance(at(next));
        if (d < 0.0) != (beyond < 0.0) {
            found.push(at(crossing(|s| solid.distance(at(s)) < 0.0, s, next)));
        }
        (s, d) = (next, beyond);
    }
    found
}

/// Where `inside` changes between `from` and `to`.
fn crossing(inside: impl Fn(f64) -> bool, mut from: f64, mut to: f64) -> f64 {
    let start = inside(from);
    while to - from > 1e-7 {
        let middle = f64::midpoint(from, to);
        if inside(middle) == start {
            from = middle;
        } else {
            to = middle;
        }
    }
    to
}
