//! Predicates on integer coordinates under a Gram matrix, exact without long arithmetic.
//!
//! Differences of coordinates are integers below 2^15, so an orientation (below 2^48) is exact in
//! doubles. The in-sphere determinant is `sum g_ij D_ij`: the six `D_ij` depend on coordinates
//! only and are exact in doubles, i64 or i128 according to the extent of the points; the metric
//! enters as integers `g_ij` below 2^41. Doubles then decide all but the closest calls
//! and i128 decides those, in a few nanoseconds, so ties cost no more than other queries.

use super::circumsphere::{self, Circumsphere, Ring};
use super::{Kernel, Site, settle_tie};
use crate::DelaunayError;

/// The largest difference of coordinates along one axis.
const SPAN_LIMIT: i64 = 32_767;
/// The largest entry of the Gram matrix becomes an integer of this many bits.
const GRAM_BITS: i32 = 40;
/// Index pairs of a symmetric matrix: the diagonal first.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The numbers in which the determinants `D_ij` are exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Range {
    Doubles,
    Words,
    LongWords,
}

/// Integer coordinates and their metric; `TILTED` where the axes are not at right angles.
#[derive(Clone, Debug)]
pub(crate) struct LatticeKernel<const TILTED: bool> {
    range: Range,
    /// The metric in integers: diagonal, then twice the entries off it, in the order of `PAIRS`.
    weights: [i64; 6],
    /// The same as doubles (exact, they have at most 41 bits).
    weights_f64: [f64; 6],
    /// mm^2 for one unit of `weights`.
    unit: f64,
    inverse: [[f64; 3]; 3],
    step_mm: [f64; 3],
}

/// The metric rounded to integers: entries times a power of two, and that power's inverse.
///
/// Direction cosines in files carry rounding, so a right angle shows up as an entry of 1e-17;
/// 40 bits are far finer than any scanner and make such an entry the zero that it should be.
fn integer_gram(gram: [[f64; 3]; 3]) -> Result<([i64; 6], f64), DelaunayError> {
    let bad = || DelaunayError::Gram { gram };
    let entries = PAIRS.map(|(i, j)| f64::midpoint(gram[i][j], gram[j][i]));
    let largest = entries.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
    let asymmetric = PAIRS.map(|(i, j)| (gram[i][j] - gram[j][i]).abs() > 1e-9 * largest);
    let usable = entries.iter().all(|e| e.is_finite()) && (1e-60..1e60).contains(&largest);
    if !usable || asymmetric.contains(&true) {
        return Err(bad());
    }
    let exponent = (largest.to_bits() >> 52) as i32 - 1023;
    let scale = 2f64.powi(GRAM_BITS - 1 - exponent);
    let g = entries.map(|e| (e * scale).round() as i64);
    let [xx, yy, zz, xy, xz, yz] = g.map(i128::from);
    let second = xx * yy - xy * xy;
    let third = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    // Far flatter cells than any scanner's would lose their shape in the rounding.
    let flat = [xx, yy, zz].into_iter().any(|d| d < 1 << 14);
    if flat || second <= 0 || third <= 0 {
        return Err(bad());
    }
    let doubled = [g[0], g[1], g[2], 2 * g[3], 2 * g[4], 2 * g[5]];
    Ok((doubled, 1.0 / scale))
}

/// Inverse of a symmetric positive definite matrix.
fn inverse([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> [[f64; 3]; 3] {
    let c = [
        yy * zz - yz * yz,
        xx * zz - xz * xz,
        xx * yy - xy * xy,
        xz * yz - xy * zz,
        xy * yz - xz * yy,
        xy * xz - xx * yz,
    ];
    let det = xx * c[0] + xy * c[3] + xz * c[4];
    let [a, b, c, ab, ac, bc] = c.map(|v| v / det);
    [[a, ab, ac], [ab, b, bc], [ac, bc, c]]
}

/// The kernel of a set of lattice points.
pub(crate) enum AnyLattice {
    /// Axes at right angles.
    Upright(LatticeKernel<false>),
    /// Any other axes.
    Tilted(LatticeKernel<true>),
}

impl AnyLattice {
    /// Chooses the arithmetic for points that span `extent` steps along each axis.
    pub(crate) fn new(gram: [[f64; 3]; 3], extent: [i64; 3]) -> Result<Self, DelaunayError> {
        if let Some(axis) = (0..3).find(|&a| extent[a] > SPAN_LIMIT) {
            return Err(DelaunayError::Span {
                axis,
                span: extent[axis],
                limit: SPAN_LIMIT,
            });
        }
        let (weights, unit) = integer_gram(gram)?;
        Ok(if weights[3..] == [0, 0, 0] {
            Self::Upright(LatticeKernel::new(weights, unit, extent))
        } else {
            Self::Tilted(LatticeKernel::new(weights, unit, extent))
        })
    }
}

impl<const TILTED: bool> LatticeKernel<TILTED> {
    fn new(weights: [i64; 6], unit: f64, extent: [i64; 3]) -> Self {
        let entry = |i: usize| weights[i] as f64 * unit * if i < 3 { 1.0 } else { 0.5 };
        let entries = [0, 1, 2, 3, 4, 5].map(entry);
        Self {
            range: Range::of(extent),
            weights,
            weights_f64: weights.map(|w| w as f64),
            unit,
            inverse: inverse(entries),
            step_mm: [0, 1, 2].map(|i| entries[i].sqrt()),
        }
    }

    /// Conflict with the determinants computed in `T`, which must be wide enough.
    #[inline]
    fn conflict_in<T: Exact>(&self, cell: [&Site<i32>; 4], query: &Site<i32>) -> bool {
        let p = cell.map(|s| difference::<T>(&s.at, &query.at));
        let weights = vertex_weights(p);
        let squares = |i: usize, j: usize| {
            weights[0] * (p[0][i] * p[0][j])
                + weights[1] * (p[1][i] * p[1][j])
                + weights[2] * (p[2][i] * p[2][j])
                + weights[3] * (p[3][i] * p[3][j])
        };
        let zero = T::default();
        let mut d = [
            squares(0, 0),
            squares(1, 1),
            squares(2, 2),
            zero,
            zero,
            zero,
        ];
        if TILTED {
            d[3] = squares(0, 1);
            d[4] = squares(0, 2);
            d[5] = squares(1, 2);
        }
        let terms = if TILTED { 6 } else { 3 };
        let (mut sum, mut size) = (0.0, 0.0);
        for (d, g) in d.iter().zip(self.weights_f64).take(terms) {
            let term = d.double() * g;
            sum += term;
            size += term.abs();
        }
        // A term carries at most two roundings and the sum five more: 7 units of 2^-53.
        if sum.abs() > size * (8.0 * circumsphere::ROUNDING) {
            return sum > 0.0;
        }
        let exact = d.iter().zip(self.weights).take(terms);
        let exact: i128 = exact.map(|(d, g)| d.long() * i128::from(g)).sum();
        if exact != 0 {
            return exact > 0;
        }
        settle_tie(cell.map(|s| s.rank), query.rank, |i| weights[i].double())
    }
}

/// Numbers wide enough for the determinants of a set of points.
trait Exact: Ring + Default + From<i32> {
    fn double(self) -> f64;
    fn long(self) -> i128;
}

impl Exact for f64 {
    #[inline]
    fn double(self) -> f64 {
        self
    }
    #[inline]
    fn long(self) -> i128 {
        // An integer below 2^53: i64 is the quicker way.
        i128::from(self as i64)
    }
}

impl Exact for i64 {
    #[inline]
    fn double(self) -> f64 {
        self as f64
    }
    #[inline]
    fn long(self) -> i128 {
        self.into()
    }
}

impl Exact for i128 {
    #[inline]
    fn double(self) -> f64 {
        self as f64
    }
    #[inline]
    fn long(self) -> i128 {
        self
    }
}

impl Range {
    /// All sums on the way to `D_ij` stay below `24 m^2 x y z`, with `m` the largest extent.
    fn of(extent: [i64; 3]) -> Self {
        let [x, y, z] = extent.map(|e| i128::from(e.max(1)));
        let m = x.max(y).max(z);
        let bound = 24 * m * m * x * y * z;
        if bound <= 1 << 53 {
            Self::Doubles
        } else if bound < 1 << 63 {
            Self::Words
        } else {
            Self::LongWords
        }
    }
}

#[inline]
fn difference<T: From<i32>>(a: &[i32; 3], b: &[i32; 3]) -> [T; 3] {
    [
        T::from(a[0] - b[0]),
        T::from(a[1] - b[1]),
        T::from(a[2] - b[2]),
    ]
}

/// The orientations of a cell with one vertex after the other replaced by the origin.
#[inline]
fn vertex_weights<T: Exact>([a, b, c, d]: [[T; 3]; 4]) -> [T; 4] {
    let plane = |p: [T; 3], q: [T; 3]| p[0] * q[1] - q[0] * p[1];
    let (ab, ac, ad) = (plane(a, b), plane(a, c), plane(a, d));
    let (bc, bd, cd) = (plane(b, c), plane(b, d), plane(c, d));
    [
        b[2] * cd - c[2] * bd + d[2] * bc,
        c[2] * ad - a[2] * cd - d[2] * ac,
        a[2] * bd - b[2] * ad + d[2] * ab,
        b[2] * ac - a[2] * bc - c[2] * ab,
    ]
}

impl<const TILTED: bool> Kernel for LatticeKernel<TILTED> {
    type Scalar = i32;

    #[inline]
    fn orientation(&self, [a, b, c, d]: [&[i32; 3]; 4]) -> f64 {
        let [u, v, w] = [b, c, d].map(|p| difference::<f64>(p, a));
        u[0] * (v[1] * w[2] - v[2] * w[1])
            + u[1] * (v[2] * w[0] - v[0] * w[2])
            + u[2] * (v[0] * w[1] - v[1] * w[0])
    }

    fn collinear(&self, [a, b, c]: [&[i32; 3]; 3]) -> bool {
        let [u, v] = [b, c].map(|p| difference::<f64>(p, a));
        [(0, 1), (1, 2), (2, 0)]
            .into_iter()
            .all(|(i, j)| u[i] * v[j] - u[j] * v[i] == 0.0)
    }

    #[inline]
    fn in_conflict(&self, cell: [&Site<i32>; 4], query: &Site<i32>) -> bool {
        match self.range {
            Range::Doubles => self.conflict_in::<f64>(cell, query),
            Range::Words => self.conflict_in::<i64>(cell, query),
            Range::LongWords => self.conflict_in::<i128>(cell, query),
        }
    }

    fn circumsphere(&self, [a, b, c, d]: [&[i32; 3]; 4]) -> Option<Circumsphere> {
        let edges = [b, c, d].map(|p| difference::<f64>(p, a));
        let size = |v: [f64; 3], f: fn(f64) -> f64| -> f64 {
            let terms = PAIRS.iter().zip(self.weights_f64);
            terms.map(|(&(i, j), g)| f(g * v[i] * v[j])).sum()
        };
        let (volume, mut n) = circumsphere::terms(edges, edges.map(|e| size(e, |t| t)));
        // D and the cross products are integers below 2^48; only N rounds.
        let longest = edges
            .map(|e| size(e, f64::abs))
            .into_iter()
            .fold(0.0, f64::max);
        let widest = edges
            .as_flattened()
            .iter()
            .fold(0.0, |m: f64, v| m.max(v.abs()));
        let error = 64.0 * circumsphere::ROUNDING * longest * widest * widest;
        let norm = n.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        if error > circumsphere::GOOD * norm {
            // Below 2^(41 + 4 * 15 + 7): i128 holds it exactly.
            let edges = [b, c, d].map(|p| difference::<i128>(p, a));
            let length = |e: [i128; 3]| -> i128 {
                let terms = PAIRS.iter().zip(self.weights);
                terms.map(|(&(i, j), g)| i128::from(g) * e[i] * e[j]).sum()
            };
            n = circumsphere::terms(edges, edges.map(length))
                .1
                .map(|v| v as f64);
        }
        let half = n.map(|v| v * self.unit / (2.0 * volume));
        let centre = self
            .inverse
            .map(|r| r[0] * half[0] + r[1] * half[1] + r[2] * half[2]);
        let radius_squared = centre[0] * half[0] + centre[1] * half[1] + centre[2] * half[2];
        let centre = [0, 1, 2].map(|k| f64::from(a[k]) + centre[k]);
        (volume != 0.0).then_some(Circumsphere {
            centre,
            radius_squared,
        })
    }

    fn number(value: i32) -> f64 {
        f64::from(value)
    }

    fn step_mm(&self) -> [f64; 3] {
        self.step_mm
    }

    fn reach(&self, axis: usize, radius_mm: f64) -> f64 {
        radius_mm * self.inverse[axis][axis].sqrt()
    }
}
