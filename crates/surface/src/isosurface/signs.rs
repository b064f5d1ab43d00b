//! Which voxels are inside, one bit each, with a border of outside ones all around.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

/// Bits of a grid of nodes: the voxels and one outside node beyond each border.
///
/// Node `[i, j, k]` (column, row, slice) is voxel `[i - 1, j - 1, k - 1]`.
pub(crate) struct Signs {
    /// Nodes along columns, rows and slices.
    pub(super) nodes: [usize; 3],
    /// 64-bit words a row of voxels has, one more than it needs at most.
    pub(super) words: usize,
    /// Rows of voxels, then one of the border.
    bits: Vec<u64>,
}

impl Signs {
    /// Of voxels `shape` (columns, rows, slices), inside where `is_inside` says so.
    pub(crate) fn of(
        shape: [usize; 3],
        is_inside: impl Fn([usize; 3]) -> bool + Sync,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let [columns, rows, slices] = shape;
        // The border's nodes, and a word beyond the last to look into.
        let words = (columns + 2).div_ceil(64) + 1;
        let mut bits = vec![0u64; words * (rows * slices + 1)];
        bits[..words * rows * slices]
            .par_chunks_mut(words * rows)
            .enumerate()
            .try_for_each(|(k, slice)| {
                task.check()?;
                for (j, row) in slice.chunks_mut(words).enumerate() {
                    for i in 0..columns {
                        row[(i + 1) / 64] |= u64::from(is_inside([i, j, k])) << ((i + 1) % 64);
                    }
                }
                Ok(())
            })?;
        Ok(Self {
            nodes: shape.map(|n| n + 2),
            words,
            bits,
        })
    }

    /// Node rows of a slice.
    pub(super) fn rows(&self) -> usize {
        self.nodes[1]
    }

    /// Node slices.
    pub(crate) fn slices(&self) -> usize {
        self.nodes[2]
    }

    /// The bits of a row of nodes.
    #[inline]
    pub(super) fn row(&self, j: usize, k: usize) -> &[u64] {
        let (rows, slices) = (self.nodes[1] - 2, self.nodes[2] - 2);
        let is_voxel = (1..=rows).contains(&j) && (1..=slices).contains(&k);
        let row = if is_voxel {
            (k - 1) * rows + j - 1
        } else {
            rows * slices
        };
        &self.bits[row * self.words..][..self.words]
    }

    /// Bit `i` tells, for word `w` of the row, whether the edge from node `i` along `axis` is cut.
    #[inline]
    pub(super) fn cuts(&self, axis: usize, j: usize, k: usize, w: usize) -> u64 {
        let row = self.row(j, k);
        match axis {
            0 => row[w] ^ after(row, w),
            // Past the last row and slice lies more border.
            1 => row[w] ^ self.row(j + 1, k)[w],
            _ => row[w] ^ self.row(j, k + 1)[w],
        }
    }

    /// How many edges along each axis from the nodes of a row are cut.
    pub(super) fn count_cuts(&self, j: usize, k: usize) -> [u32; 3] {
        [0, 1, 2].map(|axis| {
            (0..self.words)
                .map(|w| self.cuts(axis, j, k, w).count_ones())
                .sum()
        })
    }
}

/// Word `w` of the row, moved so that each node has the bit of the one after it.
#[inline]
pub(super) fn after(row: &[u64], w: usize) -> u64 {
    row[w] >> 1 | row.get(w + 1).map_or(0, |next| next << 63)
}
