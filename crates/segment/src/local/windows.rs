//! Mean and spread of the values in a box around each voxel.
//!
//! 1. `Sums::add`: the sums of the values, and of their squares, over the slices of the window, for
//!    each pixel: a slice enters, another leaves;
//! 2. `over_rows` and `over_columns`: the same along both directions of the slice, so the work does
//!    not depend on the size of the window.
//!
//! Sums are whole numbers, so where a piece of work begins does not show.

use bonemesh_task::Task;
use ndarray::parallel::prelude::*;
use ndarray::{Array3, Axis};

use crate::SegmentError;

/// Mean and variance of the values in a window.
#[derive(Clone, Copy)]
pub(super) struct Around {
    pub(super) mean: f64,
    pub(super) variance: f64,
}

/// How values are counted: as whole numbers of parts of a HU.
pub(super) struct Counted<F> {
    pub(super) whole: F,
    /// So many parts are one HU.
    pub(super) parts: f64,
}

/// Slices that are worked on with one set of sums.
const PIECE: usize = 16;

/// What `of` makes of each value and what lies around it, within `radius` voxels each way.
pub(super) fn over_windows<T: Copy + Sync, U: Copy + Default + Send + Sync>(
    hu: &Array3<T>,
    Counted { whole, parts }: &Counted<impl Fn(T) -> i64 + Sync>,
    radius: [usize; 3],
    of: impl Fn(T, Around) -> U + Sync,
    task: &Task,
) -> Result<Array3<U>, SegmentError> {
    let mut voxels = Array3::from_elem(hu.raw_dim(), U::default());
    let (slices, rows, columns) = hu.dim();
    task.begin("local threshold", slices);
    voxels
        .axis_chunks_iter_mut(Axis(0), PIECE)
        .into_par_iter()
        .enumerate()
        .try_for_each(|(piece, mut voxels)| -> Result<(), SegmentError> {
            let mut sums = Sums::new(rows, columns);
            let first = piece * PIECE;
            let mut held = first.saturating_sub(radius[0])..first.saturating_sub(radius[0]);
            for (slice, mut made) in (first..).zip(voxels.outer_iter_mut()) {
                let window = window(slice, radius[0], slices);
                while held.start < window.start {
                    sums.add(
                        hu.index_axis(Axis(0), held.start).iter().map(|v| whole(*v)),
                        -1,
                    );
                    held.start += 1;
                }
                while held.end < window.end {
                    task.check()?;
                    sums.add(
                        hu.index_axis(Axis(0), held.end).iter().map(|v| whole(*v)),
                        1,
                    );
                    held.end += 1;
                }
                sums.over_rows(radius[1]);
                for (row, (mut made, hu)) in made
                    .outer_iter_mut()
                    .zip(hu.index_axis(Axis(0), slice).outer_iter())
                    .enumerate()
                {
                    let rows = window_len(row, radius[1], rows) * window.len();
                    sums.over_columns(row, radius[2], rows, *parts);
                    for ((made, hu), around) in made.iter_mut().zip(hu).zip(&sums.around) {
                        *made = of(*hu, *around);
                    }
                }
                task.advance(1)?;
            }
            Ok(())
        })?;
    Ok(voxels)
}

/// What is left inside `0..n` of the window around `at`.
pub(super) fn window(at: usize, radius: usize, n: usize) -> std::ops::Range<usize> {
    at.saturating_sub(radius)..(at + radius + 1).min(n)
}

fn window_len(at: usize, radius: usize, n: usize) -> usize {
    window(at, radius, n).len()
}

/// Running sums of the values and of their squares.
struct Sums {
    rows: usize,
    columns: usize,
    /// Over the slices of the window.
    slices: Vec<[i64; 2]>,
    /// Over its slices and rows.
    boxes: Vec<[i64; 2]>,
    /// Along one row.
    around: Vec<Around>,
}

impl Sums {
    fn new(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            slices: vec![[0; 2]; rows * columns],
            boxes: vec![[0; 2]; rows * columns],
            around: vec![
                Around {
                    mean: 0.0,
                    variance: 0.0
                };
                columns
            ],
        }
    }

    /// Adds a slice to the sums, or with `sign` -1 takes it away.
    fn add(&mut self, values: impl Iterator<Item = i64>, sign: i64) {
        for (sums, value) in self.slices.iter_mut().zip(values) {
            sums[0] += sign * value;
            sums[1] += sign * value * value;
        }
    }

    /// Sums over rows too.
    fn over_rows(&mut self, radius: usize) {
        let columns = self.columns;
        let line = |row: usize| row * columns..(row + 1) * columns;
        let mut running = vec![[0_i64; 2]; columns];
        let mut held = 0..0;
        for row in 0..self.rows {
            let window = window(row, radius, self.rows);
            for entering in held.end..window.end {
                plus(&mut running, &self.slices[line(entering)], 1);
            }
            for leaving in held.start..window.start {
                plus(&mut running, &self.slices[line(leaving)], -1);
            }
            held = window;
            self.boxes[line(row)].copy_from_slice(&running);
        }
    }

    /// Mean and variance in the windows of one row, `lines` of which lie above one another.
    fn over_columns(&mut self, row: usize, radius: usize, lines: usize, parts: f64) {
        let boxes = &self.boxes[row * self.columns..(row + 1) * self.columns];
        let (mut running, mut held) = ([0_i64; 2], 0..0);
        for column in 0..self.columns {
            let window = window(column, radius, self.columns);
            for entering in &boxes[held.end..window.end] {
                running = [0, 1].map(|s| running[s] + entering[s]);
            }
            for leaving in &boxes[held.start..window.start] {
                running = [0, 1].map(|s| running[s] - leaving[s]);
            }
            let voxels = (lines * window.len()) as f64;
            held = window;
            let mean = running[0] as f64 / voxels;
            let variance = (running[1] as f64 / voxels - mean * mean).max(0.0);
            self.around[column] = Around {
                mean: mean / parts,
                variance: variance / (parts * parts),
            };
        }
    }
}

fn plus(sums: &mut [[i64; 2]], line: &[[i64; 2]], sign: i64) {
    for (sum, value) in sums.iter_mut().zip(line) {
        sum[0] += sign * value[0];
        sum[1] += sign * value[1];
    }
}
