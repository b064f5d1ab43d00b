//! What the tests share.

#![allow(dead_code, reason = "each test file uses its part")]

pub(crate) mod command;
pub(crate) mod distance;
pub(crate) mod femur;

use bonemesh::{HuThreshold, Method, Settings, TriangleMesh, Volume, Voxels};
use bonemesh_phantom::Body;
use distance::{Means, length, means, sampled, shift};

/// Halfway from soft tissue to the bone of the phantoms: there the threshold moves nothing.
pub(crate) const HALFWAY_HU: f64 = 640.0;

pub(crate) fn halfway() -> Settings {
    Settings {
        threshold: HuThreshold::new(HALFWAY_HU).unwrap(),
        method: Method::Alpha,
        ..Settings::default()
    }
}

pub(crate) fn hu(volume: &Volume, [k, j, i]: [usize; 3]) -> f64 {
    match volume.voxels() {
        Voxels::I16(hu) => f64::from(hu[[k, j, i]]),
        Voxels::F32(hu) => f64::from(hu[[k, j, i]]),
    }
}

/// Hounsfield units at a point of the patient, linear between voxels; `None` outside.
pub(crate) fn interpolated(volume: &Volume, patient_mm: [f64; 3]) -> Option<f64> {
    let back = volume.geometry().patient_from_voxel().inverse()?;
    let at = back.apply(patient_mm);
    let [slices, rows, columns] = volume.geometry().shape();
    let mut low = [0; 3];
    let mut part = [0.0; 3];
    for (axis, count) in [columns, rows, slices].into_iter().enumerate() {
        if at[axis] < 0.0 || at[axis] > (count - 1) as f64 {
            return None;
        }
        low[axis] = (at[axis] as usize).min(count.saturating_sub(2));
        part[axis] = at[axis] - low[axis] as f64;
    }
    let mut sum = 0.0;
    for corner in 0..8_usize {
        let up = [corner & 1, corner >> 1 & 1, corner >> 2];
        let weight: f64 = (0..3)
            .map(|a| if up[a] == 1 { part[a] } else { 1.0 - part[a] })
            .product();
        let [i, j, k] = [0, 1, 2].map(|a| low[a] + up[a]);
        if weight > 0.0 {
            sum += weight * hu(volume, [k, j, i]);
        }
    }
    Some(sum)
}

/// How far a mesh lies from the surface of a body, and where it lies as a whole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fit {
    pub(crate) distance_mm: Means,
    pub(crate) shift_mm: f64,
}

/// Measured at the vertices that `counts` takes.
pub(crate) fn fit(mesh: &TriangleMesh, body: &dyn Body, counts: impl Fn([f64; 3]) -> bool) -> Fit {
    let vertices = mesh.vertices_mm().iter().map(|p| (*p, 1.0));
    fit_of(&vertices.collect::<Vec<_>>(), body, counts)
}

/// Measured at the middles of triangles that `counts` takes, by area.
pub(crate) fn fit_of_middles(
    mesh: &TriangleMesh,
    body: &dyn Body,
    counts: impl Fn([f64; 3]) -> bool,
) -> Fit {
    fit_of(&sampled(mesh, 1), body, counts)
}

fn fit_of(points: &[([f64; 3], f64)], body: &dyn Body, counts: impl Fn([f64; 3]) -> bool) -> Fit {
    let points: Vec<_> = points.iter().filter(|(p, _)| counts(*p)).collect();
    let distance = |p: [f64; 3]| body.signed_distance_mm(p);
    let normal = |p: [f64; 3]| {
        const STEP_MM: f64 = 1e-3;
        let slope: [f64; 3] = std::array::from_fn(|c| {
            let (mut up, mut down) = (p, p);
            up[c] += STEP_MM;
            down[c] -= STEP_MM;
            distance(up) - distance(down)
        });
        let steep = length(slope);
        slope.map(|v| if steep > 0.0 { v / steep } else { 0.0 })
    };
    Fit {
        distance_mm: means(points.iter().map(|(p, weight)| (distance(*p), *weight))),
        shift_mm: length(shift(
            points.iter().map(|(p, _)| (distance(*p), normal(*p))),
        )),
    }
}
