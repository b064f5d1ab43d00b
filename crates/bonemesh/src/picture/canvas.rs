//! Pixels to draw on: rectangles, lines, text in a font that is compiled in, so that pictures are
//! the same on every machine.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Red, green, blue.
pub(super) type Colour = [u8; 3];

/// Height of the letters' boxes, in pixels.
pub(super) const TEXT_HEIGHT: usize = 20;
const HEIGHT: RasterHeight = RasterHeight::Size20;
const WEIGHT: FontWeight = FontWeight::Regular;

/// A picture; places are columns and rows from its upper left corner. What lies outside is left out.
pub(super) struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
}

impl Canvas {
    /// A picture of one colour.
    pub(super) fn new(width: usize, height: usize, colour: Colour) -> Self {
        Self {
            width,
            height,
            pixels: colour.repeat(width * height),
        }
    }

    /// Red, green and blue of each pixel, row by row.
    pub(super) fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// Fills the columns from `left` up to `right` and the rows from `top` up to `bottom`.
    pub(super) fn fill(
        &mut self,
        [left, right]: [usize; 2],
        [top, bottom]: [usize; 2],
        colour: Colour,
    ) {
        for row in top..bottom {
            for column in left..right {
                self.blend(column, row, colour, u8::MAX);
            }
        }
    }

    /// A vertical line of two pixels; `dashes` leaves every second stretch of that length out.
    pub(super) fn rule(
        &mut self,
        column: usize,
        rows: [usize; 2],
        colour: Colour,
        dashes: Option<usize>,
    ) {
        for row in rows[0]..rows[1] {
            if dashes.is_none_or(|length| row / length % 2 == 0) {
                self.fill([column, column + 2], [row, row + 1], colour);
            }
        }
    }

    /// Writes `text` with its upper left corner at a place; what the font has not becomes `?`.
    pub(super) fn write(&mut self, text: &str, column: usize, row: usize, colour: Colour) {
        for (i, letter) in text.chars().enumerate() {
            let raster =
                get_raster(letter, WEIGHT, HEIGHT).or_else(|| get_raster('?', WEIGHT, HEIGHT));
            let Some(raster) = raster else {
                continue;
            };
            let left = column + i * get_raster_width(WEIGHT, HEIGHT);
            for (y, line) in raster.rows().enumerate() {
                for (x, strength) in line.iter().enumerate() {
                    self.blend(left + x, row + y, colour, *strength);
                }
            }
        }
    }

    fn blend(&mut self, column: usize, row: usize, colour: Colour, strength: u8) {
        if column >= self.width || row >= self.height {
            return;
        }
        let at = 3 * (row * self.width + column);
        let strength = u16::from(strength);
        let full = u16::from(u8::MAX);
        for (pixel, colour) in self.pixels[at..at + 3].iter_mut().zip(colour) {
            let mixed = u16::from(*pixel) * (full - strength) + u16::from(colour) * strength;
            *pixel = (mixed / full) as u8;
        }
    }
}

/// Width of `text` in pixels.
pub(super) fn text_width(text: &str) -> usize {
    text.chars().count() * get_raster_width(WEIGHT, HEIGHT)
}
