//! The histogram of a volume with suggested thresholds, and the threshold of a rendering.

use std::num::{NonZeroU16, NonZeroUsize};
use std::path::Path;

use bonemesh_dicom::SeriesChoice;
use bonemesh_segment::{
    HuThreshold, LocalThreshold, Suggestion, ThresholdFinder, level_to_threshold,
    suggest_thresholds,
};
use bonemesh_task::{Task, pool};
use bonemesh_volume::{CropBox, Histogram, Volume};
use serde::Serialize;

use crate::source::{Reading, Source};
use crate::{Error, Settings, VERSION};

/// What a user chooses for one histogram.
#[derive(Clone, Debug, PartialEq)]
pub struct HistogramRequest {
    /// Width of the bins that are reported, in HU.
    pub bin_hu: NonZeroU16,
    /// Part of the volume to use; `None` uses all of it.
    pub crop: Option<CropBox>,
    /// Which series of the folder; `None` takes the only plausible one.
    pub series: Option<SeriesChoice>,
    /// Takes all slices that fit together for one series, whatever UIDs they name.
    pub one_series: bool,
    /// Worker threads; `None` is one per core. The result does not depend on it.
    pub threads: Option<NonZeroUsize>,
}

/// Usual width of the bins, in HU.
const BIN_HU: u16 = 10;

impl Default for HistogramRequest {
    fn default() -> Self {
        Self {
            bin_hu: NonZeroU16::new(BIN_HU).expect("10 is not 0: anything else is a bug"),
            crop: None,
            series: None,
            one_series: false,
            threads: None,
        }
    }
}

/// How often each Hounsfield value occurs, and the thresholds that this suggests.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HistogramReport {
    /// Version of this program.
    pub version: &'static str,
    /// `SeriesInstanceUID`, where the volume came from files.
    pub series_uid: Option<String>,
    /// Voxels in all bins.
    pub voxels: u64,
    /// Volume of one voxel.
    pub voxel_mm3: f64,
    /// Voxels below -1024 HU, which no tissue has; in no bin.
    pub padding: u64,
    /// Voxels beyond 32767 HU; in no bin.
    pub beyond: u64,
    /// Voxels that are no number; in no bin.
    pub not_numbers: u64,
    /// Width of the bins.
    pub bin_hu: u16,
    /// Edges of the bins, one more than there are bins; a bin ends with its upper edge.
    pub edges_hu: Vec<f64>,
    /// Voxels in each bin.
    pub counts: Vec<u64>,
    /// Thresholds found in the volume, then those of the literature.
    pub suggestions: Vec<SuggestionReport>,
    /// What the reader had to say of the series.
    pub warnings: Vec<String>,
}

/// A suggested threshold.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SuggestionReport {
    /// `edges`, `multi-otsu`, `otsu`, or the name of a preset.
    pub name: &'static str,
    /// Bone is strictly above this.
    pub threshold_hu: f64,
    /// Whether `auto` takes it.
    pub recommended: bool,
    /// Voxels above it.
    pub voxels_above: u64,
    /// What it separates, and on what grounds.
    pub reason: String,
    /// The publication it is taken from.
    pub source: &'static str,
}

/// Reads the series in the folder or file `path` and counts its values.
///
/// # Errors
/// Those of reading, [`Error::Volume`] for a crop box that does not fit.
pub fn histogram(
    path: &Path,
    request: &HistogramRequest,
    task: &Task,
) -> Result<HistogramReport, Error> {
    pool(request.threads)?.install(|| {
        let source = Source::open(path, request.one_series, task)?;
        let Reading { volume, series } = source.read(request.series.as_ref(), task)?;
        let mut report = counted(&volume, request, task)?;
        report.series_uid = Some(series.uid);
        report.warnings = series.warnings;
        Ok(report)
    })
}

/// Counts the values of `volume`.
///
/// # Errors
/// [`Error::Volume`] for a crop box that does not fit, [`Error::Cancelled`] or its like.
pub fn histogram_of(
    volume: &Volume,
    request: &HistogramRequest,
    task: &Task,
) -> Result<HistogramReport, Error> {
    pool(request.threads)?.install(|| counted(volume, request, task))
}

fn counted(
    volume: &Volume,
    request: &HistogramRequest,
    task: &Task,
) -> Result<HistogramReport, Error> {
    let cropped = request.crop.as_ref().map(|crop| volume.cropped(crop));
    let cropped = cropped.transpose()?;
    let volume = cropped.as_ref().unwrap_or(volume);
    let single = Histogram::of(volume, NonZeroU16::MIN, task)?;
    let suggestions = suggested(volume, &single, task)?;
    let binned = Histogram::of(volume, request.bin_hu, task)?;
    let voxel = volume.geometry().patient_from_voxel().determinant().abs();
    Ok(HistogramReport {
        version: VERSION,
        series_uid: None,
        voxels: binned.voxels(),
        voxel_mm3: voxel,
        padding: binned.padding(),
        beyond: binned.beyond(),
        not_numbers: binned.not_numbers(),
        bin_hu: binned.width_hu().get(),
        edges_hu: binned.edges_hu(),
        counts: binned.counts().to_vec(),
        suggestions,
        warnings: Vec::new(),
    })
}

fn suggested(
    volume: &Volume,
    histogram: &Histogram,
    task: &Task,
) -> Result<Vec<SuggestionReport>, Error> {
    // Edges are looked for slice by slice: how the voxels were stored must not show.
    let volume = volume.in_patient_order(task)?;
    let suggestions = suggest_thresholds(&volume, histogram, task)?;
    let recommended = suggestions.recommended().ok().map(|s| s.name);
    let report = |suggestion: Suggestion| SuggestionReport {
        name: suggestion.name,
        threshold_hu: suggestion.threshold.hu(),
        recommended: Some(suggestion.name) == recommended,
        voxels_above: above(histogram, suggestion.threshold),
        reason: suggestion.reason,
        source: suggestion.source,
    };
    Ok(suggestions.all.into_iter().map(report).collect())
}

/// Voxels above a threshold that is an edge of a histogram in bins of 1 HU.
fn above(histogram: &Histogram, threshold: HuThreshold) -> u64 {
    let counts = histogram.counts();
    let first = (threshold.hu() - histogram.edge_hu(0)).max(0.0) as usize;
    counts.iter().skip(first).sum()
}

/// The `volume` moved so that the global threshold of `settings` does what the local one would, if they
/// ask for it.
pub(crate) fn leveled(
    volume: &Volume,
    settings: &Settings,
    task: &Task,
) -> Result<Option<Volume>, Error> {
    let Some(leeway_hu) = settings.local_leeway_hu else {
        return Ok(None);
    };
    let local = LocalThreshold::around(settings.threshold).with_leeway_hu(leeway_hu)?;
    Ok(Some(level_to_threshold(volume, local, task)?))
}

/// The threshold that a rendering of a volume takes, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenThreshold {
    /// Bone is strictly above this.
    pub threshold: HuThreshold,
    /// How it was found, or which preset it is; `None` for any other number.
    pub reason: Option<String>,
}

impl ChosenThreshold {
    /// The `settings` with this threshold in place of their own.
    pub fn of(&self, settings: &Settings) -> Settings {
        Settings {
            threshold: self.threshold,
            find_threshold: None,
            ..settings.clone()
        }
    }
}

/// The threshold for `volume` by these `settings`: the one given, or found in the part of the
/// volume that is used.
///
/// # Errors
/// [`Error::Segment`] when none can be found, [`Error::Volume`] for a crop box that does not fit.
pub fn choose_threshold(
    volume: &Volume,
    settings: &Settings,
    task: &Task,
) -> Result<ChosenThreshold, Error> {
    pool(settings.threads)?.install(|| chosen(volume, settings, task))
}

/// The same in the current pool.
pub(crate) fn chosen(
    volume: &Volume,
    settings: &Settings,
    task: &Task,
) -> Result<ChosenThreshold, Error> {
    let Some(finder) = settings.find_threshold else {
        return Ok(ChosenThreshold {
            threshold: settings.threshold,
            reason: settings
                .preset
                .map(|p| format!("{p}: {} ({})", p.description(), p.source())),
        });
    };
    let cropped = settings.crop.as_ref().map(|crop| volume.cropped(crop));
    let cropped = cropped.transpose()?;
    let volume = cropped.as_ref().unwrap_or(volume);
    let histogram = Histogram::of(volume, NonZeroU16::MIN, task)?;
    let volume = volume.in_patient_order(task)?;
    let suggestions = suggest_thresholds(&volume, &histogram, task)?;
    let Suggestion {
        name,
        threshold,
        reason,
        source,
    } = suggestions.by(finder)?;
    Ok(ChosenThreshold {
        threshold: *threshold,
        reason: Some(match finder {
            ThresholdFinder::Auto => format!("{finder}, {name}: {reason} ({source})"),
            _ => format!("{name}: {reason} ({source})"),
        }),
    })
}
