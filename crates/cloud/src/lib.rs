//! Point clouds from edge maps: extraction, neighbour distances, samples and files.
//!
//! [`extract_points`] makes one point of every edge pixel, in the patient frame or in the
//! published method's image frame, ordered by slice, row and column. Such a cloud keeps its
//! integer [`Lattice`], on which later steps can decide ties exactly.
//! [`mean_neighbour_distance`] is the published choice of alpha, [`sample`] thins a cloud,
//! [`estimate_normals`] tells which way is out at each point, and
//! [`read_cloud`] and [`write_cloud`] exchange it with other programs. Results are the same for
//! any number of threads.
//!
//! Limits: at most `u32::MAX` points, all finite; files keep millimetres but no lattice.
//!
//! ```
//! use bonemesh_cloud::{Frame, Percent, Sampling, extract_points, mean_neighbour_distance, sample};
//! use bonemesh_segment::EdgeMap;
//! use bonemesh_task::Task;
//! use bonemesh_volume::{Affine, Geometry};
//! use ndarray::Array3;
//!
//! let affine = Affine::from_axes([0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 2.0], [0.0; 3]);
//! let edges = EdgeMap {
//!     edges: Array3::from_shape_fn([1, 3, 40], |(_, row, _)| row == 1),
//!     geometry: Geometry::new([1, 3, 40], affine)?,
//! };
//! let task = Task::default();
//! let cloud = extract_points(&edges, Frame::Patient, &task)?;
//! assert_eq!(cloud.points_mm()[2], [1.0, 0.5, 0.0]);
//!
//! let two_nearest = mean_neighbour_distance(&cloud, 2, false, &task)?;
//! assert!((two_nearest - 0.5).abs() < 1e-12);
//! let quarter = Sampling::Uniform { percent: Percent::new(25.0)? };
//! let kept = sample(&cloud, &quarter, &task)?;
//! assert_eq!(kept.len(), 10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Source: E. Rier, *Generation and segmentation of 3D models of bone from CT images based on 3D
//! point clouds* (master's thesis).
#![forbid(unsafe_code)]

mod extract;
mod forest;
mod io;
mod neighbours;
mod normals;
mod point_cloud;
mod recognise;
mod sampling;

use std::path::PathBuf;

use bonemesh_task::Cancelled;

pub use extract::extract_points;
pub use forest::{Forest, Near};
pub use io::{CloudFormat, check_target, read_cloud, write_cloud};
pub use neighbours::mean_neighbour_distance;
pub use normals::{NormalSettings, estimate_normals};
pub use point_cloud::{Frame, Lattice, PointCloud};
pub use sampling::{
    NormalsIn, Percent, Sampler, Sampling, SimilarityRanges, count_ranges, normal_similarity,
    sample,
};

/// What cannot be done with a cloud, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum CloudError {
    /// A coordinate that is no number.
    #[error("point {index} of the cloud is {point:?} mm; every coordinate must be finite")]
    NotFinite {
        /// Which point, counted from 0.
        index: usize,
        /// The point in mm.
        point: [f64; 3],
    },
    /// More points than an index can count.
    #[error("the cloud has {0} points, more than can be numbered (4294967295); crop the volume")]
    TooMany(usize),
    /// A cloud with too few points for neighbours.
    #[error(
        "a cloud of {0} point(s) has no neighbour distances or normals; choose a threshold or crop box that leaves more edges"
    )]
    TooFew(usize),
    /// A number of neighbours that leaves no distance.
    #[error("{0} neighbours (the point itself counts as one) leave no distance; ask for 2 or more")]
    NeighbourCount(usize),
    /// A radius that reaches nothing.
    #[error("{0} mm is no radius in which to look for neighbours; give a length above 0")]
    Radius(f64),
    /// A percentage that cannot be used.
    #[error("{0} is no percentage to keep; choose a number above 0 and up to 100")]
    Percent(f64),
    /// A sampler that does not exist.
    #[error(
        "there is no sampler `{0}`; choose one of uniform, targeted, random, thesis-uniform, thesis-targeted"
    )]
    Sampler(String),
    /// A percentage for a sampler that has one for each range of similarity.
    #[error(
        "the sampler `thesis-targeted` takes a percentage for each range of similarity, not one for all; leave the percentage out, or choose `targeted`"
    )]
    PercentUnused,
    /// Cells or ranges for a sampler that has none.
    #[error(
        "a grid, cut-offs and percentages of ranges mean nothing to the sampler `{0}`; leave them out, or choose `thesis-targeted`"
    )]
    RangesUnused(&'static str),
    /// Cells of no pixels.
    #[error("a cell of 0 pixels holds nothing; give a size of at least 1 pixel, such as 10")]
    GridSize,
    /// Ranges of similarity that leave gaps or overlap.
    #[error(
        "{0:?} are no cut-offs of similarity; give four rising numbers from 0 to at most 1, such as 0, 0.4, 0.6, 0.8"
    )]
    Cutoffs([f64; 4]),
    /// Cells of pixels where there are no pixels.
    #[error(
        "the points are on no grid of pixels, so there are no cells for the sampler `thesis-targeted`; give the spacing of the points, or choose `targeted`"
    )]
    NoPixels,
    /// A file name whose ending names no format.
    #[error("{} ends in no format for clouds; name it .npy, .ply or .xyz", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// A file that cannot be read.
    #[error("cannot read {} ({source}); check that it exists and may be read", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A file that cannot be written.
    #[error(
        "cannot write {} ({source}); check that its folder exists, may be written and has room", path.display()
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A file that does not hold a cloud.
    #[error("{} holds no point cloud: {reason}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what is expected.
        reason: String,
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
