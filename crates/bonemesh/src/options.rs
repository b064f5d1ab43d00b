//! The options of a rendering as its report keeps them, so that it can be made again.

use bonemesh_cloud::{Percent, Sampler, Sampling};
use bonemesh_dicom::SeriesChoice;
use bonemesh_mesh::Islands;
use serde::Serialize;

use crate::after_care::{Cavities, Holes};
use crate::{AlphaRule, Settings};

/// Every option that was chosen or left as it is, by the names and with the values that the Python
/// function `render` takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is an option of its own, named as Python names it"
)]
pub struct OptionsReport {
    /// A number in HU, or the name of a way to find it or of a published one.
    pub threshold_hu: Chosen,
    /// How far the threshold may follow the mean around a voxel.
    pub local_leeway_hu: Option<f64>,
    /// Name of the surface method.
    pub method: &'static str,
    /// Canny's smoothing, pixels.
    pub sigma: f64,
    /// Number or UID, where a series was chosen.
    pub series: Option<Chosen>,
    /// All slices that fit together were taken for one series.
    pub one_series: bool,
    /// Columns, rows, slices.
    pub crop: Option<String>,
    /// Part of the points used.
    pub sample_percent: Option<f64>,
    /// How they were chosen.
    pub sampler: &'static str,
    /// Seed of the random sampler.
    pub seed: u64,
    /// Largest circumradius, or "auto".
    pub alpha_mm: Option<Chosen>,
    /// Radii of ball pivoting.
    pub radii_mm: Option<Vec<f64>>,
    /// Depth of Poisson's cube.
    pub depth: u32,
    /// Size of Poisson's cube.
    pub scale: f64,
    /// At the true edges of the bone, not where the grey equals the threshold.
    pub true_edges: bool,
    /// The scanner's table was kept.
    pub keep_table: bool,
    /// Streaks of metal were damped.
    pub damp_metal: bool,
    /// "all", or the longest extent (mm) of holes filled.
    pub holes: Option<Chosen>,
    /// "largest", the least volume (mm3) kept, or places (mm) whose bones were kept.
    pub islands: Option<Chosen>,
    /// "all", or the largest volume (mm3) of cavities filled.
    pub cavities: Option<Chosen>,
    /// The most that smoothing may move a vertex.
    pub smooth_mm: Option<f64>,
    /// How many triangles were to be left.
    pub triangles: Option<usize>,
    /// How far the surface may move for fewer triangles.
    pub decimate_mm: Option<f64>,
}

/// A value that is a number, a word or places.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Chosen {
    /// A number with a fraction.
    Number(f64),
    /// A whole number.
    Whole(usize),
    /// A name.
    Word(String),
    /// Places in mm.
    Places(Vec<[f64; 3]>),
}

impl Chosen {
    fn word(word: &str) -> Self {
        Self::Word(word.to_owned())
    }
}

impl OptionsReport {
    /// What `settings` choose.
    pub fn of(settings: &Settings) -> Self {
        let (sampling, care) = (settings.sampling.as_ref(), &settings.after_care);
        Self {
            threshold_hu: threshold(settings),
            local_leeway_hu: settings.local_leeway_hu,
            method: settings.method.name(),
            sigma: settings.canny.sigma(),
            series: settings.series.as_ref().map(|series| match series {
                SeriesChoice::Number(number) => Chosen::Whole(*number),
                SeriesChoice::Uid(uid) => Chosen::word(uid),
            }),
            one_series: settings.one_series,
            crop: settings.crop.as_ref().map(ToString::to_string),
            sample_percent: sampling.and_then(Sampling::percent).map(Percent::get),
            sampler: sampling.map_or(Sampler::Uniform, Sampling::sampler).name(),
            seed: sampling.map_or(0, Sampling::seed),
            alpha_mm: match settings.alpha_rule {
                AlphaRule::BoneVolume if settings.alpha_mm.is_none() => Some(Chosen::word("auto")),
                _ => settings.alpha_mm.map(Chosen::Number),
            },
            radii_mm: settings.radii_mm.clone(),
            depth: settings.depth,
            scale: settings.scale,
            true_edges: settings.true_edges,
            keep_table: !settings.leave_out_table,
            damp_metal: settings.damp_metal,
            holes: care.holes.map(|holes| match holes {
                Holes::All => Chosen::word("all"),
                Holes::AtMostMm(mm) => Chosen::Number(mm),
            }),
            islands: care.islands.as_ref().map(|islands| match islands {
                Islands::Largest => Chosen::word("largest"),
                Islands::AtLeastMm3(mm3) => Chosen::Number(*mm3),
                Islands::At(places_mm) => Chosen::Places(places_mm.clone()),
            }),
            cavities: care.cavities.map(|cavities| match cavities {
                Cavities::All => Chosen::word("all"),
                Cavities::AtMostMm3(mm3) => Chosen::Number(mm3),
            }),
            smooth_mm: care.smooth_mm,
            triangles: care.decimation.triangles,
            decimate_mm: care.decimation.error_mm,
        }
    }
}

/// The threshold as it was chosen, not as it was found.
fn threshold(settings: &Settings) -> Chosen {
    let name = settings
        .find_threshold
        .map(bonemesh_segment::ThresholdFinder::name)
        .or_else(|| settings.preset.map(bonemesh_segment::ThresholdPreset::name));
    name.map_or_else(|| Chosen::Number(settings.threshold.hu()), Chosen::word)
}
