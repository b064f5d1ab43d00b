//! Every method of meshing on a phantom, through the facade.
#![allow(clippy::unwrap_used)]

use bonemesh::{
    AlphaRule, Error, Method, Phantom, PointCloud, Rendered, Settings, Task, Volume, mesh_cloud,
    render_volume, scan_phantom,
};

fn shell() -> Volume {
    let shell = Phantom::SphereShell;
    scan_phantom(shell, &shell.settings().coarser(2.0), &Task::default()).unwrap()
}

fn rendered(method: Method) -> Rendered {
    let settings = Settings {
        method,
        depth: match method {
            Method::Poisson => 6,
            _ => Settings::default().depth,
        },
        ..Settings::default()
    };
    render_volume(&shell(), &settings, &Task::default()).unwrap()
}

#[test]
fn every_method_makes_a_mesh_of_a_shell() {
    let hull_mm3 = rendered(Method::Tetrahedra).report.volume_mm3;
    for method in Method::ALL {
        let report = rendered(method).report;
        assert_eq!(report.method, method.name());
        assert!(report.triangles > 500, "{report:?}");
        let is_closed = ![Method::BallPivoting, Method::Planar].contains(&method);
        assert!(!is_closed || report.watertight, "{report:?}");
        assert_eq!(report.radii_mm.is_some(), method == Method::BallPivoting);
        // The shell's hollow stays open where a method sees it.
        let sees_hollow = matches!(method, Method::Alpha | Method::Isosurface | Method::Poisson);
        assert!(
            !sees_hollow || report.volume_mm3 < 0.9 * hull_mm3,
            "{report:?}"
        );
    }
}

#[test]
fn alpha_is_matched_to_the_volume_of_the_voxels_or_says_that_it_cannot_be() {
    let settings = Settings {
        method: Method::Alpha,
        alpha_rule: AlphaRule::BoneVolume,
        ..Settings::default()
    };
    for phantom in [Phantom::SphereShell, Phantom::Femur] {
        let scan = phantom.settings().coarser(2.0);
        let volume = scan_phantom(phantom, &scan, &Task::default()).unwrap();
        let report = render_volume(&volume, &settings, &Task::default())
            .unwrap()
            .report;
        let part = report.volume_mm3 / report.bone_volume_mm3.unwrap();
        let is_said = report
            .warnings
            .iter()
            .any(|w| w.starts_with("no alpha gives the volume"));
        assert_eq!((part - 1.0).abs() > 0.01, is_said, "{part}");
        assert!((0.8..1.2).contains(&part), "{part}");
        let coefficient = report.alpha_coefficient.unwrap();
        assert!(
            coefficient > 0.1 && report.alpha_mm.unwrap() > 0.1,
            "{coefficient}"
        );
    }
}

#[test]
fn alpha_is_refused_where_it_means_nothing() {
    let cloud = (0..30).map(|i| [f64::from(i % 4), f64::from(i / 4 % 3), f64::from(i * i % 7)]);
    let cloud = PointCloud::from_points(cloud.collect()).unwrap();
    let of = |method, alpha_mm, alpha_rule| {
        let settings = Settings {
            method,
            alpha_mm,
            alpha_rule,
            ..Settings::default()
        };
        mesh_cloud(&cloud, &settings, &Task::default()).unwrap_err()
    };
    for method in [
        Method::BallPivoting,
        Method::Poisson,
        Method::Tetrahedra,
        Method::Planar,
    ] {
        let error = of(method, Some(1.0), AlphaRule::MeanDistance);
        assert!(matches!(error, Error::NotForMethod { .. }));
    }
    let error = of(Method::Alpha, None, AlphaRule::BoneVolume);
    assert!(matches!(error, Error::NoVoxels));
}
