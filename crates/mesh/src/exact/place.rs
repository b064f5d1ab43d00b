//! Where two triangles meet.

use super::plane::Shadow;
use super::segment::hits;
use super::{Corners, Point, edges, two_sides};

/// A place (mm, rounded) that two triangles share: the mean of the points where an edge of one
/// meets the other. The triangles must share a point.
pub(crate) fn place(a: &Corners, b: &Corners) -> Point {
    let mut points = Vec::new();
    collect(a, b, &mut points);
    collect(b, a, &mut points);
    let count = points.len().max(1) as f64;
    let sum = points.iter().fold([0.0; 3], |sum: Point, point| {
        [0, 1, 2].map(|axis| sum[axis] + point[axis] / count)
    });
    // Rounding must not put the place outside the two triangles' boxes.
    [0, 1, 2].map(|axis| {
        let extent = |corners: &Corners| {
            let [a, b, c] = corners.map(|corner| corner[axis]);
            (a.min(b).min(c), a.max(b).max(c))
        };
        let ((low_a, high_a), (low_b, high_b)) = (extent(a), extent(b));
        sum[axis].max(low_a.max(low_b)).min(high_a.min(high_b))
    })
}

/// Adds the points where edges of `from` meet `to`: their crossing of its plane, or their ends in
/// it and their crossings of its edges.
fn collect(from: &Corners, to: &Corners, points: &mut Vec<Point>) {
    for [p, q] in edges(from) {
        let ends = two_sides(to, [p, q]);
        if ends == [0.0; 2] {
            let Some(shadow) = Shadow::of(to) else { return };
            points.extend([p, q].into_iter().filter(|end| shadow.holds(to, end)));
            for edge in edges(to) {
                let turns = [p, q].map(|end| shadow.turn(edge[0], edge[1], end));
                if turns[0] != turns[1] && shadow.cross([p, q], edge) {
                    points.push(between(p, q, turns));
                }
            }
        } else if hits([p, q], ends, to) {
            points.push(between(p, q, ends));
        }
    }
}

/// The point of a segment where a linear function, of which the `values` at its ends are given, is 0.
fn between(p: &Point, q: &Point, values: [f64; 2]) -> Point {
    let share = values[0] / (values[0] - values[1]);
    [0, 1, 2].map(|axis| p[axis] + share * (q[axis] - p[axis]))
}
