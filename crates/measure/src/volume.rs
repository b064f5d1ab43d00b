//! Volumes of meshes and of tetrahedra.

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::chunked_sum;
use rayon::prelude::*;

use bonemesh_mesh::vector::{cross, dot, minus};

/// The volume (mm3) inside a closed mesh, negative if it faces inward; of an open one it means nothing.
///
/// It is that of the surface where it lies: a mesh through the centres of voxels is a pixel narrower and a
/// slice shorter than the voxels together.
pub fn mesh_volume_mm3(mesh: &TriangleMesh) -> f64 {
    let Some([low, high]) = mesh.bounds_mm() else {
        return 0.0;
    };
    // From the middle of the mesh, since the origin may be far away and digits would be lost.
    let middle = [0, 1, 2].map(|axis| f64::midpoint(low[axis], high[axis]));
    let sixths: Vec<f64> = mesh
        .triangles()
        .par_iter()
        .map(|t| {
            let [a, b, c] = mesh.corners_mm(*t).map(|corner| minus(corner, middle));
            dot(a, cross(b, c))
        })
        .collect();
    chunked_sum(&sixths) / 6.0
}

/// The volume (mm3) of tetrahedra over `points_mm`, each counted positive.
///
/// # Panics
/// When a number is not below the number of points.
pub fn tetrahedra_volume_mm3(points_mm: &[[f64; 3]], cells: &[[u32; 4]]) -> f64 {
    let sixths: Vec<f64> = cells
        .par_iter()
        .map(|cell| {
            let [a, b, c, d] = cell.map(|i| points_mm[i as usize]);
            dot(minus(b, a), cross(minus(c, a), minus(d, a))).abs()
        })
        .collect();
    chunked_sum(&sixths) / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_far_away_has_the_volume_of_one_at_the_origin() {
        for far in [0.0, 1e6] {
            let points = [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]];
            let points = points.map(|p| p.map(|c| c + far)).to_vec();
            assert!(
                (tetrahedra_volume_mm3(&points, &[[0, 1, 2, 3], [0, 2, 1, 3]]) - 9.0).abs() < 1e-9
            );
            let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
            let mesh = TriangleMesh::new(points, faces).unwrap();
            assert!((mesh_volume_mm3(&mesh) - 4.5).abs() < 1e-9);
        }
        assert_eq!(mesh_volume_mm3(&TriangleMesh::default()).to_bits(), 0);
    }
}
