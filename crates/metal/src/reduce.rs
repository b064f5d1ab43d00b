//! The streaks of one slice, damped by normalised metal artefact reduction.
//!
//! 1. `filled`: the slice as attenuation, metal replaced by water.
//! 2. `Rays::trace`: the rays that meet metal. What the scanner measured along them makes the streaks.
//! 3. `bridged`: along each angle the trace is bridged in a straight line (Kalender 1987); back
//!    projected, the difference gives a first slice with weaker but blurred streaks.
//! 4. `prior`: air, soft tissue and bone without streaks. Streaks are elsewhere in the slice as it
//!    came than in the damped one, so that bone is what both call bone, air what both call air.
//! 5. `bridged` again, of projections divided by those of the prior, and multiplied by them after
//!    (Meyer 2010): edges of bone and air within the trace come from the prior. With the slice that
//!    this gives, 4 and 5 are done anew.
//! 6. Only the difference is back projected and added to the slice: nothing is resampled.

use std::ops::Range;

use bonemesh_task::{Cancelled, Task};

use crate::project::{Grid, Rays, Sinogram, Trace};

/// Below this is air in the prior, from that up bone; soft tissue between them.
const AIR_HU: f32 = -500.0;
const BONE_HU: f32 = 350.0;
/// What the prior puts in the place of soft tissue.
const SOFT_HU: f32 = 20.0;
/// Bins beside the trace whose mean it is bridged from.
const BESIDE: usize = 3;
/// Rays with less prior than so many mm of water are divided by that.
const LEAST_MM: f32 = 2.0;
/// How often the prior is made. Errors beside metal hardly fall any more after the fourth.
const ROUNDS: usize = 4;
/// Padding lies below this and stays.
const PADDING_HU: f32 = -1024.0;
/// Where scales of 12 bits end; steeper metal would only make rounding worse.
const SCALE_END_HU: f32 = 3071.0;

/// How much each pixel of a slice changes (HU): metal and padding not at all.
pub(crate) fn correction(
    hu: &[f32],
    is_metal: &[bool],
    grid: Grid,
    task: &Task,
) -> Result<Vec<f32>, Cancelled> {
    let rays = Rays::new(grid);
    let slice = filled(hu, is_metal);
    let smooth = smoothed(&slice, grid);
    let trace = rays.trace(is_metal);
    let measured = rays.project(&slice, &trace, BESIDE, task)?;
    let mut change = rays.back(&bridged(&rays, &measured, None, &trace), task)?;
    for _ in 0..ROUNDS {
        let prior = prior(&slice, &smooth, &change, grid);
        let of_prior = rays.project(&prior, &trace, BESIDE, task)?;
        let difference = bridged(&rays, &measured, Some(&of_prior), &trace);
        change = rays.back(&difference, task)?;
    }
    // NaN is padding too.
    let changes = |pixel: usize| !is_metal[pixel] && hu[pixel] >= PADDING_HU;
    let in_hu = |pixel| {
        if changes(pixel) {
            1000.0 * change[pixel]
        } else {
            0.0
        }
    };
    Ok((0..hu.len()).map(in_hu).collect())
}

/// Attenuation in that of water, metal replaced by water.
fn filled(hu: &[f32], is_metal: &[bool]) -> Vec<f32> {
    let value = |(hu, is_metal): (&f32, &bool)| {
        if *is_metal {
            1.0
        } else {
            attenuation(hu.min(SCALE_END_HU))
        }
    };
    hu.iter().zip(is_metal).map(value).collect()
}

fn attenuation(hu: f32) -> f32 {
    (1.0 + hu / 1000.0).max(0.0)
}

/// What bridging the trace changes in the projections.
fn bridged(rays: &Rays, measured: &Sinogram, prior: Option<&Sinogram>, trace: &Trace) -> Sinogram {
    let mut difference = rays.blank();
    for (angle, stretches) in trace.iter().enumerate() {
        let row = measured.row(angle);
        let prior = prior.map(|prior| prior.row(angle));
        let norm = |bin: usize| prior.map_or(1.0, |prior| prior[bin].max(LEAST_MM));
        let mean = |bins: Range<usize>| {
            let count = bins.len() as f32;
            bins.map(|bin| row[bin] / norm(bin)).sum::<f32>() / count
        };
        let out = difference.row_mut(angle);
        for (number, stretch) in stretches.iter().enumerate() {
            // Beside one metal there can be the trace of another.
            let before = number.checked_sub(1).map_or(0, |n| stretches[n].end);
            let after = stretches.get(number + 1).map_or(usize::MAX, |s| s.start);
            let left = before.max(stretch.start - BESIDE)..stretch.start;
            let right = stretch.end..after.min(stretch.end + BESIDE);
            // The means lie in the middle of their bins.
            let from = 0.5 * (left.len() as f32 + 1.0);
            let way = from + stretch.len() as f32 + 0.5 * (right.len() as f32 - 1.0);
            let (left, right) = (mean(left), mean(right));
            for bin in stretch.clone() {
                let part = ((bin - stretch.start) as f32 + from) / way;
                out[bin] = norm(bin) * (left + part * (right - left)) - row[bin];
            }
        }
    }
    difference
}

/// Air and soft tissue made even, bone as it is: the mean of the slice before and after a change.
fn prior(slice: &[f32], smooth: &[f32], change: &[f32], grid: Grid) -> Vec<f32> {
    let changed: Vec<f32> = slice
        .iter()
        .zip(change)
        .map(|(v, c)| (v + c).max(0.0))
        .collect();
    let smooth_after = smoothed(&changed, grid);
    let class = |pixel: usize| {
        let (low, high) = (
            smooth[pixel].min(smooth_after[pixel]),
            smooth[pixel].max(smooth_after[pixel]),
        );
        if high < attenuation(AIR_HU) {
            0.0
        } else if low >= attenuation(BONE_HU) {
            f32::midpoint(slice[pixel], changed[pixel])
        } else {
            attenuation(SOFT_HU)
        }
    };
    (0..slice.len()).map(class).collect()
}

/// Means of three by three pixels, weighted 1 2 1 each way.
fn smoothed(slice: &[f32], grid: Grid) -> Vec<f32> {
    let Grid { rows, columns, .. } = grid;
    let mean = |a: f32, b: f32, c: f32| (a + 2.0 * b + c) / 4.0;
    let across: Vec<f32> = slice
        .chunks_exact(columns)
        .flat_map(|line| {
            let at = |column: usize| line[column.min(columns - 1)];
            (0..columns).map(move |i| mean(at(i.saturating_sub(1)), at(i), at(i + 1)))
        })
        .collect();
    let at = |row: usize, column: usize| across[row.min(rows - 1) * columns + column];
    (0..slice.len())
        .map(|pixel| {
            let (row, column) = (pixel / columns, pixel % columns);
            mean(
                at(row.saturating_sub(1), column),
                at(row, column),
                at(row + 1, column),
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: Grid = Grid {
        rows: 60,
        columns: 64,
        step_mm: [1.0, 1.0],
    };

    /// A disc of soft tissue with a disc of metal in it.
    fn disc() -> (Vec<f32>, Vec<bool>) {
        let at = |pixel: usize| [(pixel % 64) as f32 - 32.0, (pixel / 64) as f32 - 30.0];
        let from = |[x, y]: [f32; 2], [a, b]: [f32; 2]| (x - a).hypot(y - b);
        let is_metal = |pixel: &usize| from(at(*pixel), [8.0, 3.0]) < 2.5;
        let hu = |pixel: usize| {
            if is_metal(&pixel) {
                3071.0
            } else if from(at(pixel), [0.0, 0.0]) < 24.0 {
                SOFT_HU
            } else {
                -1000.0
            }
        };
        (
            (0..64 * 60).map(hu).collect(),
            (0..64 * 60).map(|p| is_metal(&p)).collect(),
        )
    }

    #[test]
    fn without_streaks_there_is_next_to_nothing_to_damp() {
        let (hu, is_metal) = disc();
        let change = correction(&hu, &is_metal, GRID, &Task::default()).unwrap();
        let squares: f32 = change.iter().map(|c| c * c).sum();
        let spread = (squares / change.len() as f32).sqrt();
        assert!(spread < 4.0, "{spread} HU");
    }

    #[test]
    fn metal_and_padding_stay() {
        let (mut hu, is_metal) = disc();
        hu[..64].fill(-2000.0);
        hu[100] = f32::NAN;
        let change = correction(&hu, &is_metal, GRID, &Task::default()).unwrap();
        assert!(change.iter().all(|c| c.is_finite()));
        assert!(change[..64].iter().all(|c| *c == 0.0) && change[100] == 0.0);
        assert!(
            change
                .iter()
                .zip(&is_metal)
                .all(|(c, metal)| !metal || *c == 0.0)
        );
    }

    #[test]
    fn a_cancelled_task_stops_it() {
        let (hu, is_metal) = disc();
        let task = Task::default();
        task.cancel().cancel();
        assert!(correction(&hu, &is_metal, GRID, &task).is_err());
    }
}
