//! Bodies whose walls are known, and what is cut out of them.

use bonemesh_mesh::{TriangleMesh, TriangleTree, check_topology, find_intersections};
use bonemesh_roi::{Solid, SolidRequest, ThicknessMm, select_solid};
use bonemesh_surface::level_surface;
use bonemesh_task::Task;
use bonemesh_volume::Affine;

pub(crate) const STEP_MM: f64 = 0.25;

/// The surface of a body given by how far (mm) places are inside of it, in a box around the origin.
pub(crate) fn body(half_mm: [f64; 3], inside: impl Fn([f64; 3]) -> f64) -> TriangleMesh {
    body_of_edges(STEP_MM, half_mm, inside)
}

/// The same with edges of about that length.
pub(crate) fn body_of_edges(
    step_mm: f64,
    half_mm: [f64; 3],
    inside: impl Fn([f64; 3]) -> f64,
) -> TriangleMesh {
    let shape = half_mm.map(|half| (2.0 * half / step_mm) as usize + 3);
    let first = half_mm.map(|half| -half - step_mm * 0.73);
    let [i, j, k] = shape;
    let mut values = Vec::new();
    for node in 0..i * j * k {
        let at = [node % i, node / i % j, node / i / j];
        let place = [0, 1, 2].map(|axis| first[axis] + step_mm * at[axis] as f64);
        values.push(inside(place) as f32);
    }
    let affine = Affine::from_axes(
        [step_mm, 0.0, 0.0],
        [0.0, step_mm, 0.0],
        [0.0, 0.0, step_mm],
        first,
    );
    let task = Task::default();
    let mesh = level_surface(&values, shape, &affine, &task)
        .unwrap()
        .unwrap();
    mesh.as_written(&task).unwrap()
}

pub(crate) fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// A ball of 20 mm with a hollow of 14 mm.
pub(crate) fn shell() -> TriangleMesh {
    body([21.0; 3], |p| (20.0 - length(p)).min(length(p) - 14.0))
}

pub(crate) fn selected(mesh: &TriangleMesh, is_in: impl Fn([f64; 3]) -> bool) -> Vec<u32> {
    let vertices = (0..).zip(mesh.vertices_mm());
    vertices
        .filter(|(_, v)| is_in(**v))
        .map(|(n, _)| n)
        .collect()
}

pub(crate) fn request(thickness_mm: f64) -> SolidRequest {
    SolidRequest::new(ThicknessMm::new(thickness_mm).unwrap())
}

pub(crate) fn solid(mesh: &TriangleMesh, selected: &[u32], thickness_mm: f64) -> Solid {
    sound(mesh, selected, &request(thickness_mm))
}

/// Cuts, and checks that the result is what a printer needs.
pub(crate) fn sound(mesh: &TriangleMesh, selected: &[u32], request: &SolidRequest) -> Solid {
    let solid = select_solid(mesh, selected, request, &Task::default()).unwrap();
    let task = Task::default();
    let topology = check_topology(&solid.mesh, &task).unwrap();
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    assert_eq!(
        topology.inconsistent_edges + topology.degenerate_triangles,
        0
    );
    assert!(topology.volume_mm3 > 0.0);
    let tree = TriangleTree::new(&solid.mesh, &task).unwrap();
    assert_eq!(find_intersections(&tree, 1, &task).unwrap().count, 0);
    solid
}

pub(crate) fn volume_mm3(solid: &Solid) -> f64 {
    check_topology(&solid.mesh, &Task::default())
        .unwrap()
        .volume_mm3
}
