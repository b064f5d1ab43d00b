//! Neighbour distances on a lattice, without computing any: points are bits of a packed image.
//!
//! 1. `Offsets` sorts the steps to neighbouring places by length. Few lengths are distinct; each
//!    is a class.
//! 2. A `Level` is a ball of such steps: the bits to look at in each row around a point, several
//!    rows side by side in one word, and the class of each bit.
//! 3. `Search::look` counts the points of each class around one point. Those beyond the `k`-th are
//!    taken away from the outside in; what is left is added to a tally for the whole cloud.
//!
//! The sum of all distances is the tally times the lengths: whole numbers until the end, so the
//! order of the work cannot show. Points too lonely for the largest ball are left to others.

mod level;
mod offsets;
#[cfg(test)]
mod tests;

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::Lattice;
use level::{Layout, Level, levels};
use offsets::Offsets;

/// Steps in the largest ball for each neighbour asked for; where more are needed, a cell grid
/// has less to look at.
const STEPS_PER_NEIGHBOUR: usize = 40;

/// More steps than this have no table.
const MAX_STEPS: usize = 60_000;

/// Bits of the packed image a point may cost.
const BITS_PER_POINT: f64 = 1024.0;

/// Points that one worker takes at a time.
const BATCH: usize = 4096;

/// Points from which the usual level is learnt.
const PROBES: usize = 256;

/// Columns that share the memory of the last level.
const COLUMNS_PER_MEMORY: usize = 8;

/// Points packed into bits, and the levels to look at around them.
pub(super) struct Packed<'a> {
    coordinates: &'a [[i32; 3]],
    k: usize,
    offsets: Offsets,
    levels: Vec<Level>,
    /// The smallest level that holds a class.
    level_of_class: Vec<u8>,
    usual_level: u8,
    low: [i32; 3],
    layout: Layout,
    bits: Vec<u8>,
}

/// What a batch of points adds to the whole.
struct Batch {
    /// Neighbours of each class.
    tally: Vec<u32>,
    lonely: Vec<u32>,
}

/// The result for a whole cloud.
pub(super) struct Sums {
    /// Sum of the distances (mm) of all points but the lonely to their `k` nearest.
    pub(super) sum_mm: f64,
    /// Indices of the points too far from others.
    pub(super) lonely: Vec<u32>,
}

impl<'a> Packed<'a> {
    /// `None` where the lattice is not worth it: points that share a place, too few points in too
    /// large a box, or a lattice without handy steps.
    pub(super) fn new(lattice: &'a Lattice, k: usize) -> Option<Self> {
        let steps = STEPS_PER_NEIGHBOUR * k;
        if steps > MAX_STEPS {
            return None;
        }
        let affine = &lattice.frame_from_lattice;
        let offsets = Offsets::new([0, 1, 2].map(|axis| affine.axis(axis)), steps)?;
        let coordinates = &lattice.coordinates[..];
        let (low, layout, bits) = pack(coordinates, offsets.reach())?;
        let levels = levels(&offsets, k, layout);
        let level_of_class = (0..offsets.distances_mm.len())
            .map(|class| levels.partition_point(|level| level.classes <= class) as u8)
            .collect();
        let mut packed = Self {
            coordinates,
            k,
            offsets,
            levels,
            level_of_class,
            usual_level: 0,
            low,
            layout,
            bits,
        };
        packed.usual_level = packed.probe()?;
        Some(packed)
    }

    /// The level that most points need, or `None` when many need more than there is.
    fn probe(&self) -> Option<u8> {
        let mut search = Search::new(self);
        let stride = self.coordinates.len().div_ceil(PROBES);
        let mut needed = Vec::new();
        let mut lonely = 0;
        for point in self.coordinates.iter().step_by(stride) {
            match search.take(*point) {
                Some(level) => needed.push(level),
                None => lonely += 1,
            }
        }
        needed.sort_unstable();
        (lonely <= needed.len() / 4).then(|| needed.get(needed.len() / 2).copied())?
    }

    /// Sums over all points.
    pub(super) fn sums(&self, task: &Task) -> Result<Sums, Cancelled> {
        let batches: Vec<Batch> = self
            .coordinates
            .par_chunks(BATCH)
            .enumerate()
            .map(|(batch, points)| {
                let mut search = Search::new(self);
                let mut lonely = Vec::new();
                for (offset, point) in points.iter().enumerate() {
                    task.check()?;
                    if search.take(*point).is_none() {
                        lonely.push((batch * BATCH + offset) as u32);
                    }
                }
                task.advance(points.len() - lonely.len())?;
                let tally = search.tally;
                Ok(Batch { tally, lonely })
            })
            .collect::<Result<_, Cancelled>>()?;
        let lengths = self.offsets.distances_mm.iter().enumerate();
        let sum_mm = lengths
            .map(|(class, length)| {
                let pairs: u64 = batches.iter().map(|b| u64::from(b.tally[class])).sum();
                pairs as f64 * length
            })
            .sum();
        let lonely = batches.into_iter().flat_map(|b| b.lonely).collect();
        Ok(Sums { sum_mm, lonely })
    }
}

/// One worker's walk.
struct Search<'a> {
    packed: &'a Packed<'a>,
    /// Points of each class around the present point; zero between points.
    counts: Vec<u16>,
    tally: Vec<u32>,
    /// The level last needed near a column: the row above says most about a point.
    levels: Vec<u8>,
}

impl<'a> Search<'a> {
    fn new(packed: &'a Packed<'a>) -> Self {
        let classes = packed.offsets.distances_mm.len();
        Self {
            packed,
            counts: vec![0; classes],
            tally: vec![0; classes],
            levels: vec![packed.usual_level; packed.layout.row / COLUMNS_PER_MEMORY + 1],
        }
    }

    /// Adds the distances from `point` to its nearest to the tally; the level that it took, or
    /// `None` when even the largest is too small.
    fn take(&mut self, point: [i32; 3]) -> Option<u8> {
        let packed = self.packed;
        let from_low: [i32; 3] = std::array::from_fn(|axis| point[axis] - packed.low[axis]);
        let at = packed.layout.bit(from_low);
        let memory = from_low[0] as usize / COLUMNS_PER_MEMORY;
        let mut levels = packed.levels[self.levels[memory] as usize..].iter();
        let (level, found) = loop {
            let level = levels.next()?;
            let found = self.look(at, level);
            if found >= packed.k {
                break (level, found);
            }
            self.counts[..level.classes].fill(0);
        };
        let last = self.drop_farthest(level.classes, found - packed.k);
        let counts = &mut self.counts[..level.classes];
        for (sum, count) in self.tally.iter_mut().zip(counts) {
            *sum += u32::from(*count);
            *count = 0;
        }
        let needed = packed.level_of_class[last];
        self.levels[memory] = needed;
        Some(needed)
    }

    /// Counts the points of each class around the bit `at`, and all of them.
    fn look(&mut self, at: usize, level: &Level) -> usize {
        let bits = &self.packed.bits[..];
        let counts = &mut self.counts[..level.classes];
        let mut found = 0;
        for group in &level.groups {
            let mut word = 0;
            for window in &group.windows {
                let bit = at.wrapping_add_signed(window.offset);
                let bytes = bits[bit / 8..].first_chunk();
                let bytes = bytes.expect("windows lie within the bits, else this is a bug");
                word |= (u64::from_le_bytes(*bytes) >> (bit % 8) & window.mask) << window.shift;
            }
            while word != 0 {
                let class = group.classes[word.trailing_zeros() as usize];
                counts[class as usize] += 1;
                found += 1;
                word &= word - 1;
            }
        }
        found
    }

    /// Takes the `excess` farthest points from the counts; the farthest class that is left.
    fn drop_farthest(&mut self, classes: usize, mut excess: usize) -> usize {
        let mut last = classes - 1;
        loop {
            let count = &mut self.counts[last];
            let dropped = excess.min(*count as usize);
            *count -= dropped as u16;
            excess -= dropped;
            if *count > 0 {
                return last;
            }
            last -= 1;
        }
    }
}

/// The points as bits, the lowest coordinates, and the layout for steps up to `reach`.
fn pack(coordinates: &[[i32; 3]], reach: [i32; 3]) -> Option<([i32; 3], Layout, Vec<u8>)> {
    let first = *coordinates.first()?;
    let (mut low, mut high) = (first, first);
    for point in coordinates {
        for axis in 0..3 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    let size: [f64; 3] = std::array::from_fn(|axis| {
        f64::from(high[axis]) - f64::from(low[axis]) + 1.0 + f64::from(reach[axis])
    });
    let around = f64::from(2 * reach[2] + 2) * size[0] * size[1];
    let needed = size.iter().product::<f64>() + around;
    if needed > BITS_PER_POINT * (coordinates.len() as f64 + 1024.0) {
        return None;
    }
    let [columns, rows, slices] = size.map(|size| size as usize);
    let (row, slice) = (columns, columns * rows);
    let mut layout = Layout {
        lead: 0,
        row,
        slice,
    };
    layout.lead = layout.step(reach) as usize;
    let mut bits = vec![0_u8; (slices * slice + 2 * layout.lead) / 8 + 16];
    for point in coordinates {
        let from_low = std::array::from_fn(|axis| point[axis] - low[axis]);
        let bit = layout.bit(from_low);
        let (byte, mask) = (&mut bits[bit / 8], 1 << (bit % 8));
        if *byte & mask != 0 {
            return None;
        }
        *byte |= mask;
    }
    Some((low, layout, bits))
}
