//! A ray along x and a triangle.

use robust::{Coord, orient2d};

use super::{Corners, Point, side};

/// How a ray passes a triangle's plane, if it meets the triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Passing {
    /// It does not meet the triangle.
    Not,
    /// From the back to the front, the side from which the corners turn counter-clockwise.
    Outward,
    /// From the front to the back.
    Inward,
}

/// How the ray from `from` along x passes a triangle.
///
/// The ray is taken to lie beside edges and corners it would meet, by a step along y too small for
/// any number and one along z smaller still, so that a closed surface is met consistently. A triangle
/// that holds `from` itself is not passed.
pub(crate) fn passing(corners: &Corners, from: &Point) -> Passing {
    let [a, b, c] = corners;
    let turns = [turn(a, b, from), turn(b, c, from), turn(c, a, from)];
    let is_left = turns.iter().all(|turn| *turn > 0);
    let is_right = turns.iter().all(|turn| *turn < 0);
    if !is_left && !is_right {
        return Passing::Not;
    }
    // With y to the right and z up, x comes towards whoever looks: a triangle that turns left has its
    // front where x is higher, and the ray that comes from lower x passes outward.
    let behind = side(a, b, c, from);
    let is_before = if is_left { behind > 0.0 } else { behind < 0.0 };
    match (is_before, is_left) {
        (false, _) => Passing::Not,
        (true, true) => Passing::Outward,
        (true, false) => Passing::Inward,
    }
}

/// Whether `a`, `b` and the point turn left (1) or right (-1) in the plane of y and z; 0 if `a` and
/// `b` are one there.
fn turn(a: &Point, b: &Point, point: &Point) -> i8 {
    let [p, q, r] = [a, b, point].map(|point| Coord {
        x: point[1],
        y: point[2],
    });
    let exact = orient2d(p, q, r);
    let sign = |value: f64| i8::from(value > 0.0) - i8::from(value < 0.0);
    // How the determinant changes with the point's step along y, then along z.
    [exact, p.y - q.y, q.x - p.x]
        .into_iter()
        .map(sign)
        .find(|sign| *sign != 0)
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: Corners = [[2.0, 0.0, 0.0], [2.0, 4.0, 0.0], [2.0, 0.0, 4.0]];

    #[test]
    fn a_ray_passes_what_lies_before_it_once_and_the_way_it_faces() {
        let [a, b, c] = WALL;
        assert_eq!(passing(&WALL, &[0.0, 1.0, 1.0]), Passing::Outward);
        assert_eq!(passing(&[a, c, b], &[0.0, 1.0, 1.0]), Passing::Inward);
        for beside in [
            [3.0, 1.0, 1.0],
            [2.0, 1.0, 1.0],
            [0.0, 3.0, 3.0],
            [0.0, -1.0, 1.0],
        ] {
            assert_eq!(passing(&WALL, &beside), Passing::Not, "{beside:?}");
        }
    }

    #[test]
    fn of_triangles_around_a_corner_or_edge_just_one_is_passed() {
        let centre = [2.0, 0.0, 0.0];
        let ring = [
            [2.0, 1.0, 0.0],
            [2.0, 0.0, 1.0],
            [2.0, -1.0, 0.0],
            [2.0, 0.0, -1.0],
        ];
        for from in [[0.0; 3], [0.0, 0.5, 0.0], [0.0, 0.0, -0.5]] {
            let passed = (0..4).filter(|&i| {
                passing(&[centre, ring[i], ring[(i + 1) % 4]], &from) == Passing::Outward
            });
            assert_eq!(passed.count(), 1, "{from:?}");
        }
    }
}
