//! How thick the bone is under a selection.

use bonemesh_mesh::{TriangleMesh, TriangleTree, wall_thickness_at};
use bonemesh_task::Task;

use crate::RoiError;
use crate::selection::Selection;
use crate::solid::{Neighbourhood, Space, is_inside_out};

/// How far (mm) from the selection the other side of the bone is looked for.
const REACH_MM: f64 = 40.0;
/// Vertices that are looked at, evenly among those selected: enough for a median.
const MOST: usize = 2_000;

/// The thickness of the bone under some vertices (mm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalThickness {
    /// The least.
    pub least_mm: f64,
    /// Half of the vertices have less.
    pub median_mm: f64,
    /// The largest.
    pub largest_mm: f64,
}

/// Measures how thick the bone is under the `selected` vertices, as [`bonemesh_mesh::wall_thickness`] does;
/// `None` where nothing lies opposite within 40 mm. A mesh that is inside out is measured as if it were not.
///
/// # Errors
/// [`RoiError::NoSelection`], [`RoiError::OneVertex`], [`RoiError::Index`], or the work was cancelled.
pub fn local_thickness(
    mesh: &TriangleMesh,
    selected: &[u32],
    task: &Task,
) -> Result<Option<LocalThickness>, RoiError> {
    let selection = Selection::new(selected, mesh.vertices_mm().len())?;
    let place = |vertex: &u32| mesh.vertices_mm()[*vertex as usize];
    let space = Space::of(selection.indices().iter().map(place)).ok_or(RoiError::NoSelection)?;
    let near = Neighbourhood::around(mesh, &space.wider(REACH_MM), task)?;
    let numbers = (0..).zip(&near.of_mesh);
    let own: Vec<u32> = numbers
        .filter(|(_, vertex)| selection.contains(**vertex))
        .map(|(number, _)| number)
        .collect();
    let some: Vec<u32> = own
        .iter()
        .step_by(own.len().div_ceil(MOST).max(1))
        .copied()
        .collect();
    let mut triangles = near.triangles;
    if is_inside_out(mesh) {
        for corners in &mut triangles {
            corners.swap(1, 2);
        }
    }
    let near = TriangleMesh::new(near.vertices_mm, triangles)?;
    let tree = TriangleTree::new(&near, task)?;
    let mut thickness = wall_thickness_at(&tree, &some, task)?;
    thickness.retain(|mm| mm.is_finite());
    thickness.sort_by(f64::total_cmp);
    let (Some(least), Some(largest)) = (thickness.first(), thickness.last()) else {
        return Ok(None);
    };
    Ok(Some(LocalThickness {
        least_mm: *least,
        median_mm: thickness[thickness.len() / 2],
        largest_mm: *largest,
    }))
}
