//! Distances between bodies for which they are known.

use crate::bodies::{ball, cuboid, moved, together, turned};
use bonemesh_measure::{MeasureError, Reference, Spread, compare_surfaces, signed_distances};
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Task, pool};
use proptest::prelude::*;

fn signed_mm(places: &[[f64; 3]], mesh: &TriangleMesh) -> Vec<f64> {
    let task = Task::default();
    let reference = Reference::new(mesh, &task).unwrap();
    signed_distances(places, &reference, &task).unwrap()
}

#[test]
fn balls_within_each_other_are_apart_by_their_radii() {
    let (small, large) = (ball([5.0; 3], 20.0, 120), ball([5.0; 3], 21.5, 120));
    let found = compare_surfaces(&small, &large, 20_000, &Task::default()).unwrap();
    for mm in [
        found.mean_mm,
        found.rms_mm,
        found.p95_mm,
        found.hausdorff_mm,
    ] {
        assert!((mm - 1.5).abs() < 0.02, "{found:?}");
    }
    assert!((found.to_reference.signed_mean_mm + 1.5).abs() < 0.02);
    assert!((found.from_reference.signed_mean_mm - 1.5).abs() < 0.02);
    assert_eq!(found.signed_mm.len(), 20_000);
}

#[test]
fn a_shifted_cube_is_as_far_as_the_shift_on_two_sides_and_on_the_others_less() {
    let cube = cuboid([0.0; 3], [10.0; 3]);
    let found = compare_surfaces(
        &cube,
        &moved(&cube, [1.0, 0.0, 0.0]),
        60_000,
        &Task::default(),
    )
    .unwrap();
    assert!((found.hausdorff_mm - 1.0).abs() < 1e-12);
    // One side is 1 mm off everywhere. Of the four beside it a strip of 1 mm is off, 0.5 mm in the mean. The
    // last one lies inside, 1 mm off but near its rim, where another side is nearer by what is missing.
    let (outer, strips) = (100.0, 4.0 * 10.0 * 0.5);
    let inner = 100.0 - 4.0 * (10.0 - 6.0 + 2.0 / 3.0);
    let mean = (outer + inner + strips) / 600.0;
    assert!(
        (found.mean_mm - mean).abs() < 1e-3,
        "{} {mean}",
        found.mean_mm
    );
    let signed = (outer - inner + strips) / 600.0;
    let found = found.to_reference.signed_mean_mm;
    assert!((found - signed).abs() < 1e-3, "{found} {signed}");
}

#[test]
fn a_surface_is_at_no_distance_from_itself() {
    let ball = ball([1.0, 2.0, 3.0], 7.0, 30);
    let found = compare_surfaces(&ball, &ball, 5000, &Task::default()).unwrap();
    assert!(found.hausdorff_mm < 1e-12, "{found:?}");
}

#[test]
fn hausdorff_is_symmetric_and_sees_what_one_mesh_alone_has() {
    let cube = cuboid([0.0; 3], [10.0; 3]);
    let both = together(&cube, &cuboid([30.0, 0.0, 0.0], [31.0, 1.0, 1.0]));
    for (a, b) in [(&cube, &both), (&both, &cube)] {
        let found = compare_surfaces(a, b, 3000, &Task::default()).unwrap();
        assert!((found.hausdorff_mm - 21.0).abs() < 1e-9, "{found:?}");
    }
}

proptest! {
    #[test]
    fn a_box_tells_inside_from_outside_at_faces_edges_and_corners(
        place in prop::array::uniform3(-6.0..16.0_f64),
        is_whole in prop::array::uniform3(any::<bool>()),
    ) {
        // Whole coordinates lie above corners and edges, where signs are hard.
        let place = [0, 1, 2].map(|a| if is_whole[a] { place[a].round() } else { place[a] });
        let [found] = signed_mm(&[place], &cuboid([0.0; 3], [10.0; 3]))[..] else { unreachable!() };
        let out = place.map(|c| (-c).max(c - 10.0));
        let beyond = out.map(|o| o.max(0.0)).iter().map(|o| o * o).sum::<f64>().sqrt();
        let expected = if beyond > 0.0 { beyond } else { out[0].max(out[1]).max(out[2]) };
        prop_assert!((found - expected).abs() < 1e-9, "{place:?}: {found}, not {expected}");
    }
}

#[test]
fn a_wedge_sharper_than_its_faces_tell_is_signed_by_its_edge() {
    // A flat pyramid seen from beyond its rim: nearest is an edge whose triangles disagree.
    let vertices = vec![
        [0.0, 0.0, 0.0],
        [10.0, 0.0, 0.0],
        [5.0, 10.0, 0.0],
        [5.0, 4.0, 0.3],
    ];
    let mesh =
        TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
    let places = [
        [5.0, -1.0, 0.0],
        [5.0, -1.0, 0.5],
        [5.0, -1.0, -0.5],
        [-1.0, -1.0, 0.0],
    ];
    assert!(signed_mm(&places, &mesh).iter().all(|d| *d > 0.9));
    assert!(signed_mm(&[[5.0, 4.0, 0.1]], &mesh)[0] < 0.0);
    let inward = signed_mm(&places, &turned(&mesh));
    assert!(inward.iter().all(|d| *d < -0.9));
}

#[test]
fn the_result_is_the_same_for_any_number_of_threads() {
    let (a, b) = (ball([0.0; 3], 9.0, 25), ball([0.5, 0.2, 0.0], 9.3, 31));
    let results: Vec<_> = [1, 2, 5]
        .into_iter()
        .map(|threads| {
            let pool = pool(std::num::NonZeroUsize::new(threads)).unwrap();
            pool.install(|| compare_surfaces(&a, &b, 4000, &Task::default()).unwrap())
        })
        .collect();
    assert!(results.iter().all(|r| *r == results[0]));
}

#[test]
fn nothing_to_measure_is_refused_and_a_cancel_stops_it() {
    let (cube, flat) = (cuboid([0.0; 3], [1.0; 3]), TriangleMesh::default());
    for (a, b) in [(&cube, &flat), (&flat, &cube)] {
        let error = compare_surfaces(a, b, 10, &Task::default()).unwrap_err();
        assert!(matches!(error, MeasureError::NoSurface(_)), "{error}");
    }
    let task = Task::default();
    task.cancel().cancel();
    assert!(
        compare_surfaces(&cube, &cube, 10, &task)
            .unwrap_err()
            .is_cancelled()
    );
    assert_eq!(Spread::of(&[]).max_mm.to_bits(), 0);
}
