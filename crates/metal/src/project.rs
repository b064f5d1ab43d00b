//! Parallel projections of a slice and back.
//!
//! A ray of angle `a` and offset `s` is the line `x cos a + y sin a = s` through the slice, in mm
//! about its middle. Projecting adds up the slice along rays by linear interpolation in the rows or
//! columns that they cross most steeply (P. M. Joseph, IEEE Trans. Med. Imaging 1(3), 1982). Back is
//! filtered back projection with the band-limited ramp of G. N. Ramachandran and
//! A. V. Lakshminarayanan, PNAS 68(9), 1971.

use std::f64::consts::PI;
use std::ops::Range;

use bonemesh_task::{Cancelled, Task};

/// Angles for each pixel of the longer side. Half of pi would sample the edge of a slice as finely
/// as its pixels; what is projected here is only the small difference that damping makes.
const ANGLES_PER_PIXEL: f64 = 1.2;
/// Fewest angles, for small slices.
const MIN_ANGLES: usize = 240;
/// Bins beyond the ends of the slice's diagonal, so that no trace reaches the last one.
const MARGIN: usize = 8;

/// Rows, columns and pixel size of a slice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    /// Distance between columns and between rows (mm).
    pub(crate) step_mm: [f64; 2],
}

/// Values by angle and bin.
#[derive(Clone, Debug)]
pub(crate) struct Sinogram {
    bins: usize,
    values: Vec<f32>,
}

impl Sinogram {
    /// The bins of one angle.
    pub(crate) fn row(&self, angle: usize) -> &[f32] {
        &self.values[angle * self.bins..][..self.bins]
    }

    pub(crate) fn row_mut(&mut self, angle: usize) -> &mut [f32] {
        &mut self.values[angle * self.bins..][..self.bins]
    }
}

/// Stretches of bins, in order and apart, for each angle.
pub(crate) type Trace = Vec<Vec<Range<usize>>>;

/// All rays through a slice.
#[derive(Clone, Debug)]
pub(crate) struct Rays {
    grid: Grid,
    /// Cosine and sine of each angle.
    directions: Vec<[f64; 2]>,
    bins: usize,
    /// Distance between bins (mm).
    pitch_mm: f64,
}

impl Rays {
    pub(crate) fn new(grid: Grid) -> Self {
        let [dx, dy] = grid.step_mm;
        let pitch_mm = dx.min(dy);
        let (wide, high) = (grid.columns as f64 * dx, grid.rows as f64 * dy);
        let angles = (ANGLES_PER_PIXEL * wide.max(high) / pitch_mm).round() as usize;
        let angles = angles.max(MIN_ANGLES);
        let direction = |angle: usize| {
            let (sin, cos) = (PI * angle as f64 / angles as f64).sin_cos();
            [cos, sin]
        };
        Self {
            grid,
            directions: (0..angles).map(direction).collect(),
            bins: (wide.hypot(high) / pitch_mm).ceil() as usize + 2 * MARGIN,
            pitch_mm,
        }
    }

    pub(crate) fn angles(&self) -> usize {
        self.directions.len()
    }

    /// Zero for every ray.
    pub(crate) fn blank(&self) -> Sinogram {
        Sinogram {
            bins: self.bins,
            values: vec![0.0; self.angles() * self.bins],
        }
    }

    /// The rays that meet marked pixels, with a bin on either side for their blur.
    pub(crate) fn trace(&self, is_marked: &[bool]) -> Trace {
        let Grid { columns, .. } = self.grid;
        let marked: Vec<[f64; 2]> = (0..is_marked.len())
            .filter(|pixel| is_marked[*pixel])
            .map(|pixel| self.place_mm(pixel / columns, pixel % columns))
            .collect();
        let mut is_met = vec![false; self.bins];
        let of_angle = |&[cos, sin]: &[f64; 2]| {
            is_met.fill(false);
            let [dx, dy] = self.grid.step_mm;
            let half = 0.5 * (dx * cos.abs() + dy * sin.abs()) / self.pitch_mm + 1.0;
            for [x, y] in &marked {
                let at = self.bin(x * cos + y * sin);
                let first = (at - half).round().max(0.0) as usize;
                let last = ((at + half).round() as usize).min(self.bins - 1);
                is_met[first..=last].fill(true);
            }
            stretches(&is_met)
        };
        self.directions.iter().map(of_angle).collect()
    }

    /// The slice added up (value times mm) along the rays of `trace` and `beside` more on either
    /// side; 0 for all others.
    pub(crate) fn project(
        &self,
        slice: &[f32],
        trace: &Trace,
        beside: usize,
        task: &Task,
    ) -> Result<Sinogram, Cancelled> {
        let mut sinogram = self.blank();
        for (angle, stretches) in trace.iter().enumerate() {
            task.check()?;
            let mut done = 0;
            for stretch in stretches {
                let first = stretch.start.saturating_sub(beside).max(done);
                done = (stretch.end + beside).min(self.bins);
                for bin in first..done {
                    sinogram.values[angle * self.bins + bin] = self.along(slice, angle, bin);
                }
            }
        }
        Ok(sinogram)
    }

    /// The sum along one ray.
    fn along(&self, slice: &[f32], angle: usize, bin: usize) -> f32 {
        let [cos, sin] = self.directions[angle];
        let [dx, dy] = self.grid.step_mm;
        let Grid { rows, columns, .. } = self.grid;
        let offset = self.offset_mm(bin);
        let (middle_x, middle_y) = ((columns - 1) as f64 / 2.0, (rows - 1) as f64 / 2.0);
        // Steep rays cross every row, flat ones every column.
        if cos.abs() * dx >= sin.abs() * dy {
            let slope = -dy * sin / cos / dx;
            let start = offset / cos / dx + middle_x - middle_y * slope;
            let walk = Walk {
                start,
                slope,
                lines: [rows, columns],
                strides: [columns, 1],
            };
            walk.sum(slice) * (dy / cos.abs()) as f32
        } else {
            let slope = -dx * cos / sin / dy;
            let start = offset / sin / dy + middle_y - middle_x * slope;
            let walk = Walk {
                start,
                slope,
                lines: [columns, rows],
                strides: [1, columns],
            };
            walk.sum(slice) * (dx / sin.abs()) as f32
        }
    }

    /// Filters the values of all rays and spreads them back over the slice.
    pub(crate) fn back(&self, sinogram: &Sinogram, task: &Task) -> Result<Vec<f32>, Cancelled> {
        let Grid { rows, columns, .. } = self.grid;
        let ramp = self.ramp();
        let mut slice = vec![0.0_f32; rows * columns];
        for (angle, [cos, sin]) in self.directions.iter().enumerate() {
            task.check()?;
            let Some(filtered) = filtered(sinogram.row(angle), &ramp) else {
                continue;
            };
            let per_column = (cos * self.grid.step_mm[0] / self.pitch_mm) as f32;
            for (row, line) in slice.chunks_exact_mut(columns).enumerate() {
                let [x, y] = self.place_mm(row, 0);
                let start = self.bin(x * cos + y * sin) as f32;
                for (column, value) in line.iter_mut().enumerate() {
                    let at = start + per_column * column as f32;
                    let bin = at as usize;
                    let part = at - bin as f32;
                    let [a, b] = [filtered[bin], filtered[bin + 1]];
                    *value += a + part * (b - a);
                }
            }
        }
        Ok(slice)
    }

    /// The ramp filter by distance in bins, with the width of an angle and of a bin in it.
    fn ramp(&self) -> Vec<f32> {
        let scale = PI / self.angles() as f64 / self.pitch_mm;
        let at = |bin: usize| match bin {
            0 => 0.25,
            odd if odd % 2 == 1 => -1.0 / (PI * odd as f64).powi(2),
            _ => 0.0,
        };
        (0..self.bins).map(|bin| (scale * at(bin)) as f32).collect()
    }

    fn place_mm(&self, row: usize, column: usize) -> [f64; 2] {
        let Grid {
            rows,
            columns,
            step_mm: [dx, dy],
        } = self.grid;
        let from_middle = |index: usize, count: usize| index as f64 - (count - 1) as f64 / 2.0;
        [
            from_middle(column, columns) * dx,
            from_middle(row, rows) * dy,
        ]
    }

    fn bin(&self, offset_mm: f64) -> f64 {
        offset_mm / self.pitch_mm + (self.bins - 1) as f64 / 2.0
    }

    fn offset_mm(&self, bin: usize) -> f64 {
        (bin as f64 - (self.bins - 1) as f64 / 2.0) * self.pitch_mm
    }
}

/// A ray's way over parallel lines of pixels.
struct Walk {
    /// Where it crosses the first line, in pixels, and how much further on it crosses the next.
    start: f64,
    slope: f64,
    /// Lines, and pixels of a line.
    lines: [usize; 2],
    /// From line to line, and from pixel to pixel of a line.
    strides: [usize; 2],
}

impl Walk {
    fn sum(&self, slice: &[f32]) -> f32 {
        let [lines, pixels] = self.lines;
        let [next_line, next_pixel] = self.strides;
        let last = (pixels - 1) as f64;
        let mut sum = 0.0_f32;
        for line in self.crossed(lines, last) {
            let at = self.start + self.slope * line as f64;
            if !(0.0..last).contains(&at) {
                continue;
            }
            let pixel = at as usize;
            let part = (at - pixel as f64) as f32;
            let here = line * next_line + pixel * next_pixel;
            let [a, b] = [slice[here], slice[here + next_pixel]];
            sum += a + part * (b - a);
        }
        sum
    }

    /// The lines that are crossed within their length, give or take one.
    fn crossed(&self, lines: usize, last: f64) -> Range<usize> {
        if self.slope.abs() < 1e-9 {
            return 0..lines;
        }
        let [a, b] = [-self.start / self.slope, (last - self.start) / self.slope];
        let first = (a.min(b) - 1.0).clamp(0.0, lines as f64) as usize;
        let end = (a.max(b) + 2.0).clamp(0.0, lines as f64) as usize;
        first..end
    }
}

/// The stretches of what is met.
fn stretches(is_met: &[bool]) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for bin in 0..=is_met.len() {
        let met = is_met.get(bin).copied().unwrap_or(false);
        match start {
            None if met => start = Some(bin),
            Some(from) if !met => {
                found.push(from..bin);
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// A row of bins after the ramp filter; `None` if all are zero.
fn filtered(row: &[f32], ramp: &[f32]) -> Option<Vec<f32>> {
    let first = row.iter().position(|v| *v != 0.0)?;
    let last = row.iter().rposition(|v| *v != 0.0)?;
    let mut out = vec![0.0_f32; row.len()];
    for (from, value) in row.iter().enumerate().take(last + 1).skip(first) {
        if *value != 0.0 {
            let (before, after) = out.split_at_mut(from);
            for (out, tap) in after.iter_mut().zip(ramp) {
                *out += value * tap;
            }
            for (out, tap) in before.iter_mut().rev().zip(&ramp[1..]) {
                *out += value * tap;
            }
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: Grid = Grid {
        rows: 90,
        columns: 70,
        step_mm: [0.5, 0.4],
    };

    /// A soft blob at a place (mm), `width` mm wide; its integral along any line is known.
    fn blob(rays: &Rays, [a, b]: [f64; 2], width: f64) -> Vec<f32> {
        let value = |pixel: usize| {
            let [x, y] = rays.place_mm(pixel / GRID.columns, pixel % GRID.columns);
            let squared = ((x - a).powi(2) + (y - b).powi(2)) / (width * width);
            (-squared / 2.0).exp() as f32
        };
        (0..GRID.rows * GRID.columns).map(value).collect()
    }

    fn everywhere(rays: &Rays) -> Trace {
        vec![vec![MARGIN..rays.bins - MARGIN]; rays.angles()]
    }

    // Linear interpolation broadens a blob as narrow as this by one part in a hundred.
    #[test]
    fn a_blob_has_its_known_projections() {
        let rays = Rays::new(GRID);
        let (place, width) = ([3.0, -5.0], 2.0);
        let slice = blob(&rays, place, width);
        let sinogram = rays.project(&slice, &everywhere(&rays), 0, &Task::default());
        let sinogram = sinogram.unwrap();
        for (angle, [cos, sin]) in rays.directions.iter().enumerate() {
            for (bin, sum) in sinogram.row(angle).iter().enumerate() {
                let off = rays.offset_mm(bin) - place[0] * cos - place[1] * sin;
                let known = (2.0 * PI).sqrt() * width * (-(off / width).powi(2) / 2.0).exp();
                assert!(
                    (f64::from(*sum) - known).abs() < 0.05,
                    "{angle} {bin}: {sum} {known}"
                );
            }
        }
    }

    #[test]
    fn projected_and_back_is_the_slice() {
        let rays = Rays::new(GRID);
        let slice = blob(&rays, [-2.0, 4.0], 1.5);
        let task = Task::default();
        let sinogram = rays.project(&slice, &everywhere(&rays), 0, &task).unwrap();
        let back = rays.back(&sinogram, &task).unwrap();
        let worst = slice
            .iter()
            .zip(&back)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f32::max);
        assert!(worst < 0.03, "{worst}");
    }

    #[test]
    fn a_trace_holds_every_ray_through_its_pixels() {
        let rays = Rays::new(GRID);
        let mut is_marked = vec![false; GRID.rows * GRID.columns];
        for pixel in [0, 69, 2000, 2001, 2070, 6299] {
            is_marked[pixel] = true;
        }
        let slice: Vec<f32> = is_marked.iter().map(|m| f32::from(u8::from(*m))).collect();
        let all = rays
            .project(&slice, &everywhere(&rays), 0, &Task::default())
            .unwrap();
        for (angle, stretches) in rays.trace(&is_marked).iter().enumerate() {
            assert!(stretches.windows(2).all(|pair| pair[0].end < pair[1].start));
            for (bin, sum) in all.row(angle).iter().enumerate() {
                let is_traced = stretches.iter().any(|s| s.contains(&bin));
                assert!(*sum == 0.0 || is_traced, "{angle} {bin}");
            }
        }
    }
}
