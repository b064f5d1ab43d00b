//! Squared distances to planes, added up (Garland and Heckbert).

use crate::vector::{Vector, cross, dot, minus, plus_scaled};

/// Part of a quadric's weight with which its vertex is held near where it is: what decides on flat
/// and cylindrical parts, where the planes alone leave the place open.
const TETHER: f64 = 1e-6;

/// The sum of `area * (distance to the plane)^2` over some triangles.
///
/// Written out, the sum at `x` is `x A x + 2 b x + c`, with `A` symmetric.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quadric {
    /// xx, xy, xz, yy, yz, zz
    a: [f64; 6],
    b: Vector,
    c: f64,
    /// Sum of the areas.
    pub(super) weight: f64,
}

impl Quadric {
    /// The plane of a triangle, weighted with a third of its area; nothing if it has no area.
    pub(super) fn of([p, q, r]: [Vector; 3]) -> Self {
        let normal = cross(minus(q, p), minus(r, p));
        let doubled = dot(normal, normal).sqrt();
        if doubled <= f64::MIN_POSITIVE {
            return Self::default();
        }
        let weight = doubled / 6.0;
        let [x, y, z] = normal.map(|component| component / doubled);
        let d = -dot([x, y, z], p);
        Self {
            a: [x * x, x * y, x * z, y * y, y * z, z * z].map(|v| v * weight),
            b: [x, y, z].map(|v| v * d * weight),
            c: d * d * weight,
            weight,
        }
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            a: std::array::from_fn(|i| self.a[i] + other.a[i]),
            b: std::array::from_fn(|i| self.b[i] + other.b[i]),
            c: self.c + other.c,
            weight: self.weight + other.weight,
        }
    }

    /// The sum at a place; rounding does not make it negative.
    pub(super) fn at(&self, place: Vector) -> f64 {
        let slope = self.slope(place);
        (dot(slope, place) + dot(self.b, place) + self.c).max(0.0)
    }

    /// `A x + b`
    fn slope(&self, [x, y, z]: Vector) -> Vector {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        [
            xx * x + xy * y + xz * z + self.b[0],
            xy * x + yy * y + yz * z + self.b[1],
            xz * x + yz * y + zz * z + self.b[2],
        ]
    }

    /// Where the sum is least, held near `start` where the planes do not say.
    ///
    /// Cramer's rule on `(A + t) step = -slope(start)`, which has a solution for every t > 0.
    pub(super) fn least_near(&self, start: Vector) -> Vector {
        let tether = TETHER * self.weight + f64::MIN_POSITIVE;
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let columns = [
            [xx + tether, xy, xz],
            [xy, yy + tether, yz],
            [xz, yz, zz + tether],
        ];
        let aim = self.slope(start).map(|v| -v);
        let determinant = dot(columns[0], cross(columns[1], columns[2]));
        if determinant <= 0.0 {
            return start;
        }
        let step = [
            dot(aim, cross(columns[1], columns[2])),
            dot(columns[0], cross(aim, columns[2])),
            dot(columns[0], cross(columns[1], aim)),
        ];
        plus_scaled(start, determinant.recip(), step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOR: [Vector; 3] = [[0.0, 0.0, 2.0], [3.0, 0.0, 2.0], [0.0, 3.0, 2.0]];
    const WALL: [Vector; 3] = [[1.0, 0.0, 0.0], [1.0, 3.0, 0.0], [1.0, 0.0, 3.0]];
    const BACK: [Vector; 3] = [[0.0, 5.0, 0.0], [3.0, 5.0, 0.0], [0.0, 5.0, 3.0]];

    #[test]
    fn a_plane_gives_area_times_squared_distance() {
        let quadric = Quadric::of(FLOOR);
        assert!((quadric.at([7.0, -3.0, 4.0]) - 1.5 * 4.0).abs() < 1e-12);
        assert!((quadric.weight - 1.5).abs() < 1e-12);
    }

    #[test]
    fn three_planes_meet_in_the_least_place_and_one_moves_it_along_its_normal_alone() {
        let corner = Quadric::of(FLOOR)
            .plus(&Quadric::of(WALL))
            .plus(&Quadric::of(BACK));
        let near = corner.least_near([1.1, 4.9, 2.2]);
        for (found, wanted) in near.iter().zip([1.0, 5.0, 2.0]) {
            assert!((found - wanted).abs() < 2e-3, "{near:?}");
        }
        let [x, y, z] = Quadric::of(FLOOR).least_near([7.0, 8.0, 3.0]);
        assert!((x - 7.0).abs() < 1e-12 && (y - 8.0).abs() < 1e-12 && (z - 2.0).abs() < 2e-3);
    }

    #[test]
    fn no_plane_leaves_everything_where_it_is() {
        let none = Quadric::of([[1.0; 3]; 3]);
        let start = [1.0, 2.0, 3.0];
        let moved = minus(none.least_near(start), start);
        assert!(dot(moved, moved) < f64::MIN_POSITIVE);
        assert!(none.at([1.0, 2.0, 3.0]).abs() < f64::MIN_POSITIVE);
    }
}
