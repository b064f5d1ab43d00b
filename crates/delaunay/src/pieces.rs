//! Whole triangulations piece by piece, in parallel, without any bound on the size of cells.
//!
//! 1. Cut space across its longest extent and triangulate each piece's points alone.
//! 2. A cell whose circumsphere stays clear of all other pieces is a cell of the whole. The
//!    vertices of all other cells, and of the hulls, are the *border*.
//! 3. Triangulate the border's points alone. Of these cells, those with vertices of several
//!    pieces belong to the whole, and of the others those that a piece had found, too.
//!
//! Why that is all and nothing else (after Funke and Sanders 2017):
//! - A vertex none of whose cells in its piece is in conflict with another piece's point has the
//!   same cells in the whole. So every vertex of a cell of several pieces is on the border, and
//!   that cell is one of the border's triangulation.
//! - A cell of the border's triangulation with a vertex `v` outside piece `k` has no point `q`
//!   of `k` inside. Lift all points, and take heights from the plane through the cell's lifted
//!   vertices: inside is below. From `v` and from `q` edges of the whole descend to the lowest
//!   point, past points inside only. So a path leads from `v` to `q`, and on it an edge enters
//!   `k`. That edge belongs to cells of several pieces: its end in `k` is on the border, and
//!   inside, where the border's triangulation has none.
//! - So a cell of several pieces there has nothing inside: it is of the whole. A cell of one
//!   piece may only have that piece's points inside, and has none if the piece found it, too.
//!
//! All of this holds with ties settled by [`crate::predicates`], which are those of one lift.

use bonemesh_task::Task;
use rayon::prelude::*;

use crate::DelaunayError;
use crate::kept::canonical;
use crate::points::Sites;
use crate::predicates::{Kernel, Site};
use crate::slabs::Slabs;
use crate::triangulation::{Cell, Triangulation};

/// Points below which a piece is not worth a cut.
const POINTS_PER_PIECE: usize = 32_768;
/// Points that a piece is thick, were they spread evenly: a border is a few points thick.
const THICKNESS: f64 = 40.0;
/// Cells sorted between two looks at the cancel switch: a millisecond.
const CELLS_PER_CHECK: usize = 1 << 14;

/// The cells of the whole triangulation, as ranks, in no particular order. The stages are
/// `tetrahedra` and, where there are pieces, `borders`.
pub(crate) fn whole<K: Kernel>(
    sites: &Sites<K>,
    task: &Task,
) -> Result<Vec<[u32; 4]>, DelaunayError> {
    in_pieces(sites, count(sites), task)
}

/// How many pieces pay; depends on the points alone.
fn count<K: Kernel>(sites: &Sites<K>) -> usize {
    let points = sites.sorted.len();
    let extents = [0, 1, 2].map(|k| sites.bounds.high[k] - sites.bounds.low[k]);
    let longest = extents.into_iter().fold(0.0, f64::max);
    let volume: f64 = extents.iter().product();
    let step = (volume / points as f64).cbrt();
    let shortest = extents.into_iter().fold(f64::INFINITY, f64::min);
    // A plate has most points on its hull, which is border everywhere.
    if shortest < THICKNESS * step / 2.0 {
        return 1;
    }
    let by_thickness = longest / (THICKNESS * step);
    (by_thickness as usize).min(points / POINTS_PER_PIECE)
}

fn in_pieces<K: Kernel>(
    sites: &Sites<K>,
    count: usize,
    task: &Task,
) -> Result<Vec<[u32; 4]>, DelaunayError> {
    let pieces = Slabs::without_margin(sites, count.max(1));
    if pieces.len() > 1 {
        let mut shares = vec![Vec::new(); pieces.len()];
        for site in &sites.sorted {
            shares[pieces.owner(sites.kernel.place_mm(&site.at))].push(*site);
        }
        task.begin("tetrahedra", sites.sorted.len());
        let found = shares.into_par_iter().enumerate().map(|(piece, share)| {
            let found = Triangulation::build(sites, &share, Vec::new(), task)?;
            let sorted = found.map(|found| Sorted::new(&found, &pieces, piece, task));
            sorted.transpose()
        });
        let found: Option<Vec<Sorted>> = found.collect::<Result<_, DelaunayError>>()?;
        // A piece may be flat: then there is nothing to build on.
        if let Some(found) = found {
            return joined(sites, &pieces, found, task);
        }
    }
    task.begin("tetrahedra", sites.sorted.len());
    let whole = Triangulation::build(sites, &sites.sorted, Vec::new(), task)?;
    Ok(whole.map_or_else(Vec::new, |t| {
        let cells = t.finite_cells();
        cells.map(|cell| canonical(t.cell_sites(cell)).0).collect()
    }))
}

/// A piece's cells, as ranks.
struct Sorted {
    /// Cells of the whole.
    safe: Vec<[u32; 4]>,
    /// Cells that another piece may break, ascending.
    unsafe_cells: Vec<[u32; 4]>,
    /// Vertices of those and of the hull, ascending.
    border: Vec<u32>,
}

impl Sorted {
    fn new<K: Kernel>(
        found: &Triangulation<'_, K>,
        pieces: &Slabs,
        piece: usize,
        task: &Task,
    ) -> Result<Self, DelaunayError> {
        let mut sorted = Self {
            safe: Vec::with_capacity(found.cells.len()),
            unsafe_cells: Vec::new(),
            border: Vec::new(),
        };
        for (i, cell) in found.cells.iter().enumerate() {
            if i % CELLS_PER_CHECK == 0 {
                task.check()?;
            }
            if !cell.is_in_use() {
                continue;
            }
            if cell.is_infinite() {
                let hull = cell
                    .vertices
                    .into_iter()
                    .filter(|&v| v != crate::triangulation::GHOST);
                let ranks = hull.map(|v| found.vertices[v as usize].site.rank);
                sorted.border.extend(ranks);
                continue;
            }
            let (ranks, ascending) = canonical(found.cell_sites(cell));
            if is_clear(found, cell, pieces, piece) {
                sorted.safe.push(ranks);
            } else {
                sorted.unsafe_cells.push(ranks);
                sorted.border.extend(ascending.map(|s| s.rank));
            }
        }
        sorted.unsafe_cells.sort_unstable();
        sorted.border.sort_unstable();
        sorted.border.dedup();
        Ok(sorted)
    }
}

/// Whether a cell's circumsphere certainly stays within its piece.
fn is_clear<K: Kernel>(
    found: &Triangulation<'_, K>,
    cell: &Cell,
    pieces: &Slabs,
    piece: usize,
) -> bool {
    let precision = found.precision;
    let radius = cell.sphere.radius_squared.sqrt() * (1.0 + 2.0 * precision.tolerance);
    // An unknown radius is in no piece.
    pieces.only_owner(cell.sphere.centre, radius + 4.0 * precision.place) == Some(piece)
}

/// The pieces' cells and those between them.
fn joined<K: Kernel>(
    sites: &Sites<K>,
    pieces: &Slabs,
    found: Vec<Sorted>,
    task: &Task,
) -> Result<Vec<[u32; 4]>, DelaunayError> {
    let mut border: Vec<u32> = found
        .iter()
        .flat_map(|f| f.border.iter().copied())
        .collect();
    border.sort_unstable();
    task.check()?;
    let at_border: Vec<Site<K::Scalar>> = border
        .iter()
        .map(|&rank| sites.sorted[rank as usize])
        .collect();
    task.begin("borders", at_border.len());
    let between = Triangulation::build(sites, &at_border, Vec::new(), task)?
        .expect("the hull of a solid piece is solid, anything else is a bug");
    let owner = |s: &Site<K::Scalar>| pieces.owner(sites.kernel.place_mm(&s.at));
    let of_the_whole = |cell: &Cell| {
        let (ranks, ascending) = canonical(between.cell_sites(cell));
        let owners = ascending.each_ref().map(owner);
        let piece = owners[0];
        let is_mixed = owners.iter().any(|&other| other != piece);
        (is_mixed || found[piece].unsafe_cells.binary_search(&ranks).is_ok()).then_some(ranks)
    };
    let mut cells: Vec<[u32; 4]> = between
        .cells
        .par_iter()
        .filter(|cell| cell.is_finite())
        .filter_map(of_the_whole)
        .collect();
    for piece in found {
        cells.extend(piece.safe);
    }
    Ok(cells)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Points;
    use crate::points::AnySites;
    use proptest::prelude::*;

    fn assert_pieces_make_the_whole<K: Kernel>(sites: &Sites<K>, count: usize) {
        let [mut whole, mut pieces] =
            [1, count].map(|n| in_pieces(sites, n, &Task::default()).unwrap());
        whole.sort_unstable();
        pieces.sort_unstable();
        assert_eq!(pieces, whole);
    }

    fn assert_of_any(points: Points<'_>, count: usize) {
        match AnySites::new(points, &Task::default()) {
            Ok(AnySites::Upright(sites)) => assert_pieces_make_the_whole(&sites, count),
            Ok(AnySites::Tilted(sites)) => assert_pieces_make_the_whole(&sites, count),
            Ok(AnySites::Free(sites)) => assert_pieces_make_the_whole(&sites, count),
            Err(_) => {}
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { max_shrink_iters: 300, ..ProptestConfig::with_cases(600) })]

        #[test]
        fn pieces_of_a_lattice_make_its_whole(
            points in prop::collection::vec([0..30i32, 0..6i32, 0..5i32], 4..400),
            count in 2..7usize,
            third in prop_oneof![Just(1.0), Just(2.25)],
            tilt in prop_oneof![Just(0.0), Just(0.3)],
        ) {
            let gram = [[1.0, tilt, 0.0], [tilt, 1.0, 0.0], [0.0, 0.0, third]];
            assert_of_any(Points::Lattice { coordinates: &points, gram }, count);
        }

        #[test]
        fn pieces_of_free_points_make_their_whole(
            points in prop::collection::vec([0.0..50.0f64, 0.0..9.0f64, 0.0..9.0f64], 4..400),
            count in 2..7usize,
        ) {
            assert_of_any(Points::Free(&points), count);
        }

        #[test]
        fn far_clusters_with_long_cells_between_make_their_whole(
            points in prop::collection::vec([0..3i32, 0..4i32, 0..4i32], 8..60),
            gap in 5..2000i32,
            count in 2..4usize,
        ) {
            let far = points.iter().map(|&[x, y, z]| [gap - 2 * x, y + 1, z]);
            let points: Vec<[i32; 3]> = points.iter().copied().chain(far).collect();
            let gram = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            assert_of_any(Points::Lattice { coordinates: &points, gram }, count);
        }
    }

    #[test]
    fn many_points_are_cut_and_few_are_not() {
        let points: Vec<[f64; 3]> = (0..600_000)
            .map(|i| [i % 100, i / 100 % 60, i / 6000].map(f64::from))
            .collect();
        let Ok(AnySites::Free(sites)) = AnySites::new(Points::Free(&points), &Task::default())
        else {
            panic!("free points");
        };
        assert_eq!(count(&sites), 2);
        let Ok(AnySites::Free(sites)) =
            AnySites::new(Points::Free(&points[..60_000]), &Task::default())
        else {
            panic!("free points");
        };
        assert!(count(&sites) <= 1);
    }
}
