//! Thinning a cloud.

mod choice;
mod contours;
mod lines;
mod random;
mod remaining;
mod similarity;
mod slices;
mod spread;
mod targeted;
mod thesis_targeted;
mod thesis_uniform;
mod uniform;

use bonemesh_task::Task;

use crate::{CloudError, PointCloud};
pub use choice::{Sampler, Sampling};
pub use similarity::{NormalsIn, normal_similarity};
pub use thesis_targeted::{SimilarityRanges, count_ranges};

/// A part to keep, above 0 and up to 100 percent.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Percent(f64);

impl Percent {
    /// Checks the value.
    ///
    /// # Errors
    /// [`CloudError::Percent`] unless 0 < percent <= 100.
    pub fn new(percent: f64) -> Result<Self, CloudError> {
        if percent > 0.0 && percent <= 100.0 {
            Ok(Self(percent))
        } else {
            Err(CloudError::Percent(percent))
        }
    }

    /// The value in percent.
    pub fn get(self) -> f64 {
        self.0
    }

    /// The value as a part of one.
    pub fn fraction(self) -> f64 {
        self.0 / 100.0
    }
}

/// The indices of the points to keep, ascending.
///
/// Only [`Sampling::Random`] draws lots; the same seed keeps the same points. An empty cloud keeps
/// nothing.
///
/// # Errors
/// [`CloudError::NoPixels`] for [`Sampling::ThesisTargeted`] without a lattice,
/// [`CloudError::Cancelled`].
pub fn sample(
    cloud: &PointCloud,
    sampling: &Sampling,
    task: &Task,
) -> Result<Vec<u32>, CloudError> {
    task.begin("sample", cloud.len());
    task.check()?;
    let mut kept = match sampling {
        Sampling::Uniform { percent } => uniform::keep(cloud, *percent, task)?,
        Sampling::Targeted { percent } => targeted::keep(cloud, *percent, task)?,
        Sampling::Random { percent, seed } => random::keep(cloud.len(), *percent, *seed),
        Sampling::ThesisUniform { percent } => thesis_uniform::keep(cloud, *percent, task)?,
        Sampling::ThesisTargeted(ranges) => thesis_targeted::keep(cloud, ranges, task)?,
    };
    kept.sort_unstable();
    Ok(kept)
}

#[cfg(test)]
mod tests;
