//! The plane in which a bone is most like its mirror image.
//!
//! Trimmed iterative closest points (Chetverikov et al. 2002), for a plane instead of a motion: samples of
//! the surface are mirrored, each is matched with the nearest place that faces the same way, the worst
//! matches are left out, and the plane moves so that the rest come nearer, measured across the surface (Chen
//! and Medioni 1992). Started from directions all around, since a bone has more than one plane in which it
//! is nearly like its image; the best of what they come to wins.

use bonemesh_mesh::{Plane, TriangleMesh, TriangleTree};
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::RoiError;
use bonemesh_mesh::vector::{Vector, cross, dot, length, minus, plus_scaled, unit_or_zero};

/// Samples for trying directions, for following the best of them, and for the result.
const SAMPLES: [usize; 3] = [400, 2_000, 20_000];
/// Directions that are tried, and how many of the best are followed.
const DIRECTIONS: usize = 96;
const FOLLOWED: usize = 8;
/// Rounds of matching and moving for these three.
const ROUNDS: [usize; 3] = [3, 15, 40];
/// The share of the samples that is kept: the rest may be asymmetric.
const KEPT: f64 = 0.7;
/// Farther matches (mm) are none.
const REACH_MM: f64 = 25.0;
/// Cosine of the most that two matched places face apart.
const ALIKE: f64 = 0.5;
/// The distance, in parts of the body's size, that counts for all that are farther when planes are ranked.
/// What is trimmed must count there: but for its ears and its nose a head is symmetric in three planes.
const FAR: f64 = 0.15;
/// Moves (radians, and parts of the body's size) that are none.
const STILL: f64 = 1e-7;

/// A plane of symmetry, and how good it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symmetry {
    /// The plane. Its normal points where the largest of its components is positive.
    pub plane: Plane,
    /// Root mean square of the distances (mm) from the mirrored surface to the surface, of the best 70 %.
    pub error_mm: f64,
    /// Mean of all distances (mm), of which none counts as larger than 15 % of the body's mean radius: what
    /// is not symmetric shows here.
    pub mean_mm: f64,
}

/// Finds the plane in which a mesh is most like its mirror image, whatever up to 30 % of it do.
///
/// The mesh should be oriented. The result is the same for any number of threads. Limits: what has no
/// symmetry gets the best plane there is, with an error that says so; what is symmetric in many planes, as a
/// tube is, gets one of them.
///
/// # Errors
/// [`RoiError::NoSymmetry`] for a mesh without area, or the work was cancelled.
pub fn symmetry_plane(mesh: &TriangleMesh, task: &Task) -> Result<Symmetry, RoiError> {
    let [coarse, medium, fine] = SAMPLES;
    let samples = samples(mesh, fine).ok_or(RoiError::NoSymmetry)?;
    let tree = TriangleTree::new(mesh, task)?;
    let middle = mean(&samples);
    let size_mm = samples
        .iter()
        .map(|s| length(minus(s.place, middle)))
        .sum::<f64>()
        / fine as f64;
    let every = |count: usize| -> Vec<Sample> {
        let stride = samples.len().div_ceil(count);
        samples.iter().step_by(stride).copied().collect()
    };
    let body = |samples: Vec<Sample>| Body {
        tree: &tree,
        samples,
        middle,
        size_mm,
    };
    task.begin("symmetry plane", DIRECTIONS + FOLLOWED + ROUNDS[2]);
    let few = body(every(coarse));
    let starts = directions().map(Guess::across);
    let mut tried = follow_all(&few, starts.collect(), ROUNDS[0], task)?;
    tried.truncate(FOLLOWED);
    let some = body(every(medium));
    let followed = follow_all(&some, tried, ROUNDS[1], task)?;
    let best = *followed.first().ok_or(RoiError::NoSymmetry)?;
    body(samples).result(best, task)
}

/// A place on the surface and which way it faces.
#[derive(Clone, Copy)]
struct Sample {
    place: Vector,
    normal: Vector,
}

/// A plane on its way: normal · (p - middle) = offset.
#[derive(Clone, Copy)]
struct Guess {
    normal: Vector,
    offset_mm: f64,
    /// Mean square of all distances (mm2), of which none counts as larger than a part of the body.
    error_mm2: f64,
}

impl Guess {
    /// Through the middle, not looked at yet.
    fn across(normal: Vector) -> Self {
        Self {
            normal,
            offset_mm: 0.0,
            error_mm2: f64::INFINITY,
        }
    }
}

/// A mirrored sample and the nearest place of the surface.
struct Match {
    /// The sample before it was mirrored, from the middle.
    from: Vector,
    /// From the surface's place to the mirrored sample.
    away: Vector,
    /// Which way the surface faces there.
    normal: Vector,
}

struct Body<'a> {
    tree: &'a TriangleTree<'a>,
    samples: Vec<Sample>,
    middle: Vector,
    size_mm: f64,
}

impl Body<'_> {
    /// The matches, nearest first.
    fn matches(&self, guess: &Guess) -> Vec<Match> {
        let found = self
            .samples
            .iter()
            .map(|sample| self.matched(sample, guess));
        let mut found: Vec<Match> = found.flatten().collect();
        let squared = |m: &Match| dot(m.away, m.away);
        found.sort_by(|a, b| squared(a).total_cmp(&squared(b)));
        found
    }

    fn matched(&self, sample: &Sample, guess: &Guess) -> Option<Match> {
        let from = minus(sample.place, self.middle);
        let above = dot(guess.normal, from) - guess.offset_mm;
        let image = plus_scaled(sample.place, -2.0 * above, guess.normal);
        let nearest = self.tree.nearest(image, REACH_MM)?;
        let normal = self.facing(nearest.triangle);
        let turned = dot(guess.normal, sample.normal);
        let facing = plus_scaled(sample.normal, -2.0 * turned, guess.normal);
        (dot(facing, normal) > ALIKE).then(|| Match {
            from,
            away: minus(image, nearest.place_mm),
            normal,
        })
    }

    fn facing(&self, triangle: u32) -> Vector {
        let mesh = self.tree.mesh();
        let [a, b, c] = mesh.corners_mm(mesh.triangles()[triangle as usize]);
        unit_or_zero(cross(minus(b, a), minus(c, a)))
    }

    /// The best of the matches.
    fn kept<'m>(&self, matches: &'m [Match]) -> &'m [Match] {
        let kept = (KEPT * self.samples.len() as f64) as usize;
        &matches[..kept.min(matches.len())]
    }

    /// By which planes are ranked; what has no match counts as far.
    fn error_mm2(&self, matches: &[Match]) -> f64 {
        let far_mm2 = (FAR * self.size_mm).powi(2);
        let missing = (self.samples.len() - matches.len()) as f64;
        let sum: f64 = matches
            .iter()
            .map(|m| dot(m.away, m.away).min(far_mm2))
            .sum();
        (sum + missing * far_mm2) / self.samples.len() as f64
    }

    /// Moves the plane until it stands still, at most so often.
    fn follow(&self, mut guess: Guess, rounds: usize, task: &Task) -> Result<Guess, Cancelled> {
        for _ in 0..rounds {
            task.check()?;
            let matches = self.matches(&guess);
            guess.error_mm2 = self.error_mm2(&matches);
            let Some(turn) = self.step(&guess, self.kept(&matches)) else {
                return Ok(guess);
            };
            let [a, b, shift] = turn;
            let [first, second] = across(guess.normal);
            let tilted = plus_scaled(plus_scaled(guess.normal, a, first), b, second);
            guess.normal = unit_or_zero(tilted);
            guess.offset_mm += shift;
            if a.abs().max(b.abs()).max(shift.abs() / self.size_mm) < STILL {
                break;
            }
        }
        guess.error_mm2 = self.error_mm2(&self.matches(&guess));
        Ok(guess)
    }

    /// By how much the plane tilts (radians) and shifts (mm): least squares of the distances across the
    /// surface, linear in these.
    fn step(&self, guess: &Guess, matches: &[Match]) -> Option<[f64; 3]> {
        let [first, second] = across(guess.normal);
        let mut gram = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        for Match { from, away, normal } in matches {
            let above = dot(guess.normal, *from) - guess.offset_mm;
            let leaning = dot(*normal, guess.normal);
            let tilt =
                |axis: Vector| -2.0 * (above * dot(*normal, axis) + dot(axis, *from) * leaning);
            // In parts of the body's size, so that tilts and shifts weigh alike.
            let slopes = [tilt(first), tilt(second), 2.0 * leaning * self.size_mm];
            let residual = dot(*normal, *away);
            for row in 0..3 {
                right[row] -= slopes[row] * residual;
                for column in 0..3 {
                    gram[row][column] += slopes[row] * slopes[column];
                }
            }
        }
        let trace = gram[0][0] + gram[1][1] + gram[2][2];
        for (axis, row) in gram.iter_mut().enumerate() {
            // What is symmetric in many planes must not run away along them.
            row[axis] += 1e-6 * trace;
        }
        let [a, b, shift] = solved(gram, right)?;
        Some([a, b, shift * self.size_mm])
    }

    fn result(&self, guess: Guess, task: &Task) -> Result<Symmetry, RoiError> {
        let guess = self.follow(guess, ROUNDS[2], task)?;
        let matches = self.matches(&guess);
        let kept = self.kept(&matches);
        if kept.is_empty() {
            return Err(RoiError::NoSymmetry);
        }
        let far_mm = FAR * self.size_mm;
        let near: f64 = matches.iter().map(|m| length(m.away).min(far_mm)).sum();
        let missing = (self.samples.len() - matches.len()) as f64;
        let squares: f64 = kept.iter().map(|m| dot(m.away, m.away)).sum();
        let normal = guess.normal;
        let largest = (0..3).max_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()));
        let sign = largest.map_or(1.0, |axis| normal[axis].signum());
        let offset = guess.offset_mm + dot(normal, self.middle);
        Ok(Symmetry {
            plane: Plane::new(normal.map(|n| sign * n), sign * offset)?,
            error_mm: (squares / kept.len() as f64).sqrt(),
            mean_mm: (near + missing * far_mm) / self.samples.len() as f64,
        })
    }
}

/// Follows all guesses; best first.
fn follow_all(
    body: &Body<'_>,
    guesses: Vec<Guess>,
    rounds: usize,
    task: &Task,
) -> Result<Vec<Guess>, Cancelled> {
    let followed = guesses.into_par_iter().map(|guess| {
        let followed = body.follow(guess, rounds, task)?;
        task.advance(1)?;
        Ok(followed)
    });
    let mut followed = followed.collect::<Result<Vec<Guess>, Cancelled>>()?;
    followed.sort_by(|a, b| a.error_mm2.total_cmp(&b.error_mm2));
    Ok(followed)
}

/// So many places on the surface, evenly by area: the same for the same mesh.
fn samples(mesh: &TriangleMesh, count: usize) -> Option<Vec<Sample>> {
    /// Parts by which places in a triangle step from sample to sample: never the same twice.
    const STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
    let double = |t: &[u32; 3]| {
        let [a, b, c] = mesh.corners_mm(*t);
        cross(minus(b, a), minus(c, a))
    };
    let areas = mesh.triangles().iter().map(|t| length(double(t)));
    let total: f64 = areas.clone().sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let mut samples = Vec::with_capacity(count);
    let mut passed = 0.0;
    for (triangle, area) in mesh.triangles().iter().zip(areas) {
        passed += area;
        while samples.len() < count
            && (samples.len() as f64 + 0.5) * total / (count as f64) < passed
        {
            let number = samples.len() as f64;
            let [mut u, mut v] = STEPS.map(|step| (number * step).fract());
            if u + v > 1.0 {
                [u, v] = [1.0 - u, 1.0 - v];
            }
            let [a, b, c] = mesh.corners_mm(*triangle);
            let place = plus_scaled(plus_scaled(a, u, minus(b, a)), v, minus(c, a));
            let normal = unit_or_zero(double(triangle));
            samples.push(Sample { place, normal });
        }
    }
    Some(samples)
}

fn mean(samples: &[Sample]) -> Vector {
    let sum = samples
        .iter()
        .fold([0.0; 3], |sum, s| plus_scaled(sum, 1.0, s.place));
    sum.map(|v| v / samples.len().max(1) as f64)
}

/// Directions evenly over a half of the sphere, each with its opposite left out (a spiral of the golden
/// ratio).
fn directions() -> impl Iterator<Item = Vector> {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    (0..DIRECTIONS).map(|number| {
        let up = (number as f64 + 0.5) / DIRECTIONS as f64;
        let turn = std::f64::consts::TAU * (number as f64 * GOLDEN).fract();
        let around = (1.0 - up * up).sqrt();
        // The spiral's sparse end, its rim, is where few bones have their plane.
        [up, around * turn.cos(), around * turn.sin()]
    })
}

/// Two directions at right angles to a third and to one another.
fn across(normal: Vector) -> [Vector; 2] {
    let least = (0..3).min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()));
    let mut beside = [0.0; 3];
    beside[least.unwrap_or(0)] = 1.0;
    let first = unit_or_zero(cross(beside, normal));
    [first, cross(normal, first)]
}

/// x with gram · x = right (Cramer); `None` if there is not one.
fn solved(gram: [Vector; 3], right: Vector) -> Option<Vector> {
    let determinant = |[a, b, c]: [Vector; 3]| dot(a, cross(b, c));
    let whole = determinant(gram);
    let solution = [0, 1, 2].map(|axis| {
        let mut changed = gram;
        for row in 0..3 {
            changed[row][axis] = right[row];
        }
        determinant(changed) / whole
    });
    solution.iter().all(|v| v.is_finite()).then_some(solution)
}
