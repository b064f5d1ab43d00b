//! Exact answers about points, segments and triangles whose coordinates are doubles.
//!
//! Everything rests on the signs of two determinants, which Shewchuk's adaptive arithmetic gives
//! without error as long as no product of three differences leaves the range of a double: always
//! for coordinates that are 32-bit floats, and for others from 1e-90 to 1e90 mm or 0.

#![expect(
    clippy::float_cmp,
    reason = "0 means exactly on the plane or line, and only equal corners are the same"
)]

mod meet;
mod passing;
mod place;
mod plane;
mod segment;

use robust::{Coord3D, orient3d};

pub(crate) use meet::meet;
pub(crate) use passing::{Passing, passing};
pub(crate) use place::place;
pub(crate) use plane::has_area;

/// A place in mm.
pub(crate) type Point = [f64; 3];

/// The corners of a triangle; except for [`has_area`], of one that has an area.
pub(crate) type Corners = [Point; 3];

/// Above 0 on one side of the plane through `a`, `b`, `c`, below 0 on the other, 0 on it.
#[inline]
fn side(a: &Point, b: &Point, c: &Point, point: &Point) -> f64 {
    // Triangles within one slice are many, and the exact arithmetic takes longest to find 0.
    let is_flat_along = |i: usize| a[i] == point[i] && b[i] == point[i] && c[i] == point[i];
    if is_flat_along(2) || is_flat_along(1) || is_flat_along(0) {
        return 0.0;
    }
    orient3d(coord(a), coord(b), coord(c), coord(point))
}

#[inline]
fn coord(&[x, y, z]: &Point) -> Coord3D<f64> {
    Coord3D { x, y, z }
}

/// The side of a triangle's plane on which each of two points lies.
#[inline]
fn two_sides([a, b, c]: &Corners, [p, q]: [&Point; 2]) -> [f64; 2] {
    [side(a, b, c, p), side(a, b, c, q)]
}

/// The side of a triangle's plane on which each corner of another lies.
#[inline]
fn three_sides([a, b, c]: &Corners, [p, q, r]: &Corners) -> [f64; 3] {
    [side(a, b, c, p), side(a, b, c, q), side(a, b, c, r)]
}

/// Whether all values are above 0 or all below.
#[inline]
fn is_one_sided(values: &[f64]) -> bool {
    values.iter().all(|v| *v > 0.0) || values.iter().all(|v| *v < 0.0)
}

/// Whether one value is above 0 and another below.
#[inline]
fn is_two_sided([u, v, w]: [f64; 3]) -> bool {
    (u > 0.0 || v > 0.0 || w > 0.0) && (u < 0.0 || v < 0.0 || w < 0.0)
}

/// The edges of a triangle.
#[inline]
fn edges([a, b, c]: &Corners) -> [[&Point; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}
