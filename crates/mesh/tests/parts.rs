//! Islands and cavities.

#![allow(clippy::unwrap_used, reason = "tests")]
#![allow(clippy::float_cmp, reason = "rounded volumes")]

mod bodies;
mod shapes;

use bodies::{hollow, topology};
use bonemesh_mesh::{Islands, MeshError, TriangleMesh, fill_cavities, keep_islands};
use bonemesh_task::Task;
use shapes::{box_mesh, mesh, together, torus};

#[test]
fn islands_go_by_their_volume_and_take_their_cavities_along() {
    let big = together(&box_mesh([0.0; 3], [10.0; 3]), &hollow([1.0; 3], [9.0; 3]));
    let small = together(
        &box_mesh([20.0; 3], [25.0; 3]),
        &hollow([21.0; 3], [24.0; 3]),
    );
    let floating = box_mesh([4.0; 3], [6.0; 3]);
    let all = together(&together(&small, &big), &floating);
    let kept = |keep| keep_islands(&all, &keep, &Task::default()).unwrap();
    let volume = |mesh: &TriangleMesh| topology(mesh).volume_mm3.round();

    let largest = kept(Islands::Largest);
    assert_eq!(
        (volume(&largest.mesh), largest.removed.len()),
        (1000.0 - 512.0, 3)
    );
    let removed: Vec<(f64, bool)> = largest
        .removed
        .iter()
        .map(|r| (r.volume_mm3.round(), r.is_cavity))
        .collect();
    assert_eq!(removed, [(125.0, false), (27.0, true), (8.0, false)]);
    assert_eq!(kept(Islands::AtLeastMm3(8.5)).removed.len(), 1);
    assert_eq!(kept(Islands::AtLeastMm3(7.5)).mesh, all);
    assert!(kept(Islands::AtLeastMm3(1e6)).mesh.triangles().is_empty());
}

#[test]
fn islands_are_kept_by_places_in_them_on_them_or_beside_them() {
    let shell = together(&box_mesh([0.0; 3], [10.0; 3]), &hollow([1.0; 3], [9.0; 3]));
    let floating = box_mesh([4.0; 3], [6.0; 3]);
    let other = box_mesh([20.0; 3], [25.0; 3]);
    let all = together(&together(&shell, &floating), &other);
    let volume_at = |places: &[[f64; 3]]| {
        let kept = keep_islands(&all, &Islands::At(places.to_vec()), &Task::default()).unwrap();
        topology(&kept.mesh).volume_mm3.round()
    };
    assert_eq!(volume_at(&[[0.5, 5.0, 5.0]]), 1000.0 - 512.0);
    // Nearest is the wall of its cavity.
    assert_eq!(volume_at(&[[1.5, 5.0, 5.0]]), 1000.0 - 512.0);
    assert_eq!(volume_at(&[[5.0; 3]]), 8.0);
    assert_eq!(volume_at(&[[26.0; 3]]), 125.0);
    assert_eq!(volume_at(&[[26.0; 3], [5.0; 3], [24.0; 3]]), 133.0);
    let far = keep_islands(
        &all,
        &Islands::At(vec![[5.0; 3], [5.0, 80.0, 5.0]]),
        &Task::default(),
    );
    let message = far.unwrap_err().to_string();
    assert!(message.contains("5.0,80.0,5.0"), "{message}");
    assert!(message.contains("25.0,25.0,25.0"), "{message}");
}

#[test]
fn filled_cavities_take_along_what_floats_in_them() {
    let body = together(&box_mesh([0.0; 3], [10.0; 3]), &hollow([1.0; 3], [8.0; 3]));
    let inner = together(&box_mesh([2.0; 3], [7.0; 3]), &hollow([3.0; 3], [5.0; 3]));
    let pore = hollow([8.5; 3], [9.5; 3]);
    let all = together(&together(&body, &inner), &pore);
    let filled = |most| fill_cavities(&all, most, &Task::default()).unwrap();
    let volume = |mesh: &TriangleMesh| topology(mesh).volume_mm3.round();
    assert_eq!(volume(&filled(None).mesh), 1000.0);
    assert_eq!(filled(None).removed.len(), 4);
    assert_eq!(filled(Some(8.5)).removed.len(), 2);
    assert_eq!(
        volume(&filled(Some(1.5)).mesh),
        1000.0 - 343.0 + 125.0 - 8.0
    );
    // Nothing encloses an inverted body, so it is none.
    let inverted = hollow([0.0; 3], [1.0; 3]);
    assert_eq!(
        fill_cavities(&inverted, None, &Task::default())
            .unwrap()
            .mesh,
        inverted
    );
}

#[test]
fn a_body_in_a_bend_of_another_is_not_in_it() {
    let bar = box_mesh([-3.0; 3], [3.0; 3]);
    let both = together(&torus(60, 40), &bar);
    let kept = keep_islands(&both, &Islands::AtLeastMm3(1000.0), &Task::default()).unwrap();
    assert_eq!(kept.mesh.triangles().len(), 60 * 40 * 2);
    let turned = together(&torus(60, 40), &hollow([-3.0; 3], [3.0; 3]));
    assert!(
        fill_cavities(&turned, None, &Task::default())
            .unwrap()
            .removed
            .is_empty()
    );
}

#[test]
fn tiny_and_empty_meshes_pass_and_bad_numbers_are_refused() {
    let task = Task::default();
    let point = mesh(vec![[1.0; 3]; 3], vec![[0, 1, 2], [0, 0, 1]]);
    for given in [TriangleMesh::default(), mesh(vec![[1.0; 3]], vec![]), point] {
        assert!(keep_islands(&given, &Islands::Largest, &task).is_ok());
        assert!(fill_cavities(&given, None, &task).is_ok());
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let given = box_mesh([0.0; 3], [1.0; 3]);
        let refused = [
            keep_islands(&given, &Islands::AtLeastMm3(bad), &task).unwrap_err(),
            fill_cavities(&given, Some(bad), &task).unwrap_err(),
        ];
        let is_volume = |e: &MeshError| matches!(e, MeshError::Volume { .. });
        assert!(refused.iter().all(is_volume));
    }
}

#[test]
fn a_cancelled_task_stops_both() {
    let task = Task::default();
    task.cancel().cancel();
    let given = torus(20, 10);
    let kept = keep_islands(&given, &Islands::Largest, &task);
    assert!(matches!(kept, Err(MeshError::Cancelled(_))));
    let filled = fill_cavities(&given, None, &task);
    assert!(matches!(filled, Err(MeshError::Cancelled(_))));
}
