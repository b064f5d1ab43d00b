//! Step 1: the Gaussian, corrected for the image's border.
//!
//! Over rows a binary image has few sums: the nine pixels above each other that a Gaussian of
//! sigma 1 weighs can be black or white in 512 ways. Their sums are looked up.

use super::active::Spans;
use super::kernel::gaussian_weights;
use super::plane::{Extent, Pixel};

/// The largest radius for which sums over rows are looked up.
const TABLE_RADIUS: usize = 4;

/// Ways in which so many pixels can be black or white.
const TABLE_SIZE: usize = 1 << (2 * TABLE_RADIUS + 1);

/// The Gaussian of one sigma for images of one size.
pub(super) struct Smoothing {
    extent: Extent,
    /// Weight at distance 0, 1, .. radius.
    weights: Vec<f64>,
    /// Gaussian of an image of ones plus epsilon, one row for each class of rows: rows that
    /// reach equally far beyond the image share one.
    border: Vec<f64>,
    /// The weighted sum of a column of pixels whose values are the bits of the index.
    table: Option<Box<[f64; TABLE_SIZE]>>,
}

/// Scratch memory of one worker.
pub(super) struct Lines {
    /// Sums over rows.
    line: Vec<f64>,
    /// For each column the pixels that the Gaussian weighs, from the lowest bit down the image.
    codes: Vec<u16>,
}

impl Lines {
    pub(super) fn new(extent: Extent) -> Self {
        Self {
            line: Vec::new(),
            codes: vec![0; extent.columns],
        }
    }
}

impl Smoothing {
    pub(super) fn new(sigma: f64, extent: Extent) -> Self {
        let weights = gaussian_weights(sigma);
        let mut smoothing = Self {
            extent,
            weights,
            border: Vec::new(),
            table: None,
        };
        let classes = extent.rows.min(2 * smoothing.radius() + 1);
        smoothing.border = Vec::with_capacity(classes * extent.columns);
        for class in 0..classes {
            smoothing.push_border(class, classes);
        }
        smoothing.fill_table();
        smoothing
    }

    /// Fills the table, in the order in which `weigh_rows` adds.
    fn fill_table(&mut self) {
        let radius = self.radius();
        if radius > TABLE_RADIUS {
            return;
        }
        let mut table = Box::new([0.0; TABLE_SIZE]);
        for (code, sum) in table.iter_mut().enumerate() {
            let bit = |at: usize| (code >> at & 1) as f64;
            *sum = bit(radius) * self.weights[0];
            for distance in (1..=radius).rev() {
                let pair = bit(radius - distance) + bit(radius + distance);
                *sum += pair * self.weights[distance];
            }
        }
        self.table = Some(table);
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

    /// Gets `lines` ready for the first row of `image`.
    pub(super) fn begin<P: Pixel>(&self, image: &[P], lines: &mut Lines) {
        lines.codes.fill(0);
        for row in 0..self.radius() {
            self.enter_row(image, row, lines);
        }
    }

    /// Pushes a row of pixels, black beyond the image, into the codes of a binary image.
    fn enter_row<P: Pixel>(&self, image: &[P], row: usize, lines: &mut Lines) {
        if !P::IS_BINARY || self.table.is_none() {
            return;
        }
        let (columns, top) = (self.extent.columns, 2 * self.radius());
        if row >= self.extent.rows {
            lines.codes.iter_mut().for_each(|code| *code >>= 1);
            return;
        }
        let pixels = &image[row * columns..(row + 1) * columns];
        for (code, pixel) in lines.codes.iter_mut().zip(pixels) {
            *code = *code >> 1 | pixel.bit() << top;
        }
    }

    /// Writes the smoothed pixels of a row at `spans`; rows come one after the other.
    pub(super) fn smooth_row<P: Pixel>(
        &self,
        image: &[P],
        row: usize,
        spans: &Spans,
        lines: &mut Lines,
        smoothed: &mut [f64],
    ) {
        self.enter_row(image, row + self.radius(), lines);
        let border = self.border_of(row);
        for &(start, end) in spans.of_row(row) {
            let (start, end) = (start as usize, end as usize);
            let Lines { line, codes } = lines;
            match &self.table {
                Some(table) if P::IS_BINARY => self.look_up_rows(table, codes, start, end, line),
                _ => self.weigh_rows(image, row, start, end, line),
            }
            let (out, ones) = (&mut smoothed[start..end], &border[start..end]);
            match self.weights.first_chunk::<5>() {
                // The default sigma: with its number of terms known, they stay in registers.
                Some(weights) if self.radius() == 4 => weigh_nine_columns(weights, line, ones, out),
                _ => self.weigh_columns(line, ones, out),
            }
        }
    }

    /// What `weigh_rows` does, for a binary image.
    fn look_up_rows(
        &self,
        table: &[f64; TABLE_SIZE],
        codes: &[u16],
        start: usize,
        end: usize,
        line: &mut Vec<f64>,
    ) {
        let radius = self.radius();
        let (first, last) = (
            start.saturating_sub(radius),
            (end + radius).min(codes.len()),
        );
        line.clear();
        line.resize(first + radius - start, 0.0);
        let sums = codes[first..last].iter();
        line.extend(sums.map(|code| table[*code as usize % TABLE_SIZE]));
        line.resize(end - start + 2 * radius, 0.0);
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

    /// The Gaussian over columns of `line`, which reaches `radius` beyond `out` on both sides,
    /// divided by that of `ones`.
    fn weigh_columns(&self, line: &[f64], ones: &[f64], out: &mut [f64]) {
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
        for (value, ones) in out.iter_mut().zip(ones) {
            *value /= ones;
        }
    }
}

/// `weigh_columns` for a radius of 4.
fn weigh_nine_columns(weights: &[f64; 5], line: &[f64], ones: &[f64], out: &mut [f64]) {
    let n = out.len();
    let [a, b, c, d, centre, e, f, g, h] = std::array::from_fn(|shift| &line[shift..][..n]);
    let ones = &ones[..n];
    for i in 0..n {
        let mut sum = centre[i] * weights[0];
        sum += (a[i] + h[i]) * weights[4];
        sum += (b[i] + g[i]) * weights[3];
        sum += (c[i] + f[i]) * weights[2];
        sum += (d[i] + e[i]) * weights[1];
        out[i] = sum / ones[i];
    }
}
