//! Metal in a CT volume: found, told, and its streaks damped.
//!
//! Fillings, crowns, implants and screws harden and starve the X-ray beam. In the slices they are in
//! this leaves dark and bright streaks and noise, and a surface there gets spikes, webs and islands.
//! [`find_metal`] says how much metal there is, where, and how strong the streaks are;
//! [`damp_metal`] replaces what the scanner measured through metal by what the slice without streaks
//! would have given.
//!
//! Promise: slices without metal stay as they are to the last bit; metal itself stays; the result is
//! the same for any number of threads and whatever the order of the voxels.
//!
//! What is metal: connected voxels of [`METAL_HU`] and more, 4 mm3 at least. Enamel reaches 2500 to
//! 3000 HU, more where a sharp kernel overshoots; so pieces without a flat top where the scanner's
//! scale ends, and without values beyond 4000 HU, count only where their slices have streaks.
//!
//! Limits: damping works on finished slices, not on the scanner's raw data. It takes slices for the
//! planes in which the scanner turned; those of a scan stored in other planes are not. What the scale
//! cut off (dark streaks below -1024 HU) cannot be had back. Bone within a few millimetres of metal,
//! where every ray meets metal, is as uncertain after damping as before, and edges there may be
//! blurred. Where metal left no streaks damping makes a slice worse, not better: two crowns painted
//! into a dry skull raise the spread of its values by a fifth. Metal of few voxels in thick ones stays below [`METAL_HU`] and is not seen. Cone-beam
//! scanners whose values are no Hounsfield units need another method.
//!
//! ```
//! use bonemesh_metal::{damp_metal, find_metal};
//! use bonemesh_task::Task;
//! use bonemesh_volume::{Affine, Geometry, Volume, Voxels};
//! use ndarray::Array3;
//!
//! let affine = Affine::from_axes([0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
//! let is_crown = |(k, j, i)| k < 4 && (10..20).contains(&j) && (10..20).contains(&i);
//! let hu = Array3::from_shape_fn([9, 40, 40], |at| if is_crown(at) { 3071_i16 } else { 40 });
//! let volume = Volume::new(Voxels::I16(hu), Geometry::new([9, 40, 40], affine)?)?;
//!
//! let task = Task::default();
//! let metal = find_metal(&volume, &task)?.expect("a crown");
//! assert_eq!((metal.pieces, metal.slices), (1, [0, 3]));
//! assert_eq!(metal.volume_mm3, 100.0);
//! let damped = damp_metal(&volume, &metal, &task)?;
//! assert_eq!(damped.geometry(), volume.geometry());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Sources: W. A. Kalender, R. Hebel, J. Ebersberger, *Reduction of CT artifacts caused by metallic
//! implants*, Radiology 164(2), 1987; E. Meyer, R. Raupach, M. Lell, B. Schmidt, M. Kachelriess,
//! *Normalized metal artifact reduction (NMAR) in computed tomography*, Medical Physics 37(10), 2010;
//! X.-Y. Gong et al., Dentomaxillofacial Radiology 42(4), 2013, for dental fillings.
#![forbid(unsafe_code)]

mod bright;
mod damp;
mod find;
mod project;
mod reduce;
mod slice;
mod streaks;

use bonemesh_segment::SegmentError;
use bonemesh_task::Cancelled;
use bonemesh_volume::VolumeError;

pub use damp::damp_metal;
pub use find::{Metal, find_metal};
pub use streaks::Streaks;

/// Metal starts here, above enamel and below 3071 HU, where scales of 12 bits end and into which
/// metals fall (J. Jayamani et al., *Determination of computed tomography number of high-density
/// materials in 12-bit, 12-bit extended and 16-bit depth*, Journal of Radiotherapy in Practice).
pub const METAL_HU: f32 = 3000.0;

/// Why metal cannot be looked for or damped.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum MetalError {
    /// Its pieces cannot be told apart.
    #[error(transparent)]
    Segment(SegmentError),
    /// No part of the volume can be taken.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// The metal is that of another volume.
    #[error("the metal was found in a volume of another shape or place; find it in this one")]
    OtherVolume,
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<SegmentError> for MetalError {
    fn from(error: SegmentError) -> Self {
        match error {
            SegmentError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            other => Self::Segment(other),
        }
    }
}
