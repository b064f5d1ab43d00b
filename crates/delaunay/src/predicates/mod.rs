//! Exact decisions about points, by two kernels: integer lattices and free doubles.
//!
//! Everything above this module asks only the questions of [`Kernel`]; none of it computes with
//! coordinates. All answers are exact but the differences in mm, whose error is known.

mod exact_sphere;
mod free;
mod lattice;

pub(crate) use exact_sphere::ExactSphere;
pub(crate) use free::FreeKernel;
pub(crate) use lattice::{AnyLattice, LatticeKernel};

/// A point and its place in the order of all points by coordinates (z, then y, then x).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Site<S> {
    /// Coordinates.
    pub(crate) at: [S; 3],
    /// Place among all distinct points of the input; decides ties.
    pub(crate) rank: u32,
}

/// The questions that a triangulation asks about its points.
///
/// `a, b, c, d` is positively oriented when `det[b - a, c - a, d - a] > 0`.
pub(crate) trait Kernel: Sync {
    /// A coordinate.
    type Scalar: Copy + Send + Sync + Default + PartialEq + std::fmt::Debug;

    /// A number with the sign of `det[b - a, c - a, d - a]`.
    fn orientation(&self, corners: [&[Self::Scalar; 3]; 4]) -> f64;

    /// Whether three points lie on one line.
    fn collinear(&self, corners: [&[Self::Scalar; 3]; 3]) -> bool;

    /// Whether `query` lies inside the circumsphere of a positively oriented cell; a tie is
    /// settled by the perturbed lift, see [`settle_tie`].
    fn in_conflict(&self, cell: [&Site<Self::Scalar>; 4], query: &Site<Self::Scalar>) -> bool;

    /// The sphere through four points that span space.
    fn exact_sphere(&self, corners: [&[Self::Scalar; 3]; 4]) -> ExactSphere;

    /// The vector from `b` to `a` in mm along three fixed axes at right angles.
    fn difference_mm(&self, a: &[Self::Scalar; 3], b: &[Self::Scalar; 3]) -> [f64; 3];

    /// Error of [`Kernel::difference_mm`] as a part of the vector's length.
    fn difference_error(&self) -> f64;

    /// A vector in coordinates along the axes of [`Kernel::difference_mm`].
    fn vector_mm(&self, vector: [f64; 3]) -> [f64; 3];

    /// A point's place in mm.
    #[inline]
    fn place_mm(&self, at: &[Self::Scalar; 3]) -> [f64; 3] {
        self.difference_mm(at, &[Self::Scalar::default(); 3])
    }
}

/// Settles a query that lies exactly on the circumsphere: is it inside?
///
/// Each point's lift (its squared length, the height on the paraboloid whose lower hull is the
/// Delaunay triangulation) is raised by an infinitesimal that is larger for a higher rank. The
/// highest rank whose raise changes anything decides: raising the query takes it out, raising a
/// vertex takes the query in where the vertex's weight at the query is positive.
/// `weight(i)` has the sign of the orientation of the cell with vertex `i` replaced by the query
/// (Devillers and Teillaud 2011).
#[inline]
pub(crate) fn settle_tie(ranks: [u32; 4], query: u32, weight: impl Fn(usize) -> f64) -> bool {
    let mut below = u32::MAX;
    loop {
        // The highest rank that has not been asked yet; the query's ends the search.
        let mut highest = query;
        let mut vertex = None;
        for (i, &rank) in ranks.iter().enumerate() {
            if rank < below && rank > highest {
                highest = rank;
                vertex = Some(i);
            }
        }
        let Some(vertex) = vertex else { return false };
        let weight = weight(vertex);
        if weight != 0.0 {
            return weight > 0.0;
        }
        below = highest;
    }
}
