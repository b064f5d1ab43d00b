//! Bytes as a mesh file: the first chooses between STL, PLY, OBJ and 3MF.

#![no_main]

use bonemesh_fuzz::with_files;
use bonemesh_mesh::read_mesh;
use bonemesh_task::Task;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let Some((kind, bytes)) = input.split_first() else {
        return;
    };
    let name = ["mesh.stl", "mesh.ply", "mesh.obj", "mesh.3mf"][usize::from(kind & 3)];
    with_files(&[(name, bytes)], |folder| {
        if let Ok(mesh) = read_mesh(folder.join(name), &Task::default()) {
            let vertices = mesh.vertices_mm();
            assert!(vertices.iter().flatten().all(|v| v.is_finite()));
            let is_vertex = |v: &u32| (*v as usize) < vertices.len();
            assert!(mesh.triangles().iter().flatten().all(is_vertex));
        }
    });
});
