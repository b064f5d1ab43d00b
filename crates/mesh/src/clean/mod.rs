//! Triangles that are no part of a surface, taken out.
//!
//! 1. Triangles with two equal corners go: their other two edges are one.
//! 2. `doubled`: of equal triangles one stays, or none where they are a wall without thickness.
//! 3. `needles`: a triangle without area lies along an edge; its neighbour across that edge is divided instead.
//!    What comes of that may be there already, so 2 and 3 take turns until nothing changes.

mod doubled;
mod needles;

use bonemesh_task::Task;

use crate::topology::is_collapsed;
use crate::{MeshError, TriangleMesh};

/// What [`clean`] gives.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Cleaned {
    /// The mesh, in coordinates that a file's 32-bit floats hold.
    pub mesh: TriangleMesh,
    /// Triangles taken out that had two equal corners or no area.
    pub degenerate: usize,
    /// Triangles taken out that lay on others with the same corners.
    pub doubled: usize,
}

/// Takes out triangles without area and triangles that lie on others, without opening a surface that is closed.
///
/// A triangle without area whose corners differ is a fold along its longest edge: it goes, and the neighbour
/// across that edge is divided at its middle corner. Of triangles with the same corners one stays; where two
/// surfaces are joined by a wall without thickness (triangles that face each other, with an edge of three
/// or more different triangles), none. What cannot be mended so stays as it is, and
/// [`crate::check_topology`] counts it.
///
/// The mesh is taken as its file gives it back ([`TriangleMesh::as_written`]); vertices keep their numbers.
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::NotFinite`] for a coordinate too large for a 32-bit float, [`MeshError::Cancelled`].
pub fn clean(mesh: &TriangleMesh, task: &Task) -> Result<Cleaned, MeshError> {
    let mesh = mesh.as_written(task)?;
    let given = mesh.triangles().len();
    task.begin("cleaning", given);
    let mut triangles = mesh.triangles().to_vec();
    triangles.retain(|triangle| !is_collapsed(*triangle));
    let mut degenerate = given - triangles.len();
    let mut doubled = 0;
    loop {
        let before = triangles.len();
        doubled::take_out(&mut triangles, task)?;
        doubled += before - triangles.len();
        let needles = needles::divide_neighbours(mesh.vertices_mm(), &mut triangles, task)?;
        degenerate += needles;
        if needles == 0 {
            break;
        }
    }
    Ok(Cleaned {
        doubled,
        degenerate,
        mesh: TriangleMesh::new(mesh.vertices_mm().to_vec(), triangles)?,
    })
}
