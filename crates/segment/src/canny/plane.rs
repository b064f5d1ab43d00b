//! All steps on one slice, row by row: a row is smoothed, the one above it gets its gradient, the
//! one above that is suppressed. So each value is used while it is near.

use std::ops::Range;

use super::CannySettings;
use super::active::{ActiveSpans, Spans};
use super::hysteresis::{Candidate, Hysteresis};
use super::smoothing::{Lines, Smoothing};

/// Rows and columns of a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Extent {
    pub(super) rows: usize,
    pub(super) columns: usize,
}

impl Extent {
    pub(super) fn pixels(self) -> usize {
        self.rows * self.columns
    }

    /// Where a row is kept in a plane of [`Scratch`].
    fn kept(self, row: usize) -> Range<usize> {
        let start = row % KEPT * self.columns;
        start..start + self.columns
    }

    /// Where a smoothed row is kept, with one pixel more on both sides.
    fn kept_wider(self, row: usize) -> Range<usize> {
        let start = row % KEPT * (self.columns + 2);
        start..start + self.columns + 2
    }
}

/// What an image may be made of.
pub(super) trait Pixel: Copy {
    /// Whether there are but two values.
    const IS_BINARY: bool;

    /// The pixel's value in the arithmetic of the filters.
    fn value(self) -> f64;

    /// The value of a binary pixel.
    fn bit(self) -> u16;
}

impl Pixel for bool {
    const IS_BINARY: bool = true;

    fn value(self) -> f64 {
        f64::from(u8::from(self))
    }

    fn bit(self) -> u16 {
        u16::from(self)
    }
}

impl Pixel for f64 {
    const IS_BINARY: bool = false;

    fn value(self) -> f64 {
        self
    }

    fn bit(self) -> u16 {
        u16::from(self != 0.0)
    }
}

/// Rows of a plane that are kept: one on each side of a row, in a power of two.
const KEPT: usize = 4;

/// The last rows of each plane, which stay in the processor's nearest cache, and other memory
/// that is reused from slice to slice.
///
/// Only the active spans of a row hold its values; nothing else is read.
pub(super) struct Scratch {
    extent: Extent,
    /// Rows are one pixel wider on both sides: beyond the border the image is mirrored, which for
    /// one pixel means repeated.
    smoothed: Vec<f64>,
    /// Derivative along a column, from row to row.
    down: Vec<f64>,
    /// Derivative along a row, from column to column.
    across: Vec<f64>,
    magnitude: Vec<f64>,
    lines: Lines,
    /// Columns of a row's span whose magnitude reaches `low`.
    reaching: Vec<u32>,
    candidates: Vec<Candidate>,
    hysteresis: Hysteresis,
}

impl Scratch {
    pub(super) fn new(extent: Extent) -> Self {
        let plane = vec![0.0; KEPT * extent.columns];
        Self {
            extent,
            smoothed: vec![0.0; KEPT * (extent.columns + 2)],
            down: plane.clone(),
            across: plane.clone(),
            magnitude: plane,
            lines: Lines::new(extent),
            reaching: vec![0; extent.columns],
            candidates: Vec::new(),
            hysteresis: Hysteresis::new(extent.pixels()),
        }
    }

    /// Sets the edge pixels of `image` in `edges`, which is all false before.
    pub(super) fn find_edges<P: Pixel>(
        &mut self,
        image: &[P],
        smoothing: &Smoothing,
        settings: CannySettings,
        spans: &ActiveSpans,
        edges: &mut [bool],
    ) {
        let rows = self.extent.rows;
        self.candidates.clear();
        smoothing.begin(image, &mut self.lines);
        // Each step needs one row more of the step before it.
        for row in 0..=rows {
            if row < rows {
                self.smooth(image, smoothing, row, &spans.smoothed);
            }
            if row > 0 {
                self.gradient(row - 1, &spans.gradient);
            }
            if row > 2 {
                self.suppress(row - 2, &spans.candidates, settings);
            }
        }
        self.hysteresis
            .connect(&self.candidates, self.extent.columns, edges);
    }

    /// Largest gradient magnitude of an image that is one everywhere: what rounding leaves.
    pub(super) fn gradient_of_ones(&mut self, smoothing: &Smoothing) -> f64 {
        let rows = self.extent.rows;
        let spans = ActiveSpans::all(self.extent);
        let ones = vec![true; self.extent.pixels()];
        smoothing.begin(&ones, &mut self.lines);
        let mut most = 0.0;
        for row in 0..=rows {
            if row < rows {
                self.smooth(&ones, smoothing, row, &spans.smoothed);
            }
            if row > 0 {
                self.gradient(row - 1, &spans.gradient);
            }
            most = self.magnitude.iter().copied().fold(most, f64::max);
        }
        most
    }

    /// Step 1 for one row.
    fn smooth<P: Pixel>(&mut self, image: &[P], smoothing: &Smoothing, row: usize, spans: &Spans) {
        let columns = self.extent.columns;
        let wider = &mut self.smoothed[self.extent.kept_wider(row)];
        smoothing.smooth_row(image, row, spans, &mut self.lines, &mut wider[1..=columns]);
        wider[0] = wider[1];
        wider[columns + 1] = wider[columns];
    }

    /// Step 2 for one row: Sobel's derivatives of the smoothed image and their magnitude.
    fn gradient(&mut self, row: usize, spans: &Spans) {
        let extent = self.extent;
        let rows = [row.saturating_sub(1), row, (row + 1).min(extent.rows - 1)];
        for &(start, end) in spans.of_row(row) {
            let (start, end) = (start as usize, end as usize);
            let square = rows.map(|row| &self.smoothed[extent.kept_wider(row)][start..end + 2]);
            let first = extent.kept(row).start;
            let here = first + start..first + end;
            sobel(
                square,
                &mut self.down[here.clone()],
                &mut self.across[here.clone()],
                &mut self.magnitude[here],
            );
        }
    }

    /// Step 3 for one row that is not on the border: keeps the pixels that are a maximum along
    /// their gradient and reach `low`.
    ///
    /// Candidates are appended without a branch each, since no processor can guess them.
    fn suppress(&mut self, row: usize, spans: &Spans, settings: CannySettings) {
        let (extent, magnitude, low) = (self.extent, &self.magnitude, settings.effective_low());
        let (columns, here) = (extent.columns, extent.kept(row));
        let ridge = Ridge {
            magnitude: [row - 1, row, row + 1].map(|row| &magnitude[extent.kept(row)]),
            down: &self.down[here.clone()],
            across: &self.across[here],
        };
        let [_, here, _] = ridge.magnitude;
        for &(start, end) in spans.of_row(row) {
            let (start, end) = ((start as usize).max(1), (end as usize).min(columns - 1));
            let mut reaching = 0;
            for (column, magnitude) in (start..end).zip(&here[start.min(end)..end]) {
                self.reaching[reaching] = column as u32;
                reaching += usize::from(*magnitude >= low);
            }
            let known = self.candidates.len();
            self.candidates
                .resize(known + reaching, Candidate::default());
            let mut len = known;
            for column in &self.reaching[..reaching] {
                let column = *column as usize;
                self.candidates[len] = Candidate {
                    pixel: (row * columns + column) as u32,
                    is_strong: here[column] >= settings.high,
                };
                len += usize::from(ridge.is_maximum(column));
            }
            self.candidates.truncate(len);
        }
    }
}

/// The gradients of a row, with the magnitudes of the rows above and below.
struct Ridge<'a> {
    magnitude: [&'a [f64]; 3],
    down: &'a [f64],
    across: &'a [f64],
}

impl Ridge<'_> {
    /// Whether no neighbour along the gradient is larger, interpolated between the pixel
    /// straight ahead and the diagonal one.
    ///
    /// Written without branches: which way a bone's border runs, no processor can guess.
    fn is_maximum(&self, column: usize) -> bool {
        let (down, across) = (self.down[column], self.across[column]);
        let (steep, flat) = (down.abs(), across.abs());
        let is_falling_diagonal = (down <= 0.0) == (across <= 0.0);
        // A gradient of exactly 45 degrees only looks at the diagonal, whichever case it takes.
        let is_steep = if is_falling_diagonal {
            steep > flat
        } else {
            steep >= flat
        };
        // One neighbour lies in the row `ahead` to the right, the other in the row `behind` to
        // the left.
        let [above, here, below] = self.magnitude;
        let (ahead, behind) = if is_falling_diagonal {
            (below, above)
        } else {
            (above, below)
        };
        let (straight_ahead, straight_behind) = if is_steep {
            (ahead[column], behind[column])
        } else {
            (here[column + 1], here[column - 1])
        };
        let (less, more) = if is_steep {
            (flat, steep)
        } else {
            (steep, flat)
        };
        let weight = less / more;
        let magnitude = here[column];
        let is_covered = |diagonal: f64, straight: f64| {
            diagonal * weight + straight * (1.0 - weight) <= magnitude
        };
        is_covered(ahead[column + 1], straight_ahead)
            & is_covered(behind[column - 1], straight_behind)
    }
}

/// Both derivatives of a span of a row and their magnitudes, from the rows above, here and below
/// that begin and end one pixel further out.
///
/// Each derivative is a difference followed by a weighted sum, in `SciPy`'s order.
fn sobel(square: [&[f64]; 3], down: &mut [f64], across: &mut [f64], magnitude: &mut [f64]) {
    let n = magnitude.len();
    // Plain slices of equal length let the compiler work on several pixels at once.
    let [above, here, below] = square.map(|row| [&row[..n], &row[1..][..n], &row[2..][..n]]);
    let (down, across) = (&mut down[..n], &mut across[..n]);
    let weighted = |before: f64, centre: f64, after: f64| centre * 2.0 + (before + after);
    for i in 0..n {
        let vertical = |side: usize| below[side][i] - above[side][i];
        down[i] = weighted(vertical(0), vertical(1), vertical(2));
    }
    for i in 0..n {
        let horizontal = |row: [&[f64]; 3]| row[2][i] - row[0][i];
        across[i] = weighted(horizontal(above), horizontal(here), horizontal(below));
    }
    for i in 0..n {
        magnitude[i] = (down[i] * down[i] + across[i] * across[i]).sqrt();
    }
}
