//! Centre and radius of the sphere through four points, with a certificate.
//!
//! With `u, v, w` from one corner to the others, `l` their squared lengths in the metric `G`,
//! `D = det[u, v, w]` and `N = l_u (v x w) + l_v (w x u) + l_w (u x v)`, the centre lies at
//! `G^-1 N / (2 D)` from that corner and `R^2 = N^T G^-1 N / (4 D^2)`.

use std::ops::{Add, Mul, Neg, Sub};

/// A sphere in the coordinates of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Circumsphere {
    /// Centre, in coordinates.
    pub(crate) centre: [f64; 3],
    /// Squared radius in mm^2.
    pub(crate) radius_squared: f64,
}

/// Relative error of `D` and `N` above which doubles give way to wider numbers.
pub(super) const GOOD: f64 = 1e-12;
/// Relative error of `D` and `N` above which a sphere is not certain.
pub(super) const CERTAIN: f64 = 1e-7;
/// Half a unit in the last place of 1.
pub(super) const ROUNDING: f64 = f64::EPSILON / 2.0;

/// Numbers that determinants can be made of.
pub(super) trait Ring:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}
impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Ring for T {}

#[inline]
fn cross<T: Ring>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `D` and `N` of the three edges from a corner and their squared lengths.
#[inline]
pub(super) fn terms<T: Ring>([u, v, w]: [[T; 3]; 3], [lu, lv, lw]: [T; 3]) -> (T, [T; 3]) {
    let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
    let d = u[0] * vw[0] + u[1] * vw[1] + u[2] * vw[2];
    let n = [0, 1, 2].map(|k| lu * vw[k] + lv * wu[k] + lw * uv[k]);
    (d, n)
}

/// A sum of two doubles that do not overlap: about 106 bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Double(pub(super) f64, pub(super) f64);

impl Double {
    /// `a - b`, exactly.
    pub(super) fn difference(a: f64, b: f64) -> Self {
        let s = a - b;
        let bb = a - s;
        Self(s, (a - (s + bb)) + (bb - b))
    }

    fn sum(a: f64, b: f64) -> Self {
        let s = a + b;
        let bb = s - a;
        Self(s, (a - (s - bb)) + (b - bb))
    }

    fn product(a: f64, b: f64) -> Self {
        let p = a * b;
        Self(p, a.mul_add(b, -p))
    }
}

impl Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let high = Self::sum(self.0, other.0);
        let low = Self::sum(self.1, other.1);
        let first = Self::sum(high.0, high.1 + low.0);
        Self::sum(first.0, first.1 + low.1)
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let p = Self::product(self.0, other.0);
        Self::sum(p.0, p.1 + (self.0 * other.1 + self.1 * other.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_double_keeps_what_one_f64_drops() {
        let tiny = 2f64.powi(-80);
        let x = Double::sum(1.0, tiny);
        let square = x * x - Double(1.0, 0.0);
        assert_eq!(square.0.to_bits(), (2.0 * tiny).to_bits());
        assert!((Double::difference(1.0, -tiny) - x).0 == 0.0);
    }

    #[test]
    fn a_unit_cube_corner_has_its_sphere_in_the_middle() {
        let (d, n) = terms(
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [1.0, 1.0, 1.0],
        );
        assert_eq!((d, n), (1.0, [1.0; 3]));
    }
}
