//! Where there is work: the pixels near a transition of a binary image.
//!
//! A pixel's gradient is zero unless the square from which it is computed (the Gaussian's radius
//! plus one for Sobel's filter) holds both values, and then it holds two neighbours that differ.
//! So edges can lie only near such pairs. Rows are packed into bits: 64 pixels are looked at in
//! one operation, and empty ones cost nothing.

use super::plane::Extent;

/// Column ranges `start..end` of each row, ascending and apart.
#[derive(Default)]
pub(super) struct Spans {
    ranges: Vec<(u32, u32)>,
    /// Where each row's ranges begin in `ranges`.
    first: Vec<usize>,
}

impl Spans {
    fn clear(&mut self) {
        self.ranges.clear();
        self.first.clear();
        self.first.push(0);
    }

    fn close_row(&mut self) {
        self.first.push(self.ranges.len());
    }

    /// The ranges of a row.
    pub(super) fn of_row(&self, row: usize) -> &[(u32, u32)] {
        &self.ranges[self.first[row]..self.first[row + 1]]
    }

    /// Adds to the open row the runs of ones in `words`, each grown by `reach` on both sides.
    fn push_runs(&mut self, words: &[u64], columns: usize, reach: usize) {
        let open = *self
            .first
            .last()
            .expect("clear() opens a row, else this is a bug");
        for (index, word) in words.iter().enumerate() {
            let mut word = *word;
            while word != 0 {
                let skip = word.trailing_zeros();
                let ones = (word >> skip).trailing_ones();
                let begin = index * 64 + skip as usize;
                let start = begin.saturating_sub(reach) as u32;
                let end = (begin + ones as usize + reach).min(columns) as u32;
                match self.ranges[open..].last_mut() {
                    Some(last) if last.1 >= start => last.1 = last.1.max(end),
                    _ => self.ranges.push((start, end)),
                }
                word &= u64::MAX.checked_shl(skip + ones).unwrap_or(0);
            }
        }
    }
}

/// Where each step works; every step reads one pixel further than it writes.
#[derive(Default)]
pub(super) struct ActiveSpans {
    /// Pixels that may be an edge.
    pub(super) candidates: Spans,
    /// Pixels whose gradient those are compared with.
    pub(super) gradient: Spans,
    /// Pixels whose smoothed value those need.
    pub(super) smoothed: Spans,
}

impl ActiveSpans {
    /// Every pixel.
    pub(super) fn all(extent: Extent) -> Self {
        let mut spans = Self::default();
        for spans in spans.each() {
            spans.clear();
            for _ in 0..extent.rows {
                spans.ranges.push((0, extent.columns as u32));
                spans.close_row();
            }
        }
        spans
    }

    /// From the innermost to the outermost.
    fn each(&mut self) -> [&mut Spans; 3] {
        [&mut self.candidates, &mut self.gradient, &mut self.smoothed]
    }
}

/// Finds the active spans of binary images of one size.
pub(super) struct Active {
    extent: Extent,
    /// Farthest pixel on which a gradient depends.
    reach: usize,
    words: usize,
    /// A row of packed pixels, and the one below it.
    packed: [Vec<u64>; 2],
    /// Bits of the pixels that differ from the one to the right or below.
    transitions: Vec<u64>,
    /// Transitions in reach above or below a row.
    nearby: Vec<u64>,
    spans: ActiveSpans,
}

impl Active {
    /// For a Gaussian of `radius` pixels.
    pub(super) fn new(extent: Extent, radius: usize) -> Self {
        let words = extent.columns.div_ceil(64);
        Self {
            extent,
            reach: radius + 1,
            words,
            packed: [vec![0; words], vec![0; words]],
            transitions: vec![0; words * extent.rows],
            nearby: vec![0; words],
            spans: ActiveSpans::default(),
        }
    }

    /// The spans in which `image` can hold edges.
    pub(super) fn around_transitions(&mut self, image: &[bool]) -> &ActiveSpans {
        self.mark_transitions(image);
        let Self {
            extent,
            reach,
            words,
            transitions,
            nearby,
            spans,
            ..
        } = self;
        let (rows, words) = (extent.rows, *words);
        let row_of = |row: usize| &transitions[row * words..(row + 1) * words];
        for spans in spans.each() {
            spans.clear();
        }
        for row in 0..rows {
            nearby.fill(0);
            let mut include = |from: usize, to: usize| {
                for near in from..to {
                    for (sum, word) in nearby.iter_mut().zip(row_of(near)) {
                        *sum |= word;
                    }
                }
            };
            include(row.saturating_sub(*reach), (row + *reach + 1).min(rows));
            for (further, spans) in spans.each().into_iter().enumerate() {
                let reach = *reach + further;
                if further > 0 {
                    if let Some(above) = row.checked_sub(reach) {
                        or_into(nearby, row_of(above));
                    }
                    if row + reach < rows {
                        or_into(nearby, row_of(row + reach));
                    }
                }
                spans.push_runs(nearby, extent.columns, reach);
                spans.close_row();
            }
        }
        &self.spans
    }

    /// Sets the bit of each pixel that differs from its right or lower neighbour.
    fn mark_transitions(&mut self, image: &[bool]) {
        let Extent { rows, columns } = self.extent;
        let [row_bits, below_bits] = &mut self.packed;
        pack(&image[..columns], row_bits);
        for row in 0..rows {
            let marks = &mut self.transitions[row * self.words..(row + 1) * self.words];
            mark_right(row_bits, columns, marks);
            if row + 1 < rows {
                pack(&image[(row + 1) * columns..(row + 2) * columns], below_bits);
                for (mark, (here, below)) in
                    marks.iter_mut().zip(row_bits.iter().zip(below_bits.iter()))
                {
                    *mark |= here ^ below;
                }
            }
            std::mem::swap(row_bits, below_bits);
        }
    }
}

fn or_into(sum: &mut [u64], words: &[u64]) {
    for (sum, word) in sum.iter_mut().zip(words) {
        *sum |= word;
    }
}

/// Writes the bits of pixels that differ from the one to their right.
fn mark_right(row: &[u64], columns: usize, marks: &mut [u64]) {
    for (index, mark) in marks.iter_mut().enumerate() {
        let next = row.get(index + 1).map_or(0, |word| word << 63);
        *mark = row[index] ^ (row[index] >> 1 | next);
    }
    // The last column has no right neighbour.
    marks[(columns - 1) / 64] &= !(1 << ((columns - 1) % 64));
}

/// Packs a row of pixels, first pixel into the lowest bit.
fn pack(pixels: &[bool], words: &mut [u64]) {
    for (word, pixels) in words.iter_mut().zip(pixels.chunks(64)) {
        *word = 0;
        let (whole, rest) = pixels.as_chunks::<8>();
        for (index, eight) in whole.iter().enumerate() {
            // Byte k holds 0 or 1 at bit 8k; the product gathers these at bits 56 + k.
            let bytes = u64::from_le_bytes(eight.map(u8::from));
            let bits = bytes.wrapping_mul(0x0102_0408_1020_4080) >> 56;
            *word |= bits << (8 * index);
        }
        for (index, pixel) in rest.iter().enumerate() {
            *word |= u64::from(*pixel) << (8 * whole.len() + index);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Whether the square of `reach` around a pixel holds both values.
    fn holds_both(image: &[bool], extent: Extent, row: usize, column: usize, reach: usize) -> bool {
        let mut seen = [false; 2];
        for r in row.saturating_sub(reach)..(row + reach + 1).min(extent.rows) {
            for c in column.saturating_sub(reach)..(column + reach + 1).min(extent.columns) {
                seen[usize::from(image[r * extent.columns + c])] = true;
            }
        }
        seen == [true; 2]
    }

    proptest! {
        #[test]
        fn every_pixel_that_sees_a_transition_is_active(
            rows in 1..40_usize,
            columns in 1..150_usize,
            radius in 0..5_usize,
            marks in prop::collection::vec((0..40_usize, 0..150_usize), 0..6),
            ground in any::<bool>(),
        ) {
            let extent = Extent { rows, columns };
            let mut image = vec![ground; rows * columns];
            for (row, column) in marks {
                if row < rows && column < columns {
                    image[row * columns + column] = !ground;
                }
            }
            let mut active = Active::new(extent, radius);
            let spans = active.around_transitions(&image);
            let all = [&spans.candidates, &spans.gradient, &spans.smoothed];
            for (further, spans) in all.into_iter().enumerate() {
                for row in 0..rows {
                    let ranges = spans.of_row(row);
                    prop_assert!(ranges.windows(2).all(|w| w[0].1 < w[1].0));
                    for column in 0..columns {
                        let reach = radius + 1 + further;
                        let inside = ranges
                            .iter()
                            .any(|(s, e)| (*s as usize..*e as usize).contains(&column));
                        if holds_both(&image, extent, row, column, reach) {
                            prop_assert!(inside, "{row} {column} {further}");
                        }
                        if !holds_both(&image, extent, row, column, reach + 1) {
                            prop_assert!(!inside, "{row} {column} {further}");
                        }
                    }
                }
            }
        }
    }
}
