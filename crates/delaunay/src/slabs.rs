//! Alpha complexes slab by slab, in parallel.
//!
//! Cut space across its longest extent. A cell belongs to the slab that holds its circumcentre.
//! Give each slab the points within `alpha` of it and triangulate those alone:
//!
//! - a cell of the whole triangulation with `R <= alpha` whose centre is in the slab has its
//!   closed ball, and so all that speaks for or against it, among the slab's points: it is a
//!   cell there;
//! - a cell found in the slab, with its centre there and `R <= alpha`, has no other point of the
//!   whole set in its ball: it is a cell of the whole triangulation.
//!
//! Ties agree, because they are settled by the coordinates of the five points concerned. Centre
//! and radius are computed from the four points in one order, so every slab that sees a cell
//! computes the same bits and exactly one of them keeps it. What rounding they carry (at most
//! 1e-7, else no sphere is returned) is covered by a wider margin.

use bonemesh_task::Task;
use rayon::prelude::*;

use crate::DelaunayError;
use crate::alpha::{canonical, small_sphere};
use crate::points::Sites;
use crate::predicates::{Kernel, Site};
use crate::triangulation::Triangulation;

/// How much margin may add to the work, as a part of the points' extent.
const MARGIN_SHARE: f64 = 0.125;
/// Points below which a slab is not worth a cut.
const POINTS_PER_SLAB: usize = 8192;
/// Points looked at to place the cuts.
const SAMPLES: usize = 1 << 16;

/// Where space is cut; depends on the points and alpha alone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slabs {
    axis: usize,
    /// Ascending; slab `i` is from cut `i - 1` to before cut `i`.
    cuts: Vec<f64>,
    /// How far a slab's points reach beyond it.
    margin: f64,
}

impl Slabs {
    /// As many slabs, a power of two, as keep the margins small, with equal shares of points.
    pub(crate) fn plan<K: Kernel>(sites: &Sites<K>, alpha: f64) -> Self {
        let (axis, low, high) = longest_axis(sites);
        let margin = margin(sites, axis, alpha, low, high);
        let by_margin = 1.0 + MARGIN_SHARE * (high - low) / (2.0 * margin);
        let by_points = sites.sorted.len() / POINTS_PER_SLAB;
        let slabs = (by_margin as usize).min(by_points).max(1);
        Self::with_count(sites, alpha, 1 << slabs.ilog2())
    }

    /// `count` slabs with about equal shares of points.
    pub(crate) fn with_count<K: Kernel>(sites: &Sites<K>, alpha: f64, count: usize) -> Self {
        let (axis, low, high) = longest_axis(sites);
        let stride = sites.sorted.len().div_ceil(SAMPLES).max(1);
        let sampled = sites.sorted.iter().step_by(stride);
        let mut places: Vec<f64> = sampled.map(|s| K::number(s.at[axis])).collect();
        places.sort_unstable_by(f64::total_cmp);
        let mut cuts: Vec<f64> = (1..count)
            .map(|i| places[i * places.len() / count])
            .collect();
        cuts.dedup();
        Self {
            axis,
            cuts,
            margin: margin(sites, axis, alpha, low, high),
        }
    }

    fn owner(&self, centre: [f64; 3]) -> usize {
        self.cuts.partition_point(|&cut| cut <= centre[self.axis])
    }

    /// The sites of each slab and its margins, in the order of ranks.
    fn share_out<K: Kernel>(&self, sites: &Sites<K>) -> Vec<Vec<Site<K::Scalar>>> {
        (0..=self.cuts.len())
            .into_par_iter()
            .map(|slab| {
                let from = slab
                    .checked_sub(1)
                    .map_or(f64::NEG_INFINITY, |i| self.cuts[i]);
                let to = self.cuts.get(slab).copied().unwrap_or(f64::INFINITY);
                let closed = from - self.margin..=to + self.margin;
                let within = |s: &&Site<K::Scalar>| closed.contains(&K::number(s.at[self.axis]));
                sites.sorted.iter().filter(within).copied().collect()
            })
            .collect()
    }
}

/// The axis of the largest extent in mm, and that extent in coordinates.
fn longest_axis<K: Kernel>(sites: &Sites<K>) -> (usize, f64, f64) {
    let step = sites.kernel.step_mm();
    let extent = |axis: usize| {
        let values = sites.sorted.iter().map(|s| K::number(s.at[axis]));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        })
    };
    let mut longest = (0, 0.0, 0.0);
    for axis in 0..3 {
        let (low, high) = extent(axis);
        if (high - low) * step[axis] > (longest.2 - longest.1) * step[longest.0] {
            longest = (axis, low, high);
        }
    }
    longest
}

/// The reach of a ball of radius alpha, and room for the rounding of its centre and radius.
fn margin<K: Kernel>(sites: &Sites<K>, axis: usize, alpha: f64, low: f64, high: f64) -> f64 {
    let rounding = 1e-12 * low.abs().max(high.abs());
    sites.kernel.reach(axis, alpha) * (1.0 + 1e-5) + rounding
}

/// The cells with a circumradius of at most `alpha`, as ranks, in no particular order.
pub(crate) fn in_slabs<K: Kernel>(
    sites: &Sites<K>,
    alpha: f64,
    slabs: &Slabs,
    task: &Task,
) -> Result<Vec<[u32; 4]>, DelaunayError> {
    let shares = slabs.share_out(sites);
    task.begin("tetrahedra", shares.iter().map(Vec::len).sum());
    let cells: Vec<Vec<[u32; 4]>> = shares
        .into_par_iter()
        .enumerate()
        .map(|(slab, share)| {
            // A slab may hold too few points, or a flat set of them: then it has no cell.
            let Some(found) = Triangulation::build(&sites.kernel, &share, task)? else {
                return Ok(Vec::new());
            };
            let kept = found.finite_cells().filter_map(|cell| {
                let (ranks, cell) = canonical(cell);
                let sphere = small_sphere(&sites.kernel, &cell, alpha)?;
                (slabs.owner(sphere.centre) == slab).then_some(ranks)
            });
            Ok(kept.collect())
        })
        .collect::<Result<_, DelaunayError>>()?;
    Ok(cells.concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Points;
    use crate::points::AnySites;
    use crate::predicates::FreeKernel;
    use proptest::prelude::*;

    fn free_sites(points: &[[f64; 3]]) -> Option<Sites<FreeKernel>> {
        match AnySites::new(Points::Free(points)) {
            Ok(AnySites::Free(sites)) => Some(sites),
            _ => None,
        }
    }

    /// Cells of the whole triangulation that alpha keeps.
    fn whole<K: Kernel>(sites: &Sites<K>, alpha: f64) -> Vec<[u32; 4]> {
        let task = Task::default();
        let built = Triangulation::build(&sites.kernel, &sites.sorted, &task).unwrap();
        let mut cells: Vec<[u32; 4]> = built
            .unwrap()
            .finite_cells()
            .map(canonical)
            .filter(|(_, cell)| small_sphere(&sites.kernel, cell, alpha).is_some())
            .map(|(ranks, _)| ranks)
            .collect();
        cells.sort_unstable();
        cells
    }

    fn in_pieces<K: Kernel>(sites: &Sites<K>, alpha: f64, count: usize) -> Vec<[u32; 4]> {
        let slabs = Slabs::with_count(sites, alpha, count);
        let mut cells = in_slabs(sites, alpha, &slabs, &Task::default()).unwrap();
        cells.sort_unstable();
        cells
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        #[test]
        fn slabs_find_exactly_the_small_cells_of_the_whole_lattice(
            points in prop::collection::vec([0..24i32, 0..6i32, 0..5i32], 4..250),
            alpha in prop_oneof![0.6..8.0f64, Just(0.75f64.sqrt()), Just(1.5), Just(1e6)],
            count in 2..12usize,
            third in prop_oneof![Just(1.0), Just(2.25)],
            tilt in prop_oneof![Just(0.0), Just(0.3)],
        ) {
            let gram = [[1.0, tilt, 0.0], [tilt, 1.0, 0.0], [0.0, 0.0, third]];
            match AnySites::new(Points::Lattice { coordinates: &points, gram }) {
                Ok(AnySites::Upright(s)) => {
                    prop_assert_eq!(in_pieces(&s, alpha, count), whole(&s, alpha));
                }
                Ok(AnySites::Tilted(s)) => {
                    prop_assert_eq!(in_pieces(&s, alpha, count), whole(&s, alpha));
                }
                _ => {}
            }
        }

        #[test]
        fn slabs_find_exactly_the_small_cells_of_free_points(
            points in prop::collection::vec([0.0..50.0f64, 0.0..9.0f64, 0.0..9.0f64], 4..250),
            alpha in 0.5..12.0f64,
            count in 2..12usize,
        ) {
            let sites = free_sites(&points).unwrap();
            prop_assert_eq!(in_pieces(&sites, alpha, count), whole(&sites, alpha));
        }

        #[test]
        fn a_turned_lattice_with_its_rounding_parts_no_cell(
            angle in 0.0..3.2f64,
            alpha in prop_oneof![0.6..4.0f64, Just(0.75f64.sqrt())],
            count in 2..9usize,
        ) {
            // Cospherical but for the last bits: the flattest cells there are.
            let (sin, cos) = angle.sin_cos();
            let turn = |i: i32| {
                let [x, y, z] = [i % 12, i / 12 % 4, i / 48].map(f64::from);
                [x * cos - y * sin, x * sin + y * cos, z]
            };
            let points: Vec<[f64; 3]> = (0..192).map(turn).collect();
            let sites = free_sites(&points).unwrap();
            prop_assert_eq!(in_pieces(&sites, alpha, count), whole(&sites, alpha));
        }
    }

    #[test]
    fn a_slab_of_one_plane_has_no_cell_of_its_own() {
        // Two far planes and a block between: the outer slabs see a plane each.
        let mut points: Vec<[i32; 3]> = Vec::new();
        for i in 0..27 {
            points.push([50 + i % 3, i / 3 % 3, i / 9]);
            points.push([0, i % 3, i / 3]);
            points.push([100, i % 3, i / 3]);
        }
        let gram = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let lattice = Points::Lattice {
            coordinates: &points,
            gram,
        };
        let Ok(AnySites::Upright(sites)) = AnySites::new(lattice) else {
            panic!("an upright lattice");
        };
        let cells = in_pieces(&sites, 2.0, 3);
        assert_eq!(cells, whole(&sites, 2.0));
        assert!(cells.len() >= 8 * 5);
    }

    #[test]
    fn a_long_cloud_is_cut_and_a_small_one_is_not() {
        let long: Vec<[f64; 3]> = (0..40_000)
            .map(|i| [f64::from(i) * 0.01, f64::from(i % 7), f64::from(i % 5)])
            .collect();
        let sites = free_sites(&long).unwrap();
        assert_eq!(Slabs::plan(&sites, 1.0).cuts.len(), 3);
        assert!(Slabs::plan(&sites, 100.0).cuts.is_empty());
        let sites = free_sites(&long[..1000]).unwrap();
        assert!(Slabs::plan(&sites, 0.01).cuts.is_empty());
    }
}
