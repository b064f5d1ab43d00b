//! What ball pivoting promises.

use super::*;
use crate::synthetic::{line_model, sphere};
use bonemesh_mesh::check_topology;
use bonemesh_task::Cancel;
use proptest::prelude::*;

fn pivoted(cloud: &PointCloud, radii_mm: Option<Vec<f64>>) -> Result<BallPivoted, SurfaceError> {
    let settings = BallPivotingSettings {
        radii_mm,
        ..BallPivotingSettings::default()
    };
    ball_pivoting(cloud, &settings, &Task::default())
}

#[test]
fn a_sphere_is_closed_and_faces_outward() {
    let cloud = sphere(3000, 20.0, [5.0, 6.0, -70.0]);
    let mesh = pivoted(&cloud, None).unwrap().mesh;
    let topology = check_topology(&mesh, &Task::default()).unwrap();
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    assert_eq!(topology.components, 1);
    assert_eq!(mesh.vertices_mm().len(), 3000);
    let full = 4.0 / 3.0 * std::f64::consts::PI * 20.0_f64.powi(3);
    // Flat triangles lie inside the sphere.
    assert!(
        (0.99..1.0).contains(&(topology.volume_mm3 / full)),
        "{}",
        topology.volume_mm3 / full
    );
}

/// Triangles with corners in two slices.
fn joining(mesh: &TriangleMesh) -> usize {
    let z = |v: u32| mesh.vertices_mm()[v as usize][2].to_bits();
    let joins = |t: &&[u32; 3]| z(t[0]) != z(t[1]) || z(t[1]) != z(t[2]);
    mesh.triangles().iter().filter(joins).count()
}

#[test]
fn the_line_model_joins_on_thin_slices_and_hardly_on_thick_ones() {
    let thin = pivoted(&line_model(10, 1.0), Some(vec![1.35, 2.7]))
        .unwrap()
        .mesh;
    let topology = check_topology(&thin, &Task::default()).unwrap();
    assert_eq!(
        (topology.non_manifold_edges, topology.inconsistent_edges),
        (0, 0)
    );
    assert!(joining(&thin) > 5000, "{}", joining(&thin));
    // Normals from within a slice stand across it, as the study's did, and let nothing join.
    let in_slices = BallPivotingSettings {
        radii_mm: Some(vec![1.35, 2.7]),
        normals: NormalSettings {
            radius_mm: 4.0,
            ..NormalSettings::default()
        },
    };
    let thick = line_model(10, 5.0);
    let thick = ball_pivoting(&thick, &in_slices, &Task::default())
        .unwrap()
        .mesh;
    assert!(joining(&thick) * 10 < joining(&thin), "{}", joining(&thick));
    // A ball of 1.35 mm cannot reach from slice to slice, whatever the normals.
    let small = pivoted(&line_model(10, 5.0), Some(vec![1.35]));
    assert!(small.map_or(0, |s| joining(&s.mesh)) == 0);
    let wide = pivoted(&line_model(10, 5.0), Some(vec![5.0, 10.0]))
        .unwrap()
        .mesh;
    assert!(joining(&wide) > 1000, "{}", joining(&wide));
}

#[test]
fn the_radii_are_three_and_six_times_the_mean_distance() {
    let cloud = line_model(2, 1.0);
    let found = pivoted(&cloud, None).unwrap().radii_mm;
    let nearest = mean_neighbour_distance(&cloud, 2, false, &Task::default()).unwrap();
    assert!((found[0] - 3.0 * nearest).abs() < 1e-12 && (found[1] - 6.0 * nearest).abs() < 1e-12);
}

#[test]
fn repeated_points_change_nothing() {
    let once = sphere(500, 10.0, [0.0; 3]);
    let mut points = once.points_mm().to_vec();
    points.extend_from_within(..200);
    let twice = PointCloud::from_points(points).unwrap();
    assert_eq!(
        pivoted(&once, None).unwrap(),
        pivoted(&twice, None).unwrap()
    );
}

#[test]
fn what_no_ball_rolls_over_is_named() {
    let cloud = sphere(500, 10.0, [0.0; 3]);
    for radii in [vec![], vec![0.0], vec![1.0, f64::NAN], vec![-1.0]] {
        let error = pivoted(&cloud, Some(radii)).unwrap_err();
        assert!(matches!(error, SurfaceError::Radii(_)));
    }
    let error = pivoted(&cloud, Some(vec![1e-3])).unwrap_err();
    assert!(matches!(error, SurfaceError::NothingPivoted { .. }));
    let same = PointCloud::from_points(vec![[1.0; 3]; 9]).unwrap();
    assert!(matches!(
        pivoted(&same, None).unwrap_err(),
        SurfaceError::Cloud(_)
    ));
    let line = (0..20).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let line = PointCloud::from_points(line).unwrap();
    let error = pivoted(&line, None).unwrap_err();
    assert!(matches!(error, SurfaceError::NothingPivoted { .. }));
    let cancel = Cancel::default();
    cancel.cancel();
    let task = Task::new(cancel);
    let error = ball_pivoting(&cloud, &BallPivotingSettings::default(), &task).unwrap_err();
    assert!(matches!(error, SurfaceError::Cancelled(_)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn edges_have_at_most_two_triangles_that_agree(
        points in prop::collection::vec(prop::array::uniform3(0..7i32), 3..150),
        radius in 0.6..3.0f64,
    ) {
        let points = points.into_iter().map(|p| p.map(f64::from)).collect();
        let cloud = PointCloud::from_points(points).unwrap();
        if let Ok(found) = pivoted(&cloud, Some(vec![radius, 2.0 * radius])) {
            let topology = check_topology(&found.mesh, &Task::default()).unwrap();
            prop_assert_eq!(topology.non_manifold_edges, 0);
            prop_assert_eq!(topology.inconsistent_edges, 0);
            let mut sorted: Vec<[u32; 3]> = found.mesh.triangles().to_vec();
            for triangle in &mut sorted {
                triangle.sort_unstable();
            }
            sorted.sort_unstable();
            sorted.dedup();
            prop_assert_eq!(sorted.len(), found.mesh.triangles().len());
        }
    }
}
