//! From a folder of CT files to a bone mesh, and from a selection on it to a region of its own.
//!
//! This is the one crate that programs use; it fixes the order of the steps and adds nothing
//! to them:
//!
//! ```text
//! folder -> Series -> Volume -> Mask -> EdgeMap -> PointCloud -> tetrahedra -> TriangleMesh -> region
//! ```
//!
//! Promise: the result depends only on the files and the [`Settings`], never on the number of
//! threads; every failure is one [`Error`] whose message names the file or value and the remedy;
//! nothing is left half-written.
//!
//! The threshold is a setting; [`Settings::find_threshold`] finds it in the volume, and
//! [`histogram`] tells what there is to choose from.
//!
//! Limits: the surface of method `alpha` is the boundary of a regularised alpha complex. It has
//! no open edge but can touch itself along edges and vertices, which [`check`] reports.
//!
//! ```
//! use bonemesh::{Phantom, Settings, Task, render_volume, scan_phantom};
//!
//! let task = Task::default();
//! let shell = Phantom::SphereShell;
//! let volume = scan_phantom(shell, &shell.settings().coarser(2.0), &task)?;
//! let rendered = render_volume(&volume, &Settings::default(), &task)?;
//! assert!(rendered.report.watertight);
//! # Ok::<(), bonemesh::Error>(())
//! ```
//!
//! The method is that of E. Rier, *Generation and segmentation of 3D models of bone from CT
//! images based on 3D point clouds*, MASc thesis, McMaster University.

mod after_care;
mod check;
mod choices;
pub mod cli;
mod compare;
mod error;
mod faults;
mod left_out;
mod memory;
mod metal;
mod mirror;
mod of_cloud;
mod options;
mod panics;
mod picture;
mod preview;
mod region;
mod region_report;
mod render;
mod report;
mod settings;
mod sidecar;
mod source;
mod table;
mod table_pieces;
mod thresholds;
mod whole_file;

pub use after_care::{AfterCare, AfterCareReport, Cavities, Holes, LeftHole, MOST_NAMED, care_for};
pub use check::{Checked, Place, PrintCheck, check, check_walls, wall_thickness};
pub use compare::{
    CompareReport, CompareSettings, Compared, EdgeMidpointReport, SpreadReport, compare,
    distances_to,
};
pub use error::Error;
pub use faults::{Faults, find_faults};
pub use metal::MetalReport;
pub use mirror::{ChosenPlane, PlaneChoice, PlaneReport};
pub use options::{Chosen, OptionsReport};
pub use panics::hush_foreign_panics;
pub use picture::{check_picture_target, write_distances, write_histogram};
pub use preview::{Preview, PreviewReport, PreviewSurface};
pub use region::{Mirror, RegionRequest, RegionResult, select_roi, select_rois};
pub use region_report::{RegionReport, SolidReport, ThesisReport};
pub use render::{Rendered, mesh_cloud, point_cloud, render, render_volume};
pub use report::{CheckReport, LeftOutIslands, RenderReport, Seconds, check as check_topology};
pub use settings::{AlphaRule, Method, Settings};
pub use sidecar::{check_sidecar_target, sidecar_path, write_sidecar};
pub use source::{Contents, Reading, Source};
pub use thresholds::{
    ChosenThreshold, HistogramReport, HistogramRequest, SuggestionReport, choose_threshold,
    histogram, histogram_of,
};

pub use bonemesh_cloud::{
    CloudError, Frame, NormalSettings, NormalsIn, Percent, PointCloud, Sampler, Sampling,
    SimilarityRanges, count_ranges, estimate_normals, mean_neighbour_distance, normal_similarity,
    sample,
};
pub use bonemesh_delaunay::{DelaunayError, Points, Tetrahedra, tetrahedralize};
pub use bonemesh_dicom::{DicomError, Gap, LeftOut, SeriesChoice, SeriesReport};
pub use bonemesh_measure::{
    MeasureError, ResidualVolume, Spread, compare_surfaces, edge_midpoints, heat_colours,
    mesh_volume_mm3, residual_volume, tetrahedra_volume_mm3,
};
pub use bonemesh_mesh::{
    Decimated, Decimation, HoleLeft, HoleLimits, HoleReason, HolesFilled, Intersection,
    Intersections, Islands, Kept, MeshError, Outline, PatientFrame, Plane, RemovedPart, Smoothed,
    TriangleMesh, TriangleTree, check_target, decimate, fill_cavities, fill_holes,
    find_intersections, keep_islands, read_mesh, section, smooth, write_mesh, write_mesh_in,
    write_with_colours,
};
pub use bonemesh_metal::{Metal, MetalError, Streaks, damp_metal, find_metal};
pub use bonemesh_phantom::{
    Phantom, PhantomError, ScanSettings, WrittenPhantom, model_images, scan as scan_phantom,
    write_phantom,
};
pub use bonemesh_roi::{
    ClearanceMm, Direction, LocalThickness, Method as RoiMethod, RoiError, Symmetry, ThicknessMm,
    local_thickness, symmetry_plane,
};
pub use bonemesh_segment::{
    CannySettings, Components, Connectivity, EdgeThreshold, HuThreshold, LocalThreshold, Mask,
    SegmentError, Suggestion, Suggestions, ThresholdChoice, ThresholdFinder, ThresholdPreset,
    canny, connected_components, detect_edges, edge_threshold, grow_region, hysteresis_threshold,
    largest_component, local_threshold, multi_otsu, otsu, suggest_thresholds, threshold,
};
pub use bonemesh_surface::{
    BallPivoted, BallPivotingSettings, PoissonSettings, SurfaceError, VolumeMatched, alpha_surface,
    ball_pivoting, planar_surface, poisson, tetrahedra_surface, volume_matched_boundary,
};
pub use bonemesh_task::{Cancel, Cancelled, Progress, Task, pool};
pub use bonemesh_volume::{
    Affine, Anatomical, CropBox, CropError, Geometry, Histogram, SlicePlane, Volume, VolumeError,
    Voxels, Window,
};
pub use bonemesh_volume_file::VolumeFileError;

/// The version of this program, written into reports and objects.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
