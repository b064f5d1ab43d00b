//! Tetrahedra that lie on the surface, neither in the bone nor in the air.
//!
//! Their corners are all on the surface, so that hardly anything decides what they are, and each
//! of them labelled at odds with those beside it is a tooth. They become what makes the surface
//! smaller. Each change makes it smaller, so this ends.

use bonemesh_task::{Cancelled, Task};
use rustc_hash::FxHashSet;

use super::points::Grid;

/// Times that all of them are looked at, at most.
const ROUNDS: usize = 4;
/// Tetrahedra looked at between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// Changes the labels of cells `shallow` (ascending) where that makes the boundary `triangles` of
/// the bone smaller; whether any changed.
pub(super) fn smooth(
    cells: &[[u32; 4]],
    shallow: &[u32],
    is_bone: &mut [bool],
    triangles: &[[u32; 3]],
    grid: &Grid,
    task: &Task,
) -> Result<bool, Cancelled> {
    let mut boundary: FxHashSet<[u32; 3]> = triangles.iter().copied().map(sorted).collect();
    let mut is_changed = false;
    for _ in 0..ROUNDS {
        let mut changed = 0;
        for (i, &c) in shallow.iter().enumerate() {
            if i % STRIDE == 0 {
                task.check()?;
            }
            let facets = facets(cells[c as usize]);
            let is_between = facets.map(|f| boundary.contains(&f));
            if !is_between.contains(&true) || !is_smaller(facets, is_between, grid) {
                continue;
            }
            for (facet, is_between) in facets.into_iter().zip(is_between) {
                if is_between {
                    boundary.remove(&facet);
                } else {
                    boundary.insert(facet);
                }
            }
            is_bone[c as usize] ^= true;
            changed += 1;
        }
        is_changed |= changed > 0;
        if changed == 0 {
            break;
        }
    }
    Ok(is_changed)
}

fn sorted(mut facet: [u32; 3]) -> [u32; 3] {
    facet.sort_unstable();
    facet
}

fn facets([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 4] {
    [[b, c, d], [a, c, d], [a, b, d], [a, b, c]].map(sorted)
}

/// Whether the facets that are boundary have more area than the others.
fn is_smaller(facets: [[u32; 3]; 4], is_between: [bool; 4], grid: &Grid) -> bool {
    let mut gain = 0.0;
    for (facet, is_between) in facets.into_iter().zip(is_between) {
        let area = area(facet, grid);
        gain += if is_between { area } else { -area };
    }
    // Not by rounding alone: a cell must not change for ever.
    gain > 0.5
}

/// Twice the area, in squares of the grid.
fn area([a, b, c]: [u32; 3], grid: &Grid) -> f64 {
    let at = |v: u32| grid.coordinates[v as usize].map(f64::from);
    let (start, p, q) = (at(a), at(b), at(c));
    let [u, v] = [p, q].map(|p| [0, 1, 2].map(|k| p[k] - start[k]));
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    normal.iter().map(|n| n * n).sum::<f64>().sqrt()
}
