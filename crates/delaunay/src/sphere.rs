//! Circumspheres in doubles that know how good they are: most in-sphere questions end here.
//!
//! With `u, v, w` from a corner `p` to the other three, `l` their squared lengths,
//! `D = det[u, v, w]` and `N = l_u (v x w) + l_v (w x u) + l_w (u x v)`, the centre lies at
//! `p + N / (2 D)`.
//!
//! Let `e` be the relative error of `u, v, w` and `m` the longest of them, at most `2 R`. To
//! first order `N` is off by at most `30 e m^4` and `D` by `8 e m^3`, so the centre by
//! `38 e R m^3 / |D|`. Cells with `|D| >= FLAT m^3` therefore have centre and radius within
//! `k R`, `k = 40 e / FLAT`; flatter ones get no sphere. A query `q` is compared by
//! `s = |q - c|^2 - R^2`, whose error is at most `2 (|q - c| + R) (k R + a)` with `a` the error
//! of the places of `c` and `q`. With `A` the largest coordinate of `p`, those of `c` and `q` are
//! at most `A + R` and `A + R + |q - c|`, so `a <= 4 e' (A + R + |q - c|)`, `e'` being `e` and one
//! more rounding. Where `4 e' A <= k R` the error of `s` is below `8 k (|q - c|^2 + R^2)`: a larger
//! `s` has the right sign, and exact arithmetic decides the others, most of them true ties.

/// Least `|D|` for the cube of the longest edge.
const FLAT: f64 = 1.0 / (1u64 << 20) as f64;
/// Squared lengths for whose products doubles have room.
const SIZES: std::ops::Range<f64> = 1e-80..1e80;
/// Tolerance above which the first-order bounds mean nothing.
const COARSE: f64 = 1.0 / 256.0;
/// Spheres computed side by side, so that the compiler can use vectors.
pub(crate) const LANES: usize = 4;

/// Centre and squared radius in mm; a radius of NaN where the cell is infinite or too flat.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    pub(crate) centre: [f64; 3],
    pub(crate) radius_squared: f64,
}

impl Sphere {
    /// No sphere is known.
    pub(crate) const UNKNOWN: Self = Self {
        centre: [0.0; 3],
        radius_squared: f64::NAN,
    };
}

/// The vector from the common corner to another, and its squared length.
pub(crate) type Arm = [f64; 4];

/// An [`Arm`].
#[inline]
pub(crate) fn arm([x, y, z]: [f64; 3]) -> Arm {
    [x, y, z, x * x + y * y + z * z]
}

/// What spheres of one set of points can be trusted with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Precision {
    /// Relative error of `s` above which its sign is certain, and of squared radii; infinite
    /// where nothing is.
    pub(crate) tolerance: f64,
    /// Error in mm of absolute places.
    pub(crate) place: f64,
    /// Least radius for the largest coordinate of a cell's corner.
    least_radius: f64,
}

impl Precision {
    /// For differences with a relative error of `difference` and coordinates up to
    /// `largest` mm.
    pub(crate) fn new(difference: f64, largest: f64) -> Self {
        let relative = 40.0 * difference / FLAT;
        let tolerance = 8.0 * relative;
        // Three coordinates, each rounded again when a centre is added.
        let place = 4.0 * (difference + f64::EPSILON);
        Self {
            tolerance: if tolerance < COARSE {
                tolerance
            } else {
                f64::INFINITY
            },
            place: place * largest,
            least_radius: place / relative,
        }
    }

    /// Positive where `place` is certainly outside, negative where inside, 0 where unknown.
    #[inline]
    pub(crate) fn side(&self, sphere: &Sphere, place: [f64; 3]) -> f64 {
        let x = place[0] - sphere.centre[0];
        let y = place[1] - sphere.centre[1];
        let z = place[2] - sphere.centre[2];
        let distance_squared = x * x + y * y + z * z;
        let side = distance_squared - sphere.radius_squared;
        // An unknown radius makes the comparison false.
        if side.abs() > self.tolerance * (distance_squared + sphere.radius_squared) {
            side
        } else {
            0.0
        }
    }

    /// The spheres through `corner` (mm) and the ends of three arms each.
    // Spelled out, since closures over the three axes are not always inlined.
    #[inline(never)]
    pub(crate) fn spheres(&self, corner: [f64; 3], arms: &[[&Arm; 3]; LANES]) -> Spheres {
        let lane = |arm: usize, k: usize| Lane(std::array::from_fn(|i| arms[i][arm][k]));
        let u = [lane(0, 0), lane(0, 1), lane(0, 2)];
        let v = [lane(1, 0), lane(1, 1), lane(1, 2)];
        let w = [lane(2, 0), lane(2, 1), lane(2, 2)];
        let (lu, lv, lw) = (lane(0, 3), lane(1, 3), lane(2, 3));
        let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
        let d = u[0] * vw[0] + u[1] * vw[1] + u[2] * vw[2];
        let half = d.half_inverse();
        let x = (lu * vw[0] + lv * wu[0] + lw * uv[0]) * half;
        let y = (lu * vw[1] + lv * wu[1] + lw * uv[1]) * half;
        let z = (lu * vw[2] + lv * wu[2] + lw * uv[2]) * half;
        let radius_squared = x * x + y * y + z * z;
        let longest = lu.largest(lv).largest(lw);
        let (solid, cube) = (d * d, longest * longest * longest);
        let [p, q, r] = corner;
        let least = self.least_radius * p.abs().max(q.abs()).max(r.abs());
        let least_squared = least * least;
        let known = |i: usize| {
            solid.0[i] >= FLAT * FLAT * cube.0[i]
                && radius_squared.0[i] >= least_squared
                && SIZES.contains(&longest.0[i])
        };
        let centre = |c: Lane, k: usize| c.0.map(|offset| corner[k] + offset);
        Spheres {
            x: centre(x, 0),
            y: centre(y, 1),
            z: centre(z, 2),
            radius_squared: std::array::from_fn(|i| {
                if known(i) {
                    radius_squared.0[i]
                } else {
                    f64::NAN
                }
            }),
        }
    }
}

/// Spheres side by side. Number by number they are stored and read without waiting, which
/// copies of whole spheres are not.
pub(crate) struct Spheres {
    x: [f64; LANES],
    y: [f64; LANES],
    z: [f64; LANES],
    radius_squared: [f64; LANES],
}

impl Spheres {
    #[inline]
    pub(crate) fn get(&self, lane: usize) -> Sphere {
        Sphere {
            centre: [self.x[lane], self.y[lane], self.z[lane]],
            radius_squared: self.radius_squared[lane],
        }
    }
}

/// The same number of [`LANES`] spheres.
#[derive(Clone, Copy)]
struct Lane([f64; LANES]);

impl Lane {
    #[inline]
    fn each(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
    #[inline]
    fn largest(self, other: Self) -> Self {
        self.each(other, f64::max)
    }
    #[inline]
    fn half_inverse(self) -> Self {
        Self(self.0.map(|v| 0.5 / v))
    }
}

impl std::ops::Add for Lane {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        self.each(other, |a, b| a + b)
    }
}

impl std::ops::Sub for Lane {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self.each(other, |a, b| a - b)
    }
}

impl std::ops::Mul for Lane {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.each(other, |a, b| a * b)
    }
}

#[inline]
fn cross(a: [Lane; 3], b: [Lane; 3]) -> [Lane; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predicates::{FreeKernel, Kernel, Site};
    use proptest::prelude::*;

    fn sphere_of(precision: &Precision, corners: [[f64; 3]; 4]) -> Sphere {
        let [p, u, v, w] = corners;
        let arms = [u, v, w].map(|q| arm([0, 1, 2].map(|k| q[k] - p[k])));
        precision.spheres(p, &[arms.each_ref(); LANES]).get(0)
    }

    #[test]
    fn the_corner_of_a_unit_cube_has_its_sphere_in_the_middle() {
        let precision = Precision::new(f64::EPSILON, 1.0);
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let sphere = sphere_of(&precision, corners);
        assert_eq!(sphere.centre.map(f64::to_bits), [0.5f64.to_bits(); 3]);
        assert_eq!(sphere.radius_squared.to_bits(), 0.75f64.to_bits());
        assert!(precision.side(&sphere, [0.5, 0.5, 0.0]) < 0.0);
        assert!(precision.side(&sphere, [2.0, 0.5, 0.0]) > 0.0);
        assert!(precision.side(&sphere, [1.0; 3]).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn nothing_is_certain_of_flat_tiny_or_coarse_cells() {
        let precision = Precision::new(f64::EPSILON, 1.0);
        let unknown = |far: f64, scale: f64, height: f64| {
            let tips = [
                [far, 0.0, 0.0],
                [far + scale, 0.0, 0.0],
                [far, scale, 0.0],
                [far + scale, scale, height],
            ];
            sphere_of(&precision, tips).radius_squared.is_nan()
        };
        assert!(!unknown(0.0, 1.0, 0.1));
        assert!(unknown(0.0, 1.0, 1e-8));
        assert!(unknown(1.0, 1e-9, 1e-10));
        assert!(!unknown(1e4, 1.0, 0.1));
        assert!(unknown(1e14, 1.0, 0.1));
        let coarse = Precision::new(1e-8, 1.0);
        let sphere = sphere_of(
            &coarse,
            [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        );
        assert!(coarse.side(&sphere, [900.0; 3]).abs() < f64::MIN_POSITIVE);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn what_is_certain_is_right(
            corners in prop::array::uniform4(prop::array::uniform3(-4.0..4.0f64)),
            lift in prop_oneof![Just(1.0), Just(1e-3), Just(1e-5)],
            toward in prop::array::uniform3(-1.0..1.0f64),
            nearness in prop_oneof![Just(1e-2), Just(1e-6), Just(1e-9), Just(1e-12)],
            far in prop_oneof![Just(0.0), Just(1000.0)],
        ) {
            let corners = corners.map(|[x, y, z]| [x + far, y - far, z * lift]);
            let precision = Precision::new(f64::EPSILON, far + 4.0);
            let mut sites = [0, 1, 2, 3].map(|i| Site { at: corners[i], rank: i as u32 });
            if FreeKernel.orientation(sites.each_ref().map(|s| &s.at)) < 0.0 {
                sites.swap(2, 3);
            }
            let sphere = sphere_of(&precision, sites.map(|s| s.at));
            // Cells too flat for a sphere make every answer 0.
            // A query next to the sphere, on either side of it.
            let length = toward.iter().map(|t| t * t).sum::<f64>().sqrt().max(1e-3);
            for sign in [-1.0, 1.0] {
                let reach = sphere.radius_squared.sqrt() * (1.0 + sign * nearness) / length;
                let query = [0, 1, 2].map(|k| sphere.centre[k] + toward[k] * reach);
                let inside = FreeKernel.in_conflict(
                    sites.each_ref(),
                    &Site { at: query, rank: 4 },
                );
                let side = precision.side(&sphere, query);
                prop_assert!(side == 0.0 || (side < 0.0) == inside, "{side} {inside}");
                // Nearly all of the solid cells have a sphere, and it is sure of easy queries.
                let is_easy = nearness > 1e-3 && !sphere.radius_squared.is_nan();
                prop_assert!(side != 0.0 || !is_easy);
            }
        }
    }
}
