//! Step 2: vertices near a selected one and on its inner side.
//!
//! The selected vertices lie in a grid of cells a little larger than the thickness, so the ones
//! within it of a vertex lie in the 27 cells around it. Most vertices of a mesh have none there.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::Patch;
use super::levels::is_same_level;
use bonemesh_mesh::vector::minus;

/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 12;

/// The unselected vertices, ascending, that are within the thickness of a selected one (Manhattan)
/// and nearer to its projection than to it, or, with one level selected, on another level; and
/// that are not above the projection's top.
pub(super) fn of_patch(patch: &Patch<'_>, task: &Task) -> Result<Vec<u32>, Cancelled> {
    task.begin("region", patch.vertices_mm.len());
    let grid = Grid::of(patch);
    let top = patch.projected_top();
    let found: Vec<Vec<u32>> = patch
        .vertices_mm
        .par_chunks(STRIDE)
        .enumerate()
        .map(|(chunk, points)| {
            task.advance(points.len())?;
            let first = (chunk * STRIDE) as u32;
            let surround = (first..).zip(points).filter(|&(vertex, &point)| {
                point[2] <= top
                    && !patch.selection.contains(vertex)
                    && grid.any_near(point, |selected| is_behind(patch, point, selected))
            });
            Ok(surround.map(|(vertex, _)| vertex).collect())
        })
        .collect::<Result<_, Cancelled>>()?;
    Ok(found.concat())
}

/// Whether `point` is within the thickness of `selected` and on its inner side.
fn is_behind(patch: &Patch<'_>, point: [f64; 3], selected: [f64; 3]) -> bool {
    let distance = manhattan(point, selected);
    distance <= patch.thickness_mm
        && if patch.is_one_level() {
            !is_same_level(point, selected)
        } else {
            let projected = [0, 1, 2].map(|axis| selected[axis] + patch.shift[axis]);
            manhattan(point, projected) < distance
        }
}

/// Sum of the coordinate differences.
fn manhattan(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = minus(a, b).map(f64::abs);
    x + y + z
}

/// The selected vertices by cell.
struct Grid {
    cell_mm: f64,
    low: [i64; 3],
    high: [i64; 3],
    cells: FxHashMap<[i64; 3], Vec<[f64; 3]>>,
}

impl Grid {
    fn of(patch: &Patch<'_>) -> Self {
        let farthest = patch
            .vertices_mm
            .as_flattened()
            .iter()
            .fold(0.0_f64, |farthest, c| farthest.max(c.abs()));
        // Larger than the thickness by more than the division rounds: points that far apart are
        // never two cells apart.
        let cell_mm = (1.001 * patch.thickness_mm).max(1e-6 * farthest);
        let mut cells = FxHashMap::<[i64; 3], Vec<[f64; 3]>>::default();
        let (mut low, mut high) = ([i64::MAX; 3], [i64::MIN; 3]);
        for point in patch.points() {
            let cell = cell_of(point, cell_mm);
            low = [0, 1, 2].map(|axis| low[axis].min(cell[axis]));
            high = [0, 1, 2].map(|axis| high[axis].max(cell[axis]));
            cells.entry(cell).or_default().push(point);
        }
        Self {
            cell_mm,
            low,
            high,
            cells,
        }
    }

    /// Whether `test` holds for one of the selected vertices in the cells around `point`.
    fn any_near(&self, point: [f64; 3], test: impl Fn([f64; 3]) -> bool) -> bool {
        let [i, j, k] = cell_of(point, self.cell_mm);
        let is_far = [i, j, k]
            .iter()
            .zip(self.low.iter().zip(&self.high))
            .any(|(cell, (low, high))| *cell < low - 1 || *cell > high + 1);
        if is_far {
            return false;
        }
        let around = |centre: i64| centre - 1..=centre + 1;
        around(i)
            .flat_map(|i| around(j).map(move |j| (i, j)))
            .flat_map(|(i, j)| around(k).map(move |k| [i, j, k]))
            .filter_map(|cell| self.cells.get(&cell))
            .flatten()
            .any(|&selected| test(selected))
    }
}

/// The cell of a point; at most a million cells from the origin, see [`Grid::of`].
fn cell_of(point: [f64; 3], cell_mm: f64) -> [i64; 3] {
    point.map(|c| (c / cell_mm).floor() as i64)
}
