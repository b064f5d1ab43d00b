//! The triangulation of a polygon in space that bends least.

use bonemesh_task::{Cancelled, Task};

use crate::vector::{Vector, cross, dot, minus, unit};

/// A closed polygon in space.
pub(super) struct Polygon<'a> {
    pub(super) corners: &'a [Vector],
    /// Beyond the edge from each corner to the next: the direction (length 1) that the surface faces there.
    pub(super) beyond: &'a [Option<Vector>],
}

/// What may be used; corners are given by number.
pub(super) trait Allowed {
    /// Whether a chord may become an edge.
    fn chord(&self, from: usize, to: usize) -> bool;
    /// Whether three corners may become a triangle.
    fn triangle(&self, corners: [usize; 3]) -> bool;
}

/// The best triangulation of the part from one corner on to another.
#[derive(Clone, Copy)]
struct Part {
    /// Largest bend: 1 - the cosine of the angle by which neighbours differ.
    bend: f64,
    doubled_area: f64,
    /// The corner that makes a triangle with the part's ends.
    tip: usize,
    /// The direction of that triangle or, of a part that is one edge, of the surface beyond.
    facing: Option<Vector>,
}

const NOTHING: Part = Part {
    bend: f64::INFINITY,
    doubled_area: f64::INFINITY,
    tip: 0,
    facing: None,
};

/// The triangulation with the least largest bend, the rim's own included, and of those the one of
/// least area (Barequet and Sharir's dynamic programme with Liepa's measure); `None` if none is
/// allowed. Time grows with the cube of the number of corners.
pub(super) fn triangulate(
    polygon: &Polygon<'_>,
    allowed: &impl Allowed,
    task: &Task,
) -> Result<Option<Vec<[usize; 3]>>, Cancelled> {
    let count = polygon.corners.len();
    let mut parts = vec![NOTHING; count * count];
    for from in 0..count - 1 {
        parts[from * count + from + 1] = Part {
            bend: 0.0,
            doubled_area: 0.0,
            facing: polygon.beyond[from],
            ..NOTHING
        };
    }
    for length in 2..count {
        task.check()?;
        for from in 0..count - length {
            let to = from + length;
            let is_whole = length == count - 1;
            if is_whole || allowed.chord(from, to) {
                parts[from * count + to] = best(polygon, &parts, [from, to], allowed);
            }
        }
    }
    if parts[count - 1].bend.is_infinite() {
        return Ok(None);
    }
    let mut triangles = Vec::with_capacity(count - 2);
    let mut open = vec![[0, count - 1]];
    while let Some([from, to]) = open.pop() {
        if to > from + 1 {
            let tip = parts[from * count + to].tip;
            triangles.push([from, tip, to]);
            open.extend([[from, tip], [tip, to]]);
        }
    }
    Ok(Some(triangles))
}

/// The best part between two corners, from the best of the parts that it may be made of.
fn best(
    polygon: &Polygon<'_>,
    parts: &[Part],
    [from, to]: [usize; 2],
    allowed: &impl Allowed,
) -> Part {
    let count = polygon.corners.len();
    let is_whole = to - from == count - 1;
    let mut best = NOTHING;
    for tip in from + 1..to {
        let (left, right) = (&parts[from * count + tip], &parts[tip * count + to]);
        let bend = left.bend.max(right.bend);
        if bend > best.bend || bend.is_infinite() {
            continue;
        }
        let [a, b, c] = [from, tip, to].map(|corner| polygon.corners[corner]);
        let normal = cross(minus(b, a), minus(c, a));
        let Some(facing) = unit(normal) else { continue };
        let beyond = if is_whole { polygon.beyond[to] } else { None };
        let neighbours = [left.facing, right.facing, beyond].into_iter().flatten();
        let bend = neighbours.fold(bend, |bend, other| bend.max(1.0 - dot(facing, other)));
        let doubled_area = left.doubled_area + right.doubled_area + dot(normal, normal).sqrt();
        let is_better = bend < best.bend || bend <= best.bend && doubled_area < best.doubled_area;
        if is_better && allowed.triangle([from, tip, to]) {
            best = Part {
                bend,
                doubled_area,
                tip,
                facing: Some(facing),
            };
        }
    }
    best
}
