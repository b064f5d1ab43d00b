//! Steps 2 and 3 on one slice, and the scratch memory of all four.

use super::CannySettings;
use super::active::{ActiveSpans, Spans};
use super::hysteresis::{Candidate, Hysteresis};
use super::smoothing::Smoothing;

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
}

/// What an image may be made of.
pub(super) trait Pixel: Copy {
    /// The pixel's value in the arithmetic of the filters.
    fn value(self) -> f64;
}

impl Pixel for bool {
    fn value(self) -> f64 {
        f64::from(u8::from(self))
    }
}

impl Pixel for f64 {
    fn value(self) -> f64 {
        self
    }
}

/// Planes of one slice, reused from slice to slice.
///
/// Only the active spans of a plane hold values of the present slice; nothing else is read.
pub(super) struct Scratch {
    extent: Extent,
    smoothed: Vec<f64>,
    /// Derivative along a column, from row to row.
    down: Vec<f64>,
    /// Derivative along a row, from column to column.
    across: Vec<f64>,
    magnitude: Vec<f64>,
    line: Vec<f64>,
    candidates: Vec<Candidate>,
    hysteresis: Hysteresis,
}

impl Scratch {
    pub(super) fn new(extent: Extent) -> Self {
        let plane = vec![0.0; extent.pixels()];
        Self {
            extent,
            smoothed: plane.clone(),
            down: plane.clone(),
            across: plane.clone(),
            magnitude: plane,
            line: Vec::new(),
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
        smoothing.smooth(image, &spans.smoothed, &mut self.smoothed, &mut self.line);
        self.gradient(&spans.gradient);
        self.suppress(&spans.candidates, settings);
        self.hysteresis
            .connect(&self.candidates, self.extent.columns, edges);
    }

    /// Largest gradient magnitude of an image that is one everywhere: what rounding leaves.
    pub(super) fn gradient_of_ones(&mut self, smoothing: &Smoothing) -> f64 {
        let spans = ActiveSpans::all(self.extent);
        let ones = vec![true; self.extent.pixels()];
        smoothing.smooth(&ones, &spans.smoothed, &mut self.smoothed, &mut self.line);
        self.gradient(&spans.gradient);
        self.magnitude.iter().copied().fold(0.0, f64::max)
    }

    /// Step 2: Sobel's derivatives of the smoothed image and their magnitude.
    fn gradient(&mut self, spans: &Spans) {
        let Extent { rows, columns } = self.extent;
        for row in 0..rows {
            let line = |row: usize| &self.smoothed[row * columns..(row + 1) * columns];
            // Beyond the border the image is mirrored, which for one pixel means repeated.
            let three = [
                line(row.saturating_sub(1)),
                line(row),
                line((row + 1).min(rows - 1)),
            ];
            for &(start, end) in spans.of_row(row) {
                let (start, end) = (start as usize, end as usize);
                let here = row * columns + start..row * columns + end;
                let out = Derivatives {
                    down: &mut self.down[here.clone()],
                    across: &mut self.across[here.clone()],
                    magnitude: &mut self.magnitude[here],
                };
                out.fill(three, start);
            }
        }
    }

    /// Step 3: keeps the pixels that are a maximum along their gradient and reach `low`.
    fn suppress(&mut self, spans: &Spans, settings: CannySettings) {
        let Extent { rows, columns } = self.extent;
        let low = settings.effective_low();
        self.candidates.clear();
        for row in 1..rows.saturating_sub(1) {
            for &(start, end) in spans.of_row(row) {
                let (start, end) = ((start as usize).max(1), (end as usize).min(columns - 1));
                for pixel in row * columns + start..row * columns + end.max(start) {
                    let magnitude = self.magnitude[pixel];
                    if magnitude >= low && self.is_maximum(pixel) {
                        self.candidates.push(Candidate {
                            pixel: pixel as u32,
                            is_strong: magnitude >= settings.high,
                        });
                    }
                }
            }
        }
    }

    /// Whether no neighbour along the gradient is larger, interpolated between the pixel
    /// straight ahead and the diagonal one.
    fn is_maximum(&self, pixel: usize) -> bool {
        let columns = self.extent.columns as isize;
        let (down, across) = (self.down[pixel], self.across[pixel]);
        let (steep, flat) = (down.abs(), across.abs());
        let is_falling_diagonal = (down <= 0.0) == (across <= 0.0);
        // A gradient of exactly 45 degrees only looks at the diagonal, whichever case it takes.
        let is_steep = if is_falling_diagonal {
            steep > flat
        } else {
            steep >= flat
        };
        let vertical = if is_falling_diagonal {
            columns
        } else {
            -columns
        };
        let (straight, weight) = if is_steep {
            (vertical, flat / steep)
        } else {
            (1, steep / flat)
        };
        let diagonal = vertical + 1;
        let magnitude = self.magnitude[pixel];
        let at = |step: isize| self.magnitude[pixel.wrapping_add_signed(step)];
        let is_covered = |side: isize| {
            at(side * diagonal) * weight + at(side * straight) * (1.0 - weight) <= magnitude
        };
        is_covered(1) && is_covered(-1)
    }
}

/// Where the gradient of one span of a row goes.
struct Derivatives<'a> {
    down: &'a mut [f64],
    across: &'a mut [f64],
    magnitude: &'a mut [f64],
}

impl Derivatives<'_> {
    /// Computes the span that begins at column `start` from the rows above, here and below.
    fn fill(self, three: [&[f64]; 3], start: usize) {
        let columns = three[0].len();
        let end = start + self.down.len();
        let inner = start.max(1)..end.min(columns - 1).max(start.max(1));
        // Inside, plain slices of equal length let the compiler work on several pixels at once.
        let n = inner.len().min(end.saturating_sub(inner.start));
        let [above, here, below] = three.map(|row| {
            [
                &row[inner.start - 1..][..n],
                &row[inner.start..][..n],
                &row[(inner.start + 1).min(columns)..][..n],
            ]
        });
        let skip = inner.start - start;
        let (down, across) = (&mut self.down[skip..][..n], &mut self.across[skip..][..n]);
        let magnitude = &mut self.magnitude[skip..][..n];
        for i in 0..n {
            let square = [above, here, below].map(|row| [row[0][i], row[1][i], row[2][i]]);
            (down[i], across[i], magnitude[i]) = sobel(square);
        }
        let last = columns - 1;
        for column in [0, last] {
            if (start..end).contains(&column) {
                let (left, right) = (column.saturating_sub(1), (column + 1).min(last));
                let square = three.map(|row| [row[left], row[column], row[right]]);
                let at = column - start;
                (self.down[at], self.across[at], self.magnitude[at]) = sobel(square);
            }
        }
    }
}

/// Both derivatives and the magnitude at the centre of three by three pixels.
///
/// Each derivative is a difference followed by a weighted sum, in `SciPy`'s order; the term with
/// weight zero stays because it carries infinities and NaN.
fn sobel([above, here, below]: [[f64; 3]; 3]) -> (f64, f64, f64) {
    let difference = |before: f64, centre: f64, after: f64| centre * 0.0 + -(before - after);
    let weighted = |before: f64, centre: f64, after: f64| centre * 2.0 + (before + after);
    let vertical = |i: usize| difference(above[i], here[i], below[i]);
    let horizontal = |row: [f64; 3]| difference(row[0], row[1], row[2]);
    let down = weighted(vertical(0), vertical(1), vertical(2));
    let across = weighted(horizontal(above), horizontal(here), horizontal(below));
    (down, across, (down * down + across * across).sqrt())
}
