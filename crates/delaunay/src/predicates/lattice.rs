//! Predicates on integer coordinates under a Gram matrix, exact without long arithmetic.
//!
//! Differences of coordinates are integers below 2^15, so an orientation (below 2^48) is exact in
//! doubles. The in-sphere determinant is `sum g_ij D_ij`: the six `D_ij` depend on coordinates
//! only and are exact in doubles, i64 or i128 according to the extent of the points; the metric
//! enters as integers `g_ij` below 2^41. Doubles then decide all but the closest calls
//! and i128 decides those, in a few nanoseconds, so ties cost no more than other queries.

use std::ops::{Add, Mul, Sub};

use num_bigint::BigInt;

use super::{ExactSphere, Kernel, Site, settle_tie};
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
    /// mm^2 for one unit of `weights` is two to this power.
    unit_exponent: i32,
    frame: MetricFrame,
}

/// The metric rounded to integers, its unit two to a power of mm^2, and its axes in mm.
///
/// Direction cosines in files carry rounding, so a right angle shows up as an entry of 1e-17;
/// 40 bits are far finer than any scanner and make such an entry the zero that it should be.
fn integer_gram(gram: [[f64; 3]; 3]) -> Result<Metric, DelaunayError> {
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
    Ok(Metric {
        weights: doubled,
        unit_exponent: exponent + 1 - GRAM_BITS,
        frame: MetricFrame::new(g.map(|v| v as f64 / scale), third as f64 / scale.powi(3)),
    })
}

struct Metric {
    weights: [i64; 6],
    unit_exponent: i32,
    frame: MetricFrame,
}

/// The axes of a lattice in mm: a triangular root of its metric.
#[derive(Clone, Debug)]
struct MetricFrame {
    /// Column `k` holds the components of a step along axis `k`, those below `k` being zero:
    /// `[x, (x, y), (x, y, z)]`.
    x: f64,
    y: [f64; 2],
    z: [f64; 3],
    /// Relative error of lengths measured with it.
    error: f64,
}

impl MetricFrame {
    /// Cholesky's root of a metric with the given determinant.
    ///
    /// It is the root of a metric whose entries are off by a few roundings of the roots of the
    /// diagonal (Higham, *Accuracy and Stability of Numerical Algorithms*, 10.1), so what counts
    /// is the metric scaled to a diagonal of ones: lengths are off by a few roundings of the
    /// inverse of its determinant, `xx yy zz / det`, however thick the slices. At right angles
    /// only each length's own rounding remains.
    fn new([xx, yy, zz, xy, xz, yz]: [f64; 6], determinant: f64) -> Self {
        // Far below any entry that is not lost in rounding: it keeps a root from being 0.
        let root = |rest: f64, entry: f64| rest.max(f64::EPSILON * entry).sqrt();
        let x = xx.sqrt();
        let (yx, zx) = (xy / x, xz / x);
        let y = root(yy - yx * yx, yy);
        let zy = (yz - zx * yx) / y;
        let z = root(zz - zx * zx - zy * zy, zz);
        let upright = xy == 0.0 && xz == 0.0 && yz == 0.0;
        let condition = xx * yy * zz / determinant;
        Self {
            x,
            y: [yx, y],
            z: [zx, zy, z],
            error: f64::EPSILON * if upright { 2.0 } else { 32.0 * condition },
        }
    }

    #[inline]
    fn vector_mm<const TILTED: bool>(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let mut mm = [self.x * x, self.y[1] * y, self.z[2] * z];
        if TILTED {
            mm[0] += self.y[0] * y + self.z[0] * z;
            mm[1] += self.z[1] * z;
        }
        mm
    }
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
        let metric = integer_gram(gram)?;
        Ok(if metric.weights[3..] == [0, 0, 0] {
            Self::Upright(LatticeKernel::new(metric, extent))
        } else {
            Self::Tilted(LatticeKernel::new(metric, extent))
        })
    }
}

impl<const TILTED: bool> LatticeKernel<TILTED> {
    fn new(metric: Metric, extent: [i64; 3]) -> Self {
        Self {
            range: Range::of(extent),
            weights: metric.weights,
            weights_f64: metric.weights.map(|w| w as f64),
            unit_exponent: metric.unit_exponent,
            frame: metric.frame,
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
        if sum.abs() > size * (4.0 * f64::EPSILON) {
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
trait Exact:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Default + From<i32>
{
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

    fn exact_sphere(&self, corners: [&[i32; 3]; 4]) -> ExactSphere {
        let whole = corners.map(|p| p.map(BigInt::from));
        ExactSphere::new(whole, self.weights, self.unit_exponent.into(), 0)
    }

    #[inline]
    fn difference_mm(&self, a: &[i32; 3], b: &[i32; 3]) -> [f64; 3] {
        self.frame.vector_mm::<TILTED>(difference(a, b))
    }

    fn difference_error(&self) -> f64 {
        self.frame.error
    }

    fn vector_mm(&self, vector: [f64; 3]) -> [f64; 3] {
        self.frame.vector_mm::<TILTED>(vector)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Precision;

    #[test]
    fn thick_slices_of_a_tilted_gantry_keep_their_spheres() {
        for (pixel, slice) in [(0.5, 1.0), (0.45, 3.0), (0.45, 5.0), (0.3, 5.0)] {
            for degrees in [0.00001f64, 15.0, 30.0] {
                let sheared = pixel * slice * degrees.to_radians().sin();
                let gram = [
                    [pixel * pixel, 0.0, 0.0],
                    [0.0, pixel * pixel, sheared],
                    [0.0, sheared, slice * slice],
                ];
                let Ok(AnyLattice::Tilted(kernel)) = AnyLattice::new(gram, [511, 511, 200]) else {
                    panic!("a tilted lattice");
                };
                let precision = Precision::new(kernel.difference_error(), 500.0);
                assert!(precision.tolerance < 1e-3, "{pixel} {slice} {degrees}");
                // Lengths along the axes and across, against the metric itself.
                for v in [[1, 0, 0], [0, 1, 0], [0, 0, 1], [3, -7, 2], [-1, 9, -4]] {
                    let mm = kernel.difference_mm(&v, &[0; 3]);
                    let length_squared: f64 = mm.iter().map(|m| m * m).sum();
                    let w = v.map(f64::from);
                    let rows = [0, 1, 2].map(|i| (0..3).map(|j| gram[i][j] * w[j]).sum::<f64>());
                    let expected: f64 = (0..3).map(|i| rows[i] * w[i]).sum();
                    // The metric itself is rounded to 2^-40 of its largest entry.
                    assert!((length_squared / expected - 1.0).abs() < 1e-8);
                }
            }
        }
    }
}
