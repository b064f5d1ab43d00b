//! The surface of all bone in a volume, at the true edges of the bone.
//!
//! 1. `level`: near every surface of the asked-for threshold, find the grey of the true edge, in
//!    the middle between the bone's grey and that around it.
//! 2. `signs`: voxels above that level are inside; beyond the volume's border all is outside, so
//!    that bone which the scan cuts off is closed there.
//! 3. `march`: a vertex on every edge between an inside and an outside voxel, and in each cube of
//!    voxels the triangles of its case (`cases`).
//! 4. `slide`: vertices slide along their edges until noise and stairs are smooth.
//!
//! The surface is a closed 2-manifold without self-intersections: see `cases`.

mod blur;
mod cases;
pub(crate) mod cut;
mod cuts;
mod edge;
pub(crate) mod grey;
mod layer;
mod level;
pub(crate) mod march;
pub(crate) mod signs;
mod slide;

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::{Affine, Volume, Voxels};
use ndarray::Array3;
use rayon::prelude::*;

use crate::SurfaceError;
use cut::Crossing;
use cuts::Cuts;
use grey::{Grey, Voxel, usable};
use march::{Rows, triangles};
use signs::Signs;

/// Smoothing moves the surface hardly further than this part of a pixel: on phantoms it takes a sixth
/// of the mean error off curved bone, and more does not take more.
const SMOOTH_PIXELS: f32 = 0.2;

/// How an isosurface is placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IsosurfaceSettings<'a> {
    /// Bone is above this.
    pub threshold_hu: f64,
    /// The volume with values that stand above the threshold where and as far as those of the volume
    /// itself stand above thresholds of their own, if they have such ones.
    pub leveled: Option<&'a Volume>,
    /// Moves the surface to the true edges of the bone, whatever the threshold, and smooths an
    /// isosurface by up to a fifth of a pixel; otherwise it lies where the grey between voxels equals
    /// the threshold.
    pub true_edges: bool,
}

impl IsosurfaceSettings<'_> {
    /// How values between voxels pass 0.
    pub(crate) fn crossing(self) -> Crossing {
        if self.true_edges {
            cut::in_boxes
        } else {
            cut::linear
        }
    }
}

/// The surface of the bone in `volume`, outward-oriented, in patient space (mm).
///
/// Whole Hounsfield units are compared half a unit higher, so that a voxel of just the threshold
/// is outside and none lies on the surface. The stages are `edges` and `surface`.
///
/// # Errors
/// [`SurfaceError::NothingAbove`], [`SurfaceError::TooSmall`], [`SurfaceError::TooLarge`],
/// [`SurfaceError::Cancelled`].
pub fn isosurface(
    volume: &Volume,
    settings: IsosurfaceSettings<'_>,
    task: &Task,
) -> Result<TriangleMesh, SurfaceError> {
    let affine = volume.geometry().patient_from_voxel();
    let mesh = if settings.true_edges {
        let above = above_level(volume, settings, task)?;
        let above = Grey::new(&above, shape(volume));
        surface(
            above.shape(),
            |at| above.at(at),
            settings.crossing(),
            affine,
            Some(tolerance_mm(volume)),
            task,
        )
    } else {
        let threshold = threshold(volume, settings);
        match settings.leveled.unwrap_or(volume).voxels() {
            Voxels::I16(hu) => in_order(hu, |grey| {
                let above = |at| grey.at(at) - threshold;
                surface(grey.shape(), above, settings.crossing(), affine, None, task)
            }),
            Voxels::F32(hu) => in_order(hu, |grey| {
                let above = |at| grey.at(at) - threshold;
                surface(grey.shape(), above, settings.crossing(), affine, None, task)
            }),
        }
    };
    mesh?.ok_or_else(|| nothing(volume, settings))
}

/// Why there is no surface: no voxel is above the threshold, or those that are do not reach the
/// grey of their own edges.
pub(crate) fn nothing(volume: &Volume, settings: IsosurfaceSettings<'_>) -> SurfaceError {
    let threshold = threshold(volume, settings);
    let is_any_above = match settings.leveled.unwrap_or(volume).voxels() {
        Voxels::I16(hu) => hu.iter().any(|&hu| f32::from(hu) > threshold),
        Voxels::F32(hu) => hu.iter().any(|&hu| hu > threshold),
    };
    let threshold_hu = settings.threshold_hu;
    if is_any_above {
        SurfaceError::TooSmall { threshold_hu }
    } else {
        SurfaceError::NothingAbove { threshold_hu }
    }
}

/// How far smoothing moves the surface: what noise and stairs make of it, less than its detail.
fn tolerance_mm(volume: &Volume) -> f32 {
    let [x, y, _] = volume.geometry().spacing_mm();
    SMOOTH_PIXELS * x.min(y) as f32
}

/// Columns, rows, slices.
pub(crate) fn shape(volume: &Volume) -> [usize; 3] {
    let [slices, rows, columns] = volume.geometry().shape();
    [columns, rows, slices]
}

/// Usable voxels in the order slice, row, column, whatever order they are stored in.
fn in_order<T: Voxel, R>(hu: &Array3<T>, of: impl FnOnce(&Grey<'_, T>) -> R) -> R {
    let (slices, rows, columns) = hu.dim();
    let hu = hu.as_standard_layout();
    let hu = hu.as_slice().expect("in order, else it is a bug");
    of(&Grey::new(&usable(hu), [columns, rows, slices]))
}

/// The threshold, above all of its whole numbers: so none of them lies just on the surface.
fn threshold(volume: &Volume, settings: IsosurfaceSettings<'_>) -> f32 {
    let hu = match volume.voxels() {
        Voxels::I16(_) => settings.threshold_hu.floor() + 0.5,
        Voxels::F32(_) => settings.threshold_hu,
    };
    hu as f32
}

/// What voxels are above the level that a surface follows, by slice, row and column: positive
/// inside; at the true edges as a part of their contrast, otherwise in HU. The stage is `edges`.
pub(crate) fn above_level(
    volume: &Volume,
    settings: IsosurfaceSettings<'_>,
    task: &Task,
) -> Result<Vec<f32>, Cancelled> {
    let threshold = threshold(volume, settings);
    let of = settings.leveled.unwrap_or(volume);
    match volume.voxels() {
        Voxels::I16(hu) => in_order(hu, |grey| {
            above_in(grey, of, threshold, volume, settings, task)
        }),
        Voxels::F32(hu) => in_order(hu, |grey| {
            above_in(grey, of, threshold, volume, settings, task)
        }),
    }
}

/// Compares the voxels of another volume on the same lattice with the threshold.
fn above_in<T: Voxel>(
    grey: &Grey<'_, T>,
    compared: &Volume,
    threshold: f32,
    volume: &Volume,
    settings: IsosurfaceSettings<'_>,
    task: &Task,
) -> Result<Vec<f32>, Cancelled> {
    match compared.voxels() {
        Voxels::I16(hu) => in_order(hu, |compared| {
            let above_threshold = |at| compared.at(at) - threshold;
            above(grey, above_threshold, volume, settings, task)
        }),
        Voxels::F32(hu) => in_order(hu, |compared| {
            let above_threshold = |at| compared.at(at) - threshold;
            above(grey, above_threshold, volume, settings, task)
        }),
    }
}

/// `above_threshold` tells how far (HU) a voxel is above its threshold.
fn above<T: Voxel>(
    grey: &Grey<'_, T>,
    above_threshold: impl Fn([usize; 3]) -> f32 + Sync,
    volume: &Volume,
    settings: IsosurfaceSettings<'_>,
    task: &Task,
) -> Result<Vec<f32>, Cancelled> {
    if settings.true_edges {
        let geometry = volume.geometry();
        let spacing = geometry.spacing_mm().map(|v| v as f32);
        let steepest = steepest(geometry.patient_from_voxel());
        return level::above_level(grey, above_threshold, spacing, steepest, task);
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
                *value = above_threshold([place % columns, place / columns, k]);
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

/// The surface between the nodes of a lattice with values above 0 and the others, where lines between
/// them pass 0: a closed 2-manifold without self-intersections, outward-oriented; `None` if no value is
/// above 0.
///
/// `values` are by slice, row and column of `[columns, rows, slices]`; `affine` puts columns, rows and
/// slices to their places. The stage is `surface`.
///
/// # Errors
/// [`SurfaceError::TooLarge`], [`SurfaceError::Cancelled`].
pub fn level_surface(
    values: &[f32],
    [columns, rows, slices]: [usize; 3],
    affine: &Affine,
    task: &Task,
) -> Result<Option<TriangleMesh>, SurfaceError> {
    let value = |[i, j, k]: [usize; 3]| values[(k * rows + j) * columns + i];
    let shape = [columns, rows, slices];
    surface(shape, value, cut::linear, affine, None, task)
}

/// The surface between voxels of a value above 0 and others, if there are any; `crossing` tells
/// where between two values it is, and what is smoothed moves hardly further than `tolerance_mm`.
pub(crate) fn surface(
    shape: [usize; 3],
    value: impl Fn([usize; 3]) -> f32 + Sync,
    crossing: impl Fn(f32, f32) -> f32 + Sync,
    affine: &Affine,
    tolerance_mm: Option<f32>,
    task: &Task,
) -> Result<Option<TriangleMesh>, SurfaceError> {
    let signs = Signs::of(shape, |at| value(at) > 0.0, task)?;
    let rows = Rows::of(&signs).ok_or(SurfaceError::TooLarge)?;
    if rows.vertices == 0 {
        return Ok(None);
    }
    task.begin("surface", 2 * signs.slices() - 1);
    let mut cuts = Cuts::of(&signs, shape, value, crossing, task)?;
    let mut triangles = triangles(&signs, &rows, task)?;
    if let Some(tolerance_mm) = tolerance_mm {
        cuts.smooth(&triangles, affine, tolerance_mm, task)?;
    }
    if affine.determinant() < 0.0 {
        // Outward among columns, rows and slices is inward in a frame of the other hand.
        for triangle in &mut triangles {
            triangle.swap(1, 2);
        }
    }
    let vertices = cuts.places.par_iter();
    let vertices = vertices.map(|place| affine.apply(place.map(f64::from)));
    Ok(Some(TriangleMesh::new(vertices.collect(), triangles)?))
}
