//! From a point to one triangle.

use crate::vector::{Vector, cross, dot, minus, plus_scaled};

/// The squared distance (mm2) of a point to the nearest point of a triangle.
///
/// Inside the triangle's prism it is that to the plane, else that to the nearest edge; both are exact
/// up to rounding, and a triangle without area has edges alone.
pub(crate) fn squared_distance(point: Vector, [a, b, c]: [Vector; 3]) -> f64 {
    let normal = cross(minus(b, a), minus(c, a));
    let is_within =
        |from: Vector, to: Vector| dot(cross(minus(to, from), minus(point, from)), normal) >= 0.0;
    let squared_length = dot(normal, normal);
    if squared_length > 0.0 && is_within(a, b) && is_within(b, c) && is_within(c, a) {
        let height = dot(minus(point, a), normal);
        return height * height / squared_length;
    }
    let to_edge = |from, to| squared_distance_to_segment(point, from, to);
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

/// Whether [`squared_distance`] is at most `limit` (mm2); most of those that are far are told quickly.
pub(crate) fn is_within(point: Vector, [a, b, c]: [Vector; 3], limit: f64) -> bool {
    let normal = cross(minus(b, a), minus(c, a));
    let squared_length = dot(normal, normal);
    let height = dot(minus(point, a), normal);
    if height * height > limit * squared_length {
        return false;
    }
    let is_beside =
        |from: Vector, to: Vector| dot(cross(minus(to, from), minus(point, from)), normal) < 0.0;
    let is_flat = squared_length <= 0.0;
    let mut is_over = !is_flat;
    for (from, to) in [(a, b), (b, c), (c, a)] {
        // What is beside the triangle is nearest to an edge beside which it is.
        if is_flat || is_beside(from, to) {
            is_over = false;
            if squared_distance_to_segment(point, from, to) <= limit {
                return true;
            }
        }
    }
    is_over
}

fn squared_distance_to_segment(point: Vector, from: Vector, to: Vector) -> f64 {
    let (along, there) = (minus(to, from), minus(point, from));
    let squared_length = dot(along, along);
    let part = if squared_length > 0.0 {
        (dot(there, along) / squared_length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let away = minus(point, plus_scaled(from, part, along));
    dot(away, away)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOR: [Vector; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    #[test]
    fn within_says_the_same_as_the_distance() {
        let needle = [[0.0; 3], [4.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        let slanted = [[0.3, -1.0, 0.2], [2.5, 0.4, 1.0], [-0.5, 1.7, -0.6]];
        for i in 0..1000 {
            let point = [0, 1, 2].map(|axis| f64::from(i / 10_i32.pow(axis) % 10) * 0.7 - 2.0);
            for corners in [FLOOR, needle, slanted, [[1.0; 3]; 3]] {
                let squared = squared_distance(point, corners);
                assert!(
                    is_within(point, corners, squared * 1.0001 + 1e-12),
                    "{point:?}"
                );
                assert!(
                    !is_within(point, corners, squared * 0.9999 - 1e-12),
                    "{point:?}"
                );
            }
        }
    }

    #[test]
    fn face_edges_and_corners_are_each_nearest_once() {
        let cases = [
            ([1.0, 1.0, 3.0], 9.0),
            ([1.0, 1.0, 0.0], 0.0),
            ([2.0, -2.0, 0.0], 4.0),
            ([3.0, 3.0, 1.0], 3.0),
            ([-3.0, -4.0, 0.0], 25.0),
            ([7.0, -4.0, 0.0], 25.0),
        ];
        for (point, wanted) in cases {
            for turn in 0..3 {
                let corners = [0, 1, 2].map(|corner| FLOOR[(corner + turn) % 3]);
                let found = squared_distance(point, corners);
                assert!((found - wanted).abs() < 1e-12, "{point:?}: {found}");
            }
        }
        let needle = [[0.0; 3], [4.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        assert!((squared_distance([2.0, 3.0, 0.0], needle) - 9.0).abs() < 1e-12);
        assert!((squared_distance([2.0, 3.0, 0.0], [[2.0, 0.0, 0.0]; 3]) - 9.0).abs() < 1e-12);
    }
}
