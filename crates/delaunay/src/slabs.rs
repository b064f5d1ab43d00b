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
//! Ties agree, because they are settled by the coordinates of the five points concerned, and
//! every slab that sees a cell finds the same owner for it (see [`crate::kept`]).

use std::ops::RangeInclusive;
use std::sync::{Mutex, PoisonError};

use bonemesh_task::Task;
use rayon::prelude::*;

use crate::DelaunayError;
use crate::points::Sites;
use crate::predicates::{Kernel, Site};
use crate::triangulation::{Cell, Triangulation};

/// How much margin may add to the work, as a part of the points' extent.
const MARGIN_SHARE: f64 = 0.125;
/// Points below which a slab is not worth a cut.
const POINTS_PER_SLAB: usize = 8192;
/// Points looked at to place the cuts.
const SAMPLES: usize = 1 << 16;
/// Part of alpha that covers the rounding of centres.
const ALPHA_ROUNDING: f64 = 1e-5;

/// Where space is cut; depends on the points and alpha alone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slabs {
    /// Of the kernel's places in mm.
    axis: usize,
    /// Ascending, in mm; slab `i` is from cut `i - 1` to before cut `i`.
    cuts: Vec<f64>,
    /// How far a slab's points reach beyond it: a ball of radius alpha and its rounding.
    margin: f64,
}

impl Slabs {
    /// As many slabs, a power of two, as keep the margins small, with equal shares of points.
    pub(crate) fn plan<K: Kernel>(sites: &Sites<K>, alpha: f64) -> Self {
        let (axis, extent) = longest_axis(sites);
        let places = sampled_places(sites, axis);
        let by_margin = 1.0 + MARGIN_SHARE * extent / (2.0 * margin(sites, alpha));
        let by_points = sites.sorted.len() / POINTS_PER_SLAB;
        let slabs = (by_margin as usize).min(by_points).max(1);
        let mut count = 1usize << slabs.ilog2();
        // Where points crowd, their slabs are thin: the margins then hold most of them.
        loop {
            let slabs = Self::at_quantiles(sites, axis, &places, alpha, count);
            if slabs.with_margins(&places) <= (1.0 + MARGIN_SHARE) * places.len() as f64 {
                return slabs;
            }
            count /= 2;
        }
    }

    /// `count` slabs with about equal shares of points.
    pub(crate) fn with_count<K: Kernel>(sites: &Sites<K>, alpha: f64, count: usize) -> Self {
        let (axis, _) = longest_axis(sites);
        Self::at_quantiles(sites, axis, &sampled_places(sites, axis), alpha, count)
    }

    /// `count` slabs with about equal shares of the sorted `places`.
    fn at_quantiles<K: Kernel>(
        sites: &Sites<K>,
        axis: usize,
        places: &[f64],
        alpha: f64,
        count: usize,
    ) -> Self {
        let margin = margin(sites, alpha);
        let mut cuts: Vec<f64> = (1..count)
            .map(|i| places[i * places.len() / count])
            .collect();
        cuts.dedup();
        // Where places are as coarse as alpha, no cut is safe.
        if margin > 2.0 * alpha {
            cuts.clear();
        }
        Self { axis, cuts, margin }
    }

    /// How many of the sorted `places` all slabs with their margins hold.
    fn with_margins(&self, places: &[f64]) -> f64 {
        let held = (0..self.len()).map(|slab| {
            let reach = self.reach(slab);
            let first = places.partition_point(|place| place < reach.start());
            places[first..].partition_point(|place| place <= reach.end())
        });
        held.sum::<usize>() as f64
    }

    /// `count` slabs whose points are their own.
    pub(crate) fn without_margin<K: Kernel>(sites: &Sites<K>, count: usize) -> Self {
        let mut slabs = Self::with_count(sites, f64::INFINITY, count);
        slabs.margin = 0.0;
        // Many points at the lowest place would leave the first slab empty.
        slabs.cuts.retain(|&cut| cut > sites.bounds.low[slabs.axis]);
        slabs
    }

    /// How many slabs there are.
    pub(crate) fn len(&self) -> usize {
        self.cuts.len() + 1
    }

    /// The slab that holds a place.
    #[inline]
    pub(crate) fn owner(&self, place_mm: [f64; 3]) -> usize {
        let along = place_mm[self.axis];
        self.cuts.partition_point(|&cut| cut <= along)
    }

    /// The slab that holds everything within `reach` of a place, if one does.
    #[inline]
    pub(crate) fn only_owner(&self, place_mm: [f64; 3], reach: f64) -> Option<usize> {
        let along = place_mm[self.axis];
        let owner = self.cuts.partition_point(|&cut| cut <= along - reach);
        let next = self.cuts.get(owner);
        next.is_none_or(|&cut| along + reach < cut).then_some(owner)
    }

    /// A slab, wider by the margin at each cut.
    fn reach(&self, slab: usize) -> RangeInclusive<f64> {
        let below = slab.checked_sub(1).map(|i| self.cuts[i] - self.margin);
        let above = self.cuts.get(slab).map(|cut| cut + self.margin);
        below.unwrap_or(f64::NEG_INFINITY)..=above.unwrap_or(f64::INFINITY)
    }

    /// The sites of each slab and its margins, in the order of ranks.
    fn share_out<K: Kernel>(&self, sites: &Sites<K>) -> Vec<Vec<Site<K::Scalar>>> {
        let share = |slab| {
            let reach = self.reach(slab);
            let along = |s: &&Site<K::Scalar>| sites.kernel.place_mm(&s.at)[self.axis];
            let is_near = |s: &&Site<K::Scalar>| reach.contains(&along(s));
            sites.sorted.iter().filter(is_near).copied().collect()
        };
        (0..self.len()).into_par_iter().map(share).collect()
    }

    /// Triangulates every slab and gives each triangulation, with its slab's number, to
    /// `harvest`. A slab may hold too few points, or a flat set of them: it has no cell, and
    /// nothing to harvest. The stage is `tetrahedra`.
    pub(crate) fn triangulate<K: Kernel, T: Send>(
        &self,
        sites: &Sites<K>,
        task: &Task,
        harvest: impl Fn(usize, &Triangulation<'_, K>) -> Result<T, DelaunayError> + Sync,
    ) -> Result<Vec<T>, DelaunayError> {
        let shares = self.share_out(sites);
        task.check()?;
        task.begin("tetrahedra", shares.iter().map(Vec::len).sum());
        let rooms = Rooms::new(shares.len());
        let harvests = shares.into_par_iter().enumerate().map(|(slab, share)| {
            let Some(found) = Triangulation::build(sites, &share, rooms.take(), task)? else {
                return Ok(None);
            };
            let harvested = harvest(slab, &found)?;
            rooms.give(found.into_room());
            Ok(Some(harvested))
        });
        let harvests: Vec<Option<T>> = harvests.collect::<Result<_, DelaunayError>>()?;
        Ok(harvests.into_iter().flatten().collect())
    }
}

/// Memory of cells that goes from slab to slab: new memory would cost a tenth of the time.
struct Rooms(Mutex<FreeRooms>);

struct FreeRooms {
    rooms: Vec<Vec<Cell>>,
    /// Slabs that have not asked for a room.
    waiting: usize,
}

impl Rooms {
    fn new(slabs: usize) -> Self {
        Self(Mutex::new(FreeRooms {
            rooms: Vec::new(),
            waiting: slabs,
        }))
    }

    fn take(&self) -> Vec<Cell> {
        let mut free = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        free.waiting -= 1;
        free.rooms.pop().unwrap_or_default()
    }

    /// Keeps a room for the next slab, or frees it while other threads are at work.
    fn give(&self, room: Vec<Cell>) {
        let mut free = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if free.waiting > 0 {
            free.rooms.push(room);
        }
    }
}

/// Places along an axis of evenly chosen sites, sorted.
fn sampled_places<K: Kernel>(sites: &Sites<K>, axis: usize) -> Vec<f64> {
    let stride = sites.sorted.len().div_ceil(SAMPLES).max(1);
    let sampled = sites.sorted.iter().step_by(stride);
    let places = sampled.map(|s| sites.kernel.place_mm(&s.at)[axis]);
    let mut places: Vec<f64> = places.collect();
    places.sort_unstable_by(f64::total_cmp);
    places
}

/// The axis of the largest extent, and that extent in mm.
fn longest_axis<K: Kernel>(sites: &Sites<K>) -> (usize, f64) {
    let extent = |k: usize| sites.bounds.high[k] - sites.bounds.low[k];
    let longer = |i: usize, j: usize| if extent(j) > extent(i) { j } else { i };
    let axis = longer(longer(0, 1), 2);
    (axis, extent(axis))
}

/// The reach of a ball of radius alpha, and room for the rounding of places and centres.
fn margin<K: Kernel>(sites: &Sites<K>, alpha: f64) -> f64 {
    alpha * (1.0 + ALPHA_ROUNDING) + 4.0 * sites.precision.place
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Points;
    use crate::boundary::single_facets_sorted;
    use crate::kept::Kept;
    use crate::points::AnySites;
    use crate::predicates::FreeKernel;
    use proptest::prelude::*;

    fn free_sites(points: &[[f64; 3]]) -> Option<Sites<FreeKernel>> {
        match AnySites::new(Points::Free(points), &Task::default()) {
            Ok(AnySites::Free(sites)) => Some(sites),
            _ => None,
        }
    }

    /// Ranks of cells and of boundary triangles.
    type Complex = (Vec<[u32; 4]>, Vec<[u32; 3]>);

    /// Cells of the whole triangulation that alpha keeps, and the boundary made from these.
    fn whole<K: Kernel>(sites: &Sites<K>, alpha: f64) -> Complex {
        let (cells, _) = in_pieces(sites, alpha, 1);
        let boundary = crate::Tetrahedra {
            cells: cells.clone(),
        };
        let boundary = boundary.boundary(&Task::default()).unwrap();
        (cells, boundary)
    }

    fn in_pieces<K: Kernel>(sites: &Sites<K>, alpha: f64, count: usize) -> Complex {
        let slabs = Slabs::with_count(sites, alpha, count);
        let found = slabs.triangulate(sites, &Task::default(), |slab, found| {
            let kept = Kept::new(found, alpha, &slabs, slab, &Task::default())?;
            assert_eq!(kept.count(), kept.ranks().len());
            Ok((kept.ranks(), kept.facets()))
        });
        let (cells, facets): (Vec<_>, Vec<_>) = found.unwrap().into_iter().unzip();
        let mut cells = cells.concat();
        cells.sort_unstable();
        let facets = facets.concat().into_par_iter();
        (
            cells,
            single_facets_sorted(facets, &Task::default()).unwrap(),
        )
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
            match AnySites::new(Points::Lattice { coordinates: &points, gram }, &Task::default()) {
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
        let Ok(AnySites::Upright(sites)) = AnySites::new(lattice, &Task::default()) else {
            panic!("an upright lattice");
        };
        let found = in_pieces(&sites, 2.0, 3);
        assert_eq!(found, whole(&sites, 2.0));
        assert!(found.0.len() >= 8 * 5);
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
        // A point far away makes the cloud longer, not its slabs thicker.
        let mut stray = long;
        stray.push([1e7, 0.0, 0.0]);
        let sites = free_sites(&stray).unwrap();
        assert!(Slabs::plan(&sites, 100.0).cuts.is_empty());
    }
}
