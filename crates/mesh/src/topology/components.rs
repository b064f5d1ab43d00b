//! Connected parts.

use bonemesh_task::{Cancelled, Task};

use super::is_collapsed;
use super::sets::Sets;
use crate::TriangleMesh;

/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 16;

/// How many parts share no vertex with one another.
pub(super) fn count(mesh: &TriangleMesh, task: &Task) -> Result<usize, Cancelled> {
    let mut sets = Sets::new(mesh.vertices_mm().len());
    let mut is_used = vec![false; mesh.vertices_mm().len()];
    let mut joins = 0;
    for triangles in mesh.triangles().chunks(STRIDE) {
        for &[a, b, c] in triangles.iter().filter(|t| !is_collapsed(**t)) {
            for vertex in [a, b, c] {
                is_used[vertex as usize] = true;
            }
            joins += usize::from(sets.join(a, b)) + usize::from(sets.join(b, c));
        }
        task.check()?;
    }
    // Every join of two sets leaves one part fewer than there were vertices.
    Ok(is_used.iter().filter(|used| **used).count() - joins)
}
