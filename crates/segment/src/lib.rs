//! Bone masks and Canny edges of a CT volume, slice by slice and to the last bit.
//!
//! [`threshold`] marks as bone what lies strictly above a number of Hounsfield units;
//! [`detect_edges`] finds Canny's edges of every slice of such a mask, pixel for pixel as
//! scikit-image's `feature.canny` finds them on the boolean image; [`canny`] does the same for
//! one grey image. Results are the same for any number of threads.
//!
//! Where the threshold comes from: [`suggest_thresholds`] finds thresholds in the volume itself
//! ([`edge_threshold`], [`multi_otsu`], [`otsu`]) and adds those of the literature
//! ([`ThresholdPreset`]). What else can be made of one: [`local_threshold`] lets it follow the
//! values around each voxel, [`hysteresis_threshold`] and [`grow_region`] keep what is connected
//! with dense bone or with seeds, [`connected_components`] and [`largest_component`] take a mask
//! apart. [`outside_air`] is what lies around whatever was scanned.
//!
//! Limits: edges are two-dimensional, slice by slice; a border of one pixel never holds an edge.
//! No threshold knows what bone is: metal, contrast agent and the scanner's table can lie above
//! it too.
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
//! clouds* (master's thesis), for their use on thresholded CT slices. Thresholds cite theirs where
//! they are documented.
#![forbid(unsafe_code)]

mod canny;
mod choice;
mod components;
mod edges;
mod local;
mod otsu;
mod outside;
mod presets;
mod region;
mod suggest;
mod threshold;

use bonemesh_task::Cancelled;
use bonemesh_volume::Geometry;
use ndarray::Array3;

pub use canny::{CannySettings, canny, detect_edges};
pub use choice::{ThresholdChoice, ThresholdFinder};
pub use components::{Components, Connectivity, connected_components, largest_component};
pub use edges::{EdgeThreshold, edge_threshold};
pub use local::{LocalThreshold, level_to_threshold, local_threshold};
pub use otsu::{multi_otsu, otsu};
pub use outside::outside_air;
pub use presets::ThresholdPreset;
pub use region::{grow_region, hysteresis_threshold};
pub use suggest::{Suggestion, Suggestions, suggest_thresholds};
pub use threshold::{HuThreshold, threshold};

/// What cannot be segmented, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum SegmentError {
    /// A threshold that is no number.
    #[error("the threshold {0:e} is no Hounsfield value; use a number such as 350")]
    Threshold(f64),
    /// No voxel is bone.
    #[error(
        "nothing lies above the threshold of {threshold_hu} HU: {}",
        spanned("below", *lowest_hu, *highest_hu)
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
        "everything lies above the threshold of {threshold_hu} HU: {}",
        spanned("of at least", *lowest_hu, *highest_hu)
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
    /// A number of classes that no histogram is split into.
    #[error("a histogram cannot be split into {0} classes; choose 2 to 5")]
    Classes(usize),
    /// Fewer different values than classes.
    #[error(
        "the voxels have {occupied} different value(s), which make no {classes} classes; give a threshold in HU"
    )]
    TooFewValues {
        /// Bins that hold any voxel.
        occupied: usize,
        /// Classes that were asked for.
        classes: usize,
    },
    /// Too few edges between soft tissue and bone.
    #[error(
        "only {edges} of {of} edge pixels of bone have soft tissue beside them, too few to find a threshold; use multi-level Otsu or give a threshold in HU"
    )]
    FewBoneEdges {
        /// Edge pixels between soft tissue and bone.
        edges: usize,
        /// All edge pixels of bone.
        of: usize,
    },
    /// Nothing tells bone from anything else.
    #[error(
        "all voxels have the same value, so no threshold can be found; give one in HU, such as 350"
    )]
    NoSuggestion,
    /// `edges` and the like found none.
    #[error("`{0}` finds no threshold in this scan; use `auto`, or a number in HU, such as 350")]
    NotFound(ThresholdFinder),
    /// A name that no threshold has.
    #[error("there is no threshold `{0}`; use a number in HU, or one of: {names}", names = names())]
    NoSuchThreshold(String),
    /// A window that cannot be used.
    #[error("a window of {0} mm cannot be used; choose a number above 0, such as 10")]
    Window(f64),
    /// A leeway or contrast that cannot be used.
    #[error("a {what} of {hu} HU cannot be used; choose a number from 0 to 1000, such as 150")]
    Local {
        /// Which of them.
        what: &'static str,
        /// Its value.
        hu: f64,
    },
    /// No seed to grow from.
    #[error("there is no seed to grow from; give at least one voxel (slice, row, column)")]
    NoSeeds,
    /// A seed that is no voxel.
    #[error(
        "the seed {seed:?} lies outside the volume of {shape:?} (slices, rows, columns) voxels; count from 0"
    )]
    SeedOutside {
        /// The seed, `[slice, row, column]`.
        seed: [usize; 3],
        /// Slices, rows, columns.
        shape: [usize; 3],
    },
    /// A seed that does not lie above the threshold.
    #[error(
        "the seed {seed:?} has {hu} HU, which is not above the threshold of {threshold_hu} HU; choose a voxel of bone or a lower threshold"
    )]
    SeedBelow {
        /// The seed, `[slice, row, column]`.
        seed: [usize; 3],
        /// Its value.
        hu: f64,
        /// The threshold (HU).
        threshold_hu: f64,
    },
    /// Two thresholds in the wrong order.
    #[error("the low threshold {low_hu} HU is above the high one, {high_hu} HU; swap them")]
    ThresholdOrder {
        /// The lower threshold as given (HU).
        low_hu: f64,
        /// The higher threshold as given (HU).
        high_hu: f64,
    },
    /// A mask without any voxel has no largest component.
    #[error("the mask is empty, so it has no largest component; choose a lower threshold")]
    NoComponent,
    /// More stretches of voxels than can be numbered.
    #[error(
        "the mask falls into {0} stretches, more than can be numbered; choose a smaller part of the volume"
    )]
    TooManyRuns(usize),
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// More lies between no two kinds of tissue.
const MOST_LEEWAY_HU: f64 = 1000.0;

/// What a volume spans, and which threshold would do.
fn spanned(which: &str, lowest_hu: f64, highest_hu: f64) -> String {
    if lowest_hu < highest_hu {
        let bound = if which == "below" {
            highest_hu
        } else {
            lowest_hu
        };
        format!(
            "the volume spans {lowest_hu} to {highest_hu} HU; choose a threshold {which} {bound}"
        )
    } else {
        format!(
            "every voxel of the volume has {lowest_hu} HU; choose another series, or a larger crop box"
        )
    }
}

impl SegmentError {
    /// A difference in HU, if it is one.
    fn local(what: &'static str, hu: f64) -> Result<f64, Self> {
        if (0.0..=MOST_LEEWAY_HU).contains(&hu) {
            Ok(hu)
        } else {
            Err(Self::Local { what, hu })
        }
    }
}

fn names() -> String {
    ThresholdChoice::names().collect::<Vec<_>>().join(", ")
}

/// Which voxels are bone, `[slice, row, column]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    /// True where the voxel is bone.
    pub voxels: Array3<bool>,
    /// Place in the patient.
    pub geometry: Geometry,
}

impl Mask {
    /// Slices, rows, columns.
    ///
    /// # Errors
    /// [`SegmentError::Shape`] when the voxels are not of the geometry's shape.
    fn checked_shape(&self) -> Result<[usize; 3], SegmentError> {
        let (slices, rows, columns) = self.voxels.dim();
        let (array, geometry) = ([slices, rows, columns], self.geometry.shape());
        if array == geometry {
            Ok(array)
        } else {
            Err(SegmentError::Shape { array, geometry })
        }
    }
}

/// Which voxels lie on an edge, `[slice, row, column]`.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeMap {
    /// True where the voxel is an edge pixel of its slice.
    pub edges: Array3<bool>,
    /// Place in the patient.
    pub geometry: Geometry,
}
