//! The straight line of a stack, and slices that lie beside it.
//!
//! A volume's slices follow one another in a straight line. A table that sways or a patient who
//! is moved between two scans leaves slices beside it; those are moved back within their plane.

use crate::hounsfield::Voxel;
use crate::slice::Slice;
use crate::vector::{cross, difference, dot, length, scaled};

/// Distance from the straight line, in pixels, up to which a stack is straight.
const CROOKED: f64 = 0.5;

/// Distance, in pixels, from which a slice of a crooked stack is moved: less is rounding.
const MOVED: f64 = 0.1;

/// Share of the strayed slices to which another line must bring a crooked stack to be preferred to
/// an upright one: slices strewn about lie nearer to one slope or another by chance.
const CLEARLY: f64 = 0.9;

/// Where the first pixel of each slice should be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// A point of the line, and its place along the normal (mm).
    anchor: [f64; 3],
    anchor_mm: f64,
    /// Way for each mm along the normal; slanted in a tilted stack.
    per_mm: [f64; 3],
    is_straight: bool,
}

impl Line {
    /// The line of a stack: from the first slice to the last where all slices lie on it;
    /// otherwise, of a few that may be meant, the one that most slices lie on or near.
    ///
    /// Slices that were moved all at once, as by centring the image anew, are no slope: most
    /// neighbours still follow each other in the stack's own direction.
    pub(crate) fn of(slices: &[Slice]) -> Self {
        let (first, last) = (&slices[0], &slices[slices.len() - 1]);
        let straight = Self {
            anchor: first.place().position,
            anchor_mm: first.along_mm,
            per_mm: between(first, last),
            is_straight: true,
        };
        let is_beside = |s: &Slice| straight.sideways_px(s).into_iter().any(|o| o > CROOKED);
        if !slices.iter().any(is_beside) {
            return straight;
        }
        let neighbours = pairs(slices, 1);
        let candidates = [
            longest_run(slices, neighbours),
            neighbours,
            pairs(slices, slices.len() / 2),
        ];
        let upright = Self::towards(slices, upright(slices));
        let mut best = (upright.strayed(slices), upright);
        for per_mm in candidates {
            let line = Self::towards(slices, per_mm);
            let strayed = line.strayed(slices);
            if strayed < best.0 * CLEARLY {
                best = (strayed, line);
            }
        }
        best.1
    }

    /// The line in a direction that goes through the middle of a crooked stack's slices.
    fn towards(slices: &[Slice], per_mm: [f64; 3]) -> Self {
        let anchor_mm = slices[0].along_mm;
        let start = |s: &Slice| {
            let way = scaled(per_mm, s.along_mm - anchor_mm);
            difference(s.place().position, way)
        };
        Self {
            anchor: middle(&slices.iter().map(start).collect::<Vec<_>>()),
            anchor_mm,
            per_mm,
            is_straight: false,
        }
    }

    /// How many slices lie beside the line: one on it counts 0, one far away 1 however far it is.
    /// (A sum of distances would be smallest for a slope between two halves of a stack.)
    fn strayed(&self, slices: &[Slice]) -> f64 {
        let off = |s: &Slice| self.sideways_px(s).into_iter().fold(0.0, f64::max);
        slices.iter().map(|s| off(s) / (off(s) + CROOKED)).sum()
    }

    /// The line at a place along the normal.
    pub(crate) fn at(&self, along_mm: f64) -> [f64; 3] {
        let way = scaled(self.per_mm, along_mm - self.anchor_mm);
        std::array::from_fn(|i| self.anchor[i] + way[i])
    }

    /// Way for each mm along the normal.
    pub(crate) fn per_mm(&self) -> [f64; 3] {
        self.per_mm
    }

    /// What a user should know if the stack is crooked.
    pub(crate) fn note(&self, slices: &[Slice]) -> Option<String> {
        if self.is_straight {
            return None;
        }
        let farthest = |off: &dyn Fn(&Slice) -> f64| slices.iter().map(off).fold(0.0, f64::max);
        let crooked_mm = farthest(&|s| length(self.beside(s)));
        let cut_mm = farthest(&|s| {
            let ([columns, rows], [dx, dy]) = (self.sideways_px(s), s.place().spacing);
            (columns * dx).max(rows * dy)
        });
        Some(format!(
            "slices are shifted sideways by up to {crooked_mm:.2} mm against a straight stack; moved to their places by linear interpolation, up to {cut_mm:.2} mm of their edge lie outside the volume"
        ))
    }

    /// Moves the pixels of a slice that lies beside the line to where the line wants them.
    pub(crate) fn straighten<T: Voxel>(&self, slice: &Slice, hu: &mut [T]) {
        let by = self.offset_px(slice);
        if !self.is_straight && by.into_iter().any(|o| o.abs() > MOVED) {
            moved(hu, slice.header.layout.columns, by);
        }
    }

    fn beside(&self, slice: &Slice) -> [f64; 3] {
        difference(slice.place().position, self.at(slice.along_mm))
    }

    /// Columns and rows from where the line wants the slice to where it is.
    fn offset_px(&self, slice: &Slice) -> [f64; 2] {
        let (off, place) = (self.beside(slice), slice.place());
        let [x, y] = place.orientation;
        let [dx, dy] = place.spacing;
        [dot(off, x) / dx, dot(off, y) / dy]
    }

    fn sideways_px(&self, slice: &Slice) -> [f64; 2] {
        self.offset_px(slice).map(f64::abs)
    }
}

/// Way from one slice to another for each mm along the normal.
fn between(a: &Slice, b: &Slice) -> [f64; 3] {
    let way = difference(b.place().position, a.place().position);
    scaled(way, 1.0 / (b.along_mm - a.along_mm))
}

/// Way for each mm along the normal of a stack that stands upright on its slices.
fn upright(slices: &[Slice]) -> [f64; 3] {
    let [x, y] = slices[0].place().orientation;
    let normal = cross(x, y);
    // Slices ascend along the normal that counts, whichever side it is taken from.
    let along = dot(normal, between(&slices[0], &slices[slices.len() - 1]));
    scaled(normal, along.signum() / length(normal))
}

/// The middle of the ways from each slice to the one `apart` further; Theil (1950) and Sen (1968)
/// draw lines through medians of slopes.
fn pairs(slices: &[Slice], apart: usize) -> [f64; 3] {
    let ways = slices.iter().zip(&slices[apart..]);
    middle(&ways.map(|(a, b)| between(a, b)).collect::<Vec<_>>())
}

/// The way through the longest run of slices whose neighbours follow each other in a direction:
/// over many slices, rounded positions weigh little.
fn longest_run(slices: &[Slice], per_mm: [f64; 3]) -> [f64; 3] {
    let follows = |a: &Slice, b: &Slice| {
        let line = Line {
            anchor: a.place().position,
            anchor_mm: a.along_mm,
            per_mm,
            is_straight: false,
        };
        line.sideways_px(b).into_iter().all(|o| o <= CROOKED)
    };
    let mut longest: &[Slice] = &[];
    for run in slices.chunk_by(follows) {
        if run.len() > longest.len() {
            longest = run;
        }
    }
    match longest {
        [first, .., last] => between(first, last),
        _ => per_mm,
    }
}

/// The one nearest to the median of each coordinate.
fn middle(points: &[[f64; 3]]) -> [f64; 3] {
    let median = [0, 1, 2].map(|axis| {
        let mut sorted: Vec<f64> = points.iter().map(|p| p[axis]).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    });
    let off = |p: &&[f64; 3]| length(difference(**p, median));
    let nearest = points.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.copied().unwrap_or(median)
}

/// Moves an image by columns and rows, linear between pixels; what comes from outside is air.
fn moved<T: Voxel>(hu: &mut [T], columns: usize, by: [f64; 2]) {
    let own = hu.to_vec();
    let rows = own.len() / columns;
    let [(column_step, right), (row_step, down)] =
        by.map(|o| ((-o).floor() as i64, (-o) - (-o).floor()));
    let at = |row: i64, column: i64| {
        let inside = (0..rows as i64).contains(&row) && (0..columns as i64).contains(&column);
        if inside {
            own[row as usize * columns + column as usize]
        } else {
            T::AIR
        }
    };
    for (index, hu) in hu.iter_mut().enumerate() {
        let row = (index / columns) as i64 + row_step;
        let column = (index % columns) as i64 + column_step;
        let above = T::between(at(row, column), at(row, column + 1), right);
        let below = T::between(at(row + 1, column), at(row + 1, column + 1), right);
        *hu = T::between(above, below, down);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_pixels_are_moved_unchanged_and_air_follows() {
        let mut hu: Vec<i16> = vec![1, 2, 3, 4, 5, 6];
        moved(&mut hu, 3, [1.0, 0.0]);
        assert_eq!(hu, [-1000, 1, 2, -1000, 4, 5]);
        moved(&mut hu, 3, [0.0, -1.0]);
        assert_eq!(hu, [-1000, 4, 5, -1000, -1000, -1000]);
    }

    #[test]
    fn parts_of_a_pixel_keep_a_slope_where_it_is() {
        let slope = |column: f64, row: f64| 100.0 * column - 40.0 * row;
        let mut hu: Vec<f32> = (0..48)
            .map(|n| slope(f64::from(n % 8), f64::from(n / 8)) as f32)
            .collect();
        moved(&mut hu, 8, [1.25, -2.5]);
        for (column, row) in [(3, 1), (6, 2)] {
            let expected = slope(f64::from(column) - 1.25, f64::from(row) + 2.5);
            let found = f64::from(hu[(8 * row + column) as usize]);
            assert!((found - expected).abs() < 1e-3);
        }
    }
}
