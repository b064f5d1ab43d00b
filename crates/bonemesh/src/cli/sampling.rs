//! Which part of the points is used, on the command line.

use bonemesh_cloud::{Percent, Sampler, Sampling, SimilarityRanges};
use clap::Args;

use super::arguments::number;
use crate::Error;

#[derive(Debug, Args)]
pub(super) struct SamplingArguments {
    /// Keep this percentage of the points (above 0, at most 100).
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true, value_parser = percent)]
    sample: Option<Percent>,
    /// How the kept points are chosen: uniform, targeted (more where contours bend), random,
    /// thesis-uniform; or thesis-targeted, which takes --percentages in place of --sample
    /// [default: uniform].
    #[arg(long, value_name = "NAME")]
    sampler: Option<Sampler>,
    /// Seed of the random sampler.
    #[arg(long, default_value_t = 0, requires = "sample")]
    seed: u64,
    /// Cells of thesis-targeted in pixels [default: 10].
    #[arg(long, value_name = "PIXELS", requires = "sampler")]
    grid_px: Option<u32>,
    /// Similarities from which the four ranges of thesis-targeted begin [default: 0,0.4,0.6,0.8].
    #[arg(long, value_name = "A,B,C,D", requires = "sampler", value_parser = four)]
    cutoffs: Option<[f64; 4]>,
    /// Percentages that thesis-targeted keeps of these ranges, of the highest first
    /// [default: 10,25,50,75].
    #[arg(long, value_name = "A,B,C,D", requires = "sampler", value_parser = four)]
    percentages: Option<[f64; 4]>,
}

impl SamplingArguments {
    /// What was chosen; `None` if all points are kept.
    ///
    /// # Errors
    /// [`Error::NoPercent`], [`Error::Cloud`] for what does not go together.
    pub(super) fn chosen(&self) -> Result<Option<Sampling>, Error> {
        let sampler = self.sampler.unwrap_or_default();
        let chosen = Sampling::chosen(sampler, self.sample, self.seed, self.ranges()?)?;
        match (chosen, self.sampler) {
            (None, Some(sampler)) => Err(Error::NoPercent(sampler.name())),
            (chosen, _) => Ok(chosen),
        }
    }

    fn ranges(&self) -> Result<Option<SimilarityRanges>, Error> {
        if (self.grid_px, self.cutoffs, self.percentages) == (None, None, None) {
            return Ok(None);
        }
        let ranges = SimilarityRanges::new(
            self.grid_px.unwrap_or(SimilarityRanges::GRID_PX),
            self.cutoffs.unwrap_or(SimilarityRanges::CUTOFFS),
            self.percentages.unwrap_or(SimilarityRanges::PERCENTAGES),
        )?;
        Ok(Some(ranges))
    }
}

fn percent(text: &str) -> Result<Percent, String> {
    Percent::new(number(text)?).map_err(|e| e.to_string())
}

/// Four numbers between commas.
fn four(text: &str) -> Result<[f64; 4], String> {
    let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    let count = numbers.len();
    numbers
        .try_into()
        .map_err(|_| format!("{count} numbers are given; give four, such as 10,25,50,75"))
}
