//! From a selection to its region by the thesis's method.

use bonemesh_cloud::{PointCloud, mean_neighbour_distance};
use bonemesh_mesh::TriangleMesh;
use bonemesh_surface::{AlphaSurface, alpha_surface};
use bonemesh_task::Task;

use crate::selection::Selection;
use crate::{RoiError, ThicknessMm, thesis};

/// Neighbours over which alpha is averaged, the point itself included, as for whole clouds.
const NEIGHBOURS: usize = 100;

/// The bone under a selection as a mesh of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Its surface, where it lies in the mesh it was taken from.
    pub mesh: TriangleMesh,
    /// Distinct selected vertices.
    pub selected: usize,
    /// Vertices of the mesh found behind them.
    pub kept_points: usize,
    /// Largest circumradius of a tetrahedron.
    pub alpha_mm: f64,
    /// Unit normal of the selection, into the bone.
    pub normal: [f64; 3],
    /// Tetrahedra that make the region.
    pub tetrahedra: usize,
    /// Their volume.
    pub volume_mm3: f64,
}

/// The region of `mesh` under the `selected` vertices down to `thickness`.
///
/// Selected vertices may repeat and come in any order; the result does not depend on it, nor on
/// the number of threads. The vertices of the region are vertices of the mesh, unmoved. Triangles
/// of the mesh play no part.
///
/// # Errors
/// [`RoiError`]: nothing or one vertex selected, an index the mesh does not have, no normal, a mesh
/// without slices, nothing behind the selection, or the work was cancelled.
pub fn select_region(
    mesh: &TriangleMesh,
    selected: &[u32],
    thickness: ThicknessMm,
    task: &Task,
) -> Result<Region, RoiError> {
    let selection = Selection::new(selected, mesh.vertices_mm().len())?;
    let behind = thesis::find_behind(mesh, &selection, thickness, task)?;
    if behind.kept.is_empty() {
        return Err(RoiError::NothingBehind {
            thickness_mm: thickness.mm(),
        });
    }
    let points = region_points(mesh.vertices_mm(), selection.indices(), &behind.kept);
    // Never all in one plane: in the plane of the selection, a point within t (Manhattan) of a
    // selected one is at least t from its projection along the normal, so it was not kept.
    let cloud = PointCloud::from_points(points)?.with_lattice_recognised();
    let alpha_mm = mean_neighbour_distance(&cloud, NEIGHBOURS, true, task)?;
    let AlphaSurface {
        mesh,
        tetrahedra,
        volume_mm3,
    } = alpha_surface(&cloud, alpha_mm, task)?;
    Ok(Region {
        mesh,
        selected: selection.indices().len(),
        kept_points: behind.kept.len(),
        alpha_mm,
        normal: behind.normal,
        tetrahedra,
        volume_mm3,
    })
}

/// The points (mm) of the selected and the kept vertices in the order of the mesh, each place once.
fn region_points(vertices_mm: &[[f64; 3]], selected: &[u32], kept: &[u32]) -> Vec<[f64; 3]> {
    let mut indices = [selected, kept].concat();
    indices.sort_unstable();
    let mut places = rustc_hash::FxHashSet::default();
    indices
        .into_iter()
        .map(|vertex| vertices_mm[vertex as usize])
        .filter(|point| places.insert(point.map(|c| (c + 0.0).to_bits())))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_of_a_region_is_there_once() {
        let vertices = [[1.0, 2.0, 0.0], [3.0; 3], [1.0, 2.0, -0.0], [4.0; 3]];
        let points = region_points(&vertices, &[0, 3], &[2, 1]);
        assert_eq!(points, [[1.0, 2.0, 0.0], [3.0; 3], [4.0; 3]]);
    }
}
