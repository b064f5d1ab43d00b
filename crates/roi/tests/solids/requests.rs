//! What does not matter for a solid, and what makes none.

use std::f64::consts::PI;
use std::num::NonZeroUsize;

use bonemesh_mesh::TriangleMesh;
use bonemesh_roi::{Direction, RoiError, SolidRequest, select_solid};
use bonemesh_task::{Task, pool};

use crate::bodies::{body, length, request, selected, shell, solid, sound, volume_mm3};

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

#[test]
fn what_is_wrong_with_a_request_is_said() {
    let shell = shell();
    let patch = selected(&shell, |p| length(p) > 17.0 && p[2] > 17.0);
    let task = Task::default();
    let error =
        |mesh: &TriangleMesh, request| select_solid(mesh, &patch, &request, &task).unwrap_err();
    let turned = shell.triangles().iter().map(|[a, b, c]| [*a, *c, *b]);
    let turned = TriangleMesh::new(shell.vertices_mm().to_vec(), turned.collect()).unwrap();
    assert!(matches!(error(&turned, request(3.0)), RoiError::NothingCut));
    assert!(matches!(
        error(&shell, request(0.01)),
        RoiError::TooThin { .. }
    ));
    let from_behind = SolidRequest {
        direction: Direction::along([0.0, 0.0, 1.0]).unwrap(),
        ..request(3.0)
    };
    assert!(matches!(error(&shell, from_behind), RoiError::FacesAway));
}

#[test]
fn a_thin_bone_selected_on_both_sides_is_cut_out_whole() {
    let lamella = body([10.0, 10.0, 2.0], |[x, y, z]| {
        (8.0 - x.abs()).min(8.0 - y.abs()).min(0.8 - z.abs())
    });
    let patch = selected(&lamella, |[x, y, _]| x.hypot(y) < 5.0);
    let both = SolidRequest {
        with_hidden: true,
        ..request(3.0)
    };
    let part = volume_mm3(&sound(&lamella, &patch, &both)) / (PI * 25.0 * 1.6);
    assert!((part - 1.0).abs() < 0.03, "{part}");
}
