//! What a user chooses for one rendering.

use std::num::NonZeroUsize;
use std::str::FromStr;

use bonemesh_cloud::Sampling;
use bonemesh_dicom::SeriesChoice;
use bonemesh_segment::{
    CannySettings, HuThreshold, ThresholdChoice, ThresholdFinder, ThresholdPreset,
};
use bonemesh_surface::PoissonSettings;
use bonemesh_volume::CropBox;

use crate::AfterCare;

/// How the surface is made.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// The published method: Delaunay tetrahedra of the edge points, filtered by alpha.
    Alpha,
    /// The surface between voxels, at the true edges of the bone.
    #[default]
    Isosurface,
    /// Delaunay tetrahedra of points on the true edges, each bone or not by what lies in it.
    Labelled,
    /// For study: a ball rolls over the edge points.
    BallPivoting,
    /// For study: screened Poisson of the edge points and their normals.
    Poisson,
    /// For study: all Delaunay tetrahedra of the edge points, that is their convex hull.
    Tetrahedra,
    /// For study: plane Delaunay triangles of the edge points seen along z.
    Planar,
}

impl Method {
    /// Every method, in the order in which they are offered.
    pub const ALL: [Self; 7] = [
        Self::Alpha,
        Self::Isosurface,
        Self::Labelled,
        Self::BallPivoting,
        Self::Poisson,
        Self::Tetrahedra,
        Self::Planar,
    ];

    /// The method of someone who names none: the default, unless they choose what only edge points
    /// have, a sample of them or alpha.
    pub fn unless_named(chooses_points: bool) -> Self {
        if chooses_points {
            Self::Alpha
        } else {
            Self::default()
        }
    }

    /// Whether the surface is made of voxels; otherwise of the edge points.
    pub(crate) fn needs_voxels(self) -> bool {
        matches!(self, Self::Isosurface | Self::Labelled)
    }

    /// The name used on the command line, in Python and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Alpha => "alpha",
            Self::Isosurface => "isosurface",
            Self::Labelled => "labelled",
            Self::BallPivoting => "ball-pivoting",
            Self::Poisson => "poisson",
            Self::Tetrahedra => "tetrahedra",
            Self::Planar => "planar",
        }
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|m| m.name() == name)
            .ok_or_else(|| {
                let names = Self::ALL.map(Self::name).join(", ");
                format!("there is no method `{name}`; choose one of: {names}")
            })
    }
}

/// How alpha is chosen where none is given.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum AlphaRule {
    /// The mean distance to 100 neighbours, as published.
    #[default]
    MeanDistance,
    /// The alpha with which the tetrahedra have the volume of the bone's voxels.
    BoneVolume,
}

/// Everything a user can choose for one rendering.
#[derive(Clone, Debug, PartialEq)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a choice of its own, named as the command line names it"
)]
pub struct Settings {
    /// Bone is strictly above this.
    pub threshold: HuThreshold,
    /// The published threshold that `threshold` is, where it was chosen by its name.
    pub preset: Option<ThresholdPreset>,
    /// How the threshold is found in the volume ([`choose_threshold`](crate::choose_threshold));
    /// `None` takes `threshold`.
    pub find_threshold: Option<ThresholdFinder>,
    /// Lets the threshold follow the mean around each voxel by up to so many HU
    /// ([`LocalThreshold`](bonemesh_segment::LocalThreshold)); `None` holds it everywhere.
    pub local_leeway_hu: Option<f64>,
    /// Canny's sigma and thresholds.
    pub canny: CannySettings,
    /// How the surface is made.
    pub method: Method,
    /// Largest circumradius kept, in mm; `None` has it chosen by `alpha_rule`.
    pub alpha_mm: Option<f64>,
    /// How alpha is chosen where `alpha_mm` is `None`.
    pub alpha_rule: AlphaRule,
    /// Radii of the balls of ball pivoting, in mm; `None` takes three and six times the mean
    /// distance to the nearest neighbour.
    pub radii_mm: Option<Vec<f64>>,
    /// Poisson's cube has 2 to the power of this many cells a side.
    pub depth: u32,
    /// Poisson's cube is so many times as large as the points.
    pub scale: f64,
    /// Places an isosurface or labelled tetrahedra at the true edges of the bone; otherwise where
    /// the grey equals the threshold.
    pub true_edges: bool,
    /// Leaves the scanner's table and headrest out of an isosurface or labelled tetrahedra, where
    /// they touch no bone.
    pub leave_out_table: bool,
    /// Damps the streaks of metal before anything else is done.
    pub damp_metal: bool,
    /// Part of the volume to use; `None` uses all of it.
    pub crop: Option<CropBox>,
    /// Which series of the folder; `None` takes the only plausible one.
    pub series: Option<SeriesChoice>,
    /// Takes all slices that fit together for one series, whatever UIDs they name.
    pub one_series: bool,
    /// Part of the points to use; `None` uses all.
    pub sampling: Option<Sampling>,
    /// What is done to the finished mesh.
    pub after_care: AfterCare,
    /// Worker threads; `None` is one per core. The result does not depend on it.
    pub threads: Option<NonZeroUsize>,
}

impl Settings {
    /// These settings with a threshold as it was chosen.
    #[must_use]
    pub fn with_threshold(self, choice: ThresholdChoice) -> Self {
        match choice {
            ThresholdChoice::Given(threshold) => Self {
                threshold,
                preset: None,
                find_threshold: None,
                ..self
            },
            ThresholdChoice::Preset(preset) => Self {
                threshold: preset.threshold(),
                preset: Some(preset),
                find_threshold: None,
                ..self
            },
            ThresholdChoice::Found(finder) => Self {
                find_threshold: Some(finder),
                ..self
            },
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            threshold: ThresholdPreset::Skull.threshold(),
            preset: None,
            find_threshold: None,
            local_leeway_hu: None,
            canny: CannySettings::default(),
            method: Method::default(),
            alpha_mm: None,
            alpha_rule: AlphaRule::default(),
            radii_mm: None,
            depth: PoissonSettings::default().depth,
            scale: PoissonSettings::default().scale,
            true_edges: true,
            leave_out_table: true,
            damp_metal: false,
            crop: None,
            series: None,
            one_series: false,
            sampling: None,
            after_care: AfterCare::default(),
            threads: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_is_found_by_its_name() {
        for method in Method::ALL {
            assert_eq!(method.name().parse::<Method>(), Ok(method));
        }
        assert!("magic".parse::<Method>().unwrap_err().contains("alpha"));
    }
}
