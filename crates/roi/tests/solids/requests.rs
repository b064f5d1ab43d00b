//! What does not matter for a solid, and what makes none.

use std::num::NonZeroUsize;

use bonemesh_mesh::TriangleMesh;
use bonemesh_roi::{RoiError, select_solid};
use bonemesh_task::{Task, pool};

use crate::bodies::{length, request, selected, shell, solid};

#[test]
fn the_solid_does_not_depend_on_threads_or_on_the_order_of_the_selection() {
    let shell = shell();
    let mut patch = selected(&shell, |p| length(p) > 17.0 && p[1] > 16.0);
    let cut = |patch: &[u32], threads| {
        let pool = pool(NonZeroUsize::new(threads)).unwrap();
        pool.install(|| solid(&shell, patch, 3.0))
    };
    let one = cut(&patch, 1);
    assert!(one == cut(&patch, 5));
    patch.reverse();
    patch.push(patch[0]);
    assert!(one == cut(&patch, 2));
}

#[test]
fn what_cannot_be_cut_is_refused() {
    let shell = shell();
    let request = request(3.0);
    let cut = |mesh: &TriangleMesh, selected: &[u32]| {
        select_solid(mesh, selected, &request, &Task::default()).unwrap_err()
    };
    assert!(matches!(cut(&shell, &[]), RoiError::NoSelection));
    assert!(matches!(cut(&shell, &[u32::MAX]), RoiError::Index { .. }));
    let far = selected(&shell, |p| length(p) > 17.0 && p[0].abs() > 19.9);
    let [first, last] = [far[0], far[far.len() - 1]];
    assert!(matches!(
        cut(&shell, &[first, last]),
        RoiError::NoFace { selected: 2 }
    ));
    let patch = selected(&shell, |p| length(p) > 17.0 && p[2] > 17.0);
    let lid = |t: &&[u32; 3]| !t.contains(&patch[patch.len() / 2]);
    let open: Vec<[u32; 3]> = shell.triangles().iter().filter(lid).copied().collect();
    let open = TriangleMesh::new(shell.vertices_mm().to_vec(), open).unwrap();
    assert!(matches!(cut(&open, &patch), RoiError::Open));
    let task = Task::default();
    task.cancel().cancel();
    let cancelled = select_solid(&shell, &patch, &request, &task).unwrap_err();
    assert!(matches!(cancelled, RoiError::Cancelled(_)));
}
