//! How many voxels have which Hounsfield unit.

use crate::{Volume, Voxels};

/// Voxel counts in bins of equal width.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Lower end of the first bin (HU).
    pub first_hu: f64,
    /// Width of a bin (HU).
    pub bin_hu: f64,
    /// Voxels in each bin.
    pub counts: Vec<u64>,
}

impl Histogram {
    /// Counts the voxels from -1024 to 3071 HU in bins of `bin_hu`; values beyond count in the end bins.
    pub fn of(volume: &Volume, bin_hu: f64) -> Self {
        let (first_hu, last_hu) = (-1024.0, 3072.0);
        let bins = ((last_hu - first_hu) / bin_hu).ceil().max(1.0) as usize;
        let mut counts = vec![0_u64; bins];
        let mut count = |hu: f64| {
            let bin = ((hu - first_hu) / bin_hu).floor().max(0.0) as usize;
            counts[bin.min(bins - 1)] += 1;
        };
        match volume.voxels() {
            Voxels::I16(a) => a.iter().for_each(|v| count(f64::from(*v))),
            Voxels::F32(a) => a.iter().for_each(|v| count(f64::from(*v))),
        }
        Self {
            first_hu,
            bin_hu,
            counts,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Affine, Geometry};

    #[test]
    fn every_voxel_is_counted_once() {
        let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        let hu = ndarray::arr3(&[[[-3000_i16, -1024, 0], [350, 3071, 9000]]]);
        let volume =
            Volume::new(Voxels::I16(hu), Geometry::new([1, 2, 3], affine).unwrap()).unwrap();
        let histogram = Histogram::of(&volume, 1.0);
        assert_eq!(histogram.counts.iter().sum::<u64>(), 6);
        assert_eq!(histogram.counts[0], 2);
        assert_eq!(histogram.counts[1374], 1);
        assert_eq!(*histogram.counts.last().unwrap(), 2);
    }
}
