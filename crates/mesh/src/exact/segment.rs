//! A segment and a triangle.

use super::plane::Shadow;
use super::{Corners, Point, edges, is_one_sided, is_two_sided, side};

/// Whether a segment, whose ends lie on these `sides` of the triangle's plane, meets the triangle;
/// ends and borders belong to both.
pub(super) fn hits([p, q]: [&Point; 2], sides: [f64; 2], triangle: &Corners) -> bool {
    if is_one_sided(&sides) {
        return false;
    }
    if sides == [0.0; 2] {
        return lies_across([p, q], triangle);
    }
    // The line goes through the plane in one point, which is in the triangle if the line passes
    // no two edges on different sides.
    let [a, b, c] = triangle;
    !is_two_sided([side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)])
}

/// [`hits`] for a segment in the triangle's plane: one end is inside or an edge is crossed.
fn lies_across(segment: [&Point; 2], triangle: &Corners) -> bool {
    Shadow::of(triangle).is_some_and(|shadow| {
        shadow.holds(triangle, segment[0])
            || edges(triangle)
                .into_iter()
                .any(|edge| shadow.cross(segment, edge))
    })
}
