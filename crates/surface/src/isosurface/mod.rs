//! The surface of all bone in a volume, at the true edges of the bone.
//!
//! 1. `level`: near every surface of the asked-for threshold, find the grey of the true edge, in
//!    the middle between the bone's grey and that around it.
//! 2. `signs`: voxels above that level are inside; beyond the volume's border all is outside, so
//!    that bone which the scan cuts off is closed there.
//! 3. `march`: a vertex on every edge between an inside and an outside voxel, and in each cube of
//!    voxels the triangles of its case (`cases`).
//!
//! The surface is a closed 2-manifold without self-intersections: see `cases`.

mod blur;
mod cases;
pub(crate) mod cut;
mod edge;
mod grey;
mod layer;
mod level;
mod march;
mod signs;

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;
use bonemesh_volume::{Affine, Volume, Voxels};
use ndarray::Array3;
use rayon::prelude::*;

use crate::SurfaceError;
use grey::{Grey, Voxel};
use march::{Rows, cut_edges, triangles};
use signs::Signs;

/// How an isosurface is placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IsosurfaceSettings {
    /// Bone is above this.
    pub threshold_hu: f64,
    /// Moves the surface to the true edges of the bone, whatever the threshold; otherwise it lies
    /// where the grey between voxels equals the threshold.
    pub true_edges: bool,
}

/// The surface of the bone in `volume`, outward-oriented, in patient space (mm).
///
/// Whole Hounsfield units are compared half a unit higher, so that a voxel of just the threshold
/// is outside and none lies on the surface. The stages are `edges` and `surface`.
///
/// # Errors
/// [`SurfaceError::NothingAbove`], [`SurfaceError::TooLarge`], [`SurfaceError::Cancelled`].
pub fn isosurface(
    volume: &Volume,
    settings: IsosurfaceSettings,
    task: &Task,
) -> Result<TriangleMesh, SurfaceError> {
    // Whole numbers have room between them, so that no voxel lies just on the surface.
    match volume.voxels() {
        Voxels::I16(hu) => of_voxels(
            hu,
            settings.threshold_hu.floor() + 0.5,
            volume,
            settings,
            task,
        ),
        Voxels::F32(hu) => of_voxels(hu, settings.threshold_hu, volume, settings, task),
    }
}

fn of_voxels<T: Voxel>(
    hu: &Array3<T>,
    above_hu: f64,
    volume: &Volume,
    settings: IsosurfaceSettings,
    task: &Task,
) -> Result<TriangleMesh, SurfaceError> {
    let (slices, rows, columns) = hu.dim();
    let shape = [columns, rows, slices];
    let ordered = hu.as_standard_layout();
    let hu = ordered.as_slice().expect("in order, else it is a bug");
    let grey = Grey::new(hu, shape);
    let threshold = above_hu as f32;
    let affine = volume.geometry().patient_from_voxel();
    let nothing = SurfaceError::NothingAbove {
        threshold_hu: settings.threshold_hu,
    };
    let mesh = if settings.true_edges {
        let spacing = volume.geometry().spacing_mm().map(|v| v as f32);
        let above = level::above_level(&grey, threshold, spacing, steepest(affine), task)?;
        let above = Grey::new(&above, shape);
        surface(shape, |at| above.at(at), cut::in_boxes, affine, task)?
    } else {
        let above = |at| grey.at(at) - threshold;
        surface(shape, above, cut::linear, affine, task)?
    };
    mesh.ok_or(nothing)
}

/// Turns a gradient in voxels into the step, in voxels, along which the grey changes fastest for
/// each mm.
fn steepest(affine: &Affine) -> impl Fn([f32; 3]) -> [f32; 3] + Sync + use<> {
    let gram = affine.gram();
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    // The inverse of the metric but for a factor, which is positive.
    let rows = [
        cross(gram[1], gram[2]),
        cross(gram[2], gram[0]),
        cross(gram[0], gram[1]),
    ]
    .map(|row| row.map(|v| v as f32));
    move |g: [f32; 3]| rows.map(|row| row[0] * g[0] + row[1] * g[1] + row[2] * g[2])
}

/// The surface between voxels of a value above 0 and others, if there are any; `crossing` tells
/// where between two values it is.
pub(crate) fn surface(
    shape: [usize; 3],
    value: impl Fn([usize; 3]) -> f32 + Sync,
    crossing: impl Fn(f32, f32) -> f32 + Sync,
    affine: &Affine,
    task: &Task,
) -> Result<Option<TriangleMesh>, SurfaceError> {
    let signs = Signs::of(shape, |at| value(at) > 0.0, task)?;
    let rows = Rows::of(&signs).ok_or(SurfaceError::TooLarge)?;
    if rows.vertices == 0 {
        return Ok(None);
    }
    task.begin("surface", 2 * signs.slices() - 1);
    let vertices: Vec<Vec<[f64; 3]>> = (0..signs.slices())
        .into_par_iter()
        .map(|k| {
            task.advance(1)?;
            let mut vertices = Vec::new();
            cut_edges(&signs, k, |node, axis| {
                let place = match cut::voxels(node, axis, shape) {
                    Some([a, b]) => cut::place(a, axis, crossing(value(a), value(b))),
                    None => cut::border(node, axis),
                };
                vertices.push(affine.apply(place.map(f64::from)));
            });
            Ok(vertices)
        })
        .collect::<Result<_, SurfaceError>>()?;
    let mut triangles = triangles(&signs, &rows, task)?;
    if affine.determinant() < 0.0 {
        // Outward among columns, rows and slices is inward in a frame of the other hand.
        for triangle in &mut triangles {
            triangle.swap(1, 2);
        }
    }
    Ok(Some(TriangleMesh::new(vertices.concat(), triangles)?))
}
