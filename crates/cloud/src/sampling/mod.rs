//! Thinning a cloud.

mod contours;
mod random;
mod remaining;
mod slices;
mod thesis_uniform;
mod uniform;

use std::fmt;
use std::str::FromStr;

use bonemesh_task::Task;

use crate::{CloudError, PointCloud};

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

/// How points are chosen.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Sampler {
    /// Evenly along the contours of each slice.
    #[default]
    Uniform,
    /// By lot, each point with the same chance.
    Random,
    /// The published pseudo-uniform way: ten neighbours at a time, of which some are kept.
    ///
    /// Percentages act in steps of ten (25 keeps 20, 9 keeps almost nothing) and gaps remain.
    ThesisUniform,
}

impl Sampler {
    /// Every sampler.
    pub const ALL: [Self; 3] = [Self::Uniform, Self::Random, Self::ThesisUniform];

    /// The name by which it is chosen.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Random => "random",
            Self::ThesisUniform => "thesis-uniform",
        }
    }
}

impl fmt::Display for Sampler {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Sampler {
    type Err = CloudError;

    fn from_str(name: &str) -> Result<Self, CloudError> {
        Self::ALL
            .into_iter()
            .find(|sampler| sampler.name() == name)
            .ok_or_else(|| CloudError::Sampler(name.to_owned()))
    }
}

/// The indices of the points to keep, ascending; the same `seed` keeps the same points.
///
/// Only [`Sampler::Random`] draws lots. An empty cloud keeps nothing.
///
/// # Errors
/// [`CloudError::Cancelled`].
pub fn sample(
    cloud: &PointCloud,
    sampler: Sampler,
    percent: Percent,
    seed: u64,
    task: &Task,
) -> Result<Vec<u32>, CloudError> {
    task.begin("sample", cloud.len());
    task.check()?;
    let mut kept = match sampler {
        Sampler::Random => random::keep(cloud.len(), percent, seed),
        Sampler::ThesisUniform => thesis_uniform::keep(cloud, percent, task)?,
        Sampler::Uniform => uniform::keep(cloud, percent, task)?,
    };
    kept.sort_unstable();
    Ok(kept)
}
