//! Neighbour distances by a k-d tree: right for every cloud, however uneven.

use std::num::NonZero;

use bonemesh_task::{Cancelled, Task};
use kiddo::SquaredEuclidean;
use kiddo::immutable::float::kdtree::ImmutableKdTree;
use rayon::prelude::*;

use super::BATCH;

/// Points in a leaf; the fastest of 32, 64 and 128 on clouds of skulls.
const LEAF: usize = 64;

/// For each of `centres` the sum of the distances to the `k` nearest of `points`.
pub(super) fn distance_sums(
    points: &[[f64; 3]],
    centres: &[[f64; 3]],
    k: usize,
    task: &Task,
) -> Result<Vec<f64>, Cancelled> {
    task.check()?;
    let k = NonZero::new(k).expect("callers ask for two or more, else this is a bug");
    // The immutable tree takes any number of points that share a coordinate, which the mutable
    // one does not, and the points of a slice always do.
    let tree: ImmutableKdTree<f64, u32, 3, LEAF> = ImmutableKdTree::new_from_slice(points);
    let batches: Vec<Vec<f64>> = centres
        .par_chunks(BATCH)
        .map(|batch| {
            let mut sums = Vec::with_capacity(batch.len());
            for point in batch {
                task.check()?;
                let nearest = tree.nearest_n::<SquaredEuclidean>(point, k);
                sums.push(nearest.iter().map(|n| n.distance.sqrt()).sum());
            }
            task.advance(batch.len())?;
            Ok(sums)
        })
        .collect::<Result<_, Cancelled>>()?;
    Ok(batches.concat())
}
