//! The Delaunay tetrahedra of points in space, exactly: one answer for one set of points.
//!
//! Promise, for any points that span space (lattices, planes, spheres of points, duplicates):
//! - every cell `[a, b, c, d]` is positively oriented, `det[b - a, c - a, d - a] > 0`, exactly;
//!   no cell is flat;
//! - no point lies inside the circumsphere of a cell, exactly;
//! - the cells fill the convex hull and nothing else;
//! - the result depends on the coordinates alone: not on the order of the input but for the
//!   numbering, not on the number of threads;
//! - the alpha complex, found in parallel slabs, is exactly the part of that triangulation with
//!   a circumradius of at most alpha, to the last bit of alpha, and its boundary is closed and
//!   faces outward.
//!
//! Limits: at most 2^30 tetrahedra at a time; lattice coordinates span at most 32,767 steps
//! along an axis and their metric is rounded to `2^-40` of its largest entry; free coordinates
//! are 0 or between 1e-45 and 1e55 in size. There are as many threads at work as an alpha complex
//! has slabs and a whole triangulation pieces; flat or small sets have one.
//!
//! ```
//! use bonemesh_delaunay::{Points, alpha_complex, tetrahedralize};
//! use bonemesh_task::Task;
//!
//! // The corners of a voxel of 0.5 x 0.5 x 1 mm: eight points of one sphere.
//! let corners: Vec<[i32; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2]).collect();
//! let gram = [[0.25, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0, 0.0, 1.0]];
//! let points = Points::Lattice { coordinates: &corners, gram };
//!
//! let whole = tetrahedralize(points, &Task::default())?;
//! assert_eq!(whole.volume_mm3(points), 0.25);
//! assert_eq!(whole.boundary(&Task::default())?.len(), 12);
//!
//! let none = alpha_complex(points, 0.6, &Task::default())?;
//! assert!(none.cells.is_empty()); // the sphere's radius is 0.612 mm
//! # Ok::<(), bonemesh_delaunay::DelaunayError>(())
//! ```
//!
//! # How it works
//! 1. `points`: distinct points are sorted by z, y, x; a point's place is its rank.
//! 2. `slabs`: space is cut across its longest extent; each slab takes the points within alpha
//!    of it, which makes it right about every cell that it will keep. Without alpha, `pieces`
//!    are triangulated with their own points only, and joined along their borders.
//! 3. `hilbert`: points are put in random rounds, each in the order of a Hilbert curve.
//! 4. `locate`: from the last cell, walk to the cell that holds the next point.
//! 5. `insert`: the cells whose circumsphere has the point inside give way, and `star` joins the
//!    point to the cavity's rim. A ghost vertex at infinity makes the outside cells, too.
//! 6. `sphere`: each cell carries its circumsphere in doubles and knows how far these can be
//!    trusted; nine of ten in-sphere questions end there.
//! 7. `predicates`: integers decide the rest on a lattice, adaptive doubles on free points. A
//!    point exactly on a circumsphere is decided by an infinitesimal raise of each point's
//!    *lift*, larger for higher ranks, so all ties together are those of one true
//!    triangulation; positions are not perturbed, which would leave flat cells.
//! 8. `kept`: cells are kept by circumradius, and facets without a kept cell beyond are the
//!    boundary; `numbered` puts cells in order and names them by the input's indices.
//!
//! # What was tried
//! On the edges of a skull (592,212 points, alpha 2.4 mm) or random points, one thread's work,
//! before and after; the machine's own noise is about 0.05.
//!
//! | idea | gain |
//! |---|---|
//! | a certified sphere in each cell, four made at a time | kept: 1.2 |
//! | loops spelled out where closures over arrays were not inlined | kept: 1.4 |
//! | rim vertices numbered densely, edges matched in a table of 32 x 32 without branches | kept: 1.1 |
//! | numbers chosen in registers, not changed in memory and copied at once | kept: 1.05 |
//! | the boundary from each slab, without a sorted list of tetrahedra | kept: 1.2 |
//! | memory of cells passed from slab to slab | kept: 1.04 |
//! | place on the curve and index in one word | kept: 1.03 |
//! | a conflicting cell's neighbours fetched from memory when it enters the queue | kept: 1.07 |
//! | the same for the vertices of the rim, or of the cavity | dropped: 0.98 |
//! | 16 slabs, or 64, in place of 4 (smaller sets, more margin) | dropped: 0.8, 0.5 |
//! | neighbours looked at when a cell enters the queue, not when it leaves | dropped: 0.97 |
//! | rounds by parity of slices or of pixels | dropped: 0.5 to 1.0 |
//! | rounds eight times the one before, in place of four | dropped: 1.0 |
//! | boundary facets in bins, not sorted | dropped: 0.95 |
//! | AVX2, fat link-time optimisation, one codegen unit | dropped: 1.0 |
//! | huge pages | not ours to set: 1.05 |
//!
//! # References
//! - A. Bowyer, *Computing Dirichlet tessellations*, 1981; D. F. Watson, *Computing the
//!   n-dimensional Delaunay tessellation*, 1981.
//! - H. Edelsbrunner, E. P. Muecke, *Three-dimensional alpha shapes*, 1994.
//! - O. Devillers, M. Teillaud, *Perturbations for Delaunay and weighted Delaunay 3D
//!   triangulations*, 2011.
//! - J. R. Shewchuk, *Adaptive precision floating-point arithmetic and fast robust geometric
//!   predicates*, 1997.
//! - N. Amenta, S. Choi, G. Rote, *Incremental constructions con BRIO*, 2003; C. H. Hamilton,
//!   *Compact Hilbert indices*, 2006.
//! - D. Funke, P. Sanders, *Parallel d-D Delaunay triangulations in shared and distributed
//!   memory*, 2017.
//! - C. Marot, J. Pellerin, J.-F. Remacle, *One machine, one minute, three billion tetrahedra*,
//!   2019.

mod alpha;
mod boundary;
mod error;
mod hilbert;
mod insert;
mod kept;
mod locate;
mod numbered;
mod pieces;
mod points;
mod predicates;
mod slabs;
mod sphere;
mod star;
mod triangulation;

pub use alpha::{alpha_boundary, alpha_complex, tetrahedralize};
pub use error::DelaunayError;
pub use points::Points;

/// Tetrahedra over indices of the input points, each positively oriented in the input's
/// coordinates: `det[b - a, c - a, d - a] > 0` for a cell `[a, b, c, d]`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Tetrahedra {
    /// Four point indices a cell.
    pub cells: Vec<[u32; 4]>,
}

/// The triangles that bound an alpha complex, and how many tetrahedra they enclose.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct AlphaBoundary {
    /// Three point indices a triangle, counter-clockwise seen from outside in the input's
    /// coordinates, sorted by their vertices, the smallest first.
    pub triangles: Vec<[u32; 3]>,
    /// How many tetrahedra the complex has.
    pub tetrahedra: usize,
}
