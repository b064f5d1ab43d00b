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
mod edge;
pub(crate) mod grey;
mod level;
pub(crate) mod march;
pub(crate) mod signs;

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::{Affine, Volume};
use rayon::prelude::*;

use crate::SurfaceError;
use grey::{Grey, Ordered};
use march::{Rows, cut_edges, triangles};
use signs::Signs;

/// Vertices stay away from voxels by this part of the step between two: those around one voxel
/// remain distinct also as 32-bit numbers.
pub(crate) const FROM_VOXEL: f32 = 0.02;

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
    let ordered = Ordered::of(volume);
    let grey = ordered.grey();
    let affine = volume.geometry().patient_from_voxel();
    if settings.true_edges {
        let above = above_level(volume, &grey, settings, task)?;
        let above = Grey::F32(&above, grey.shape());
        surface(grey.shape(), |at| above.at(at), affine, settings, task)
    } else {
        let threshold = between_units(&grey, settings.threshold_hu);
        surface(
            grey.shape(),
            |at| grey.at(at) - threshold,
            affine,
            settings,
            task,
        )
    }
}

/// A threshold that no voxel has.
fn between_units(grey: &Grey<'_>, threshold_hu: f64) -> f32 {
    let threshold = match grey {
        Grey::I16(..) => threshold_hu.floor() + 0.5,
        Grey::F32(..) => threshold_hu,
    };
    threshold as f32
}

/// Grey above the level that a surface follows, voxel by voxel: positive inside. The stage is
/// `edges`.
pub(crate) fn above_level(
    volume: &Volume,
    grey: &Grey<'_>,
    settings: IsosurfaceSettings,
    task: &Task,
) -> Result<Vec<f32>, Cancelled> {
    let threshold = between_units(grey, settings.threshold_hu);
    if settings.true_edges {
        let spacing = volume.geometry().spacing_mm().map(|v| v as f32);
        let steepest = steepest(volume.geometry().patient_from_voxel());
        return level::above_level(grey, threshold, spacing, steepest, task);
    }
    let [columns, rows, slices] = grey.shape();
    task.begin("edges", slices);
    let mut above = vec![0.0; columns * rows * slices];
    above
        .par_chunks_mut(columns * rows)
        .enumerate()
        .try_for_each(|(k, slice)| {
            task.advance(1)?;
            for (place, value) in slice.iter_mut().enumerate() {
                *value = grey.at([place % columns, place / columns, k]) - threshold;
            }
            Ok(())
        })?;
    Ok(above)
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

/// The surface between voxels of a value above 0 and others.
fn surface(
    shape: [usize; 3],
    value: impl Fn([usize; 3]) -> f32 + Sync,
    affine: &Affine,
    settings: IsosurfaceSettings,
    task: &Task,
) -> Result<TriangleMesh, SurfaceError> {
    let signs = Signs::of(shape, |at| value(at) > 0.0, task)?;
    let rows = Rows::of(&signs).ok_or(SurfaceError::TooLarge)?;
    if rows.vertices == 0 {
        let threshold_hu = settings.threshold_hu;
        return Err(SurfaceError::NothingAbove { threshold_hu });
    }
    task.begin("surface", 2 * signs.slices() - 1);
    let vertices: Vec<Vec<[f64; 3]>> = (0..signs.slices())
        .into_par_iter()
        .map(|k| {
            task.advance(1)?;
            let mut vertices = Vec::new();
            cut_edges(&signs, k, |node, axis| {
                let place =
                    place_on_edge(node, axis, shape, &value).unwrap_or_else(|| border(node, axis));
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
    Ok(TriangleMesh::new(vertices.concat(), triangles)?)
}

/// Where the value passes 0 between a node and the next one along `axis`, in voxels; `None` if
/// one of them is on the border.
pub(crate) fn place_on_edge(
    node: [usize; 3],
    axis: usize,
    shape: [usize; 3],
    value: impl Fn([usize; 3]) -> f32,
) -> Option<[f32; 3]> {
    let is_voxel = |at: [usize; 3]| (0..3).all(|k| (1..=shape[k]).contains(&at[k]));
    let mut next = node;
    next[axis] += 1;
    if !is_voxel(node) || !is_voxel(next) {
        return None;
    }
    let voxel = node.map(|n| n - 1);
    let (a, b) = (value(voxel), value(next.map(|n| n - 1)));
    let part = (a / (a - b)).clamp(FROM_VOXEL, 1.0 - FROM_VOXEL);
    let mut place = voxel.map(|v| v as f32);
    place[axis] += part;
    Some(place)
}

/// Halfway from the outermost voxels to the nodes beyond them: where their voxels end.
pub(crate) fn border(node: [usize; 3], axis: usize) -> [f32; 3] {
    let mut place = node.map(|n| n as f32 - 1.0);
    place[axis] += 0.5;
    place
}
