//! Whole triangulations and alpha complexes, in an order that only the points decide.

use bonemesh_task::Task;
use rayon::prelude::*;

use crate::points::{AnySites, Points, Sites};
use crate::predicates::{Circumsphere, Kernel, Site};
use crate::slabs::{Slabs, in_slabs};
use crate::triangulation::Triangulation;
use crate::{DelaunayError, Tetrahedra};

/// The Delaunay tetrahedra of `points`.
///
/// Of equal points the lowest index is used. Cells come sorted by the order of their points'
/// coordinates (z, y, x), and so do each cell's vertices, but for the last two, which
/// orientation places: the result depends on the set of points only. The stage is `tetrahedra`.
///
/// # Errors
/// Every [`DelaunayError`] but [`DelaunayError::Alpha`].
pub fn tetrahedralize(points: Points<'_>, task: &Task) -> Result<Tetrahedra, DelaunayError> {
    fn all<K: Kernel>(sites: &Sites<K>, task: &Task) -> Result<Tetrahedra, DelaunayError> {
        task.begin("tetrahedra", sites.sorted.len());
        let cells = match Triangulation::build(&sites.kernel, &sites.sorted, task)? {
            Some(t) => t.finite_cells().map(|c| canonical(c).0).collect(),
            None => Vec::new(),
        };
        Ok(numbered(cells, sites))
    }
    match AnySites::new(points)? {
        AnySites::Upright(sites) => all(&sites, task),
        AnySites::Tilted(sites) => all(&sites, task),
        AnySites::Free(sites) => all(&sites, task),
    }
}

/// The Delaunay tetrahedra of `points` with a circumradius of at most `alpha` (mm).
///
/// Exactly those of [`tetrahedralize`], in the same order, but found slab by slab in parallel,
/// which neither their number nor their order shows. An infinite alpha keeps all. The stage is
/// `tetrahedra`.
///
/// # Errors
/// Every [`DelaunayError`]; no tetrahedron small enough is no error but an empty result.
pub fn alpha_complex(
    points: Points<'_>,
    alpha: f64,
    task: &Task,
) -> Result<Tetrahedra, DelaunayError> {
    fn small<K: Kernel>(
        sites: &Sites<K>,
        alpha: f64,
        task: &Task,
    ) -> Result<Tetrahedra, DelaunayError> {
        let slabs = Slabs::plan(sites, alpha);
        Ok(numbered(in_slabs(sites, alpha, &slabs, task)?, sites))
    }
    if alpha.is_nan() || alpha <= 0.0 {
        return Err(DelaunayError::Alpha(alpha));
    }
    if alpha == f64::INFINITY {
        return tetrahedralize(points, task);
    }
    match AnySites::new(points)? {
        AnySites::Upright(sites) => small(&sites, alpha, task),
        AnySites::Tilted(sites) => small(&sites, alpha, task),
        AnySites::Free(sites) => small(&sites, alpha, task),
    }
}

/// A positively oriented cell as ranks: ascending, the last two swapped if orientation asks for
/// it; and its sites, ascending.
pub(crate) fn canonical<S: Copy>(mut cell: [Site<S>; 4]) -> ([u32; 4], [Site<S>; 4]) {
    let mut even = true;
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        if cell[i].rank > cell[j].rank {
            cell.swap(i, j);
            even = !even;
        }
    }
    let mut ranks = cell.map(|s| s.rank);
    if !even {
        ranks.swap(2, 3);
    }
    (ranks, cell)
}

/// The circumsphere of a cell whose sites ascend, if its radius is at most `alpha`.
///
/// One order of the sites means one rounding: whoever asks gets the same answer to the bit.
pub(crate) fn small_sphere<K: Kernel>(
    kernel: &K,
    cell: &[Site<K::Scalar>; 4],
    alpha: f64,
) -> Option<Circumsphere> {
    let [a, b, c, d] = cell;
    kernel
        .circumsphere([&a.at, &b.at, &c.at, &d.at])
        .filter(|sphere| sphere.radius_squared.sqrt() <= alpha)
}

/// Sorts cells of ranks and names the input's points.
fn numbered<K: Kernel>(mut cells: Vec<[u32; 4]>, sites: &Sites<K>) -> Tetrahedra {
    // As one long number a cell compares in the same order, but quicker.
    cells.par_sort_unstable_by_key(|&[a, b, c, d]| {
        let pair = |high: u32, low: u32| u64::from(high) << 32 | u64::from(low);
        u128::from(pair(a, b)) << 64 | u128::from(pair(c, d))
    });
    cells
        .par_iter_mut()
        .for_each(|cell| *cell = cell.map(|rank| sites.input[rank as usize]));
    Tetrahedra { cells }
}
