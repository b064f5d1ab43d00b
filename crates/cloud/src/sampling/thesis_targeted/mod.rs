//! The published targeted sampling: a grid of cells, each sampled the more densely the less alike the
//! normals of its points are.
//!
//! In every cell and slice:
//! 1. `normals`: of the points, by principal components in space over the 30 nearest of the same cell.
//! 2. `similarity`: the mean over all ordered pairs of normals of 1 - angle / pi.
//! 3. The points are sampled as in [`super::thesis_uniform`], at the percentage of the range in which
//!    the similarity lies.
//!
//! Not taken over, since the text does not mean them: points on the upper bound, slices off an even
//! lattice and single points got lost, and a cell in which nothing was kept repeated the last one's points.
//!
//! Why it fails: the points of a slice lie in one plane, so in space the least component is across that
//! plane and says nothing of the contour; it points up or down as rounding has it. Cells of up to 30
//! points have one neighbourhood, hence one normal, and count as straight whatever their shape.

mod normal;
mod similarity;

use bonemesh_task::Task;
use rayon::prelude::*;

use super::Percent;
use super::slices::Slices;
use super::thesis_uniform::keep_of_slice;
use crate::{CloudError, PointCloud};
pub(super) use similarity::{NEIGHBOURS, mean_similarity, normals};

/// Number of ranges of similarity.
const RANGES: usize = 4;

/// Cells and percentages of the published targeted sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimilarityRanges {
    grid_px: u32,
    cutoffs: [f64; RANGES],
    percentages: [Percent; RANGES],
}

impl SimilarityRanges {
    /// Cells of the first published experiment, in pixels.
    pub const GRID_PX: u32 = 10;
    /// Its cut-offs.
    pub const CUTOFFS: [f64; 4] = [0.0, 0.4, 0.6, 0.8];
    /// Its percentages, of the highest range first.
    pub const PERCENTAGES: [f64; 4] = [10.0, 25.0, 50.0, 75.0];

    /// Checks the values: cells of `grid_px` by `grid_px` pixels; ranges of similarity that begin at
    /// `cutoffs`; and the percentages kept of them, of the highest range first.
    ///
    /// # Errors
    /// [`CloudError::GridSize`] for cells of no pixels, [`CloudError::Cutoffs`] unless the cut-offs rise
    /// from 0 to at most 1, [`CloudError::Percent`].
    pub fn new(grid_px: u32, cutoffs: [f64; 4], percentages: [f64; 4]) -> Result<Self, CloudError> {
        if grid_px == 0 {
            return Err(CloudError::GridSize);
        }
        let rises = cutoffs.windows(2).all(|pair| pair[0] < pair[1]);
        if !(cutoffs[0] == 0.0 && rises && cutoffs[RANGES - 1] <= 1.0) {
            return Err(CloudError::Cutoffs(cutoffs));
        }
        let [a, b, c, d] = percentages.map(Percent::new);
        Ok(Self {
            grid_px,
            cutoffs,
            percentages: [a?, b?, c?, d?],
        })
    }

    /// Which range a similarity lies in, the lowest first.
    fn range(&self, similarity: f64) -> usize {
        let above = self.cutoffs.iter().rposition(|c| similarity >= *c);
        above.unwrap_or(0)
    }
}

impl Default for SimilarityRanges {
    /// Those of the first published experiment.
    fn default() -> Self {
        Self {
            grid_px: Self::GRID_PX,
            cutoffs: Self::CUTOFFS,
            percentages: Self::PERCENTAGES.map(Percent),
        }
    }
}

/// The indices to keep, cell by cell.
pub(super) fn keep(
    cloud: &PointCloud,
    ranges: &SimilarityRanges,
    task: &Task,
) -> Result<Vec<u32>, CloudError> {
    let cells = cells(cloud, ranges.grid_px)?;
    let slices = Slices::of(cloud);
    let kept: Vec<Vec<u32>> = cells
        .par_iter()
        .map(|members| {
            let range = range_of(cloud, members, ranges, task)?;
            let percent = ranges.percentages[RANGES - 1 - range];
            let places = slices.places(members);
            let kept = keep_of_slice(&places, slices.metric(), percent, task)?;
            task.advance(members.len())?;
            Ok(kept.into_iter().map(|i| members[i as usize]).collect())
        })
        .collect::<Result<_, CloudError>>()?;
    Ok(kept.concat())
}

/// How many cells, each of one slice, have a similarity in each range, the lowest first.
///
/// # Errors
/// [`CloudError::NoPixels`] for a cloud without a lattice, [`CloudError::Cancelled`].
pub fn count_ranges(
    cloud: &PointCloud,
    ranges: &SimilarityRanges,
    task: &Task,
) -> Result<[usize; 4], CloudError> {
    let cells = cells(cloud, ranges.grid_px)?;
    task.begin("similarity", cloud.len());
    let found: Vec<usize> = cells
        .par_iter()
        .map(|members| {
            let range = range_of(cloud, members, ranges, task)?;
            task.advance(members.len())?;
            Ok(range)
        })
        .collect::<Result<_, CloudError>>()?;
    let mut counts = [0; RANGES];
    for range in found {
        counts[range] += 1;
    }
    Ok(counts)
}

/// The range of one cell.
fn range_of(
    cloud: &PointCloud,
    members: &[u32],
    ranges: &SimilarityRanges,
    task: &Task,
) -> Result<usize, CloudError> {
    let points: Vec<_> = members
        .iter()
        .map(|i| cloud.points_mm()[*i as usize])
        .collect();
    let normals = normals(&points, NEIGHBOURS, task)?;
    Ok(ranges.range(mean_similarity(&normals, task)?))
}

/// The points of each cell and slice, in the cloud's order; the first cell begins at the lowest column
/// and row of all.
fn cells(cloud: &PointCloud, grid_px: u32) -> Result<Vec<Vec<u32>>, CloudError> {
    let Some(lattice) = cloud.lattice() else {
        return if cloud.is_empty() {
            Ok(Vec::new())
        } else {
            Err(CloudError::NoPixels)
        };
    };
    let places = &lattice.coordinates;
    let lowest = |axis: usize| places.iter().map(|c| i64::from(c[axis])).min().unwrap_or(0);
    let first = [lowest(0), lowest(1)];
    let cell = |i: &u32| {
        let [column, row, slice] = places[*i as usize].map(i64::from);
        let grid = i64::from(grid_px);
        (slice, (row - first[1]) / grid, (column - first[0]) / grid)
    };
    let mut order: Vec<u32> = (0..cloud.len() as u32).collect();
    order.sort_by_cached_key(cell);
    let cells = order.chunk_by(|a, b| cell(a) == cell(b));
    Ok(cells.map(<[u32]>::to_vec).collect())
}

#[cfg(test)]
mod tests;
