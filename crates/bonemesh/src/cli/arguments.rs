//! What can be written after `bonemesh`, turned into values that cannot be wrong.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use bonemesh_cloud::{CloudFormat, Frame};
use bonemesh_dicom::SeriesChoice;
use bonemesh_mesh::MeshFormat;
use bonemesh_segment::{CannySettings, LocalThreshold, ThresholdChoice, ThresholdPreset};
use bonemesh_volume::CropBox;
use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};

use super::after_care::{AfterCareArguments, Repair};
use super::compare::CompareArguments;
use super::histogram::HistogramArguments;
use super::mesh_file::FileArguments;
use super::phantom::PhantomArguments;
use super::roi::{Mirror, Roi};
use super::sampling::SamplingArguments;
use super::surface::{AlphaChoice, StudyArguments};
use crate::Error;
use crate::settings::{AlphaRule, Method, Settings};

/// Turns a folder of CT images into a mesh of the bone, and a selection on it into a region.
#[derive(Debug, Parser)]
#[command(name = "bonemesh", version, max_term_width = 100)]
pub(super) struct Arguments {
    /// Print one JSON object on stdout and nothing else there.
    #[arg(long, global = true)]
    pub(super) json: bool,
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// List the series in a folder, what was left out, geometry and warnings.
    Info(Info),
    /// Count how often each Hounsfield value occurs, and suggest thresholds.
    Histogram(HistogramArguments),
    /// Make the bone's mesh from a folder of CT files.
    Render(Render),
    /// Make the point cloud of the bone's edges from a folder of CT files.
    Cloud(CloudArguments),
    /// Make a mesh from a point cloud.
    Mesh(MeshArguments),
    /// Take the region under selected vertices out of a mesh.
    Roi(Roi),
    /// Mirror a mesh in a plane, or in its own plane of symmetry.
    Mirror(Mirror),
    /// Check whether a mesh can be printed: closed, manifold, no self-intersections, thinnest wall.
    Check(Check),
    /// Compare a mesh with a reference: distances, edge midpoints, residual volume.
    Compare(CompareArguments),
    /// Care for a mesh: take out triangles without area or given twice, turn over those that face the wrong way;
    /// as asked, fill holes, take islands away, fill cavities, smooth, take triangles away.
    Repair(Repair),
    /// Write a phantom as a DICOM CT series, with its truth beside it.
    Phantom(PhantomArguments),
}

#[derive(Debug, Args)]
pub(super) struct Info {
    /// Folder of CT files (sub-folders are searched too), or one NIfTI, NRRD or multi-frame file.
    pub(super) directory: PathBuf,
    /// Take all slices that fit together for one series, whatever UIDs they name.
    #[arg(long)]
    pub(super) one_series: bool,
    /// Decode the pixels too, to say the range of the values.
    #[arg(long)]
    pub(super) pixels: bool,
}

#[derive(Debug, Args)]
pub(super) struct EdgeArguments {
    /// Bone is strictly above this Hounsfield value; or a name that `bonemesh histogram` lists: a way
    /// to find it, such as auto or multi-otsu, or a published value, such as skull or cortical.
    #[arg(
        short = 't',
        long,
        visible_alias = "threshold",
        value_name = "HU",
        default_value = "350",
        allow_negative_numbers = true
    )]
    hu: ThresholdChoice,
    /// Let the threshold follow the mean around each voxel by up to so many HU, such as 150: keeps
    /// thin bone and narrow gaps, and lets in more noise.
    #[arg(long, value_name = "HU", allow_negative_numbers = true, value_parser = leeway_hu)]
    local: Option<f64>,
    /// Canny's smoothing in pixels.
    #[arg(long, default_value = "1.0", allow_negative_numbers = true, value_parser = canny)]
    sigma: CannySettings,
    /// Which series: its UID or its number in `bonemesh info`.
    #[arg(long)]
    series: Option<SeriesChoice>,
    /// Take all slices that fit together for one series, whatever UIDs they name.
    #[arg(long)]
    one_series: bool,
    /// Part of the volume to use: columns, rows, slices, each first:end (end not included).
    #[arg(long, value_name = "I0:I1,J0:J1,K0:K1")]
    crop: Option<CropBox>,
    #[command(flatten)]
    sampling: SamplingArguments,
    /// Worker threads; the result does not depend on it.
    #[arg(long, allow_negative_numbers = true, value_parser = count)]
    threads: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
pub(super) struct SurfaceArguments {
    /// How the surface is made: isosurface, labelled, or alpha, the published method; for study:
    /// ball-pivoting, poisson, tetrahedra, planar [default: isosurface; alpha of a cloud, or with
    /// --alpha or --sample].
    #[arg(long)]
    method: Option<Method>,
    /// Largest circumradius kept in mm; or `auto`, with which the mesh has the volume of the bone's
    /// voxels [default: mean distance to 100 neighbours].
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    alpha: Option<AlphaChoice>,
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    after_care: AfterCareArguments,
}

/// What can only be done with voxels.
#[derive(Debug, Args)]
pub(super) struct VoxelArguments {
    /// Puts an isosurface or a labelled one where the grey equals the threshold, not at the true
    /// edges of the bone.
    #[arg(long)]
    at_threshold: bool,
    /// Keeps the scanner's table and headrest in an isosurface or a labelled one.
    #[arg(long)]
    keep_table: bool,
    /// Damps the streaks of metal (fillings, implants, screws) before anything else is done.
    #[arg(long)]
    damp_metal: bool,
}

#[derive(Debug, Args)]
pub(super) struct Render {
    /// Folder of CT files (sub-folders are searched too), or one NIfTI, NRRD or multi-frame file.
    pub(super) directory: PathBuf,
    /// Mesh file to write (.stl, .ply, .obj, .3mf).
    #[arg(short, long, value_parser = mesh_file())]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) file: FileArguments,
    #[command(flatten)]
    pub(super) edges: EdgeArguments,
    #[command(flatten)]
    pub(super) surface: SurfaceArguments,
    #[command(flatten)]
    pub(super) voxels: VoxelArguments,
}

#[derive(Debug, Args)]
pub(super) struct Check {
    /// Mesh file (.stl, .ply, .obj, .3mf).
    pub(super) mesh: PathBuf,
    /// File (.ply) for the mesh with the thickness of its wall (mm) at every vertex, as the property
    /// `wall_mm`.
    #[arg(long, value_name = "PLY")]
    pub(super) walls: Option<PathBuf>,
    /// Worker threads; the result does not depend on it.
    #[arg(long, allow_negative_numbers = true, value_parser = count)]
    pub(super) threads: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
pub(super) struct CloudArguments {
    /// Folder of CT files (sub-folders are searched too), or one NIfTI, NRRD or multi-frame file.
    pub(super) directory: PathBuf,
    /// Cloud file to write (.npy, .ply, .xyz).
    #[arg(short, long, value_parser = cloud_file())]
    pub(super) output: PathBuf,
    /// Frame of the coordinates.
    #[arg(long, value_enum, default_value = "patient")]
    pub(super) frame: FrameName,
    #[command(flatten)]
    pub(super) edges: EdgeArguments,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum FrameName {
    /// DICOM patient frame (LPS).
    Patient,
    /// x = column dx - dx/2, y = row dy - dy/2, z = slice location.
    Image,
}

impl From<FrameName> for Frame {
    fn from(name: FrameName) -> Self {
        match name {
            FrameName::Patient => Self::Patient,
            FrameName::Image => Self::Image,
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct MeshArguments {
    /// Cloud file (.npy, .ply, .xyz).
    pub(super) cloud: PathBuf,
    /// Mesh file to write (.stl, .ply, .obj, .3mf).
    #[arg(short, long, value_parser = mesh_file())]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) file: FileArguments,
    #[command(flatten)]
    pub(super) surface: SurfaceArguments,
    /// Worker threads; the result does not depend on it.
    #[arg(long, allow_negative_numbers = true, value_parser = count)]
    pub(super) threads: Option<NonZeroUsize>,
}

impl EdgeArguments {
    /// The settings for rendering with `surface`.
    ///
    /// # Errors
    /// Those of the sampling.
    pub(super) fn settings(&self, surface: Option<&SurfaceArguments>) -> Result<Settings, Error> {
        let sampling = self.sampling.chosen()?;
        let of_surface = |s: &SurfaceArguments| s.settings(sampling.is_some());
        let made = surface.map(of_surface).unwrap_or_default();
        let settings = Settings {
            local_leeway_hu: self.local,
            canny: self.sigma,
            crop: self.crop.clone(),
            series: self.series.clone(),
            one_series: self.one_series,
            sampling,
            threads: self.threads,
            ..made
        };
        Ok(settings.with_threshold(self.hu))
    }
}

impl Render {
    /// All settings of a rendering.
    ///
    /// # Errors
    /// Those of the sampling.
    pub(super) fn settings(&self) -> Result<Settings, Error> {
        Ok(Settings {
            true_edges: !self.voxels.at_threshold,
            leave_out_table: !self.voxels.keep_table,
            damp_metal: self.voxels.damp_metal,
            ..self.edges.settings(Some(&self.surface))?
        })
    }
}

impl SurfaceArguments {
    /// The settings of the surface step; `of_points` if it can only start from edge points.
    pub(super) fn settings(&self, of_points: bool) -> Settings {
        let (alpha_mm, alpha_rule) = match self.alpha {
            Some(AlphaChoice::Auto) => (None, AlphaRule::BoneVolume),
            Some(AlphaChoice::Given(alpha_mm)) => (Some(alpha_mm), AlphaRule::default()),
            None => (None, AlphaRule::default()),
        };
        self.study.of(Settings {
            method: self
                .method
                .unwrap_or_else(|| Method::unless_named(of_points || self.alpha.is_some())),
            alpha_mm,
            alpha_rule,
            after_care: self.after_care.settings(),
            ..Settings::default()
        })
    }
}

/// A path, Unicode or not, whose ending names a mesh format.
pub(super) fn mesh_file() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| MeshFormat::of(&path).map(|_| path))
}

/// A path, Unicode or not, whose ending names a cloud format.
fn cloud_file() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| CloudFormat::of(&path).map(|_| path))
}

fn canny(text: &str) -> Result<CannySettings, String> {
    let standard = CannySettings::default();
    CannySettings::new(number(text)?, standard.low(), standard.high()).map_err(|e| e.to_string())
}

fn leeway_hu(text: &str) -> Result<f64, String> {
    let leeway_hu = number(text)?;
    let local = LocalThreshold::around(ThresholdPreset::Skull.threshold());
    let checked = local.with_leeway_hu(leeway_hu);
    checked.map(|_| leeway_hu).map_err(|e| e.to_string())
}

/// How many of something, at least one.
pub(super) fn count(text: &str) -> Result<NonZeroUsize, String> {
    let refused = |_| format!("`{text}` is no number of them; use a whole number from 1");
    text.parse().map_err(refused)
}

pub(super) fn length_mm(text: &str) -> Result<f64, String> {
    let mm = number(text)?;
    if mm > 0.0 && mm.is_finite() {
        Ok(mm)
    } else {
        Err(format!("`{text}` is no size; use a number above 0"))
    }
}

pub(super) fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("`{text}` is no number"))
}
