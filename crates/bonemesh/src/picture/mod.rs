//! The histogram as a picture.
//!
//! Bars on a logarithmic scale, since air outnumbers bone a hundred to one; suggested thresholds
//! as lines with their names, the recommended one in red, those of the literature dashed.

mod canvas;
mod distances;

use std::io;
use std::path::Path;

use crate::Error;
use crate::thresholds::{HistogramReport, SuggestionReport};
use crate::whole_file::{probe, write_whole};
pub use distances::write_distances;

use canvas::{Canvas, Colour, TEXT_HEIGHT, text_width};

const WIDTH: usize = 1200;
const HEIGHT: usize = 720;
/// Columns and rows of the chart itself; labels are around it.
const CHART: ([usize; 2], [usize; 2]) = ([110, 1170], [220, 630]);

const PAPER: Colour = [255, 255, 255];
const INK: Colour = [40, 40, 40];
const FAINT: Colour = [225, 225, 225];
const BARS: Colour = [120, 150, 185];
const RECOMMENDED: Colour = [200, 20, 30];
const FOUND: Colour = [20, 110, 60];
const PRESET: Colour = [95, 85, 160];

/// Length of the dashes of lines from the literature, in pixels.
const DASH: usize = 6;
/// Rows of labels above the chart.
const LABEL_ROWS: usize = 7;
/// Distance of the rows of labels, and of a label from what is beside it.
const LABEL_STEP: usize = TEXT_HEIGHT + 3;
const GAP: usize = 8;

/// What is shown of the scale: tissue and enamel; metal has no room.
const SHOWN_HU: [f64; 2] = [-1034.0, 4095.0];

/// Draws `report` as a PNG file, which appears only when it is complete.
///
/// # Errors
/// [`Error::Picture`].
pub fn write_histogram(path: &Path, report: &HistogramReport) -> Result<(), Error> {
    save(path, &drawn(report)).map_err(|source| failed(path, source))
}

/// Tells now whether [`write_histogram`] could write `path`, so that long work is not lost at its
/// end.
///
/// # Errors
/// [`Error::Picture`].
pub fn check_picture_target(path: &Path) -> Result<(), Error> {
    if !path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("png"))
    {
        let reason = io::Error::new(
            io::ErrorKind::InvalidInput,
            "its name does not end with .png",
        );
        return Err(failed(path, reason));
    }
    probe(path).map_err(|source| failed(path, source))
}

fn failed(path: &Path, source: io::Error) -> Error {
    Error::Picture {
        path: path.to_owned(),
        source,
    }
}

fn save(path: &Path, canvas: &Canvas) -> io::Result<()> {
    write_whole(path, |file| {
        let mut encoder = png::Encoder::new(io::BufWriter::new(file), WIDTH as u32, HEIGHT as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(canvas.pixels())?;
        Ok(writer.finish()?)
    })
}

/// Where values and counts lie on the chart.
struct Scale {
    hu: [f64; 2],
    /// The count at the upper end, a power of ten.
    decades: u32,
}

impl Scale {
    fn of(report: &HistogramReport) -> Self {
        let [low, high] = match report.edges_hu[..] {
            [first, .., last] => [first.max(SHOWN_HU[0]), last.min(SHOWN_HU[1])],
            _ => SHOWN_HU,
        };
        let most = report.counts.iter().max().copied().unwrap_or(0).max(10);
        Self {
            hu: if low < high { [low, high] } else { SHOWN_HU },
            decades: (most - 1).ilog10() + 1,
        }
    }

    /// The column of a value; those outside are at the ends.
    fn column(&self, hu: f64) -> usize {
        let ([left, right], [low, high]) = (CHART.0, self.hu);
        let part = ((hu - low) / (high - low)).clamp(0.0, 1.0);
        left + (part * (right - left) as f64).round() as usize
    }

    /// The row of a count.
    fn row(&self, count: u64) -> usize {
        let [top, bottom] = CHART.1;
        let part = (count.max(1) as f64).log10() / f64::from(self.decades);
        // A bin of one voxel is to be seen too.
        let shown = (part * (bottom - top) as f64)
            .round()
            .max(f64::from(u8::from(count > 0)));
        bottom - (shown as usize).min(bottom - top)
    }
}

fn drawn(report: &HistogramReport) -> Canvas {
    let mut canvas = Canvas::new(WIDTH, HEIGHT, PAPER);
    let scale = Scale::of(report);
    axes(&mut canvas, &scale);
    for (bin, count) in report.counts.iter().enumerate() {
        let [left, right] = [bin, bin + 1].map(|e| scale.column(report.edges_hu[e]));
        if right > left {
            canvas.fill([left, right], [scale.row(*count), CHART.1[1]], BARS);
        }
    }
    let ([left, right], [_, bottom]) = CHART;
    canvas.fill([left, right], [bottom, bottom + 2], INK);
    suggestions(&mut canvas, &scale, &report.suggestions);
    canvas.write(&title(report), left, 10, INK);
    canvas
}

fn title(report: &HistogramReport) -> String {
    let padding = match report.padding {
        0 => String::new(),
        padding => format!("; {padding} of padding left out"),
    };
    format!(
        "{} voxels by Hounsfield value, bins of {} HU{padding}",
        report.voxels, report.bin_hu
    )
}

/// Tick marks with their values and faint lines across the chart.
fn axes(canvas: &mut Canvas, scale: &Scale) {
    let ([left, right], [top, bottom]) = CHART;
    for decade in 0..=scale.decades {
        let row = scale.row(10_u64.pow(decade)).min(bottom - 1);
        canvas.fill([left, right], [row, row + 1], FAINT);
        let label = counted(decade);
        let column = left.saturating_sub(text_width(&label) + GAP);
        canvas.write(&label, column, row - TEXT_HEIGHT / 2, INK);
    }
    canvas.write("voxels", GAP, top - TEXT_HEIGHT - GAP, INK);
    let step = tick_step((scale.hu[1] - scale.hu[0]).max(10.0));
    let mut tick = (scale.hu[0] / step).ceil() * step;
    while tick <= scale.hu[1] {
        let column = scale.column(tick);
        canvas.fill([column, column + 1], [top, bottom], FAINT);
        canvas.fill([column, column + 1], [bottom, bottom + GAP], INK);
        let label = format!("{tick:.0}");
        canvas.write(
            &label,
            column - text_width(&label) / 2,
            bottom + GAP + 4,
            INK,
        );
        tick += step;
    }
    let label = "HU";
    canvas.write(
        label,
        usize::midpoint(left, right) - text_width(label) / 2,
        HEIGHT - TEXT_HEIGHT - GAP,
        INK,
    );
}

/// Ten to the power of `decade` in a few letters.
fn counted(decade: u32) -> String {
    let unit = ["", "k", "M", "G", "T"][(decade / 3).min(4) as usize];
    format!("{}{unit}", 10_u64.pow(decade % 3))
}

/// A round distance of ticks, of which about ten fit.
fn tick_step(range: f64) -> f64 {
    let rough = range / 10.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|m| m * power)
        .into_iter()
        .find(|s| *s >= rough)
        .unwrap_or(rough)
}

/// Lines at the suggested thresholds, each up to its label.
///
/// From right to left, each label goes above the lines it would cross.
fn suggestions(canvas: &mut Canvas, scale: &Scale, suggestions: &[SuggestionReport]) {
    let mut falling: Vec<&SuggestionReport> = suggestions
        .iter()
        .filter(|s| (scale.hu[0]..=scale.hu[1]).contains(&s.threshold_hu))
        .collect();
    falling.sort_by(|a, b| b.threshold_hu.total_cmp(&a.threshold_hu));
    let mut placed: Vec<(usize, usize)> = Vec::new();
    for suggestion in falling {
        let (colour, dashes) = style(suggestion);
        let column = scale.column(suggestion.threshold_hu);
        let auto = if suggestion.recommended { "auto: " } else { "" };
        let label = format!("{auto}{} {:.0}", suggestion.name, suggestion.threshold_hu);
        let width = text_width(&label);
        let left = (column + GAP).min(WIDTH.saturating_sub(width + GAP));
        let crossed = placed.iter().filter(|(line, _)| *line < left + width + GAP);
        let row = crossed.map(|(_, row)| row + 1).max().unwrap_or(0);
        let row = row.min(LABEL_ROWS - 1);
        placed.push((column, row));
        let top = CHART.1[0] - LABEL_STEP * (row + 1);
        canvas.rule(column, [top, CHART.1[1]], colour, dashes);
        canvas.write(&label, left, top, colour);
    }
}

fn style(suggestion: &SuggestionReport) -> (Colour, Option<usize>) {
    let presets = bonemesh_segment::ThresholdPreset::ALL;
    let is_preset = presets.iter().any(|p| p.name() == suggestion.name);
    match (suggestion.recommended, is_preset) {
        (true, _) => (RECOMMENDED, None),
        (false, false) => (FOUND, None),
        (false, true) => (PRESET, Some(DASH)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(counts: &[u64], thresholds: &[(&'static str, f64)]) -> HistogramReport {
        let suggestion = |(name, hu): &(&'static str, f64)| SuggestionReport {
            name,
            threshold_hu: *hu,
            recommended: *name == "edges",
            voxels_above: 0,
            reason: String::new(),
            source: "",
        };
        HistogramReport {
            version: "",
            series_uid: None,
            voxels: counts.iter().sum(),
            voxel_mm3: 1.0,
            padding: 0,
            beyond: 0,
            not_numbers: 0,
            bin_hu: 10,
            edges_hu: (0..=counts.len()).map(|e| 10.0 * e as f64).collect(),
            counts: counts.to_vec(),
            suggestions: thresholds.iter().map(suggestion).collect(),
            warnings: Vec::new(),
        }
    }

    fn pixels(canvas: &Canvas, colour: Colour) -> usize {
        canvas.pixels().chunks(3).filter(|p| **p == colour).count()
    }

    #[test]
    fn bars_grow_with_the_counts() {
        let area = |counts: &[u64]| pixels(&drawn(&report(counts, &[])), BARS);
        assert!(area(&[1000, 10, 10]) < area(&[1000, 100, 10]));
        assert_eq!(area(&[]), 0);
    }

    #[test]
    fn every_suggestion_in_sight_is_marked() {
        let bars = [5; 100];
        let picture = drawn(&report(
            &bars,
            &[("edges", 640.0), ("skull", 350.0), ("otsu", 1400.0)],
        ));
        assert!(pixels(&picture, RECOMMENDED) > 800);
        assert!(pixels(&picture, PRESET) > 400);
        assert_eq!(pixels(&picture, FOUND), 0);
    }

    #[test]
    fn odd_histograms_are_drawn_too() {
        let crowd: Vec<(&str, f64)> = (0..20).map(|_| ("multi-otsu", 999.0)).collect();
        for counts in [&[][..], &[7], &[0, 0], &[u64::MAX / 4; 3], &vec![1; 5000]] {
            let _ = drawn(&report(counts, &crowd));
        }
    }

    #[test]
    fn the_file_is_a_png_of_that_size_or_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("h.png");
        check_picture_target(&file).unwrap();
        write_histogram(&file, &report(&[3, 2, 1], &[("edges", 15.0)])).unwrap();
        let decoder = png::Decoder::new(io::BufReader::new(std::fs::File::open(&file).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width as usize, info.height as usize), (WIDTH, HEIGHT));
        let missing = folder.path().join("no/h.png");
        assert!(check_picture_target(&missing).is_err());
        assert!(check_picture_target(&folder.path().join("h.jpg")).is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
