//! Canny's edges of one image, and of every slice of a mask.
//!
//! The steps, each named as its function is:
//! 1. `smooth`: Gaussian over rows, then over columns, nothing outside the image, divided by the
//!    same Gaussian of an image of ones;
//! 2. `gradient`: Sobel's two derivatives with mirrored borders, and their magnitude;
//! 3. `suppress`: a pixel stays when its magnitude is at least `low` and at least that of both
//!    neighbours along the gradient, interpolated between pixels; the outermost ring goes;
//! 4. `connect`: of what stayed, the 8-connected pieces that reach `high` somewhere.
//!
//! An edge between two equal pixels is decided by the last bit of a magnitude, and a straight
//! bone border is full of such ties. So all arithmetic is f64 in the order in which `SciPy` does
//! it, sums included. Single precision moves one pixel in a hundred.
//!
//! What was tried to be faster where work was near transitions only already, and how much faster
//! it made the edges of 140 slices of 512 x 512 of a skull (sigma 1, processor time):
//!
//! | idea | brought |
//! |---|---|
//! | row by row, four rows of each plane in the nearest cache; Sobel on plain slices, which the compiler does two pixels at a time; candidates appended without branches; weak pixels that look for strong ones | kept: 1.7 together |
//! | sums over rows looked up: nine pixels of a binary column have 512 | kept: 1.34 |
//! | the nine terms over columns in one expression | kept: 1.08, for one small function |
//! | a bound on the Gaussian's tail to look three pixels around a transition instead of five | dropped: 1.07, for a proof that every reader would have to follow |
//! | single precision | dropped: other edges |

mod active;
mod hysteresis;
mod kernel;
mod plane;
mod smoothing;
#[cfg(test)]
mod tests;

use bonemesh_task::Task;
use ndarray::parallel::prelude::*;
use ndarray::{Array2, Array3, ArrayView2, Axis, Zip};

use crate::{EdgeMap, Mask, SegmentError};
use active::{Active, ActiveSpans};
use plane::{Extent, Scratch};
use smoothing::Smoothing;

/// Canny's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CannySettings {
    sigma: f64,
    low: f64,
    high: f64,
}

/// Widest Gaussian in pixels: nothing of a bone's outline is left long before.
const MAX_SIGMA: f64 = 100.0;

impl CannySettings {
    /// `sigma` in pixels (0 does not smooth); `low` and `high` are gradient magnitudes as
    /// Sobel's filter gives them, in the image's own unit (a mask counts as 0 and 1).
    ///
    /// # Errors
    /// [`SegmentError::Sigma`] unless 0 <= sigma <= 100,
    /// [`SegmentError::CannyThresholds`] unless 0 <= low <= high, all finite.
    pub fn new(sigma: f64, low: f64, high: f64) -> Result<Self, SegmentError> {
        if !(0.0..=MAX_SIGMA).contains(&sigma) {
            return Err(SegmentError::Sigma(sigma));
        }
        if !(0.0 <= low && low <= high && high.is_finite()) {
            return Err(SegmentError::CannyThresholds { low, high });
        }
        Ok(Self { sigma, low, high })
    }

    /// Standard deviation of the Gaussian in pixels.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Gradient magnitude from which a pixel can continue an edge.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// Gradient magnitude from which a pixel starts an edge.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// `low` as the comparison uses it: scikit-image hands it on in single precision, and
    /// replaces 0 so that flat ground is never an edge.
    fn effective_low(&self) -> f64 {
        let single = self.low as f32;
        f64::from(if single == 0.0 { 1e-14_f32 } else { single })
    }
}

impl Default for CannySettings {
    /// Sigma 1 pixel, low 0.1, high 0.2.
    fn default() -> Self {
        Self {
            sigma: 1.0,
            low: 0.1,
            high: 0.2,
        }
    }
}

/// Largest pixel of a grey image; the squares of the gradients of larger ones overflow.
const MAX_PIXEL: f64 = 1e150;

/// Canny edges of a grey image `[row, column]`; thresholds are in the image's unit.
///
/// # Errors
/// [`SegmentError::Pixel`] when a pixel is no number or its magnitude is above 1e150.
#[expect(
    clippy::needless_pass_by_value,
    reason = "views are handed over by value throughout ndarray"
)]
pub fn canny(
    image: ArrayView2<'_, f64>,
    settings: CannySettings,
) -> Result<Array2<bool>, SegmentError> {
    let is_unusable = |pixel: f64| pixel.is_nan() || pixel.abs() > MAX_PIXEL;
    if let Some(((row, column), value)) = image.indexed_iter().find(|(_, v)| is_unusable(**v)) {
        let value = *value;
        return Err(SegmentError::Pixel { row, column, value });
    }
    let mut edges = Array2::from_elem(image.raw_dim(), false);
    let (rows, columns) = image.dim();
    let extent = Extent { rows, columns };
    if extent.pixels() == 0 {
        return Ok(edges);
    }
    let smoothing = Smoothing::new(settings.sigma, extent);
    let mut scratch = Scratch::new(extent);
    let source: Vec<f64> = image.iter().copied().collect();
    let mut found = vec![false; extent.pixels()];
    scratch.find_edges(
        &source,
        &smoothing,
        settings,
        &ActiveSpans::all(extent),
        &mut found,
    );
    for (edge, found) in edges.iter_mut().zip(found) {
        *edge = found;
    }
    Ok(edges)
}

/// Canny edges of each slice of a mask, slices in parallel.
///
/// Only the neighbourhoods of the mask's borders are worked on; the result is that of the whole
/// computation, to the last bit.
///
/// # Errors
/// [`SegmentError::Shape`] when the mask is not of its geometry's shape,
/// [`SegmentError::Cancelled`].
#[expect(
    clippy::missing_panics_doc,
    reason = "a slice of a new array is contiguous"
)]
pub fn detect_edges(
    mask: &Mask,
    settings: CannySettings,
    task: &Task,
) -> Result<EdgeMap, SegmentError> {
    let (slices, rows, columns) = mask.voxels.dim();
    if [slices, rows, columns] != mask.geometry.shape() {
        return Err(SegmentError::Shape {
            array: [slices, rows, columns],
            geometry: mask.geometry.shape(),
        });
    }
    let extent = Extent { rows, columns };
    let smoothing = Smoothing::new(settings.sigma, extent);
    let everywhere = (flat_ground(settings.sigma, extent) >= settings.effective_low())
        .then(|| ActiveSpans::all(extent));
    let mut edges = Array3::from_elem(mask.voxels.raw_dim(), false);
    task.begin("edges", slices);
    Zip::from(edges.axis_iter_mut(Axis(0)))
        .and(mask.voxels.axis_iter(Axis(0)))
        .into_par_iter()
        .try_for_each_init(
            || {
                (
                    Scratch::new(extent),
                    Active::new(extent, smoothing.radius()),
                )
            },
            |(scratch, active), (mut edges, voxels)| {
                task.check()?;
                let owned;
                let voxels = if let Some(voxels) = voxels.as_slice() {
                    voxels
                } else {
                    owned = voxels.iter().copied().collect::<Vec<bool>>();
                    &owned
                };
                let spans = match &everywhere {
                    Some(spans) => spans,
                    None => active.around_transitions(voxels),
                };
                let edges = edges
                    .as_slice_mut()
                    .expect("a slice of a new array is contiguous, else this is a bug");
                scratch.find_edges(voxels, &smoothing, settings, spans, edges);
                task.advance(1)
            },
        )?;
    Ok(EdgeMap {
        edges,
        geometry: mask.geometry.clone(),
    })
}

/// The largest gradient that rounding leaves on flat ground; only a `low` above it confines
/// edges to the neighbourhood of transitions.
///
/// Flat ground differs from place to place only by how much of a pixel's square lies outside
/// the image, so an image just larger than one square has all there is to see.
fn flat_ground(sigma: f64, extent: Extent) -> f64 {
    let square = 2 * (kernel::gaussian_weights(sigma).len() + 1) + 1;
    let extent = Extent {
        rows: extent.rows.min(square),
        columns: extent.columns.min(square),
    };
    Scratch::new(extent).gradient_of_ones(&Smoothing::new(sigma, extent))
}
