//! What the Poisson surface promises.

use super::*;
use crate::synthetic::{cylinder, line_model, sphere};
use bonemesh_mesh::check_topology;
use bonemesh_task::Cancel;

fn at_depth(cloud: &PointCloud, depth: u32) -> Result<TriangleMesh, SurfaceError> {
    let settings = PoissonSettings {
        depth,
        ..PoissonSettings::default()
    };
    poisson(cloud, &settings, &Task::default())
}

#[test]
fn a_sphere_is_closed_and_has_its_radius() {
    let (radius, centre) = (20.0, [50.0, -20.0, 10.0]);
    let mesh = at_depth(&sphere(6000, radius, centre), 6).unwrap();
    let topology = check_topology(&mesh, &Task::default()).unwrap();
    assert!(topology.watertight && topology.manifold, "{topology:?}");
    assert_eq!(topology.components, 1);
    assert!(topology.volume_mm3 > 0.0);
    let off = mesh.vertices_mm().iter().map(|v| {
        let r = (0..3)
            .map(|k| (v[k] - centre[k]).powi(2))
            .sum::<f64>()
            .sqrt();
        (r - radius).abs()
    });
    // A cell is 0.69 mm.
    let worst = off.fold(0.0, f64::max);
    assert!(worst < 0.15, "{worst}");
}

#[test]
fn one_slice_of_the_line_model_gives_a_sheet_in_its_plane() {
    let mesh = at_depth(&line_model(1, 1.0), 6).unwrap();
    let topology = check_topology(&mesh, &Task::default()).unwrap();
    assert!(topology.watertight && topology.manifold);
    let cell_mm = 256.0 * 0.4492 * 1.1 / 64.0;
    let [x, y] = [255.0 * 0.4492, 256.0 * 0.4492];
    let in_bar = |v: &&[f64; 3]| (v[0] - x).abs() < 4.0 && (v[1] - y).abs() < 40.0;
    let sheet: Vec<f64> = mesh
        .vertices_mm()
        .iter()
        .filter(in_bar)
        .map(|v| v[2].abs())
        .collect();
    let in_plane = sheet.iter().filter(|z| **z < cell_mm).count();
    assert!(
        in_plane > 50 && in_plane * 3 > sheet.len(),
        "{in_plane} of {}",
        sheet.len()
    );
}

#[test]
fn a_hollow_cylinder_keeps_its_bore_on_thin_slices() {
    let cloud = cylinder(40, 1.0, [50.0, 40.0]);
    let mesh = at_depth(&cloud, 7).unwrap();
    let topology = check_topology(&mesh, &Task::default()).unwrap();
    assert!(topology.watertight && topology.manifold);
    // Of the vertices away from both ends, hardly any lies far from the two walls.
    let (outer, inner) = (50.0 * 0.4492, 40.0 * 0.4492);
    let (mut near, mut far) = (0, 0);
    for v in mesh
        .vertices_mm()
        .iter()
        .filter(|v| (8.0..31.0).contains(&v[2]))
    {
        let radius = (v[0] - 256.0 * 0.4492).hypot(v[1] - 256.0 * 0.4492);
        if (radius - outer).abs().min((radius - inner).abs()) < 0.6 {
            near += 1;
        } else {
            far += 1;
        }
    }
    assert!(near > 20 * far, "{near} {far}");
}

#[test]
fn the_surface_is_the_same_for_any_number_of_threads() {
    let cloud = sphere(2000, 5.0, [1.0; 3]);
    let meshes: Vec<TriangleMesh> = [1, 3]
        .into_iter()
        .map(|threads| {
            let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
            pool.install(|| at_depth(&cloud, 5)).unwrap()
        })
        .collect();
    assert_eq!(meshes[0], meshes[1]);
}

#[test]
fn what_cannot_be_solved_for_is_named() {
    let cloud = sphere(200, 5.0, [0.0; 3]);
    for depth in [0, 2, 9, 40] {
        assert!(matches!(
            at_depth(&cloud, depth).unwrap_err(),
            SurfaceError::Depth(_)
        ));
    }
    for scale in [0.9, -1.0, f64::NAN, f64::INFINITY, 11.0] {
        let settings = PoissonSettings {
            scale,
            ..PoissonSettings::default()
        };
        let error = poisson(&cloud, &settings, &Task::default()).unwrap_err();
        assert!(matches!(error, SurfaceError::Scale(_)));
    }
    let same = PointCloud::from_points(vec![[4.0; 3]; 50]).unwrap();
    assert!(matches!(
        at_depth(&same, 4).unwrap_err(),
        SurfaceError::NoDistance
    ));
    let two = PointCloud::from_points(vec![[0.0; 3], [1.0; 3]]).unwrap();
    assert!(matches!(
        at_depth(&two, 4).unwrap_err(),
        SurfaceError::Cloud(_)
    ));
    let cancel = Cancel::default();
    cancel.cancel();
    let error = poisson(&cloud, &PoissonSettings::default(), &Task::new(cancel)).unwrap_err();
    assert!(matches!(error, SurfaceError::Cancelled(_)));
}
