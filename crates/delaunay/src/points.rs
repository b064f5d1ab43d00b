//! From the caller's points to distinct sites in the order of their coordinates.

use bonemesh_task::Task;
use rayon::prelude::*;

use crate::DelaunayError;
use crate::predicates::{AnyLattice, FreeKernel, Kernel, Site};
use crate::sphere::Precision;
use crate::triangulation::{Span, span};

/// Smallest size of a free coordinate other than 0: the fifth power of its last bit is a double.
const SMALLEST: f64 = 1e-45;
/// Largest size of a free coordinate: an in-sphere determinant stays finite.
const LARGEST: f64 = 1e55;

/// Sites that one thread looks at in one go.
const SITES_PER_CHUNK: usize = 1 << 14;

/// The points to tetrahedralise.
#[derive(Clone, Copy, Debug)]
pub enum Points<'a> {
    /// Integer coordinates with the metric of their axes.
    Lattice {
        /// Coordinates of each point; they may span up to 32,767 steps along each axis.
        coordinates: &'a [[i32; 3]],
        /// The squared length in mm of `v` is `v^T gram v`: symmetric, positive definite. It is
        /// rounded to `2^-40` of its largest entry, and exact in what follows.
        gram: [[f64; 3]; 3],
    },
    /// Free points in mm.
    Free(&'a [[f64; 3]]),
}

impl Points<'_> {
    /// How many points there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Lattice { coordinates, .. } => coordinates.len(),
            Self::Free(points) => points.len(),
        }
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Distinct points, sorted by z, then y, then x; a site's rank is its place here.
pub(crate) struct Sites<K: Kernel> {
    pub(crate) kernel: K,
    pub(crate) sorted: Vec<Site<K::Scalar>>,
    /// Index in the input of each site; of equal points, the lowest.
    pub(crate) input: Vec<u32>,
    pub(crate) bounds: Bounds,
    pub(crate) precision: Precision,
}

/// Smallest and largest coordinates of places in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: [f64; 3],
    pub(crate) high: [f64; 3],
}

impl Bounds {
    /// Of no place: infinite and upside down.
    const NONE: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// Of any places.
    pub(crate) fn of(places: impl Iterator<Item = [f64; 3]>) -> Self {
        let mut bounds = Self::NONE;
        for place in places {
            for (k, v) in place.into_iter().enumerate() {
                bounds.low[k] = bounds.low[k].min(v);
                bounds.high[k] = bounds.high[k].max(v);
            }
        }
        bounds
    }

    fn with(self, other: Self) -> Self {
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(other.low[k])),
            high: [0, 1, 2].map(|k| self.high[k].max(other.high[k])),
        }
    }

    /// The coordinate that is largest in size.
    fn largest(&self) -> f64 {
        let all = self.low.iter().chain(&self.high);
        all.fold(0.0, |largest, v| v.abs().max(largest))
    }
}

/// [`Sites`] of any kind.
pub(crate) enum AnySites {
    Upright(Sites<crate::predicates::LatticeKernel<false>>),
    Tilted(Sites<crate::predicates::LatticeKernel<true>>),
    Free(Sites<FreeKernel>),
}

impl AnySites {
    /// Checks the points, and that they span space.
    pub(crate) fn new(points: Points<'_>, task: &Task) -> Result<Self, DelaunayError> {
        // Positions, cells and this crate's sort keys hold indices in 32 bits.
        if points.len() > crate::triangulation::CELL_LIMIT {
            return Err(DelaunayError::TooMany {
                points: points.len(),
                limit: crate::triangulation::CELL_LIMIT,
            });
        }
        match points {
            Points::Lattice { coordinates, gram } => {
                let (low, extent) = bounds(coordinates);
                let kernel = AnyLattice::new(gram, extent)?;
                task.check()?;
                let sorted = sorted_lattice(coordinates, low);
                task.check()?;
                Ok(match kernel {
                    AnyLattice::Upright(k) => Self::Upright(Sites::new(k, &sorted, points)?),
                    AnyLattice::Tilted(k) => Self::Tilted(Sites::new(k, &sorted, points)?),
                })
            }
            Points::Free(free) => {
                let sorted = sorted_free(free)?;
                task.check()?;
                Ok(Self::Free(Sites::new(FreeKernel, &sorted, points)?))
            }
        }
    }
}

/// Distinct coordinates in order, each with its lowest index in the input.
type Sorted<S> = Vec<([S; 3], u32)>;

/// Smallest coordinates, and the largest minus the smallest.
fn bounds(coordinates: &[[i32; 3]]) -> ([i32; 3], [i64; 3]) {
    let first = coordinates.first().copied().unwrap_or_default();
    let (low, high) = coordinates.iter().fold((first, first), |(low, high), p| {
        (
            [0, 1, 2].map(|k| p[k].min(low[k])),
            [0, 1, 2].map(|k| p[k].max(high[k])),
        )
    });
    let extent = [0, 1, 2].map(|k| i64::from(high[k]) - i64::from(low[k]));
    (low, extent)
}

/// Coordinates from `low` on (they span less than 2^15).
fn sorted_lattice(coordinates: &[[i32; 3]], low: [i32; 3]) -> Sorted<i32> {
    let mut keys: Vec<(u64, u32)> = coordinates
        .par_iter()
        .zip(0u32..coordinates.len() as u32)
        .map(|(p, i)| {
            let [x, y, z] = [0, 1, 2].map(|k| p[k].abs_diff(low[k]));
            (u64::from(z) << 30 | u64::from(y) << 15 | u64::from(x), i)
        })
        .collect();
    // Clouds come from slices row by row, so they are sorted already.
    if !keys.is_sorted() {
        keys.par_sort_unstable();
    }
    keys.dedup_by_key(|(key, _)| *key);
    let coordinate = |key: u64, shift: u32| (key >> shift & 0x7fff) as i32;
    keys.into_par_iter()
        .map(|(key, i)| {
            let [x, y, z] = [coordinate(key, 0), coordinate(key, 15), coordinate(key, 30)];
            ([x, y, z], i)
        })
        .collect()
}

fn sorted_free(points: &[[f64; 3]]) -> Result<Sorted<f64>, DelaunayError> {
    let sound = |v: f64| v == 0.0 || (SMALLEST..=LARGEST).contains(&v.abs());
    for (point, p) in points.iter().enumerate() {
        if let Some(&value) = p.iter().find(|&&v| !sound(v)) {
            return Err(DelaunayError::Coordinate { point, value });
        }
    }
    // Adding 0 makes -0 and 0 one coordinate.
    let mut sorted: Sorted<f64> = points
        .iter()
        .zip(0..)
        .map(|(p, i)| (p.map(|v| v + 0.0), i))
        .collect();
    sorted.par_sort_unstable_by(|(a, i), (b, j)| {
        let order = |k: usize| a[k].total_cmp(&b[k]);
        order(2).then(order(1)).then(order(0)).then(i.cmp(j))
    });
    sorted.dedup_by_key(|(p, _)| p.map(f64::to_bits));
    Ok(sorted)
}

impl<K: Kernel> Sites<K> {
    fn new(
        kernel: K,
        sorted: &[([K::Scalar; 3], u32)],
        points: Points<'_>,
    ) -> Result<Self, DelaunayError> {
        let distinct = sorted.len();
        if distinct < 4 {
            let points = points.len();
            return Err(DelaunayError::TooFew { points, distinct });
        }
        match span(&kernel, sorted.iter().map(|(at, _)| at)) {
            Span::Space(_) => {}
            Span::Plane => return Err(DelaunayError::Coplanar { distinct }),
            Span::Line | Span::Point => return Err(DelaunayError::Collinear { distinct }),
        }
        let input = sorted.par_iter().map(|&(_, input)| input).collect();
        let ranked = sorted.par_iter().zip(0u32..distinct as u32);
        let sorted: Vec<Site<K::Scalar>> =
            ranked.map(|(&(at, _), rank)| Site { at, rank }).collect();
        let bounds = sorted.par_chunks(SITES_PER_CHUNK);
        let bounds = bounds.map(|sites| Bounds::of(sites.iter().map(|s| kernel.place_mm(&s.at))));
        let bounds = bounds.reduce(|| Bounds::NONE, Bounds::with);
        Ok(Self {
            precision: Precision::new(kernel.difference_error(), bounds.largest()),
            kernel,
            sorted,
            input,
            bounds,
        })
    }
}
