//! Long rims cut to pieces that the dynamic programme can take.

use bonemesh_task::{Cancelled, Task};

use crate::vector::{Vector, cross, dot, minus, plus_scaled, unit};

/// About as many corners of a long rim are tried as ends of chords.
const TRIED: usize = 512;
/// Least part of the corners on either side of a chord, as one of so many.
const LEAST_PART: usize = 16;
/// A rim says which way it faces if its area is at least this part of a circle's as long.
const LEAST_AREA: f64 = 0.05;

/// Cuts a polygon, given by numbers of `places`, until no piece has more than `most` corners; `None` if
/// there is no chord to cut along.
///
/// Each cut is along the chord that is shortest beside the shorter way around, into the hole at both ends,
/// and allowed.
pub(super) fn divide(
    places: &[Vector],
    most: usize,
    is_allowed: impl Fn(usize, usize) -> bool,
    task: &Task,
) -> Result<Option<Vec<Vec<usize>>>, Cancelled> {
    let mut pieces = Vec::new();
    let mut long = vec![(0..places.len()).collect::<Vec<usize>>()];
    while let Some(piece) = long.pop() {
        task.check()?;
        if piece.len() <= most {
            pieces.push(piece);
            continue;
        }
        let corners: Vec<Vector> = piece.iter().map(|&number| places[number]).collect();
        let chord = chord(&corners, |i, j| is_allowed(piece[i], piece[j]));
        let Some([i, j]) = chord else {
            return Ok(None);
        };
        long.push(piece[i..=j].to_vec());
        long.push([&piece[j..], &piece[..=i]].concat());
    }
    Ok(Some(pieces))
}

/// The best chord of a polygon.
fn chord(corners: &[Vector], is_allowed: impl Fn(usize, usize) -> bool) -> Option<[usize; 2]> {
    let count = corners.len();
    let mut ways = Vec::with_capacity(count + 1);
    let mut way = 0.0;
    for (number, &corner) in corners.iter().enumerate() {
        ways.push(way);
        way += length(minus(corners[(number + 1) % count], corner));
    }
    let facing = facing(corners, way);
    let step = count.div_ceil(TRIED);
    let least = (count / LEAST_PART).max(2);
    let mut best = (f64::INFINITY, None);
    for i in (0..count).step_by(step) {
        for j in (i + least..count).step_by(step) {
            if count - (j - i) < least {
                break;
            }
            let around = (ways[j] - ways[i]).min(way - (ways[j] - ways[i]));
            let part = length(minus(corners[j], corners[i])) / around;
            let is_inward = |i, j| facing.is_none_or(|facing| leads_in(corners, i, j, facing));
            if part < best.0 && is_inward(i, j) && is_inward(j, i) && is_allowed(i, j) {
                best = (part, Some([i, j]));
            }
        }
    }
    best.1
}

/// The way a rim faces; `None` if it winds so much that it faces no way.
fn facing(corners: &[Vector], way: f64) -> Option<Vector> {
    let first = corners[0];
    let pairs = corners.windows(2);
    let doubled = pairs.fold([0.0; 3], |sum: Vector, pair| {
        plus_scaled(
            sum,
            1.0,
            cross(minus(pair[0], first), minus(pair[1], first)),
        )
    });
    let of_circle = way * way / (4.0 * std::f64::consts::PI);
    if length(doubled) / 2.0 < LEAST_AREA * of_circle {
        return None;
    }
    unit(doubled)
}

/// Whether the way from corner `i` to corner `j` begins between the edges at `i`, inside the rim.
fn leads_in(corners: &[Vector], i: usize, j: usize, facing: Vector) -> bool {
    let count = corners.len();
    let [next, previous, other] =
        [(i + 1) % count, (i + count - 1) % count, j].map(|to| minus(corners[to], corners[i]));
    // The angle to the left from the next corner.
    let angle = |to: Vector| {
        let flat = |v: Vector| plus_scaled(v, -dot(v, facing), facing);
        let (from, to) = (flat(next), flat(to));
        let angle = dot(cross(from, to), facing).atan2(dot(from, to));
        angle.rem_euclid(std::f64::consts::TAU)
    };
    let angle_other = angle(other);
    angle_other > 0.0 && angle_other < angle(previous)
}

fn length(v: Vector) -> f64 {
    dot(v, v).sqrt()
}
