//! Bone masks and Canny edges of a CT volume, slice by slice and to the last bit.
//!
//! [`threshold`] marks as bone what lies strictly above a number of Hounsfield units;
//! [`detect_edges`] finds Canny's edges of every slice of such a mask, pixel for pixel as
//! scikit-image's `feature.canny` finds them on the boolean image; [`canny`] does the same for
//! one grey image. Results are the same for any number of threads.
//!
//! Limits: edges are two-dimensional, slice by slice; a border of one pixel never holds an edge.
//!
//! ```
//! use bonemesh_segment::{CannySettings, HuThreshold, detect_edges, threshold};
//! use bonemesh_task::Task;
//! use bonemesh_volume::{Affine, Geometry, Volume, Voxels};
//! use ndarray::Array3;
//!
//! let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0], [0.0; 3]);
//! let bone = |(_, row, column)| (8..24).contains(&row) && (8..24).contains(&column);
//! let hu = Array3::from_shape_fn([2, 32, 32], |at| if bone(at) { 900_i16 } else { -1000 });
//! let volume = Volume::new(Voxels::I16(hu), Geometry::new([2, 32, 32], affine)?)?;
//!
//! let task = Task::default();
//! let mask = threshold(&volume, HuThreshold::new(350.0)?, &task)?;
//! let edges = detect_edges(&mask, CannySettings::default(), &task)?;
//! assert_eq!(mask.voxels.iter().filter(|bone| **bone).count(), 2 * 16 * 16);
//! assert!(edges.edges[[0, 8, 16]] || edges.edges[[0, 7, 16]]);
//! assert!(!edges.edges[[0, 16, 16]]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Sources: J. Canny, *A computational approach to edge detection*, IEEE PAMI 8 (1986);
//! S. van der Walt et al., *scikit-image*, `PeerJ` 2 (2014), for the order of the operations;
//! E. Rier, *Generation and segmentation of 3D models of bone from CT images based on 3D point
//! clouds* (master's thesis), for their use on thresholded CT slices.
#![forbid(unsafe_code)]

mod canny;
mod threshold;

use bonemesh_task::Cancelled;
use bonemesh_volume::Geometry;
use ndarray::Array3;

pub use canny::{CannySettings, canny, detect_edges};
pub use threshold::{HuThreshold, threshold};

/// What cannot be segmented, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum SegmentError {
    /// A threshold that is no number.
    #[error("the threshold {0} is no Hounsfield value; use a number such as 350")]
    Threshold(f64),
    /// No voxel is bone.
    #[error(
        "nothing lies above the threshold of {threshold_hu} HU: the volume spans {lowest_hu} to {highest_hu} HU; choose a threshold below {highest_hu}"
    )]
    NothingAbove {
        /// The threshold that was asked for (HU).
        threshold_hu: f64,
        /// The volume's smallest value (HU).
        lowest_hu: f64,
        /// The volume's largest value (HU).
        highest_hu: f64,
    },
    /// Every voxel is bone, so nothing has an edge.
    #[error(
        "everything lies above the threshold of {threshold_hu} HU: the volume spans {lowest_hu} to {highest_hu} HU; choose a threshold of at least {lowest_hu}"
    )]
    NothingBelow {
        /// The threshold that was asked for (HU).
        threshold_hu: f64,
        /// The volume's smallest value (HU).
        lowest_hu: f64,
        /// The volume's largest value (HU).
        highest_hu: f64,
    },
    /// A width of Canny's Gaussian that cannot be used.
    #[error("a sigma of {0} pixels cannot be used; choose a number from 0 (no smoothing) to 100")]
    Sigma(f64),
    /// Canny thresholds that cannot be used.
    #[error(
        "Canny's thresholds low {low} and high {high} cannot be used; choose numbers with 0 <= low <= high, such as 0.1 and 0.2"
    )]
    CannyThresholds {
        /// Gradient above which a pixel continues an edge.
        low: f64,
        /// Gradient from which a pixel starts an edge.
        high: f64,
    },
    /// A grey pixel that has no gradient.
    #[error(
        "the pixel at row {row}, column {column} is {value}; give numbers from -1e150 to 1e150, and a number in place of missing values"
    )]
    Pixel {
        /// Its row, counted from 0.
        row: usize,
        /// Its column, counted from 0.
        column: usize,
        /// Its value.
        value: f64,
    },
    /// Mask and geometry disagree.
    #[error(
        "the mask has {array:?} (slices, rows, columns) voxels but its geometry says {geometry:?}; make both from the same volume"
    )]
    Shape {
        /// Shape of the mask's array.
        array: [usize; 3],
        /// Shape that its geometry was made for.
        geometry: [usize; 3],
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Which voxels are bone, `[slice, row, column]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// True where the voxel is bone.
    pub voxels: Array3<bool>,
    /// Place in the patient.
    pub geometry: Geometry,
}

/// Which voxels lie on an edge, `[slice, row, column]`.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeMap {
    /// True where the voxel is an edge pixel of its slice.
    pub edges: Array3<bool>,
    /// Place in the patient.
    pub geometry: Geometry,
}
