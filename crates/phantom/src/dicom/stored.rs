//! Hounsfield units as 16-bit stored values and back: slope and intercept.

use bonemesh_volume::{Volume, Voxels};

use crate::PhantomError;

/// How Hounsfield units are stored: `hu = slope * stored + intercept`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rescale {
    pub(super) slope: f64,
    pub(super) intercept: f64,
    pub(super) signed: bool,
}

impl Rescale {
    /// Whole units are stored exactly, from -1024 up as scanners do where nothing lies below;
    /// fractional ones share out the 16 bits.
    pub(super) fn of(volume: &Volume) -> Result<Self, PhantomError> {
        let (low, high) = volume.hu_range();
        match volume.voxels() {
            Voxels::I16(_) => Ok(Self {
                slope: 1.0,
                intercept: if low < -1024.0 { 0.0 } else { -1024.0 },
                signed: low < -1024.0,
            }),
            Voxels::F32(hu) => {
                if let Some(odd) = hu.iter().find(|v| !v.is_finite()) {
                    return Err(PhantomError::Dicom {
                        what: "a Hounsfield unit",
                        value: odd.to_string(),
                        remedy: "replace values that are no numbers",
                    });
                }
                let slope = (high - low) / f64::from(u16::MAX);
                Ok(Self {
                    slope: if slope > 0.0 { slope } else { 1.0 },
                    intercept: low,
                    signed: false,
                })
            }
        }
    }

    /// Stored values of one slice, as 16-bit patterns.
    pub(super) fn slice(&self, volume: &Volume, slice: usize) -> Vec<u16> {
        let store = |hu: f64| {
            let stored = ((hu - self.intercept) / self.slope).round();
            // Signed values keep their bits.
            if self.signed {
                stored as i16 as u16
            } else {
                stored as u16
            }
        };
        let axis = ndarray::Axis(0);
        match volume.voxels() {
            Voxels::I16(hu) => hu
                .index_axis(axis, slice)
                .iter()
                .map(|v| store(f64::from(*v)))
                .collect(),
            Voxels::F32(hu) => hu
                .index_axis(axis, slice)
                .iter()
                .map(|v| store(f64::from(*v)))
                .collect(),
        }
    }
}
