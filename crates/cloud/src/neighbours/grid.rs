//! Neighbour distances by cells of equal size: four times as fast as a tree, for even clouds.
//!
//! 1. `Grid::new` sorts the points into cells, so that neighbours lie near each other in memory.
//! 2. `distance_sums` walks the points in that order. The ball around one point that holds `k`
//!    points tells how far to look from the next: no further than that radius plus the step
//!    between the two. So nearly all points that are looked at are also among the nearest.
//!
//! Voxels cannot crowd, free points can; where a cell would hold too many, there is no grid.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::BATCH;

/// Cells a point gets on average; surfaces leave most of them empty.
const CELLS_PER_POINT: f64 = 2.0;

/// The number of neighbours for which `CELLS_PER_POINT` was measured; more need larger cells.
const TYPICAL_NEIGHBOURS: f64 = 100.0;

/// A cell may hold this many points for each neighbour asked for.
const CROWDED: usize = 8;

/// Points sorted between two looks at the task.
const STRIDE: usize = 1 << 14;

/// Points sorted into cubes.
pub(super) struct Grid {
    origin: [f64; 3],
    cell_mm: f64,
    /// Cells along x, y, z.
    size: [usize; 3],
    /// Where each cell's points begin, x fastest; one more entry than cells.
    first: Vec<u32>,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
}

impl Grid {
    /// A grid for searches of `k` neighbours, or `None` when the points are too uneven for one.
    pub(super) fn new(
        points: &[[f64; 3]],
        k: usize,
        task: &Task,
    ) -> Result<Option<Self>, Cancelled> {
        let (low, high) = bounds(points);
        let extent: [f64; 3] = std::array::from_fn(|i| high[i] - low[i]);
        let Some(cell_mm) = cell_size(extent, points.len(), k) else {
            return Ok(None);
        };
        let size = extent.map(|e| (e / cell_mm) as usize + 1);
        let mut grid = Self {
            origin: low,
            cell_mm,
            size,
            first: vec![0; size.iter().product::<usize>() + 1],
            x: vec![0.0; points.len()],
            y: vec![0.0; points.len()],
            z: vec![0.0; points.len()],
        };
        for points in points.chunks(STRIDE) {
            task.check()?;
            for point in points {
                let cell = grid.cell_of(*point);
                grid.first[cell + 1] += 1;
            }
        }
        let fullest = grid.first.iter().max().map_or(0, |n| *n as usize);
        if fullest > CROWDED * k {
            return Ok(None);
        }
        for cell in 1..grid.first.len() {
            grid.first[cell] += grid.first[cell - 1];
        }
        let mut next = grid.first.clone();
        for points in points.chunks(STRIDE) {
            task.check()?;
            for point in points {
                let slot = &mut next[grid.cell_of(*point)];
                let at = *slot as usize;
                *slot += 1;
                [grid.x[at], grid.y[at], grid.z[at]] = *point;
            }
        }
        Ok(Some(grid))
    }

    /// For each point, in the grid's order, the sum of the distances to its `k` nearest, itself
    /// included.
    pub(super) fn distance_sums(&self, k: usize, task: &Task) -> Result<Vec<f64>, Cancelled> {
        self.sums_from(self.x.len(), |index| self.point(index), k, task)
    }

    /// For each of `centres` the sum of the distances to the `k` nearest points.
    pub(super) fn distance_sums_from(
        &self,
        centres: &[[f64; 3]],
        k: usize,
        task: &Task,
    ) -> Result<Vec<f64>, Cancelled> {
        self.sums_from(centres.len(), |index| centres[index], k, task)
    }

    fn sums_from(
        &self,
        centres: usize,
        centre: impl Fn(usize) -> [f64; 3] + Sync,
        k: usize,
        task: &Task,
    ) -> Result<Vec<f64>, Cancelled> {
        let mut sums = vec![0.0; centres];
        sums.par_chunks_mut(BATCH)
            .enumerate()
            .try_for_each(|(batch, sums)| {
                let mut search = Search::new(self, k);
                for (offset, sum) in sums.iter_mut().enumerate() {
                    // A ball may hold very many points where k is large.
                    task.check()?;
                    *sum = search.distance_sum(centre(batch * BATCH + offset));
                }
                task.advance(sums.len())
            })?;
        Ok(sums)
    }

    fn point(&self, index: usize) -> [f64; 3] {
        [self.x[index], self.y[index], self.z[index]]
    }

    /// The cell coordinate along `axis`, clamped to the grid.
    fn coordinate(&self, axis: usize, value: f64) -> usize {
        // The cast saturates: below the grid is 0.
        (((value - self.origin[axis]) / self.cell_mm) as usize).min(self.size[axis] - 1)
    }

    fn cell_of(&self, point: [f64; 3]) -> usize {
        let [x, y, z] = std::array::from_fn(|axis| self.coordinate(axis, point[axis]));
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// Puts into `found` the squared distances to all points within `radius_mm` of `centre`.
    fn squared_distances(&self, centre: [f64; 3], radius_mm: f64, found: &mut Found) {
        // A point exactly on the ball must not be lost to rounding.
        let reach = radius_mm * (1.0 + 1e-9);
        let limit = reach * reach;
        let low: [usize; 3] = std::array::from_fn(|a| self.coordinate(a, centre[a] - reach));
        let high: [usize; 3] = std::array::from_fn(|a| self.coordinate(a, centre[a] + reach));
        found.len = 0;
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                let row = (z * self.size[1] + y) * self.size[0];
                let start = self.first[row + low[0]] as usize;
                let end = self.first[row + high[0] + 1] as usize;
                let squared = self.x[start..end]
                    .iter()
                    .zip(&self.y[start..end])
                    .zip(&self.z[start..end])
                    .map(|((x, y), z)| {
                        let (dx, dy, dz) = (x - centre[0], y - centre[1], z - centre[2]);
                        dx * dx + dy * dy + dz * dz
                    });
                found.keep_up_to(limit, squared);
            }
        }
    }
}

/// A buffer to which values are added without a branch for each.
struct Found {
    values: Vec<f64>,
    len: usize,
}

impl Found {
    fn keep_up_to(&mut self, limit: f64, values: impl ExactSizeIterator<Item = f64>) {
        let needed = self.len + values.len();
        if self.values.len() < needed {
            self.values.resize(2 * needed, 0.0);
        }
        let room = &mut self.values[..needed];
        for value in values {
            room[self.len] = value;
            self.len += usize::from(value <= limit);
        }
    }
}

/// One worker's walk through the grid.
struct Search<'a> {
    grid: &'a Grid,
    k: usize,
    found: Found,
    /// The last point and the radius of the ball around it that holds `k` points.
    last: Option<([f64; 3], f64)>,
}

impl<'a> Search<'a> {
    fn new(grid: &'a Grid, k: usize) -> Self {
        let found = Found {
            values: Vec::new(),
            len: 0,
        };
        Self {
            grid,
            k,
            found,
            last: None,
        }
    }

    fn distance_sum(&mut self, centre: [f64; 3]) -> f64 {
        let mut radius = self.first_radius(centre);
        loop {
            self.grid.squared_distances(centre, radius, &mut self.found);
            if self.found.len >= self.k {
                break;
            }
            radius *= 1.4;
        }
        let found = &mut self.found.values[..self.found.len];
        let (_, farthest, _) = found.select_nth_unstable_by(self.k - 1, f64::total_cmp);
        self.last = Some((centre, farthest.sqrt()));
        found[..self.k].iter().map(|squared| squared.sqrt()).sum()
    }

    /// How far to look first.
    fn first_radius(&self, centre: [f64; 3]) -> f64 {
        match self.last {
            Some((point, radius)) if radius > 0.0 => {
                let squared = (0..3).map(|i| (centre[i] - point[i]).powi(2)).sum::<f64>();
                let step = squared.sqrt();
                // After a long step the old ball says less than the cloud's usual density does.
                radius + step.min(radius * 0.25)
            }
            _ => self.grid.cell_mm,
        }
    }
}

/// Smallest and largest coordinates.
fn bounds(points: &[[f64; 3]]) -> ([f64; 3], [f64; 3]) {
    let none = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    points.iter().fold(none, |(low, high), p| {
        (
            std::array::from_fn(|i| low[i].min(p[i])),
            std::array::from_fn(|i| high[i].max(p[i])),
        )
    })
}

/// The edge of a cell (mm): `CELLS_PER_POINT` in the box around the points, of whose sides only
/// those longer than a cell count.
fn cell_size(extent: [f64; 3], points: usize, k: usize) -> Option<f64> {
    let cells = points as f64 * CELLS_PER_POINT;
    let mut sides = extent;
    sides.sort_by(f64::total_cmp);
    let [short, middle, long] = sides;
    let solid = [short, middle, long].map(f64::cbrt).iter().product::<f64>() / cells.cbrt();
    let flat = middle.sqrt() * long.sqrt() / cells.sqrt();
    let even = if short >= solid {
        solid
    } else if middle >= flat {
        flat
    } else {
        long / cells
    };
    let size = even * (k as f64 / TYPICAL_NEIGHBOURS).sqrt().max(0.5);
    // A box without width, or one that floating point cannot divide, makes no grid.
    let count: f64 = extent.iter().map(|e| (e / size).floor() + 1.0).product();
    (size.is_normal() && count <= 20.0 * cells + 64.0).then_some(size)
}
