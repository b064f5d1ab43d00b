//! Which sampler, and what it is told.

use std::fmt;
use std::str::FromStr;

use super::{Percent, SimilarityRanges};
use crate::CloudError;

/// How points are chosen.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Sampler {
    /// Evenly along the contours of each slice.
    #[default]
    Uniform,
    /// Along the contours of each slice, more where they bend.
    Targeted,
    /// By lot, each point with the same chance.
    Random,
    /// The published pseudo-uniform way: ten neighbours at a time, of which some are kept.
    ///
    /// Percentages act in steps of ten (25 keeps 20, 9 keeps almost nothing) and gaps remain.
    ThesisUniform,
    /// The published targeted way: cells of a grid, each at the percentage that belongs to how alike
    /// its normals are.
    ThesisTargeted,
}

impl Sampler {
    /// Every sampler.
    pub const ALL: [Self; 5] = [
        Self::Uniform,
        Self::Targeted,
        Self::Random,
        Self::ThesisUniform,
        Self::ThesisTargeted,
    ];

    /// The name by which it is chosen.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Targeted => "targeted",
            Self::Random => "random",
            Self::ThesisUniform => "thesis-uniform",
            Self::ThesisTargeted => "thesis-targeted",
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

/// A sampler with all that it is told.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// See [`Sampler::Uniform`].
    Uniform {
        /// Part of the points to keep.
        percent: Percent,
    },
    /// See [`Sampler::Targeted`].
    Targeted {
        /// Part of the points to keep.
        percent: Percent,
    },
    /// See [`Sampler::Random`].
    Random {
        /// Part of the points to keep.
        percent: Percent,
        /// Decides the lots.
        seed: u64,
    },
    /// See [`Sampler::ThesisUniform`].
    ThesisUniform {
        /// Part of each ten points to keep, which is rounded down.
        percent: Percent,
    },
    /// See [`Sampler::ThesisTargeted`].
    ThesisTargeted(SimilarityRanges),
}

impl Sampling {
    /// A sampler and what was said beside it; `None` where nothing was chosen at all.
    ///
    /// Ranges belong to [`Sampler::ThesisTargeted`], whose points are decided by them (by the published
    /// ones if none are given); a percentage to all others, which keep everything without one.
    ///
    /// # Errors
    /// [`CloudError::PercentUnused`] and [`CloudError::RangesUnused`].
    pub fn chosen(
        sampler: Sampler,
        percent: Option<Percent>,
        seed: u64,
        ranges: Option<SimilarityRanges>,
    ) -> Result<Option<Self>, CloudError> {
        if sampler == Sampler::ThesisTargeted {
            return match percent {
                Some(_) => Err(CloudError::PercentUnused),
                None => Ok(Some(Self::ThesisTargeted(ranges.unwrap_or_default()))),
            };
        }
        if ranges.is_some() {
            return Err(CloudError::RangesUnused(sampler.name()));
        }
        Ok(percent.map(|percent| match sampler {
            Sampler::Targeted => Self::Targeted { percent },
            Sampler::Random => Self::Random { percent, seed },
            Sampler::ThesisUniform => Self::ThesisUniform { percent },
            Sampler::Uniform | Sampler::ThesisTargeted => Self::Uniform { percent },
        }))
    }

    /// Part of the points to keep, where there is one for all.
    pub fn percent(&self) -> Option<Percent> {
        match self {
            Self::Uniform { percent }
            | Self::Targeted { percent }
            | Self::Random { percent, .. }
            | Self::ThesisUniform { percent } => Some(*percent),
            Self::ThesisTargeted(_) => None,
        }
    }

    /// What decides the lots; 0 where none are drawn.
    pub fn seed(&self) -> u64 {
        match self {
            Self::Random { seed, .. } => *seed,
            _ => 0,
        }
    }

    /// Which sampler it is.
    pub fn sampler(&self) -> Sampler {
        match self {
            Self::Uniform { .. } => Sampler::Uniform,
            Self::Targeted { .. } => Sampler::Targeted,
            Self::Random { .. } => Sampler::Random,
            Self::ThesisUniform { .. } => Sampler::ThesisUniform,
            Self::ThesisTargeted(_) => Sampler::ThesisTargeted,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sampler_is_found_by_its_name_and_the_message_names_them_all() {
        for sampler in Sampler::ALL {
            assert_eq!(sampler.name().parse::<Sampler>().unwrap(), sampler);
        }
        let message = "magic".parse::<Sampler>().unwrap_err().to_string();
        assert!(
            Sampler::ALL.iter().all(|s| message.contains(s.name())),
            "{message}"
        );
    }

    #[test]
    fn a_percentage_and_ranges_go_to_the_samplers_that_have_them() {
        let percent = Percent::new(20.0).unwrap();
        let ranges = SimilarityRanges::default();
        for sampler in Sampler::ALL {
            let by_percent = Sampling::chosen(sampler, Some(percent), 3, None);
            let by_ranges = Sampling::chosen(sampler, None, 3, Some(ranges));
            let (taken, refused) = match sampler {
                Sampler::ThesisTargeted => (by_ranges, by_percent),
                _ => (by_percent, by_ranges),
            };
            assert_eq!(taken.unwrap().unwrap().sampler(), sampler);
            assert!(refused.is_err());
        }
        assert_eq!(
            Sampling::chosen(Sampler::Uniform, None, 0, None).unwrap(),
            None
        );
    }
}
