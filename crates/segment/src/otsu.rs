//! Thresholds that split a histogram into classes as unlike each other as can be.
//!
//! Otsu's criterion (1979), for several thresholds as Liao et al. (2001) state it: the sum over
//! the classes of (sum of values)² / (number of voxels) is largest. It depends on two classes at
//! a time only through their border, so the best split is found exactly by dynamic programming
//! over the bins; since the best border never moves back as the bins it splits grow, each pass
//! takes n log n steps instead of n². The steps, each named as its function is:
//! 1. `occupied`: empty bins cannot hold a border and are left out;
//! 2. `best_borders`: for each number of classes, the best split of every first part of the bins;
//! 3. `halfway`: a border between two occupied bins is put in the middle of the empty ones
//!    between them, which all split the voxels alike.
//!
//! Sources: N. Otsu, "A threshold selection method from gray-level histograms", IEEE Transactions
//! on Systems, Man, and Cybernetics 9(1), 1979; P.-S. Liao, T.-S. Chen, P.-C. Chung, "A fast
//! algorithm for multilevel thresholding", Journal of Information Science and Engineering 17(5),
//! 2001.

use std::ops::Range;

use bonemesh_volume::Histogram;

use crate::{HuThreshold, SegmentError};

/// Most classes that a histogram is split into.
const MAX_CLASSES: usize = 5;

/// The threshold that splits the voxels into two classes with the largest variance between them.
///
/// Limits: of a whole patient in air the two classes are air and body; use
/// [`multi_otsu`] with three classes for bone. A class of few voxels is drowned by large ones.
///
/// # Errors
/// [`SegmentError::TooFewValues`] when the histogram has fewer than two occupied bins.
pub fn otsu(histogram: &Histogram) -> Result<HuThreshold, SegmentError> {
    Ok(multi_otsu(histogram, 2)?[0])
}

/// The thresholds, rising, that split the voxels into 2 to 5 classes with the largest variance
/// between them: one to four thresholds.
///
/// A head in air, for example, falls into air, soft tissue and bone. Exact for the histogram
/// given: bins of 1 HU lose nothing.
///
/// # Errors
/// [`SegmentError::Classes`] for another number of classes, [`SegmentError::TooFewValues`] when
/// fewer bins are occupied than there are classes.
pub fn multi_otsu(histogram: &Histogram, classes: usize) -> Result<Vec<HuThreshold>, SegmentError> {
    if !(2..=MAX_CLASSES).contains(&classes) {
        return Err(SegmentError::Classes(classes));
    }
    let bins = occupied(histogram);
    if bins.len() < classes {
        return Err(SegmentError::TooFewValues {
            occupied: bins.len(),
            classes,
        });
    }
    let borders = Split::new(histogram, &bins).best_borders(classes);
    borders
        .into_iter()
        .map(|border| HuThreshold::new(halfway(histogram, bins[border - 1], bins[border])))
        .collect()
}

/// Numbers of the bins that hold any voxel.
fn occupied(histogram: &Histogram) -> Vec<usize> {
    let counts = histogram.counts();
    (0..counts.len()).filter(|b| counts[*b] > 0).collect()
}

/// The edge in the middle between the bin `below` a border and the next occupied one.
fn halfway(histogram: &Histogram, below: usize, above: usize) -> f64 {
    // Bin `b` ends with edge `b + 1`, and any edge up to `above` splits the voxels alike.
    histogram.edge_hu(usize::midpoint(below + 1, above + 1))
}

/// Sums over the first bins, from which a class's share of the criterion follows.
struct Split {
    /// Voxels in the first `i` occupied bins.
    voxels: Vec<f64>,
    /// Sum of the values in them, counted from the mean.
    values: Vec<f64>,
}

impl Split {
    fn new(histogram: &Histogram, bins: &[usize]) -> Self {
        let counts = histogram.counts();
        let total: u64 = histogram.voxels();
        let sum: u128 = bins
            .iter()
            .map(|b| u128::from(counts[*b]) * *b as u128)
            .sum();
        // Values near zero keep their squares from losing digits; any whole number will do.
        let mean = (sum / u128::from(total.max(1))) as i128;
        let (mut voxels, mut values) = (0_u64, 0_i128);
        let mut split = Self {
            voxels: vec![0.0],
            values: vec![0.0],
        };
        for bin in bins {
            voxels += counts[*bin];
            values += i128::from(counts[*bin]) * (*bin as i128 - mean);
            split.voxels.push(voxels as f64);
            split.values.push(values as f64);
        }
        split
    }

    /// What a class of these bins adds to the criterion.
    fn share(&self, bins: Range<usize>) -> f64 {
        let voxels = self.voxels[bins.end] - self.voxels[bins.start];
        let values = self.values[bins.end] - self.values[bins.start];
        values * values / voxels
    }

    /// The first bin of every class but the lowest.
    fn best_borders(&self, classes: usize) -> Vec<usize> {
        let bins = self.voxels.len() - 1;
        let mut best: Vec<f64> = (0..=bins)
            .map(|end| if end == 0 { 0.0 } else { self.share(0..end) })
            .collect();
        let mut borders = Vec::new();
        for classes in 2..=classes {
            let mut pass = Pass {
                split: self,
                before: &best,
                best: vec![f64::NEG_INFINITY; bins + 1],
                border: vec![0; bins + 1],
            };
            // Each class before the last needs a bin of its own.
            pass.solve(classes..bins + 1, classes - 1..bins);
            let Pass {
                best: now, border, ..
            } = pass;
            best = now;
            borders.push(border);
        }
        let mut end = bins;
        let mut found: Vec<usize> = borders
            .iter()
            .rev()
            .map(|border| {
                end = border[end];
                end
            })
            .collect();
        found.reverse();
        found
    }
}

/// One more class behind the best splits so far.
struct Pass<'a> {
    split: &'a Split,
    /// The criterion of the best split of the first `i` bins into one class less.
    before: &'a [f64],
    best: Vec<f64>,
    border: Vec<usize>,
}

impl Pass<'_> {
    /// Finds the best border for each of `ends`, all of which lie in `borders`: first for the
    /// one in the middle, which confines those on both sides of it.
    fn solve(&mut self, ends: Range<usize>, borders: Range<usize>) {
        if ends.is_empty() {
            return;
        }
        let end = usize::midpoint(ends.start, ends.end);
        for border in borders.start..borders.end.min(end) {
            let criterion = self.before[border] + self.split.share(border..end);
            if criterion > self.best[end] {
                self.best[end] = criterion;
                self.border[end] = border;
            }
        }
        let border = self.border[end];
        self.solve(ends.start..end, borders.start..border + 1);
        self.solve(end + 1..ends.end, border..borders.end);
    }
}

#[cfg(test)]
#[allow(
    clippy::float_cmp,
    reason = "thresholds are edges, which are whole numbers"
)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::num::NonZeroU16;

    fn histogram(counts: &[u64]) -> Histogram {
        Histogram::from_counts(0, NonZeroU16::MIN, counts.to_vec())
    }

    /// The criterion of the classes that begin with bin 0 and with each of `borders`.
    fn criterion(counts: &[u64], borders: &[usize]) -> f64 {
        let mut ends = vec![0];
        ends.extend(borders);
        ends.push(counts.len());
        let share = |bins: &[usize]| {
            let class = bins[0]..bins[1];
            let voxels: u64 = counts[class.clone()].iter().sum();
            let values: u64 = class.map(|b| counts[b] * b as u64).sum();
            (values * values) as f64 / voxels as f64
        };
        ends.windows(2).map(share).sum()
    }

    /// Every way to put `borders` into bins 1 to `bins`.
    fn all_borders(borders: usize, from: usize, bins: usize) -> Vec<Vec<usize>> {
        if borders == 0 {
            return vec![Vec::new()];
        }
        (from..bins)
            .flat_map(|first| {
                all_borders(borders - 1, first + 1, bins)
                    .into_iter()
                    .map(move |mut rest| {
                        rest.insert(0, first);
                        rest
                    })
            })
            .collect()
    }

    #[test]
    fn two_values_are_split_halfway() {
        let mut counts = vec![0; 1241];
        counts[40] = 9000;
        counts[1240] = 10;
        // Bin 40 holds the value 41, bin 1240 the value 1241.
        assert_eq!(otsu(&histogram(&counts)).unwrap().hu(), 641.0);
    }

    #[test]
    fn three_values_are_split_halfway() {
        let mut counts = vec![0; 2401];
        (counts[0], counts[1040], counts[2240]) = (70_000, 20_000, 900);
        let found: Vec<f64> = multi_otsu(&histogram(&counts), 3)
            .unwrap()
            .iter()
            .map(|t| t.hu())
            .collect();
        assert_eq!(found, [521.0, 1641.0]);
    }

    #[test]
    fn fewer_values_than_classes_are_refused() {
        let one = otsu(&histogram(&[0, 17, 0])).unwrap_err().to_string();
        assert!(one.contains("1 different value"), "{one}");
        assert!(multi_otsu(&histogram(&[1, 1]), 3).is_err());
        assert!(multi_otsu(&histogram(&[]), 2).is_err());
        for classes in [0, 1, 6] {
            let refused = multi_otsu(&histogram(&[1; 9]), classes);
            assert!(matches!(refused, Err(SegmentError::Classes(_))));
        }
    }

    proptest! {
        #[test]
        fn no_other_thresholds_split_better(
            counts in prop::collection::vec(0_u64..50, 5..14),
            classes in 2_usize..=5,
        ) {
            let occupied: Vec<u64> = counts.iter().copied().filter(|c| *c > 0).collect();
            prop_assume!(occupied.len() >= classes);
            let found = multi_otsu(&histogram(&counts), classes).unwrap();
            // Bin b holds the value b + 1, so the first bin above threshold t is bin t.
            let borders: Vec<usize> = found.iter().map(|t| t.hu() as usize).collect();
            let ours = criterion(&counts, &borders);
            let best = all_borders(classes - 1, 1, counts.len())
                .iter()
                .map(|b| criterion(&counts, b))
                .filter(|c| !c.is_nan())
                .fold(0.0, f64::max);
            prop_assert!(ours >= best * (1.0 - 1e-12), "{borders:?}: {ours} < {best}");
        }
    }
}
