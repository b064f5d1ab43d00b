//! What can be written after `bonemesh`, turned into values that cannot be wrong.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::str::FromStr;

use bonemesh_cloud::{CloudFormat, Frame, Percent, Sampler};
use bonemesh_dicom::SeriesChoice;
use bonemesh_mesh::{MeshFormat, TriangleMesh};
use bonemesh_phantom::{ORIENTATIONS, Orientation, Phantom, PhantomError, ScanSettings};
use bonemesh_roi::{Method as RoiMethod, ThicknessMm};
use bonemesh_segment::CannySettings;
use bonemesh_volume::CropBox;
use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};

use super::after_care::{AfterCareArguments, Repair};
use super::histogram::{HistogramArguments, HuChoice};
use super::surface::{AlphaChoice, StudyArguments};
use crate::settings::{AlphaRule, Method, Sampling, Settings};

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
    /// Check whether a mesh can be printed: closed, manifold, no self-intersections, thinnest wall.
    Check {
        /// Mesh file (.stl, .ply, .obj, .3mf).
        mesh: PathBuf,
    },
    /// Care for a mesh: fill holes, take islands away, fill cavities, smooth, take triangles away.
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
    /// Bone is strictly above this Hounsfield value; or `auto`, or a name that `bonemesh histogram`
    /// lists, such as skull or cortical.
    #[arg(long, default_value = "350", allow_negative_numbers = true)]
    hu: HuChoice,
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
    #[arg(long)]
    threads: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
struct SamplingArguments {
    /// Keep this percentage of the points (above 0, at most 100).
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true, value_parser = percent)]
    sample: Option<Percent>,
    /// How the kept points are chosen: uniform, random or thesis-uniform.
    #[arg(long, default_value = "uniform", requires = "sample")]
    sampler: Sampler,
    /// Seed of the random sampler.
    #[arg(long, default_value_t = 0, requires = "sample")]
    seed: u64,
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
    /// Puts an isosurface or a labelled one where the grey equals the threshold, not at the true
    /// edges of the bone.
    #[arg(long)]
    at_threshold: bool,
    /// Keeps the scanner's table and headrest in an isosurface or a labelled one.
    #[arg(long)]
    keep_table: bool,
    #[command(flatten)]
    after_care: AfterCareArguments,
}

#[derive(Debug, Args)]
pub(super) struct Render {
    /// Folder of CT files (sub-folders are searched too), or one NIfTI, NRRD or multi-frame file.
    pub(super) directory: PathBuf,
    /// Mesh file to write (.stl, .ply, .obj, .3mf).
    #[arg(short, long, value_parser = mesh_file())]
    pub(super) output: PathBuf,
    /// Damps the streaks of metal (fillings, implants, screws) before anything else is done.
    #[arg(long)]
    pub(super) damp_metal: bool,
    #[command(flatten)]
    pub(super) edges: EdgeArguments,
    #[command(flatten)]
    pub(super) surface: SurfaceArguments,
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
    pub(super) surface: SurfaceArguments,
    /// Worker threads; the result does not depend on it.
    #[arg(long)]
    pub(super) threads: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
pub(super) struct Roi {
    /// Mesh file (.stl, .ply, .obj, .3mf).
    pub(super) mesh: PathBuf,
    #[command(flatten)]
    pub(super) selection: Selection,
    /// How deep the region reaches below the selection, in mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = thickness)]
    pub(super) thickness: ThicknessMm,
    /// Mesh file to write (.stl, .ply, .obj, .3mf).
    #[arg(short, long, value_parser = mesh_file())]
    pub(super) output: PathBuf,
    /// How the region is found.
    #[arg(long, default_value = "thesis")]
    pub(super) method: RoiMethod,
    /// Worker threads; the result does not depend on it.
    #[arg(long)]
    pub(super) threads: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub(super) struct Selection {
    /// Text file with one vertex index a line, of the mesh as read and vertex-merged in file order.
    #[arg(long = "selection", value_name = "FILE")]
    pub(super) file: Option<PathBuf>,
    /// Select every vertex within RADIUS mm of the point X,Y,Z instead.
    #[arg(long, value_name = "X,Y,Z,RADIUS", allow_negative_numbers = true)]
    pub(super) within: Option<Ball>,
}

/// A ball in the mesh's frame, in mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    centre_mm: [f64; 3],
    radius_mm: f64,
}

impl Ball {
    /// The vertices of `mesh` inside the ball.
    pub(super) fn vertices(&self, mesh: &TriangleMesh) -> Vec<u32> {
        let squared = self.radius_mm * self.radius_mm;
        let inside = |v: &[f64; 3]| {
            (0..3)
                .map(|i| (v[i] - self.centre_mm[i]).powi(2))
                .sum::<f64>()
                <= squared
        };
        (0_u32..)
            .zip(mesh.vertices_mm())
            .filter_map(|(i, v)| inside(v).then_some(i))
            .collect()
    }
}

impl FromStr for Ball {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f64>, String> = text.split(',').map(|n| number(n.trim())).collect();
        match numbers?[..] {
            [x, y, z, radius_mm]
                if radius_mm > 0.0 && [x, y, z, radius_mm].iter().all(|v| v.is_finite()) =>
            {
                Ok(Self {
                    centre_mm: [x, y, z],
                    radius_mm,
                })
            }
            _ => Err(format!(
                "`{text}` is no ball; write x,y,z,radius in mm with a radius above 0, for example 0,-90,40,20"
            )),
        }
    }
}

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

impl EdgeArguments {
    /// The settings for rendering with `surface`.
    pub(super) fn settings(&self, surface: Option<&SurfaceArguments>) -> Settings {
        let sampling = self.sampling.settings();
        let of_surface = |s: &SurfaceArguments| s.settings(sampling.is_some());
        let made = surface.map(of_surface).unwrap_or_default();
        let (threshold, auto_threshold) = match self.hu {
            HuChoice::Auto => (made.threshold, true),
            HuChoice::Given(threshold) => (threshold, false),
        };
        Settings {
            threshold,
            auto_threshold,
            canny: self.sigma,
            crop: self.crop.clone(),
            series: self.series.clone(),
            one_series: self.one_series,
            sampling,
            threads: self.threads,
            ..made
        }
    }
}

impl SamplingArguments {
    fn settings(&self) -> Option<Sampling> {
        self.sample.map(|percent| Sampling {
            percent,
            sampler: self.sampler,
            seed: self.seed,
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
            true_edges: !self.at_threshold,
            leave_out_table: !self.keep_table,
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

fn percent(text: &str) -> Result<Percent, String> {
    Percent::new(number(text)?).map_err(|e| e.to_string())
}

fn thickness(text: &str) -> Result<ThicknessMm, String> {
    ThicknessMm::new(number(text)?).map_err(|e| e.to_string())
}

pub(super) fn length_mm(text: &str) -> Result<f64, String> {
    let mm = number(text)?;
    if mm > 0.0 && mm.is_finite() {
        Ok(mm)
    } else {
        Err(format!("`{text}` is no size; use a number above 0"))
    }
}

fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("`{text}` is no number"))
}
