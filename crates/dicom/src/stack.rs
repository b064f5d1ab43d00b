//! Slices along their common normal: an even grid, and which slices each grid place takes.
//!
//! 1. [`Grid::new`]: the distances between neighbours decide the grid's step. Slices on whole
//!    multiples of it are missing neighbours; anything else is resampled.
//! 2. [`Grid::sources`]: each place of the grid takes a slice that lies on it, or a blend of the
//!    two slices around it. Slices that turn out unreadable are simply not offered.

use std::fmt;

use crate::report::Gap;

/// Deviation, in steps, up to which slices count as even.
const EVEN: f64 = 0.01;

/// Deviation, in steps, up to which a slice is taken to lie on its grid place.
const ON_GRID: f64 = 0.05;

/// Share of the distances that a step must have to set the grid: a stray pair must not.
const MIN_SHARE: usize = 10;

/// Most grid places for one slice; finer grids would invent more than they keep.
const MAX_FILL: usize = 8;

/// Distance, in steps, from which slices are said to lie apart.
const WIDE: f64 = 1.5;

/// Places of the volume's slices along the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    pub(crate) first_mm: f64,
    pub(crate) step_mm: f64,
    pub(crate) count: usize,
}

/// How the slices lie on their grid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Evenness {
    Even,
    /// Off by at most [`ON_GRID`]; taken as even.
    Nearly {
        off_mm: f64,
    },
    Missing {
        gaps: Vec<Gap>,
    },
    /// Distances from `low_mm` to `high_mm`, resampled to the grid's step.
    Uneven {
        low_mm: f64,
        high_mm: f64,
        step_mm: f64,
        /// Where a step or more of the grid has no slice.
        gaps: Vec<Gap>,
    },
}

impl Evenness {
    /// Where slices are missing.
    pub(crate) fn into_gaps(self) -> Vec<Gap> {
        match self {
            Self::Missing { gaps } | Self::Uneven { gaps, .. } => gaps,
            Self::Even | Self::Nearly { .. } => Vec::new(),
        }
    }
}

impl fmt::Display for Evenness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Even => write!(f, "slices are evenly spaced"),
            Self::Nearly { off_mm } => write!(
                f,
                "slices lie up to {off_mm:.3} mm off even spacing; taken as even"
            ),
            Self::Missing { gaps } => {
                let places: Vec<String> =
                    gaps.iter().map(|g| format!("{:.2}", g.after_mm)).collect();
                let slices: usize = gaps.iter().map(|g| g.missing).sum();
                let plural = if slices == 1 { " is" } else { "s are" };
                write!(
                    f,
                    "{slices} slice{plural} missing (after {} mm along the stack); filled by linear interpolation",
                    places.join(", ")
                )
            }
            Self::Uneven {
                low_mm,
                high_mm,
                step_mm,
                ..
            } => write!(
                f,
                "slice distances vary from {low_mm:.3} to {high_mm:.3} mm; resampled to {step_mm:.3} mm by linear interpolation"
            ),
        }
    }
}

/// Where a place of the grid gets its pixels from; numbers count the slices offered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Source {
    Slice(usize),
    /// Between slice `.0` and the next, the fraction of the way to the next.
    Blend(usize, f64),
}

impl Grid {
    /// The grid for slices at `along` (mm, ascending, at least two, all different).
    pub(crate) fn new(along: &[f64]) -> (Self, Evenness) {
        let first_mm = along[0];
        let total = along[along.len() - 1] - first_mm;
        let steps: Vec<f64> = along.windows(2).map(|w| w[1] - w[0]).collect();
        let base = significant_step(&steps, total);
        let places = lattice(&steps, base);
        let last = places.last().copied().unwrap_or(1).max(1);
        let even = Self {
            first_mm,
            step_mm: total / last as f64,
            count: last + 1,
        };
        let off_mm = places
            .iter()
            .zip(&along[1..])
            .map(|(place, at)| (even.at(*place) - at).abs())
            .fold(0.0, f64::max);
        let off = off_mm / even.step_mm;
        let (low_mm, high_mm) = (
            steps.iter().copied().fold(f64::INFINITY, f64::min),
            steps.iter().copied().fold(0.0, f64::max),
        );
        let missing = last - steps.len().min(last);
        let uneven = |step_mm| Evenness::Uneven {
            low_mm,
            high_mm,
            step_mm,
            gaps: gaps(along, step_mm),
        };
        if off > ON_GRID {
            let count = (total / base - 1e-6).ceil().max(1.0) as usize;
            let step_mm = total / count as f64;
            let grid = Self {
                first_mm,
                step_mm,
                count: count + 1,
            };
            (grid, uneven(step_mm))
        } else if missing > 0 {
            let gaps = gaps(along, even.step_mm);
            // Gaps here and there are missing slices; as a rule they are another spacing.
            let evenness = if 4 * gaps.len() > steps.len() && steps.len() > 4 {
                uneven(even.step_mm)
            } else {
                Evenness::Missing { gaps }
            };
            (even, evenness)
        } else if off > EVEN {
            (even, Evenness::Nearly { off_mm })
        } else {
            (even, Evenness::Even)
        }
    }

    /// What a user should know where most slices of the volume are none of the scanner's.
    pub(crate) fn note(&self, found: usize) -> Option<String> {
        let between = self.count.saturating_sub(found);
        (between > found).then(|| {
            format!(
                "more slices are interpolated than found: {found} were found, {between} are filled in between; check that the series is complete"
            )
        })
    }

    /// Place `index` (mm along the normal).
    pub(crate) fn at(&self, index: usize) -> f64 {
        self.first_mm + self.step_mm * index as f64
    }

    /// Sources for the places between the first and the last slice offered, and the number of
    /// the first such place. `along` (mm) ascends.
    pub(crate) fn sources(&self, along: &[f64]) -> (usize, Vec<Source>) {
        let place = |mm: f64| (mm - self.first_mm) / self.step_mm;
        let tolerance = ON_GRID * 1.001;
        let (Some(first), Some(last)) = (along.first(), along.last()) else {
            return (0, Vec::new());
        };
        let begin = (place(*first) - tolerance).ceil().max(0.0) as usize;
        let end = ((place(*last) + tolerance).floor() as usize).min(self.count - 1);
        let mut after = 0;
        let sources = (begin..=end)
            .map(|index| {
                let at = self.at(index);
                while after + 2 < along.len() && along[after + 1] <= at {
                    after += 1;
                }
                let nearest = if along.len() > after + 1
                    && (along[after + 1] - at).abs() < (along[after] - at).abs()
                {
                    after + 1
                } else {
                    after
                };
                if (place(along[nearest]) - index as f64).abs() <= tolerance {
                    return Source::Slice(nearest);
                }
                let (low, high) = (along[after], along[after + 1]);
                Source::Blend(after, ((at - low) / (high - low)).clamp(0.0, 1.0))
            })
            .collect();
        (begin, sources)
    }
}

/// Where slices lie so far apart that at least one of the grid's fits between.
fn gaps(along: &[f64], step_mm: f64) -> Vec<Gap> {
    let wide = along.windows(2).filter(|w| w[1] - w[0] > WIDE * step_mm);
    let gap = |w: &[f64]| Gap {
        after_mm: w[0],
        missing: ((w[1] - w[0]) / step_mm).round() as usize - 1,
    };
    wide.map(gap).collect()
}

/// Whole grid places of the second and later slices.
fn lattice(steps: &[f64], base: f64) -> Vec<usize> {
    steps
        .iter()
        .scan(0, |place, step| {
            *place += (step / base).round() as usize;
            Some(*place)
        })
        .collect()
}

/// The smallest distance that enough neighbours have.
fn significant_step(steps: &[f64], total: f64) -> f64 {
    let mut sorted = steps.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let floor = total / (steps.len() * MAX_FILL) as f64;
    let mut begin = 0;
    for end in 1..=sorted.len() {
        let is_end = end == sorted.len() || sorted[end] > sorted[begin] * (1.0 + 2.0 * ON_GRID);
        if is_end {
            let cluster = &sorted[begin..end];
            let step = cluster[cluster.len() / 2];
            if cluster.len() * MIN_SHARE >= sorted.len() && step >= floor {
                return step;
            }
            begin = end;
        }
    }
    sorted[sorted.len() / 2].max(floor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn missing_slices_are_whole_multiples() {
        let along = [0.0, 1.5, 3.0, 7.5, 9.0, 10.5];
        let (grid, evenness) = Grid::new(&along);
        assert_eq!(grid.count, 8);
        assert!((grid.step_mm - 1.5).abs() < 1e-12);
        let expected = Evenness::Missing {
            gaps: vec![Gap {
                after_mm: 3.0,
                missing: 2,
            }],
        };
        assert_eq!(evenness, expected);
        let (begin, sources) = grid.sources(&along);
        assert_eq!(begin, 0);
        assert_eq!(sources[2], Source::Slice(2));
        assert_eq!(sources[3], Source::Blend(2, 1.0 / 3.0));
        assert_eq!(sources[5], Source::Slice(3));
    }

    #[test]
    fn a_coarser_second_half_keeps_the_finer_step() {
        let along = [0.0, 1.5, 3.0, 4.5, 7.5, 10.5, 13.5, 16.5];
        let (grid, evenness) = Grid::new(&along);
        assert!((grid.step_mm - 1.5).abs() < 1e-12);
        assert_eq!(grid.count, 12);
        assert!(matches!(evenness, Evenness::Uneven { .. }));
        let expected = [4.5, 7.5, 10.5, 13.5].map(|after_mm| Gap {
            after_mm,
            missing: 1,
        });
        assert_eq!(evenness.into_gaps(), expected);
        assert_eq!(grid.note(8), None);
        assert!(grid.note(5).is_some());
    }

    #[test]
    fn positions_rounded_by_the_scanner_are_even() {
        let along: Vec<f64> = (0..50)
            .map(|i| (f64::from(i) * 62.5).round() / 100.0)
            .collect();
        let (grid, evenness) = Grid::new(&along);
        assert_eq!((grid.count, evenness), (50, Evenness::Even));
        let tenths: Vec<f64> = (0..50)
            .map(|i| (f64::from(i) * 12.5).round() / 10.0)
            .collect();
        let (grid, evenness) = Grid::new(&tenths);
        assert_eq!(grid.count, 50);
        assert!(matches!(evenness, Evenness::Nearly { .. }));
    }

    #[test]
    fn a_stray_pair_does_not_set_the_step() {
        let mut along: Vec<f64> = (0..40).map(f64::from).collect();
        along.insert(20, 19.3);
        let (grid, evenness) = Grid::new(&along);
        assert!((grid.step_mm - 1.0).abs() < 1e-9);
        assert!(matches!(evenness, Evenness::Uneven { .. }));
    }

    #[test]
    fn unreadable_slices_at_the_ends_shorten_the_grid() {
        let (grid, _) = Grid::new(&[0.0, 1.0, 2.0, 3.0, 4.0]);
        let (begin, sources) = grid.sources(&[1.0, 3.0]);
        assert_eq!(begin, 1);
        let expected = [Source::Slice(0), Source::Blend(0, 0.5), Source::Slice(1)];
        assert_eq!(sources, expected);
    }

    proptest! {
        #[test]
        fn every_place_lies_between_the_slices_it_is_made_of(
            steps in proptest::collection::vec(0.05..5.0f64, 1..40),
        ) {
            let along: Vec<f64> = std::iter::once(0.0)
                .chain(steps.iter().scan(0.0, |at, s| { *at += s; Some(*at) }))
                .collect();
            let (grid, _) = Grid::new(&along);
            prop_assert!(grid.count <= along.len() * MAX_FILL + 1);
            prop_assert!((grid.at(grid.count - 1) - along[along.len() - 1]).abs() < 1e-9);
            let (begin, sources) = grid.sources(&along);
            prop_assert_eq!((begin, sources.len()), (0, grid.count));
            for (index, source) in sources.into_iter().enumerate() {
                let mm = match source {
                    Source::Slice(k) => along[k],
                    Source::Blend(k, t) => {
                        prop_assert!((0.0..=1.0).contains(&t));
                        along[k] + t * (along[k + 1] - along[k])
                    }
                };
                prop_assert!((mm - grid.at(index)).abs() <= 0.051 * grid.step_mm);
            }
        }
    }
}
