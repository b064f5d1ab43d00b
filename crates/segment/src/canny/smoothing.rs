//! Step 1: the Gaussian, corrected for the image's border.

use super::active::Spans;
use super::kernel::gaussian_weights;
use super::plane::{Extent, Pixel};

/// The Gaussian of one sigma for images of one size.
pub(super) struct Smoothing {
    extent: Extent,
    /// Weight at distance 0, 1, .. radius.
    weights: Vec<f64>,
    /// Gaussian of an image of ones plus epsilon, one row for each class of rows: rows that
    /// reach equally far beyond the image share one.
    border: Vec<f64>,
}

impl Smoothing {
    pub(super) fn new(sigma: f64, extent: Extent) -> Self {
        let weights = gaussian_weights(sigma);
        let mut smoothing = Self {
            extent,
            weights,
            border: Vec::new(),
        };
        let classes = extent.rows.min(2 * smoothing.radius() + 1);
        smoothing.border = Vec::with_capacity(classes * extent.columns);
        for class in 0..classes {
            smoothing.push_border(class, classes);
        }
        smoothing
    }

    /// Reach of the Gaussian in pixels.
    pub(super) fn radius(&self) -> usize {
        self.weights.len() - 1
    }

    /// Appends the border correction of row `class` of an image of `rows` rows.
    fn push_border(&mut self, class: usize, rows: usize) {
        let columns = self.extent.columns;
        let down = self.weigh_ones(1.0, class, rows);
        for column in 0..columns {
            let both = self.weigh_ones(down, column, columns);
            self.border.push(both + f64::EPSILON);
        }
    }

    /// The weighted sum at `at` of a line of `length` pixels that all hold `value`.
    fn weigh_ones(&self, value: f64, at: usize, length: usize) -> f64 {
        let mut sum = value * self.weights[0];
        for distance in (1..self.weights.len().min(length)).rev() {
            let before = if at >= distance { value } else { 0.0 };
            let after = if at + distance < length { value } else { 0.0 };
            sum += (before + after) * self.weights[distance];
        }
        sum
    }

    /// The border correction of a row of the image.
    fn border_of(&self, row: usize) -> &[f64] {
        let (rows, radius) = (self.extent.rows, self.radius());
        let below = rows - 1 - row;
        let class = if rows <= 2 * radius || row < radius {
            row
        } else {
            2 * radius - below.min(radius)
        };
        let columns = self.extent.columns;
        &self.border[class * columns..][..columns]
    }

    /// Writes the smoothed image at `spans`; `line` is scratch.
    pub(super) fn smooth<P: Pixel>(
        &self,
        image: &[P],
        spans: &Spans,
        smoothed: &mut [f64],
        line: &mut Vec<f64>,
    ) {
        let columns = self.extent.columns;
        for row in 0..self.extent.rows {
            let border = self.border_of(row);
            for &(start, end) in spans.of_row(row) {
                let (start, end) = (start as usize, end as usize);
                self.weigh_rows(image, row, start, end, line);
                let out = &mut smoothed[row * columns + start..row * columns + end];
                self.weigh_columns(line, out);
                for (value, ones) in out.iter_mut().zip(&border[start..end]) {
                    *value /= ones;
                }
            }
        }
    }

    /// Fills `line` with the Gaussian over rows for the columns from `start - radius` up to
    /// `end + radius`, zero outside the image.
    fn weigh_rows<P: Pixel>(
        &self,
        image: &[P],
        row: usize,
        start: usize,
        end: usize,
        line: &mut Vec<f64>,
    ) {
        let (Extent { rows, columns }, radius) = (self.extent, self.radius());
        line.clear();
        line.resize(end - start + 2 * radius, 0.0);
        let (first, last) = (start.saturating_sub(radius), (end + radius).min(columns));
        let line = &mut line[first + radius - start..last + radius - start];
        let pixels = |row: usize| &image[row * columns + first..row * columns + last];
        for (sum, centre) in line.iter_mut().zip(pixels(row)) {
            *sum = centre.value() * self.weights[0];
        }
        for distance in (1..self.weights.len().min(rows)).rev() {
            let weight = self.weights[distance];
            let (above, below) = (row >= distance, row + distance < rows);
            match (above, below) {
                (true, true) => {
                    let pairs = pixels(row - distance).iter().zip(pixels(row + distance));
                    for (sum, (above, below)) in line.iter_mut().zip(pairs) {
                        *sum += (above.value() + below.value()) * weight;
                    }
                }
                (false, false) => {}
                _ => {
                    let inside = if above {
                        row - distance
                    } else {
                        row + distance
                    };
                    for (sum, pixel) in line.iter_mut().zip(pixels(inside)) {
                        *sum += pixel.value() * weight;
                    }
                }
            }
        }
    }

    /// The Gaussian over columns of `line`, which reaches `radius` beyond `out` on both sides.
    fn weigh_columns(&self, line: &[f64], out: &mut [f64]) {
        let radius = self.radius();
        let n = out.len();
        for (sum, centre) in out.iter_mut().zip(&line[radius..]) {
            *sum = centre * self.weights[0];
        }
        for distance in (1..=radius).rev() {
            let weight = self.weights[distance];
            let before = &line[radius - distance..][..n];
            let after = &line[radius + distance..][..n];
            for (sum, (before, after)) in out.iter_mut().zip(before.iter().zip(after)) {
                *sum += (before + after) * weight;
            }
        }
    }
}
