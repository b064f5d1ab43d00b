//! What `phantom` is told.

use std::path::PathBuf;

use bonemesh_phantom::{ORIENTATIONS, Orientation, Phantom, PhantomError, ScanSettings};
use clap::Args;

use super::arguments::length_mm;

#[derive(Debug, Args)]
pub(super) struct PhantomArguments {
    /// Name of the phantom.
    #[arg(value_parser = phantom, long_help = phantom_names())]
    pub(super) name: Phantom,
    /// Folder to make; the series goes to its sub-folder `dicom`, the truth to `truth.json`.
    pub(super) directory: PathBuf,
    /// Make pixels and slices this many times as large, over the same field of view.
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = length_mm)]
    coarser: f64,
    /// Length of a pixel instead, over the same field of view.
    #[arg(long, value_name = "MM", conflicts_with = "coarser", value_parser = length_mm)]
    pixel: Option<f64>,
    /// Length of a slice instead, over the same field of view.
    #[arg(long, value_name = "MM", conflicts_with = "coarser", value_parser = length_mm)]
    slice: Option<f64>,
    /// Standard deviation of the blur in the slice.
    #[arg(long, value_name = "PIXELS")]
    blur: Option<f64>,
    /// Standard deviation of the noise.
    #[arg(long, value_name = "HU")]
    noise: Option<f64>,
    /// How the patient lies and the slices run (--help lists the names).
    #[arg(long, default_value = "axial", long_help = orientation_names())]
    orientation: Orientation,
    /// Leave out blur and noise.
    #[arg(long, conflicts_with_all = ["blur", "noise"])]
    ideal: bool,
    /// Seed of the noise.
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

impl PhantomArguments {
    /// How the phantom is scanned.
    pub(super) fn settings(&self) -> ScanSettings {
        let usual = self.name.settings().coarser(self.coarser);
        let voxels = match (self.pixel, self.slice) {
            (None, None) => usual,
            (pixel, slice) => usual.with_voxels(
                pixel.unwrap_or(usual.pixel_mm[0]),
                slice.unwrap_or(usual.slice_mm),
            ),
        };
        let settings = ScanSettings {
            seed: self.seed,
            orientation: self.orientation,
            psf_px: self.blur.unwrap_or(voxels.psf_px),
            noise_hu: self.noise.unwrap_or(voxels.noise_hu),
            ..voxels
        };
        if self.ideal {
            settings.ideal()
        } else {
            settings
        }
    }
}

fn phantom(name: &str) -> Result<Phantom, String> {
    name.parse().map_err(|e: PhantomError| e.to_string())
}

fn phantom_names() -> String {
    let names = Phantom::ALL
        .into_iter()
        .map(|p| (p.name(), p.description()));
    listed("Name of the phantom:", names)
}

fn orientation_names() -> String {
    listed(
        "How the patient lies and the slices run:",
        ORIENTATIONS.into_iter(),
    )
}

/// A title and, below it, names with what they mean.
fn listed(title: &str, names: impl Iterator<Item = (&'static str, &'static str)>) -> String {
    let lines: Vec<String> = names.map(|(n, means)| format!("  {n:16}{means}")).collect();
    format!("{title}\n{}", lines.join("\n"))
}
