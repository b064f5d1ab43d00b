//! What a single method of meshing is told on the command line.

use std::str::FromStr;

use clap::Args;

use super::arguments::length_mm;
use crate::settings::Settings;

/// What is written after `--alpha`.
#[derive(Clone, Copy, Debug)]
pub(super) enum AlphaChoice {
    /// Matched to the volume of the bone's voxels.
    Auto,
    /// A length in mm.
    Given(f64),
}

impl FromStr for AlphaChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        let mm = length_mm(text).map_err(|e| format!("{e}, or auto"))?;
        Ok(Self::Given(mm))
    }
}

/// Settings of the methods that are there for study.
#[derive(Debug, Args)]
pub(super) struct StudyArguments {
    /// Radii of ball pivoting in mm [default: 3 and 6 times the mean distance to the nearest point].
    #[arg(long, value_name = "MM,MM", value_delimiter = ',', value_parser = length_mm)]
    radii: Option<Vec<f64>>,
    /// Poisson's cube has 2^DEPTH cells a side, 3 to 8.
    #[arg(long, default_value_t = Settings::default().depth, allow_negative_numbers = true, value_parser = depth)]
    depth: u32,
    /// Poisson's cube is so many times as large as the points, 1 to 10.
    #[arg(long, default_value_t = Settings::default().scale, value_parser = scale)]
    scale: f64,
}

impl StudyArguments {
    /// `settings` with these.
    pub(super) fn of(&self, settings: Settings) -> Settings {
        Settings {
            radii_mm: self.radii.clone(),
            depth: self.depth,
            scale: self.scale,
            ..settings
        }
    }
}

fn depth(text: &str) -> Result<u32, String> {
    let depth = text.parse().ok().filter(|depth| (3..=8).contains(depth));
    depth.ok_or_else(|| format!("`{text}` is no depth; use a whole number from 3 to 8"))
}

fn scale(text: &str) -> Result<f64, String> {
    let scale = length_mm(text)?;
    if (1.0..=10.0).contains(&scale) {
        Ok(scale)
    } else {
        Err(format!("`{text}` is no scale; use a number from 1 to 10"))
    }
}
