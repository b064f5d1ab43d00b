//! How strong the streaks of a slice are.
//!
//! Streaks are thin: a value differs from the mean of those a short way on either side. The spread
//! of that difference in soft tissue, in slices with metal and in those beside without, tells
//! streaks and their noise from anatomy, of which all have about as much.

use std::collections::BTreeSet;

use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::Volume;
use rayon::prelude::*;

use crate::slice::slice_hu;

/// How far on either side (mm).
const WAY_MM: f64 = 1.5;
/// Soft tissue with streaks in it lies between these.
const RANGE_HU: [f32; 2] = [-400.0, 400.0];
/// Nine of ten differences are below this many spreads, were they normal; with the weights of the
/// three values in them.
const NINE_OF_TEN: f64 = 1.644_85 * 1.224_74;
/// Slices looked at on either side of metal, after so many left out.
const SLICES: usize = 8;
const LEFT_OUT: usize = 2;
/// Most slices looked at in metal.
const MOST: usize = 24;
/// Fewer differences tell nothing.
const FEWEST: usize = 400;

/// The spread of soft tissue in slices with metal and in those near by without (HU).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Streaks {
    /// In slices with metal.
    pub with_metal_hu: f64,
    /// In slices near by without.
    pub without_hu: f64,
}

impl Streaks {
    /// What metal adds to the spread (HU): the root of the difference of the squares.
    pub fn added_hu(&self) -> f64 {
        let squared = self.with_metal_hu.powi(2) - self.without_hu.powi(2);
        squared.max(0.0).sqrt()
    }
}

/// The streaks of the slices `metal`; `None` where there is too little soft tissue to tell, or no
/// slice without metal.
pub(crate) fn streaks_of(
    volume: &Volume,
    metal: &BTreeSet<usize>,
    task: &Task,
) -> Result<Option<Streaks>, Cancelled> {
    let [slices, ..] = volume.geometry().shape();
    let is_near = |slice: usize| {
        let near = slice.saturating_sub(LEFT_OUT)..=slice + LEFT_OUT;
        metal.range(near).next().is_some()
    };
    let without = |candidates: &mut dyn Iterator<Item = usize>| {
        candidates
            .filter(|s| !is_near(*s))
            .take(SLICES)
            .collect::<Vec<_>>()
    };
    let (Some(first), Some(last)) = (metal.first().copied(), metal.last().copied()) else {
        return Ok(None);
    };
    let mut beside = without(&mut (0..first).rev());
    beside.extend(without(&mut (last..slices)));
    if beside.is_empty() {
        beside = without(&mut (first..last));
    }
    let every = metal.len().div_ceil(MOST);
    let within: Vec<usize> = metal.iter().copied().step_by(every).collect();
    let with_metal = spread(volume, &within, task)?;
    let without = spread(volume, &beside, task)?;
    Ok(with_metal
        .zip(without)
        .map(|(with_metal_hu, without_hu)| Streaks {
            with_metal_hu,
            without_hu,
        }))
}

/// The spread over some slices.
fn spread(volume: &Volume, slices: &[usize], task: &Task) -> Result<Option<f64>, Cancelled> {
    let counts = slices
        .par_iter()
        .map(|slice| {
            task.check()?;
            Ok(differences(volume, *slice))
        })
        .try_reduce(
            || vec![0; RANGE],
            |mut a, b| {
                a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
                Ok(a)
            },
        )?;
    let all: usize = counts.iter().sum();
    if all < FEWEST {
        return Ok(None);
    }
    let mut below = 0;
    let nine_of_ten = counts.iter().position(|count| {
        below += count;
        10 * below >= 9 * all
    });
    Ok(nine_of_ten.map(|hu| hu as f64 / NINE_OF_TEN))
}

/// Differences are whole and at most the range of soft tissue.
const RANGE: usize = (RANGE_HU[1] - RANGE_HU[0]) as usize + 2;

/// How often each size of difference occurs in a slice, along rows and columns.
fn differences(volume: &Volume, slice: usize) -> Vec<usize> {
    let [_, rows, columns] = volume.geometry().shape();
    let spacing = volume.geometry().spacing_mm();
    let hu = slice_hu(volume, slice);
    let mut counts = vec![0; RANGE];
    let way = |axis: usize| ((WAY_MM / spacing[axis]).round() as usize).max(1);
    let (across, down) = (way(0), way(1));
    let is_soft = |hu: f32| (RANGE_HU[0]..=RANGE_HU[1]).contains(&hu);
    let mut count = |before: f32, here: f32, after: f32| {
        if is_soft(before) && is_soft(here) && is_soft(after) {
            counts[(here - f32::midpoint(before, after)).abs().round() as usize] += 1;
        }
    };
    for row in 0..rows {
        for column in across..columns.saturating_sub(across) {
            let at = row * columns + column;
            count(hu[at - across], hu[at], hu[at + across]);
        }
    }
    for row in down..rows.saturating_sub(down) {
        for column in 0..columns {
            let at = row * columns + column;
            count(hu[at - down * columns], hu[at], hu[at + down * columns]);
        }
    }
    counts
}
