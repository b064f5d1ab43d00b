//! Closed bodies, those that touch one another in edges or corners on their own.

use bonemesh_task::{Cancelled, Task};

use super::agree::Pair;
use super::label::Labels;
use crate::TriangleMesh;
use crate::topology::Sets;

/// Parts that hang together through edges of exactly two triangles, if all of them at a place are closed;
/// otherwise what shares vertices is one part.
///
/// `pairs`: the triangles at such edges.
pub(super) fn bodies(
    mesh: &TriangleMesh,
    pairs: &[Pair],
    task: &Task,
) -> Result<Labels, Cancelled> {
    let parts = Labels::of(mesh, task)?;
    let triangles = mesh.triangles().len();
    let mut sets = Sets::new(triangles);
    for pair in pairs {
        let [a, b] = pair.triangles;
        sets.join(a, b);
    }
    task.check()?;
    let of_sets = (0..triangles as u32).map(|triangle| sets.lowest(triangle));
    let sheets = Labels::touching(mesh, of_sets, triangles);
    if sheets.count == parts.count {
        return Ok(parts);
    }
    let known = sheets.parts(mesh, task)?;
    let mut has_open = vec![false; parts.count];
    let both = || parts.of_triangles.iter().zip(&sheets.of_triangles);
    for (&part, &sheet) in both() {
        has_open[part as usize] |= !known[sheet as usize].is_closed;
    }
    let either = both().map(|(&part, &sheet)| {
        if has_open[part as usize] {
            sheets.count as u32 + part
        } else {
            sheet
        }
    });
    Ok(Labels::touching(mesh, either, sheets.count + parts.count))
}
