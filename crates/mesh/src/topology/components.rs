//! Connected parts.

use bonemesh_task::{Cancelled, Task};

use super::is_collapsed;
use super::sets::Sets;
use crate::TriangleMesh;

/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 16;

/// Parts that share no vertex with one another.
pub(super) struct Components {
    pub(super) count: usize,
    /// Those whose volume is negative.
    pub(super) inward: usize,
}

/// Counts the parts, `volumes` being what each triangle adds to the volume of its part.
pub(super) fn count(
    mesh: &TriangleMesh,
    volumes: &[f64],
    task: &Task,
) -> Result<Components, Cancelled> {
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
    let count = is_used.iter().filter(|used| **used).count() - joins;
    let mut of_parts = vec![0.0; mesh.vertices_mm().len()];
    let triangles = mesh.triangles().chunks(STRIDE).zip(volumes.chunks(STRIDE));
    for (triangles, volumes) in triangles {
        for (triangle, volume) in triangles.iter().zip(volumes) {
            of_parts[sets.lowest(triangle[0]) as usize] += volume;
        }
        task.check()?;
    }
    Ok(Components {
        count,
        inward: of_parts.iter().filter(|volume| **volume < 0.0).count(),
    })
}
