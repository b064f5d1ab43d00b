//! `histogram`: its arguments, its work, its words.

use std::fmt::Write;
use std::num::{NonZeroU16, NonZeroUsize};
use std::path::PathBuf;

use bonemesh_dicom::SeriesChoice;
use bonemesh_segment::ThresholdFinder;
use bonemesh_task::Task;
use bonemesh_volume::CropBox;
use clap::Args;

use super::arguments::count;
use super::output::Answer;
use crate::Error;
use crate::picture::{check_picture_target, write_histogram};
use crate::thresholds::{HistogramReport, HistogramRequest, histogram};

/// Cubic millimetres in a cubic centimetre.
const MM3_PER_CM3: f64 = 1000.0;

#[derive(Debug, Args)]
pub(super) struct HistogramArguments {
    /// Folder of CT files (sub-folders are searched too), or one NIfTI, NRRD or multi-frame file.
    directory: PathBuf,
    /// Picture to draw (.png).
    #[arg(short, long, value_name = "PNG")]
    output: Option<PathBuf>,
    /// Width of the bins in HU.
    #[arg(long, value_name = "HU", default_value = "10", allow_negative_numbers = true, value_parser = width_hu)]
    bin: NonZeroU16,
    /// Which series: its UID or its number in `bonemesh info`.
    #[arg(long)]
    series: Option<SeriesChoice>,
    /// Take all slices that fit together for one series, whatever UIDs they name.
    #[arg(long)]
    one_series: bool,
    /// Part of the volume to use: columns, rows, slices, each first:end (end not included).
    #[arg(long, value_name = "I0:I1,J0:J1,K0:K1")]
    crop: Option<CropBox>,
    /// Worker threads; the result does not depend on it.
    #[arg(long, allow_negative_numbers = true, value_parser = count)]
    threads: Option<NonZeroUsize>,
}

fn width_hu(text: &str) -> Result<NonZeroU16, String> {
    let refused = |_| format!("`{text}` is no width; use a whole number of HU from 1, such as 10");
    text.parse().map_err(refused)
}

/// Runs `histogram`.
pub(super) fn run(arguments: &HistogramArguments, task: &Task) -> Result<Answer, Error> {
    if let Some(picture) = &arguments.output {
        check_picture_target(picture)?;
    }
    let request = HistogramRequest {
        bin_hu: arguments.bin,
        crop: arguments.crop.clone(),
        series: arguments.series.clone(),
        one_series: arguments.one_series,
        threads: arguments.threads,
    };
    let report = histogram(&arguments.directory, &request, task)?;
    let answer = Answer::new(&report, in_words(&report));
    let Some(picture) = &arguments.output else {
        return Ok(answer);
    };
    write_histogram(picture, &report)?;
    Ok(answer.with("output", picture.to_string_lossy()))
}

fn in_words(report: &HistogramReport) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let mut line = |l: String| {
        let _ = writeln!(text, "{l}");
    };
    let range = match report.edges_hu[..] {
        [first, .., last] => format!(" above {first} and up to {last} HU"),
        _ => String::new(),
    };
    line(format!("{} voxels{range}", report.voxels));
    for (voxels, what) in [
        (report.padding, "of padding below -1024 HU"),
        (report.beyond, "beyond 32767 HU"),
        (report.not_numbers, "that are no numbers"),
    ] {
        if voxels > 0 {
            line(format!("{voxels} more {what}, left out"));
        }
    }
    line("bone above        volume   name".to_owned());
    for s in &report.suggestions {
        let cm3 = s.voxels_above as f64 * report.voxel_mm3 / MM3_PER_CM3;
        let (name, what) = if s.recommended {
            ("auto", s.name)
        } else {
            (s.name, "")
        };
        let colon = if what.is_empty() { "" } else { ": " };
        line(format!(
            "{:>7} HU {cm3:>10.1} cm3   {name:12}{what}{colon}{}",
            s.threshold_hu, s.reason
        ));
        line(format!("{:40}{}", "", s.source));
    }
    let listed = report.suggestions.iter().map(|s| s.name);
    let auto = report.suggestions.iter().any(|s| s.recommended);
    let auto = auto.then_some(ThresholdFinder::Auto.name());
    let names: Vec<&str> = auto.into_iter().chain(listed).collect();
    let names = names.join(", ");
    line(format!("use one with --hu: {names}, or any number"));
    for warning in &report.warnings {
        line(format!("note: {warning}"));
    }
    text
}
