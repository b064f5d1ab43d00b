//! From a phantom to a CT volume.
//!
//! Each slice is painted, blurred and given its noise by itself, so that slices run in parallel
//! and the result does not depend on how many do.

mod blur;
mod noise;
mod paint;

use bonemesh_task::Task;
use bonemesh_volume::{Geometry, Volume, Voxels};
use ndarray::Array3;
use rayon::prelude::*;

use crate::body::{BONE_HU, Layers, SOFT_HU};
use crate::{Phantom, PhantomError, ScanSettings};

/// Hounsfield units that a 12-bit scanner can tell.
const HU_RANGE: (f32, f32) = (-1024.0, 3071.0);

/// Scans a phantom: a volume in Hounsfield units (16-bit, -1024 to 3071).
///
/// A body's voxel is the mean over its box (partial volume), blurred by the point-spread
/// function, plus noise. A model drawn in pixels is bone (1240 HU) on soft tissue (40 HU).
///
/// # Errors
/// [`PhantomError`] for settings that make no scan, and when cancelled.
pub fn scan(
    phantom: Phantom,
    settings: &ScanSettings,
    task: &Task,
) -> Result<Volume, PhantomError> {
    let geometry = settings.geometry()?;
    let source = Source::of(phantom, settings)?;
    let hu = scan_slices(&source, &geometry, settings, task)?;
    Ok(Volume::new(Voxels::I16(hu), geometry)?)
}

fn scan_slices(
    source: &Source,
    geometry: &Geometry,
    settings: &ScanSettings,
    task: &Task,
) -> Result<Array3<i16>, PhantomError> {
    let [slices, rows, columns] = geometry.shape();
    let mut hu = Array3::<i16>::zeros([slices, rows, columns]);
    task.begin("scan", slices);
    hu.as_slice_mut()
        .expect("a new array is contiguous; otherwise this is a bug")
        .par_chunks_mut(rows * columns)
        .enumerate()
        .try_for_each(|(k, out)| {
            scan_slice(source, geometry, settings, k, out, task)?;
            task.advance(1).map_err(PhantomError::from)
        })?;
    Ok(hu)
}

/// What the slices are painted from.
enum Source {
    Body(Layers),
    Image(Vec<f32>),
}

impl Source {
    fn of(phantom: Phantom, settings: &ScanSettings) -> Result<Self, PhantomError> {
        if let Some(known) = phantom.known() {
            return Ok(Self::Body(known.layers));
        }
        let model = phantom
            .model()
            .expect("a phantom is a body or a model; otherwise this is a bug");
        let image = model.draw(settings.columns, settings.rows)?;
        let hu = |bone: &bool| if *bone { BONE_HU } else { SOFT_HU } as f32;
        Ok(Self::Image(image.iter().map(hu).collect()))
    }
}

fn scan_slice(
    source: &Source,
    geometry: &Geometry,
    settings: &ScanSettings,
    slice: usize,
    out: &mut [i16],
    task: &Task,
) -> Result<(), PhantomError> {
    let [_, rows, columns] = geometry.shape();
    let mut image = match source {
        Source::Body(layers) => paint::slice(layers, geometry, slice, task)?,
        Source::Image(image) => image.clone(),
    };
    blur::gaussian(&mut image, columns, rows, settings.psf_px);
    noise::add(&mut image, settings.noise_hu, settings.seed, slice);
    for (hu, value) in out.iter_mut().zip(image) {
        *hu = value.round().clamp(HU_RANGE.0, HU_RANGE.1) as i16;
    }
    Ok(())
}
