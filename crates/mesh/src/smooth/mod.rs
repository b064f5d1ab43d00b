//! Smoothing that does not shrink.
//!
//! 1. `Neighbours::of`: who is joined to whom; vertices on rims, and those that are no part of a
//!    manifold, get none and stay.
//! 2. `filtered`: each vertex a step towards the middle of its neighbours and a slightly longer one
//!    away from it, again and again; then the whole way is shortened to the tolerance.
//! 3. `faulty`: vertices of triangles that meet or have lost their area, and vertices that have come
//!    to lie in one place. They go back to where they were, until there are none.

mod neighbours;

use std::sync::atomic::{AtomicBool, Ordering};

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::exact::has_area;
use crate::vector::{Vector, dot, minus, plus_scaled};
use crate::{MeshError, TriangleMesh, TriangleTree, find_intersections};
use neighbours::Neighbours;

/// Steps towards the neighbours and away from them: waves longer than some 18 edges stay as they
/// are, and no wave grows (Taubin's pass-band 1 / 0.5 - 1 / 0.53 = 0.11).
const STEPS: [f64; 2] = [0.5, -0.53];
/// Pairs of steps.
const ROUNDS: usize = 10;
/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 13;

/// What [`smooth`] gives.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Smoothed {
    /// The mesh, in coordinates that a file's 32-bit floats hold.
    pub mesh: TriangleMesh,
    /// The furthest that a vertex is from where it was (mm).
    pub largest_move_mm: f64,
    /// Vertices put back where they were, because the surface would have passed through itself.
    pub put_back: usize,
}

/// Smooths a surface without shrinking it, and moves no vertex further than `tolerance_mm`.
///
/// The mesh is taken as its file gives it back ([`TriangleMesh::as_written`]); its triangles stay,
/// vertices alone move. Those on rims and those that are no part of a manifold stay. Triangles of
/// the result meet, exactly, only where those of the given mesh do.
///
/// Taubin, *A signal processing approach to fair surface design*, SIGGRAPH 1995, with equal weights.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::Length`] for a tolerance that is no length, [`MeshError::NotFinite`] for a
/// coordinate too large for a 32-bit float, [`MeshError::Cancelled`].
pub fn smooth(mesh: &TriangleMesh, tolerance_mm: f64, task: &Task) -> Result<Smoothed, MeshError> {
    let tolerance_mm = MeshError::length("tolerance", tolerance_mm)?;
    let given = mesh.as_written(task)?;
    task.begin("smooth", given.vertices_mm().len() * 2 * ROUNDS);
    let neighbours = Neighbours::of(&given, task)?;
    let mut places = filtered(given.vertices_mm(), &neighbours, tolerance_mm, task)?;
    let mut is_back = vec![false; places.len()];
    loop {
        let result = TriangleMesh::new(places, given.triangles().to_vec())?;
        let faulty = faulty(&given, &result, task)?;
        let more: Vec<u32> = faulty
            .into_iter()
            .filter(|&v| !is_back[v as usize])
            .collect();
        if more.is_empty() {
            let moves = given.vertices_mm().iter().zip(result.vertices_mm());
            let squared = moves.map(|(from, to)| dot(minus(*to, *from), minus(*to, *from)));
            return Ok(Smoothed {
                largest_move_mm: squared.fold(0.0, f64::max).sqrt(),
                put_back: is_back.iter().filter(|is| **is).count(),
                mesh: result,
            });
        }
        places = result.into_parts().0;
        for vertex in more {
            is_back[vertex as usize] = true;
            places[vertex as usize] = given.vertices_mm()[vertex as usize];
        }
    }
}

/// Where the vertices are after all steps, as 32-bit numbers.
fn filtered(
    given: &[Vector],
    neighbours: &Neighbours,
    tolerance_mm: f64,
    task: &Task,
) -> Result<Vec<Vector>, Cancelled> {
    let mut places = given.to_vec();
    let mut next = places.clone();
    for step in STEPS.iter().cycle().take(2 * ROUNDS) {
        let chunks = next.par_chunks_mut(STRIDE).enumerate();
        chunks.try_for_each(|(chunk, next)| {
            for (vertex, next) in (chunk * STRIDE..).zip(&mut *next) {
                let place = places[vertex];
                let moved = match neighbours.middle(vertex, &places) {
                    Some(middle) => plus_scaled(place, *step, minus(middle, place)),
                    None => place,
                };
                *next = moved;
            }
            task.advance(next.len())
        })?;
        std::mem::swap(&mut places, &mut next);
    }
    places.par_iter_mut().zip(given).for_each(|(place, from)| {
        let limited = within(tolerance_mm, *from, *place);
        *place = rounded_within(tolerance_mm, *from, limited);
    });
    Ok(places)
}

/// A place on the way from `from` to `place`, nearer than `most`: a short way is hardly shortened, and
/// neighbours that move alike stay beside one another, which a sharp limit would not grant.
fn within(most: f64, from: Vector, place: Vector) -> Vector {
    let away = minus(place, from);
    let part = most / (most * most + dot(away, away)).sqrt();
    // No tolerance and no move give no number.
    if part > 0.0 {
        plus_scaled(from, part, away)
    } else {
        from
    }
}

/// The same in 32-bit numbers; `from` is one. Rounding takes no place out of the tolerance.
fn rounded_within(most: f64, from: Vector, place: Vector) -> Vector {
    for part in [1.0, 0.999, 0.9] {
        let scaled = plus_scaled(from, part, minus(place, from));
        let rounded = scaled.map(|value| f64::from(value as f32));
        let away = minus(rounded, from);
        if dot(away, away).sqrt() <= most {
            return rounded;
        }
    }
    from
}

/// Vertices where `result` has a fault; those that `given` has too may be among them.
fn faulty(given: &TriangleMesh, result: &TriangleMesh, task: &Task) -> Result<Vec<u32>, MeshError> {
    let tree = TriangleTree::new(result, task)?;
    let found = find_intersections(&tree, usize::MAX, task)?;
    let is_faulty: Vec<AtomicBool> = std::iter::repeat_with(AtomicBool::default)
        .take(result.vertices_mm().len())
        .collect();
    let note = |triangle: &[u32; 3]| {
        for vertex in triangle {
            is_faulty[*vertex as usize].store(true, Ordering::Relaxed);
        }
    };
    for number in found.pairs.iter().flat_map(|pair| pair.triangles) {
        note(&result.triangles()[number as usize]);
    }
    result.triangles().par_iter().for_each(|triangle| {
        if !has_area(&result.corners_mm(*triangle)) && has_area(&given.corners_mm(*triangle)) {
            note(triangle);
        }
    });
    let (merged, numbers) = result.merged_with_numbers(task)?;
    if merged.vertices_mm().len() < numbers.len() {
        let mut times = vec![0_u32; merged.vertices_mm().len()];
        for number in &numbers {
            times[*number as usize] += 1;
        }
        let shared = numbers.iter().map(|number| times[*number as usize] > 1);
        for (is_faulty, is_shared) in is_faulty.iter().zip(shared) {
            is_faulty.fetch_or(is_shared, Ordering::Relaxed);
        }
    }
    let numbered = (0..)
        .zip(is_faulty)
        .filter(|(_, is)| is.load(Ordering::Relaxed));
    Ok(numbered.map(|(vertex, _)| vertex).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_never_leaves_the_tolerance() {
        let from = [100.1_f32, -250.7, 33.3].map(f64::from);
        for most in [0.0, 1e-6, 1e-4, 0.1] {
            for away in [[0.1, 0.2, -0.1], [1e-5, 0.0, 0.0], [-7.0, 3.0, 2.0]] {
                let place = within(most, from, plus_scaled(from, 1.0, away));
                let rounded = rounded_within(most, from, place);
                let moved = minus(rounded, from);
                assert!(dot(moved, moved).sqrt() <= most, "{most} {away:?}");
            }
        }
    }
}
