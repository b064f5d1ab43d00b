//! Two triangles.

use super::plane::Shadow;
use super::segment::hits;
use super::{Corners, Point, is_one_sided, side, three_sides, two_sides};

/// Whether two triangles share more than a corner or an edge that both have.
///
/// Corners are the same if their coordinates are equal. With `k` common corners:
/// - 3: yes, they cover one another;
/// - 2: only if they lie in one plane, on the same side of the common edge;
/// - 1: a ray from the common corner into both leaves one of them first, across the edge opposite
///   the corner; so they share more exactly if one of these two edges meets the other triangle;
/// - 0: what they share ends at an edge of one of them, so an edge of one meets the other.
pub(crate) fn meet(a: &Corners, b: &Corners) -> bool {
    let common = |corner: &Point| b.iter().position(|other| other == corner);
    match [common(&a[0]), common(&a[1]), common(&a[2])] {
        [Some(_), Some(_), Some(_)] => true,
        [Some(i), Some(j), None] => folded(a, 2, b, 3 - i - j),
        [Some(i), None, Some(j)] => folded(a, 1, b, 3 - i - j),
        [None, Some(i), Some(j)] => folded(a, 0, b, 3 - i - j),
        [Some(i), None, None] => beyond_corner(&turned(a, 0), &turned(b, i)),
        [None, Some(i), None] => beyond_corner(&turned(a, 1), &turned(b, i)),
        [None, None, Some(i)] => beyond_corner(&turned(a, 2), &turned(b, i)),
        [None, None, None] => apart_meet(a, b),
    }
}

/// The triangle with the corner `first` as its first.
fn turned(corners: &Corners, first: usize) -> Corners {
    let [a, b, c] = *corners;
    match first {
        0 => [a, b, c],
        1 => [b, c, a],
        _ => [c, a, b],
    }
}

/// Whether triangles with a common edge, opposite the corners `i` of `a` and `j` of `b`, overlap.
fn folded(a: &Corners, i: usize, b: &Corners, j: usize) -> bool {
    let [tip, p, q] = turned(a, i);
    let other = &b[j];
    if side(&p, &q, &tip, other) != 0.0 {
        return false;
    }
    Shadow::of(a).is_some_and(|shadow| {
        is_one_sided(&[shadow.turn(&p, &q, &tip), shadow.turn(&p, &q, other)])
    })
}

/// Whether triangles whose first corner is the same share more than it.
fn beyond_corner(a: &Corners, b: &Corners) -> bool {
    let of_b = two_sides(a, [&b[1], &b[2]]);
    if is_one_sided(&of_b) {
        return false;
    }
    let of_a = two_sides(b, [&a[1], &a[2]]);
    if is_one_sided(&of_a) {
        return false;
    }
    hits([&b[1], &b[2]], of_b, a) || hits([&a[1], &a[2]], of_a, b)
}

/// Whether triangles without a common corner share a point.
fn apart_meet(a: &Corners, b: &Corners) -> bool {
    let of_b = three_sides(a, b);
    if is_one_sided(&of_b) {
        return false;
    }
    let of_a = three_sides(b, a);
    if is_one_sided(&of_a) {
        return false;
    }
    any_edge_hits(b, of_b, a) || any_edge_hits(a, of_a, b)
}

/// Whether an edge of `from`, whose corners lie on these `sides` of `to`'s plane, meets `to`.
fn any_edge_hits(from: &Corners, [i, j, k]: [f64; 3], to: &Corners) -> bool {
    let [p, q, r] = from;
    hits([p, q], [i, j], to) || hits([q, r], [j, k], to) || hits([r, p], [k, i], to)
}
