//! How often each Hounsfield value occurs.
//!
//! 1. `tally`: pieces of whole slices are counted in parallel, one table entry for each 16-bit
//!    value; counts are whole numbers, so the order in which they are added does not show.
//! 2. `Histogram::of`: what no tissue has is taken out, the rest goes into bins.

use std::num::NonZeroU16;

use bonemesh_task::{Cancelled, Task};
use ndarray::parallel::prelude::*;
use ndarray::{Array3, ArrayView2, Axis};

use crate::{Volume, Voxels};

/// Air at the end of the 12-bit scale. Nothing that a scanner measures lies below: such values
/// fill the corners outside the scanner's circle.
const LOWEST_HU: i32 = -1024;

/// Number of 16-bit values, each of which is counted by itself.
const VALUES: usize = 1 << 16;

/// Voxels that are counted into one table before it is added to the total: enough that adding
/// tables costs nothing beside counting.
const PIECE: usize = 1 << 21;

/// How often each Hounsfield value occurs in a volume.
///
/// The edges of the bins are whole multiples of their width. Bin `b` holds the values *above*
/// `edge_hu(b)` *up to and including* `edge_hu(b + 1)`: since bone is strictly above its
/// threshold, the bins from an edge on hold exactly the bone of a threshold at that edge, in
/// volumes of whole and of fractional values alike.
///
/// Values below -1024 HU are no tissue but padding (scanners write -2000 or -3024, for example)
/// and values from 32768 on are errors; both are counted, but in no bin, lest they pull at
/// thresholds. Padding of exactly -1024 cannot be told from air at the end of the 12-bit scale
/// and is counted as air, which it lies 24 HU from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Histogram {
    /// The lower edge of the first bin, in whole bin widths.
    first: i32,
    width_hu: NonZeroU16,
    counts: Vec<u64>,
    padding: u64,
    beyond: u64,
    not_numbers: u64,
}

impl Histogram {
    /// Counts the voxels of `volume` in bins of `width_hu`, from the first to the last that holds
    /// any.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn of(volume: &Volume, width_hu: NonZeroU16, task: &Task) -> Result<Self, Cancelled> {
        let tally = match volume.voxels() {
            Voxels::I16(hu) => tally(hu, |v| Kind::Value(i32::from(v)), task),
            Voxels::F32(hu) => tally(hu, kind, task),
        }?;
        let padding = tally.below + tally.values[..index(LOWEST_HU)].iter().sum::<u64>();
        let mut histogram = Self::from_values(&tally.values, width_hu);
        histogram.padding = padding;
        histogram.beyond = tally.beyond;
        histogram.not_numbers = tally.not_numbers;
        Ok(histogram)
    }

    /// A histogram of known `counts`, the first of them for the values above
    /// `first * width_hu`.
    pub fn from_counts(first: i16, width_hu: NonZeroU16, counts: Vec<u64>) -> Self {
        Self {
            first: i32::from(first),
            width_hu,
            counts,
            padding: 0,
            beyond: 0,
            not_numbers: 0,
        }
    }

    /// Bins of what is not padding in a table with an entry for each 16-bit value.
    fn from_values(values: &[u64], width_hu: NonZeroU16) -> Self {
        let tissue = index(LOWEST_HU)..VALUES;
        let occupied = |i: &usize| values[*i] > 0;
        let ends = (tissue.clone().find(occupied), tissue.rev().find(occupied));
        let (Some(lowest), Some(highest)) = ends else {
            return Self::from_counts(0, width_hu, Vec::new());
        };
        // The bin above `first` holds `value`: the edge is the last multiple below it.
        let bin = |i: usize| (value(i) - 1).div_euclid(i32::from(width_hu.get()));
        let first = bin(lowest);
        let mut counts = vec![0; (bin(highest) - first) as usize + 1];
        for i in lowest..=highest {
            counts[(bin(i) - first) as usize] += values[i];
        }
        Self {
            first,
            ..Self::from_counts(0, width_hu, counts)
        }
    }

    /// Voxels in each bin, by rising values; none where the volume holds but padding.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// Width of a bin in HU.
    pub fn width_hu(&self) -> NonZeroU16 {
        self.width_hu
    }

    /// Edge number `edge` in HU, from 0 (below the first bin) to the number of bins.
    pub fn edge_hu(&self, edge: usize) -> f64 {
        (f64::from(self.first) + edge as f64) * f64::from(self.width_hu.get())
    }

    /// Every edge in HU: one more than there are bins.
    pub fn edges_hu(&self) -> Vec<f64> {
        (0..=self.counts.len()).map(|e| self.edge_hu(e)).collect()
    }

    /// Voxels in all bins.
    pub fn voxels(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Voxels of padding: below -1024 HU.
    pub fn padding(&self) -> u64 {
        self.padding
    }

    /// Voxels beyond 32767 HU.
    pub fn beyond(&self) -> u64 {
        self.beyond
    }

    /// Voxels that are no number.
    pub fn not_numbers(&self) -> u64 {
        self.not_numbers
    }
}

/// What a voxel is counted as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The least whole number that is not below it.
    Value(i32),
    Below,
    Beyond,
    NotANumber,
}

/// Rounding up keeps a fractional value on its side of every whole threshold.
fn kind(hu: f32) -> Kind {
    let up = hu.ceil();
    if up.is_nan() {
        Kind::NotANumber
    } else if hu < LOWEST_HU as f32 {
        Kind::Below
    } else if up > f32::from(i16::MAX) {
        Kind::Beyond
    } else {
        Kind::Value(up as i32)
    }
}

/// Where the table counts `hu`.
fn index(hu: i32) -> usize {
    (hu - i32::from(i16::MIN)) as usize
}

/// What entry `index` of the table counts.
fn value(index: usize) -> i32 {
    index as i32 + i32::from(i16::MIN)
}

/// Counts of single values.
struct Tally {
    values: Vec<u64>,
    below: u64,
    beyond: u64,
    not_numbers: u64,
}

impl Tally {
    fn new() -> Self {
        Self {
            values: vec![0; VALUES],
            below: 0,
            beyond: 0,
            not_numbers: 0,
        }
    }

    /// Both together.
    fn plus(mut self, other: &Self) -> Self {
        for (sum, more) in self.values.iter_mut().zip(&other.values) {
            *sum += more;
        }
        self.below += other.below;
        self.beyond += other.beyond;
        self.not_numbers += other.not_numbers;
        self
    }
}

fn tally<T: Copy + Sync>(
    hu: &Array3<T>,
    kind: impl Fn(T) -> Kind + Sync,
    task: &Task,
) -> Result<Tally, Cancelled> {
    let (slices, rows, columns) = hu.dim();
    let piece = (PIECE / (rows * columns).max(1)).max(1);
    task.begin("histogram", slices);
    hu.axis_chunks_iter(Axis(0), piece)
        .into_par_iter()
        .try_fold(Tally::new, |mut tally, slices| {
            for slice in slices.outer_iter() {
                count(&slice, &kind, &mut tally, task)?;
                task.advance(1)?;
            }
            Ok(tally)
        })
        .try_reduce(Tally::new, |a, b| Ok(a.plus(&b)))
}

/// Rows that are counted between two looks at the switch.
const ROWS: usize = 256;

fn count<T: Copy>(
    slice: &ArrayView2<'_, T>,
    kind: &impl Fn(T) -> Kind,
    tally: &mut Tally,
    task: &Task,
) -> Result<(), Cancelled> {
    for rows in slice.axis_chunks_iter(Axis(0), ROWS) {
        task.check()?;
        for hu in rows {
            match kind(*hu) {
                Kind::Value(hu) => tally.values[index(hu)] += 1,
                Kind::Below => tally.below += 1,
                Kind::Beyond => tally.beyond += 1,
                Kind::NotANumber => tally.not_numbers += 1,
            }
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(
    clippy::float_cmp,
    reason = "edges are whole numbers, which floating point holds exactly"
)]
mod tests {
    use super::*;
    use crate::{Affine, Geometry};
    use bonemesh_task::pool;
    use proptest::prelude::*;
    use std::num::NonZeroUsize;

    fn volume(voxels: Voxels) -> Volume {
        let shape = voxels.shape();
        let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        let geometry = Geometry::new(shape, affine).unwrap();
        Volume::new(voxels, geometry).unwrap()
    }

    fn row<T: Clone>(values: &[T]) -> Array3<T> {
        Array3::from_shape_vec([1, 1, values.len()], values.to_vec()).unwrap()
    }

    fn histogram(voxels: Voxels, width: u16) -> Histogram {
        let width = NonZeroU16::new(width).unwrap();
        Histogram::of(&volume(voxels), width, &Task::default()).unwrap()
    }

    #[test]
    fn a_bin_ends_with_its_upper_edge() {
        let h = histogram(Voxels::I16(row(&[-10, -9, 0, 1, 10, 11])), 10);
        assert_eq!(h.edges_hu(), [-20.0, -10.0, 0.0, 10.0, 20.0]);
        assert_eq!(h.counts(), [1, 2, 2, 1]);
    }

    #[test]
    fn fractions_stay_on_their_side_of_a_whole_threshold() {
        let h = histogram(Voxels::F32(row(&[349.5, 350.0, 350.25, 351.0])), 1);
        assert_eq!(h.edges_hu(), [349.0, 350.0, 351.0]);
        assert_eq!(h.counts(), [2, 2]);
    }

    #[test]
    fn padding_is_counted_but_in_no_bin() {
        let whole = histogram(Voxels::I16(row(&[-32768, -2000, -1025, -1024, 40])), 1);
        assert_eq!((whole.padding(), whole.voxels()), (3, 2));
        assert_eq!(whole.edge_hu(0), -1025.0);
        let values = [
            f32::NEG_INFINITY,
            -2000.0,
            -1024.5,
            -1024.0,
            40.0,
            4e9,
            f32::NAN,
        ];
        let fractional = histogram(Voxels::F32(row(&values)), 1);
        assert_eq!((fractional.padding(), fractional.voxels()), (3, 2));
        assert_eq!((fractional.beyond(), fractional.not_numbers()), (1, 1));
        assert_eq!(fractional.counts(), whole.counts());
    }

    #[test]
    fn a_volume_of_padding_has_no_bins() {
        let h = histogram(Voxels::I16(row(&[-2000; 7])), 16);
        assert_eq!((h.counts().len(), h.padding()), (0, 7));
        assert_eq!(h.edges_hu().len(), 1);
    }

    #[test]
    fn the_counts_are_the_same_for_any_number_of_threads() {
        let hu = Array3::from_shape_fn([90, 160, 160], |(k, j, i)| {
            ((k * 7919 + j * 104_729 + i * 31) % 5000) as i16 - 1500
        });
        let volume = volume(Voxels::I16(hu));
        let width = NonZeroU16::new(7).unwrap();
        let counted = [1, 2, 3, 8].map(|n| {
            let pool = pool(NonZeroUsize::new(n)).unwrap();
            pool.install(|| Histogram::of(&volume, width, &Task::default()).unwrap())
        });
        assert_eq!(counted[0].voxels() + counted[0].padding(), 90 * 160 * 160);
        assert!(counted.iter().all(|h| *h == counted[0]));
    }

    #[test]
    fn cancelling_stops_the_count() {
        let task = Task::default();
        task.cancel().cancel();
        let volume = volume(Voxels::I16(row(&[1, 2, 3])));
        assert!(Histogram::of(&volume, NonZeroU16::MIN, &task).is_err());
    }

    proptest! {
        #[test]
        fn every_edge_splits_the_voxels_as_a_threshold_does(
            values in prop::collection::vec(-1200.0_f32..3200.0, 1..200),
            width in 1_u16..300,
        ) {
            let h = histogram(Voxels::F32(row(&values)), width);
            let tissue = values.iter().filter(|v| **v >= -1024.0);
            for edge in 0..h.edges_hu().len() {
                let above: u64 = h.counts()[edge..].iter().sum();
                let bone = tissue.clone().filter(|v| f64::from(**v) > h.edge_hu(edge)).count();
                prop_assert_eq!(above, bone as u64);
            }
        }

        #[test]
        fn whole_and_floating_volumes_agree(
            values in prop::collection::vec(any::<i16>(), 1..200),
            width in 1_u16..300,
        ) {
            let float: Vec<f32> = values.iter().map(|v| f32::from(*v)).collect();
            let whole = histogram(Voxels::I16(row(&values)), width);
            prop_assert_eq!(whole, histogram(Voxels::F32(row(&float)), width));
        }
    }
}
