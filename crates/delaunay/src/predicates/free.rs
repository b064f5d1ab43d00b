//! Predicates on free doubles: Shewchuk's adaptive arithmetic through the crate `robust`.

use num_bigint::BigInt;
use robust::{Coord, Coord3D, insphere, orient2d, orient3d};

use super::exact_sphere::decode;
use super::{ExactSphere, Kernel, Site, settle_tie};

/// Free points in mm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FreeKernel;

#[inline]
fn coord(p: &[f64; 3]) -> Coord3D<f64> {
    Coord3D {
        x: p[0],
        y: p[1],
        z: p[2],
    }
}

impl Kernel for FreeKernel {
    type Scalar = f64;

    #[inline]
    fn orientation(&self, [a, b, c, d]: [&[f64; 3]; 4]) -> f64 {
        -orient3d(coord(a), coord(b), coord(c), coord(d))
    }

    fn collinear(&self, corners: [&[f64; 3]; 3]) -> bool {
        [(0, 1), (1, 2), (2, 0)].into_iter().all(|(i, j)| {
            let [a, b, c] = corners.map(|p| Coord { x: p[i], y: p[j] });
            orient2d(a, b, c) == 0.0
        })
    }

    #[inline]
    fn in_conflict(&self, cell: [&Site<f64>; 4], query: &Site<f64>) -> bool {
        let [a, b, c, d] = cell.map(|s| coord(&s.at));
        // `robust` orients cells the other way round, hence the sign.
        let inside = -insphere(a, b, c, d, coord(&query.at));
        if inside != 0.0 {
            return inside > 0.0;
        }
        settle_tie(cell.map(|s| s.rank), query.rank, |i| {
            let mut corners = cell.map(|s| &s.at);
            corners[i] = &query.at;
            self.orientation(corners)
        })
    }

    fn exact_sphere(&self, corners: [&[f64; 3]; 4]) -> ExactSphere {
        let parts = corners.map(|p| p.map(decode));
        let used = parts
            .as_flattened()
            .iter()
            .filter(|(mantissa, _)| *mantissa != 0);
        let step_exponent = used.map(|&(_, exponent)| exponent).min().unwrap_or(0);
        let whole = parts.map(|p| {
            p.map(|(mantissa, exponent)| {
                // A zero may have any exponent.
                BigInt::from(mantissa) << (exponent - step_exponent).max(0)
            })
        });
        ExactSphere::new(whole, [1, 1, 1, 0, 0, 0], 2 * step_exponent, step_exponent)
    }

    #[inline]
    fn difference_mm(&self, a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
        [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
    }

    fn difference_error(&self) -> f64 {
        f64::EPSILON
    }

    fn vector_mm(&self, vector: [f64; 3]) -> [f64; 3] {
        vector
    }
}
