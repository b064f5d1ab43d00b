//! What normals promise.

use super::*;
use crate::Lattice;
use bonemesh_task::Cancel;
use bonemesh_volume::Affine;
use std::f64::consts::PI;

fn normals_of(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let cloud = PointCloud::from_points(points.to_vec()).unwrap();
    estimate_normals(&cloud, NormalSettings::default(), &Task::default()).unwrap()
}

/// Points spread evenly over a sphere around `centre`.
fn sphere(count: usize, radius: f64, centre: [f64; 3]) -> Vec<[f64; 3]> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    (0..count)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / count as f64;
            let (ring, turn) = ((1.0 - z * z).sqrt(), golden * i as f64);
            let on = [ring * turn.cos(), ring * turn.sin(), z];
            [0, 1, 2].map(|k| centre[k] + radius * on[k])
        })
        .collect()
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

#[test]
fn normals_of_a_sphere_are_all_outward() {
    let centre = [100.0, -30.0, 7.0];
    let points = sphere(4000, 20.0, centre);
    for (p, n) in points.iter().zip(normals_of(&points)) {
        assert!(dot(n, unit(minus(*p, centre))) > 0.999);
    }
}

#[test]
fn a_hollow_faces_into_itself_and_a_body_in_it_outward() {
    let [outer, inner, core] = [(8000, 30.0), (4000, 20.0), (1000, 8.0)];
    let mut points = sphere(outer.0, outer.1, [0.0; 3]);
    points.extend(sphere(inner.0, inner.1, [0.0; 3]));
    points.extend(sphere(core.0, core.1, [0.0; 3]));
    for (i, n) in normals_of(&points).into_iter().enumerate() {
        let is_hollow = (outer.0..outer.0 + inner.0).contains(&i);
        let facing = dot(n, unit(points[i]));
        assert!(
            if is_hollow {
                facing < -0.99
            } else {
                facing > 0.99
            },
            "{i} {facing}"
        );
    }
}

/// A tube as slices show it: contours of pixels of two walls, in mm.
fn tube(slices: i32, slice_mm: f64) -> PointCloud {
    let mut coordinates = Vec::new();
    for k in 0..slices {
        for j in -60..=60_i32 {
            for i in -60..=60_i32 {
                let radius = f64::from(i * i + j * j).sqrt();
                if (radius - 55.0).abs() < 0.5 || (radius - 40.0).abs() < 0.5 {
                    coordinates.push([i, j, k]);
                }
            }
        }
    }
    let frame_from_lattice = Affine::from_axes(
        [0.45, 0.0, 0.0],
        [0.0, 0.45, 0.0],
        [0.0, 0.0, slice_mm],
        [0.0; 3],
    );
    PointCloud::from_lattice(Lattice {
        coordinates,
        frame_from_lattice,
    })
    .unwrap()
}

#[test]
fn walls_of_a_tube_face_away_from_its_bone_on_thin_and_on_thick_slices() {
    for slice_mm in [1.0, 5.0] {
        let cloud = tube(8, slice_mm);
        let normals =
            estimate_normals(&cloud, NormalSettings::default(), &Task::default()).unwrap();
        for (p, n) in cloud.points_mm().iter().zip(normals) {
            let radius = p[0].hypot(p[1]);
            let away = if radius > 21.0 { 1.0 } else { -1.0 };
            let facing = away * (p[0] * n[0] + p[1] * n[1]) / radius;
            assert!(facing > 0.8, "{slice_mm} mm: {p:?} {n:?}");
        }
    }
}

#[test]
fn one_slice_alone_gives_the_direction_of_the_slices() {
    let cloud = tube(1, 1.0);
    let normals = estimate_normals(&cloud, NormalSettings::default(), &Task::default()).unwrap();
    assert!(normals.iter().all(|n| n[2].abs() > 0.999_999));
}

#[test]
fn degenerate_clouds_have_unit_normals() {
    let same = vec![[3.0, 4.0, 5.0]; 50];
    let line: Vec<_> = (0..50).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let far: Vec<_> = (0..50)
        .map(|i| [f64::from(i) * 1e6, f64::from(i * i), 3.0])
        .collect();
    let three = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for cloud in [same, line, far, three] {
        for n in normals_of(&cloud) {
            assert!((dot(n, n) - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn normals_are_the_same_for_any_number_of_threads() {
    let cloud = tube(6, 2.0);
    let bits: Vec<Vec<[u64; 3]>> = [1, 2, 3]
        .into_iter()
        .map(|threads| {
            let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
            let settings = NormalSettings::default();
            let normals = pool.install(|| estimate_normals(&cloud, settings, &Task::default()));
            normals
                .unwrap()
                .iter()
                .map(|n| n.map(f64::to_bits))
                .collect()
        })
        .collect();
    assert!(bits.iter().all(|b| *b == bits[0]));
}

#[test]
fn what_gives_no_normals_is_named() {
    let task = Task::default();
    let two = PointCloud::from_points(vec![[0.0; 3]; 2]).unwrap();
    let error = estimate_normals(&two, NormalSettings::default(), &task).unwrap_err();
    assert!(matches!(error, CloudError::TooFew(2)));
    let cloud = PointCloud::from_points(sphere(100, 1.0, [0.0; 3])).unwrap();
    let usual = NormalSettings::default();
    let refused = |settings| estimate_normals(&cloud, settings, &task).unwrap_err();
    let few = NormalSettings {
        neighbours: 2,
        ..usual
    };
    assert!(matches!(refused(few), CloudError::NeighbourCount(2)));
    for radius_mm in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = refused(NormalSettings { radius_mm, ..usual });
        assert!(matches!(error, CloudError::Radius(_)));
    }
    let cancel = Cancel::default();
    cancel.cancel();
    let error = estimate_normals(&cloud, usual, &Task::new(cancel)).unwrap_err();
    assert!(matches!(error, CloudError::Cancelled(_)));
}
