//! What each point says of the function.

use std::f64::consts::PI;
use std::num::NonZero;

use bonemesh_cloud::{Forest, NormalSettings};
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::grid::{Grid, Place};

/// Points that one worker handles between two looks at the task.
const BATCH: usize = 256;
/// Cells that a normal is spread over, as a part of the distance to the farthest neighbour.
const CELL_OF_REACH: f64 = 0.5;

/// A point of the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) at_mm: [f64; 3],
    pub(super) normal: [f64; 3],
    /// The piece of surface that it stands for.
    pub(super) area_mm2: f64,
    /// How many times the cells are doubled that its normal is spread over.
    pub(super) steps: u32,
}

impl Sample {
    /// Where it is in a grid.
    pub(super) fn on(&self, grid: &Grid) -> Place {
        grid.place(self.at_mm)
    }
}

/// The samples of the points, by plane of cells of the grid and then in the points' order.
pub(super) fn samples(
    points_mm: &[[f64; 3]],
    normals: &[[f64; 3]],
    grid: &Grid,
    settings: NormalSettings,
    task: &Task,
) -> Result<Vec<Sample>, Cancelled> {
    let forest = Forest::new(points_mm, task)?;
    let count = NonZero::new(settings.neighbours).expect("normals were made, else this is a bug");
    let reach = settings.radius_mm * settings.radius_mm;
    // At least four cells a side remain.
    let most = (grid.nodes - 1).ilog2() - 2;
    let sample = |at_mm: &[f64; 3], normal: &[f64; 3]| {
        let near = forest.nearest(*at_mm, count, reach);
        let farthest = near.last().map_or(0.0, |n| n.squared_mm2);
        let cells = CELL_OF_REACH * farthest.sqrt() / grid.cell_mm;
        Sample {
            at_mm: *at_mm,
            normal: *normal,
            area_mm2: PI * farthest / near.len() as f64,
            steps: cells.max(1.0).log2().ceil().min(f64::from(most)) as u32,
        }
    };
    let batches: Vec<Vec<Sample>> = points_mm
        .par_chunks(BATCH)
        .zip(normals.par_chunks(BATCH))
        .map(|(points, normals)| {
            task.check()?;
            Ok(points
                .iter()
                .zip(normals)
                .map(|(p, n)| sample(p, n))
                .collect())
        })
        .collect::<Result<_, Cancelled>>()?;
    let mut samples = batches.concat();
    // Points without neighbours or with repeats around them stand for nothing.
    samples.retain(|s| s.area_mm2 > 0.0);
    samples.sort_by_key(|s| s.on(grid).cell[2]);
    Ok(samples)
}
