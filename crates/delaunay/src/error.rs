//! What cannot be tetrahedralised, and the remedy.

use bonemesh_task::Cancelled;

/// What cannot be tetrahedralised, and the remedy.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DelaunayError {
    /// Fewer than four different points.
    #[error(
        "{points} points with {distinct} different positions make no tetrahedron; give at least 4 different points"
    )]
    TooFew {
        /// Points given.
        points: usize,
        /// Different positions among them.
        distinct: usize,
    },
    /// All points on one line.
    #[error(
        "all {distinct} different points lie on one line and enclose no space; add points beside it, in two or more slices"
    )]
    Collinear {
        /// Different positions.
        distinct: usize,
    },
    /// All points in one plane.
    #[error(
        "all {distinct} different points lie in one plane and enclose no space; add points off it, such as another slice"
    )]
    Coplanar {
        /// Different positions.
        distinct: usize,
    },
    /// A free coordinate outside the range in which the predicates are exact.
    #[error(
        "point {point} has the coordinate {value:e}; coordinates must be 0 or between 1e-45 and 1e55 in size: remove the point or change the unit"
    )]
    Coordinate {
        /// Index of the point.
        point: usize,
        /// The coordinate.
        value: f64,
    },
    /// Lattice points too far apart for the predicates' integers.
    #[error(
        "the lattice points span {span} steps along axis {axis}, at most {limit} are possible; crop them or give them as free points"
    )]
    Span {
        /// 0, 1 or 2.
        axis: usize,
        /// Largest minus smallest coordinate.
        span: i64,
        /// The largest span possible.
        limit: i64,
    },
    /// A Gram matrix that is no metric.
    #[error(
        "the Gram matrix {gram:?} is no metric (finite, symmetric, positive definite, steps at most a few thousand times each other); check the spacing and the direction of the lattice's axes"
    )]
    Gram {
        /// The matrix.
        gram: [[f64; 3]; 3],
    },
    /// Alpha is no length.
    #[error("alpha is {0} mm; it must be a length above 0")]
    Alpha(f64),
    /// More cells than indices.
    #[error(
        "{points} points make more than {limit} tetrahedra, the most that can be numbered; crop or sample the points"
    )]
    TooMany {
        /// Points given.
        points: usize,
        /// The most tetrahedra possible.
        limit: usize,
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
