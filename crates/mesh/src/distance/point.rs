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
