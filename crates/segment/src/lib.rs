//! Bone masks and Canny edges of a CT volume.

use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::{Geometry, Volume};
use ndarray::Array3;

/// What cannot be segmented, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum SegmentError {
    /// A threshold that is no number.
    #[error("the threshold {0} is no Hounsfield value; use a number such as 350")]
    Threshold(f64),
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A finite bone threshold in Hounsfield units; bone is strictly above it.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct HuThreshold(f64);

impl HuThreshold {
    /// Checks the value.
    ///
    /// # Errors
    /// [`SegmentError::Threshold`] for NaN and infinities.
    pub fn new(hu: f64) -> Result<Self, SegmentError> {
        if hu.is_finite() {
            Ok(Self(hu))
        } else {
            Err(SegmentError::Threshold(hu))
        }
    }

    /// The threshold in HU.
    pub fn hu(self) -> f64 {
        self.0
    }
}

/// Which voxels are bone, `[slice, row, column]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// True where the voxel is bone.
    pub voxels: Array3<bool>,
    /// Place in the patient.
    pub geometry: Geometry,
}

/// Which voxels lie on an edge, `[slice, row, column]`.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeMap {
    /// True where the voxel is an edge pixel of its slice.
    pub edges: Array3<bool>,
    /// Place in the patient.
    pub geometry: Geometry,
}

/// Canny's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CannySettings {
    sigma: f64,
    low: f64,
    high: f64,
}

/// Bone = HU strictly above the threshold.
///
/// # Errors
/// see SegmentError
pub fn threshold(
    volume: &Volume,
    threshold: HuThreshold,
    task: &Task,
) -> Result<Mask, SegmentError> {
    let _ = (volume, threshold, task);
    todo!()
}

/// Canny edges of each slice of a mask.
///
/// # Errors
/// see SegmentError
pub fn detect_edges(
    mask: &Mask,
    settings: CannySettings,
    task: &Task,
) -> Result<EdgeMap, SegmentError> {
    let _ = (mask, settings, task);
    todo!()
}
