//! Bodies for what is done to finished meshes, and the promises that hold for all of it.
#![allow(dead_code, reason = "each test file uses its own few")]
#![allow(clippy::unwrap_used, reason = "tests")]

use bonemesh_mesh::{Topology, TriangleMesh, TriangleTree, check_topology, find_intersections};
use bonemesh_task::Task;

use crate::shapes::{BOX, box_vertices, mesh, together, torus};

pub(crate) fn topology(mesh: &TriangleMesh) -> Topology {
    check_topology(mesh, &Task::default()).unwrap()
}

pub(crate) fn meetings(mesh: &TriangleMesh) -> usize {
    let tree = TriangleTree::new(mesh, &Task::default()).unwrap();
    find_intersections(&tree, 0, &Task::default())
        .unwrap()
        .count
}

/// A box that faces inward.
pub(crate) fn hollow(low: [f64; 3], high: [f64; 3]) -> TriangleMesh {
    mesh(
        box_vertices(low, high),
        BOX.map(|[a, b, c]| [a, c, b]).to_vec(),
    )
}

/// A torus with bumps, which differ from seed to seed.
pub(crate) fn bumpy(columns: u32, rows: u32, height: f64, seed: f64) -> TriangleMesh {
    let (vertices, triangles) = torus(columns, rows).into_parts();
    let bump = |[x, y, z]: [f64; 3]| {
        let lift =
            1.0 + height * ((x * 0.9 + seed).sin() + (y * 1.1 - seed).cos() + (z * 1.3).sin());
        [x * lift, y * lift, z * lift]
    };
    mesh(vertices.into_iter().map(bump).collect(), triangles)
}

/// The surface of unit cubes on a lattice, `is_full` ones, with vertices shared.
pub(crate) fn cubes(size: i32, is_full: impl Fn([i32; 3]) -> bool) -> TriangleMesh {
    let mut all = TriangleMesh::default();
    for i in 0..size.pow(3) {
        let at = [i % size, i / size % size, i / size / size];
        if !is_full(at) {
            continue;
        }
        let low = at.map(f64::from);
        let cube = box_vertices(low, low.map(|v| v + 1.0));
        let steps = [
            [-1, 0, 0],
            [1, 0, 0],
            [0, -1, 0],
            [0, 1, 0],
            [0, 0, -1],
            [0, 0, 1],
        ];
        let sides = steps.iter().zip(BOX.chunks(2)).filter(|(step, _)| {
            let beside = [0, 1, 2].map(|axis| at[axis] + step[axis]);
            !(beside.iter().all(|v| (0..size).contains(v)) && is_full(beside))
        });
        let triangles = sides.flat_map(|(_, side)| side.iter().copied()).collect();
        all = together(&all, &mesh(cube, triangles));
    }
    all.merged(&Task::default()).unwrap().compacted()
}

pub(crate) fn assert_sound(before: &Topology, after: &TriangleMesh) {
    let topology = topology(after);
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    assert_eq!(topology.degenerate_triangles, 0);
    assert_eq!(topology.components, before.components);
    let handles =
        |t: &Topology| t.vertices as i64 - t.unused_vertices as i64 - t.triangles as i64 / 2;
    assert_eq!(handles(&topology), handles(before));
    assert_eq!(meetings(after), 0);
    assert_eq!(&after.as_written(&Task::default()).unwrap(), after);
}
