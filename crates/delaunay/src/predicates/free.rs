//! Predicates on free doubles: Shewchuk's adaptive arithmetic through the crate `robust`.

use robust::{Coord, Coord3D, insphere, orient2d, orient3d};

use super::circumsphere::{self, CERTAIN, Circumsphere, Double, GOOD, ROUNDING};
use super::{Kernel, Site, settle_tie};

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

/// `D`, `N` and whether both are known to `tolerance`; `rounding` is the error of one operation.
fn certified(edges: [[f64; 3]; 3], d: f64, n: [f64; 3], rounding: f64, tolerance: f64) -> bool {
    let widest = edges
        .as_flattened()
        .iter()
        .fold(0.0, |m: f64, v| m.max(v.abs()));
    let cube = widest * widest * widest;
    let norm = n.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    // D sums 6 products, N 18, each of a few rounded factors no larger than `widest`.
    64.0 * rounding * cube <= tolerance * d.abs()
        && 512.0 * rounding * cube * widest <= tolerance * norm
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

    fn circumsphere(&self, [a, b, c, d]: [&[f64; 3]; 4]) -> Option<Circumsphere> {
        let edges = [b, c, d].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        let lengths = edges.map(|e| e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
        let (mut volume, mut n) = circumsphere::terms(edges, lengths);
        if !certified(edges, volume, n, ROUNDING, GOOD) {
            let wide = [b, c, d].map(|p| [0, 1, 2].map(|k| Double::difference(p[k], a[k])));
            let lengths = wide.map(|e| e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
            let (wide_volume, wide_n) = circumsphere::terms(wide, lengths);
            (volume, n) = (wide_volume.0, wide_n.map(|v| v.0));
            if !certified(edges, volume, n, ROUNDING * ROUNDING * 64.0, CERTAIN) {
                return None;
            }
        }
        let half = n.map(|v| v / (2.0 * volume));
        Some(Circumsphere {
            centre: [0, 1, 2].map(|k| a[k] + half[k]),
            radius_squared: half[0] * half[0] + half[1] * half[1] + half[2] * half[2],
        })
    }

    fn number(value: f64) -> f64 {
        value
    }

    fn step_mm(&self) -> [f64; 3] {
        [1.0; 3]
    }

    fn reach(&self, _axis: usize, radius_mm: f64) -> f64 {
        radius_mm
    }
}
