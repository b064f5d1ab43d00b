//! Neighbour distances by k-d trees: right for every cloud, however uneven.

use std::num::NonZero;

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::BATCH;
use crate::Forest;

/// For each of `centres` the sum of the distances to the `k` nearest of `points`.
pub(super) fn distance_sums(
    points: &[[f64; 3]],
    centres: &[[f64; 3]],
    k: usize,
    task: &Task,
) -> Result<Vec<f64>, Cancelled> {
    let k = NonZero::new(k).expect("callers ask for two or more, else this is a bug");
    let forest = Forest::new(points, task)?;
    let batches: Vec<Vec<f64>> = centres
        .par_chunks(BATCH)
        .map(|batch| {
            let mut sums = Vec::with_capacity(batch.len());
            for point in batch {
                task.check()?;
                let nearest = forest.nearest(*point, k, f64::INFINITY);
                // Points whose distance no number can hold.
                let beyond = if nearest.len() < k.get() {
                    f64::INFINITY
                } else {
                    0.0
                };
                sums.push(nearest.iter().map(|n| n.squared_mm2.sqrt()).sum::<f64>() + beyond);
            }
            task.advance(batch.len())?;
            Ok(sums)
        })
        .collect::<Result<_, Cancelled>>()?;
    Ok(batches.concat())
}
