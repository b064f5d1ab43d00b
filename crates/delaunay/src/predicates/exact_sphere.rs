//! Centre and radius of a sphere through four points in whole numbers of any length.
//!
//! For the few cells of which doubles are not certain: flat ones, and those whose radius is
//! alpha to the last digits, where cospherical cells must not part.

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};

/// Bits of a quotient that are kept: more than a double's.
const QUOTIENT_BITS: i64 = 64;

/// A sphere in the coordinates of its points, as fractions.
#[derive(Clone, Debug)]
pub(crate) struct ExactSphere {
    /// From the first corner to the centre, times `divisor`.
    centre: [BigInt; 3],
    divisor: BigInt,
    /// Squared radius in units of the metric: numerator, denominator.
    radius_squared: (BigInt, BigInt),
    /// mm^2 for one unit of the metric is two to this power.
    unit_exponent: i64,
    /// One coordinate for one step of the whole numbers is two to this power.
    step_exponent: i64,
}

impl ExactSphere {
    /// The sphere of a solid cell.
    ///
    /// `weights` is the metric: its diagonal, then twice the entries off it, in the order
    /// `xx, yy, zz, xy, xz, yz`; `v . v` times `2^unit_exponent` is in mm^2.
    pub(super) fn new(
        [a, b, c, d]: [[BigInt; 3]; 4],
        weights: [i64; 6],
        unit_exponent: i64,
        step_exponent: i64,
    ) -> Self {
        let [u, v, w] = [b, c, d].map(|p| difference(&p, &a));
        let length = |e: &[BigInt; 3]| -> BigInt {
            let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
            let terms = pairs.into_iter().zip(weights);
            terms.map(|((i, j), g)| &e[i] * &e[j] * g).sum()
        };
        let (vw, wu, uv) = (cross(&v, &w), cross(&w, &u), cross(&u, &v));
        let volume = dot(&u, &vw);
        let [lu, lv, lw] = [&u, &v, &w].map(length);
        let normal: [BigInt; 3] =
            std::array::from_fn(|k| &lu * &vw[k] + &lv * &wu[k] + &lw * &uv[k]);
        // Twice the metric is whole; its inverse is `adjugate / determinant`.
        let [xx, yy, zz, xy, xz, yz] = weights.map(BigInt::from);
        let rows = [
            [2 * xx, xy.clone(), xz.clone()],
            [xy, 2 * yy, yz.clone()],
            [xz, yz, 2 * zz],
        ];
        let adjugate = [
            cross(&rows[1], &rows[2]),
            cross(&rows[2], &rows[0]),
            cross(&rows[0], &rows[1]),
        ];
        let determinant = dot(&rows[0], &adjugate[0]);
        let centre = adjugate.each_ref().map(|row| dot(row, &normal));
        Self {
            radius_squared: (dot(&normal, &centre), 2 * &determinant * &volume * &volume),
            centre,
            divisor: determinant * volume,
            unit_exponent,
            step_exponent,
        }
    }

    /// Whether the radius is at most `alpha` mm (finite, positive), exactly.
    pub(crate) fn radius_is_at_most(&self, alpha: f64) -> bool {
        let (mantissa, exponent) = decode(alpha);
        let (numerator, denominator) = &self.radius_squared;
        let limit = denominator * BigInt::from(mantissa) * mantissa;
        let shift = self.unit_exponent - 2 * exponent;
        if shift >= 0 {
            numerator << shift <= limit
        } else {
            *numerator <= limit << -shift
        }
    }

    /// From the first corner to the centre, in coordinates.
    pub(crate) fn centre(&self) -> [f64; 3] {
        self.centre
            .each_ref()
            .map(|c| quotient(c, &self.divisor) * 2f64.powi(self.step_exponent as i32))
    }
}

/// A finite double as a whole number times a power of two.
pub(super) fn decode(value: f64) -> (i64, i64) {
    let bits = value.to_bits();
    let biased = (bits >> 52 & 0x7ff) as i64;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) = if biased == 0 {
        (fraction, -1074)
    } else {
        (fraction | 1 << 52, biased - 1075)
    };
    (if value < 0.0 { -mantissa } else { mantissa }, exponent)
}

fn difference(a: &[BigInt; 3], b: &[BigInt; 3]) -> [BigInt; 3] {
    std::array::from_fn(|k| &a[k] - &b[k])
}

fn dot(a: &[BigInt; 3], b: &[BigInt; 3]) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &[BigInt; 3], b: &[BigInt; 3]) -> [BigInt; 3] {
    [
        &a[1] * &b[2] - &a[2] * &b[1],
        &a[2] * &b[0] - &a[0] * &b[2],
        &a[0] * &b[1] - &a[1] * &b[0],
    ]
}

/// `a / b` rounded to a double.
fn quotient(a: &BigInt, b: &BigInt) -> f64 {
    if a.is_zero() {
        return 0.0;
    }
    let bits = |v: &BigInt| v.abs().bits() as i64;
    let shift = (QUOTIENT_BITS + bits(b) - bits(a)).max(0);
    let scaled: BigInt = (a << shift) / b;
    // Two steps, so that neither power of two is out of a double's range.
    let half = (shift / 2) as i32;
    let value = scaled.to_f64().unwrap_or(f64::INFINITY);
    value * 2f64.powi(-half) * 2f64.powi(half - shift as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube_corner(weights: [i64; 6], unit_exponent: i64) -> ExactSphere {
        let corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
        let corners = corners.map(|p| p.map(BigInt::from));
        ExactSphere::new(corners, weights, unit_exponent, 0)
    }

    #[test]
    fn a_radius_is_told_from_its_nearest_doubles() {
        // 1 x 1 x 1 mm: the radius is the square root of 3/4, which no double is.
        let unit = cube_corner([1, 1, 1, 0, 0, 0], 0);
        let above = 0.75f64.sqrt();
        let (below, above) = if above * above < 0.75 {
            (above, above.next_up())
        } else {
            (above.next_down(), above)
        };
        assert!(unit.radius_is_at_most(above) && !unit.radius_is_at_most(below));
        // 2 x 2 x 1 mm, whose radius of 1.5 is a double.
        let half_unit = cube_corner([16, 16, 4, 0, 0, 0], -2);
        assert!(half_unit.radius_is_at_most(1.5));
        assert!(!half_unit.radius_is_at_most(1.5f64.next_down()));
        assert_eq!(half_unit.centre().map(f64::to_bits), [0.5f64.to_bits(); 3]);
    }

    #[test]
    fn a_tilted_metric_has_its_centre_at_equal_distances() {
        let weights = [4, 5, 9, 2, 0, -4];
        let c = cube_corner(weights, 0).centre();
        let metric = |v: [f64; 3]| {
            4.0 * v[0] * v[0] + 5.0 * v[1] * v[1] + 9.0 * v[2] * v[2] + 2.0 * v[0] * v[1]
                - 4.0 * v[1] * v[2]
        };
        let to_origin = metric(c);
        for k in 0..3 {
            let mut v = c;
            v[k] -= 1.0;
            assert!((metric(v) - to_origin).abs() < 1e-12);
        }
    }

    #[test]
    fn every_double_is_its_whole_number_and_power() {
        for value in [1.0, -0.1, 1e-300, 5e-324, 1.75e55, 0.0] {
            let (mantissa, exponent) = decode(value);
            let (half, rest) = (exponent / 2, exponent - exponent / 2);
            let back = mantissa as f64 * 2f64.powi(half as i32) * 2f64.powi(rest as i32);
            assert_eq!(back.to_bits(), value.to_bits());
        }
    }
}
