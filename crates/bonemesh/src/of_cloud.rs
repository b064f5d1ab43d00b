//! From a cloud to a mesh, by each method that needs no voxels.

use std::time::Instant;

use bonemesh_cloud::{PointCloud, mean_neighbour_distance};
use bonemesh_mesh::TriangleMesh;
use bonemesh_surface::{
    AlphaSurface, BallPivotingSettings, PoissonSettings, alpha_boundary, ball_pivoting,
    boundary_surface, planar_surface, poisson, tetrahedra_surface, volume_matched_boundary,
};
use bonemesh_task::Task;

use crate::choices::no_cloud;
use crate::render::{Rendered, lap};
use crate::report::{RenderReport, Seconds, check};
use crate::{AlphaRule, Error, Method, Settings};

/// Neighbours (with the point itself) whose mean distance is the published choice of alpha.
const ALPHA_NEIGHBOURS: usize = 100;

/// A volume is met where it is off by less than this part.
const VOLUME_MET: f64 = 0.01;

/// A surface that reaches further beyond its points than this part of their extent bulges.
const BULGE: f64 = 0.05;

/// Makes the surface of `cloud`; `bone_mm3` is the volume of the voxels that it comes from.
pub(crate) fn cloud_to_mesh(
    cloud: &PointCloud,
    bone_mm3: Option<f64>,
    settings: &Settings,
    seconds: Seconds,
    task: &Task,
) -> Result<Rendered, Error> {
    if settings.method == Method::Alpha {
        return alpha(cloud, bone_mm3, settings, seconds, task);
    }
    let mut clock = Instant::now();
    let (mut tetrahedra, mut radii_mm) = (None, None);
    let mesh = match settings.method {
        Method::BallPivoting => {
            let balls = BallPivotingSettings {
                radii_mm: settings.radii_mm.clone(),
                ..BallPivotingSettings::default()
            };
            let pivoted = ball_pivoting(cloud, &balls, task)?;
            radii_mm = Some(pivoted.radii_mm);
            pivoted.mesh
        }
        Method::Poisson => {
            let poisson_settings = PoissonSettings {
                depth: settings.depth,
                scale: settings.scale,
                ..PoissonSettings::default()
            };
            poisson(cloud, &poisson_settings, task)?
        }
        Method::Tetrahedra => {
            let surface = tetrahedra_surface(cloud, task)?;
            tetrahedra = Some(surface.tetrahedra);
            surface.mesh
        }
        Method::Planar => planar_surface(cloud, task)?,
        Method::Alpha | Method::Isosurface | Method::Labelled => {
            return Err(no_cloud(settings.method));
        }
    };
    let topology = check(&mesh, task)?;
    let mut report = RenderReport::new(settings, &topology, surfaced(seconds, lap(&mut clock)));
    report.points = Some(cloud.len());
    report.tetrahedra = tetrahedra;
    report.radii_mm = radii_mm;
    report.warnings.extend(bulge(cloud, &mesh));
    Ok(Rendered { mesh, report })
}

/// What is to be said of a surface that reaches far beyond its points, as Poisson's can.
fn bulge(cloud: &PointCloud, mesh: &TriangleMesh) -> Option<String> {
    let [low, high] = mesh.bounds_mm()?;
    let points = cloud.points_mm();
    let beyond = |axis: usize| {
        let along = points.iter().map(|point| point[axis]);
        let first = along.clone().fold(f64::INFINITY, f64::min);
        let last = along.fold(f64::NEG_INFINITY, f64::max);
        ((first - low[axis]).max(high[axis] - last), last - first)
    };
    let (beyond_mm, extent_mm) = (0..3)
        .map(beyond)
        .fold((0.0, 0.0), |(most, size), of_axis| {
            (of_axis.0.max(most), of_axis.1.max(size))
        });
    (beyond_mm > BULGE * extent_mm).then(|| {
        format!("the surface bulges {beyond_mm:.0} mm beyond its points: it is no body to be used")
    })
}

/// The published method.
fn alpha(
    cloud: &PointCloud,
    bone_mm3: Option<f64>,
    settings: &Settings,
    mut seconds: Seconds,
    task: &Task,
) -> Result<Rendered, Error> {
    let is_matched = settings.alpha_mm.is_none() && settings.alpha_rule == AlphaRule::BoneVolume;
    if is_matched && bone_mm3.is_none() {
        return Err(Error::NoVoxels);
    }
    let mut clock = Instant::now();
    let mean_mm = if let Some(alpha_mm) = settings.alpha_mm {
        alpha_mm
    } else {
        mean_neighbour_distance(cloud, ALPHA_NEIGHBOURS, true, task)?
    };
    if settings.alpha_mm.is_none() && mean_mm <= 0.0 {
        return Err(Error::NoAlpha);
    }
    seconds.neighbours = lap(&mut clock);
    let matched_mm3 = bone_mm3.filter(|_| is_matched);
    let (alpha_mm, boundary) = match matched_mm3 {
        Some(bone_mm3) => {
            let matched = volume_matched_boundary(cloud, bone_mm3, task)?;
            (matched.alpha_mm, matched.boundary)
        }
        None => (mean_mm, alpha_boundary(cloud, mean_mm, task)?),
    };
    seconds.tetrahedra = lap(&mut clock);
    let surface = boundary_surface(cloud, boundary, task)?;
    let topology = check(&surface.mesh, task)?;
    let mut report = RenderReport::new(settings, &topology, surfaced(seconds, lap(&mut clock)));
    report.points = Some(cloud.len());
    report.alpha_mm = Some(alpha_mm);
    report.tetrahedra = Some(surface.tetrahedra);
    // Summed exactly on the lattice.
    report.volume_mm3 = surface.volume_mm3;
    if let Some(bone_mm3) = matched_mm3 {
        report.alpha_coefficient = Some(alpha_mm / mean_mm);
        report.bone_volume_mm3 = Some(bone_mm3);
        report.warnings.extend(missed(&surface, bone_mm3));
    }
    Ok(Rendered {
        mesh: surface.mesh,
        report,
    })
}

/// What is to be said where no alpha gives the volume of the bone.
fn missed(surface: &AlphaSurface, bone_mm3: f64) -> Option<String> {
    let part = surface.volume_mm3 / bone_mm3;
    ((part - 1.0).abs() > VOLUME_MET).then(|| {
        format!(
            "no alpha gives the volume of the bone's voxels: {:.2} of {:.2} cm3 is the nearest; set alpha in mm",
            surface.volume_mm3 / 1000.0,
            bone_mm3 / 1000.0
        )
    })
}

/// The seconds with those of the surface, added up.
fn surfaced(seconds: Seconds, surface: f64) -> Seconds {
    let before = seconds.edges + seconds.cloud + seconds.neighbours + seconds.tetrahedra;
    Seconds {
        surface,
        total: before + surface,
        ..seconds
    }
}
