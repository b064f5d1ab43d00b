//! The edge of the bone near a place on the threshold's surface.
//!
//! 1. Sample the grey along its gradient, inward and outward.
//! 2. Climb from the given place to where the change is steepest.
//! 3. Follow the edge both ways until it flattens out: there it shows the grey of the bone and of
//!    what lies around it. Where the other side of a thin wall or of a narrow gap begins first, it
//!    ends there, and the distance to that other edge tells the wall's or the gap's width.

use std::cell::Cell;
use std::ops::Range;

use super::grey::{Grey, Voxel};
use super::layer;

/// Samples to each side, at most.
const REACH: usize = 12;
/// Samples in all.
const SAMPLES: usize = 2 * REACH + 1;
/// Distance of samples, in voxels.
const STEP: f32 = 0.5;
/// The edge ends where it changes by less than this part of its steepest change.
const FLAT: f32 = 0.12;
/// Weakest edge that counts, in HU.
const LEAST_CONTRAST_HU: f32 = 60.0;

/// An edge of the bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    /// Its place in voxels, where the grey is in the middle.
    pub(super) at: [f32; 3],
    /// Product with a step in voxels: how far outward that leads along the profile.
    pub(super) outward: [f32; 3],
    /// Part of the profile's direction that leads across slices, 0 to 1.
    pub(super) across_slices: f32,
    /// The greys around and in the bone, HU.
    pub(super) low_hu: f32,
    pub(super) high_hu: f32,
    /// Steepest change, HU for each voxel.
    pub(super) slope: f32,
    /// How far it reaches inward and outward, in voxels along its profile.
    pub(super) inner: f32,
    pub(super) outer: f32,
    /// Voxels to where the grey passes the middle again behind the wall, and before the gap.
    pub(super) wall: Option<f32>,
    pub(super) gap: Option<f32>,
    /// Voxels between the middle of bone and soft tissue and that of soft tissue and air, where
    /// there is air around.
    pub(super) layer: Option<f32>,
}

impl Edge {
    /// From the grey around the bone to the bone's, HU.
    pub(super) fn contrast_hu(&self) -> f32 {
        self.high_hu - self.low_hu
    }
}

/// The edge near a place (in voxels) on the threshold's surface, if there is one. `gradient` is
/// the grey's there; `steepest` turns it into the direction, in voxels, in which the grey changes
/// fastest for each mm.
pub(super) fn edge_near<T: Voxel>(
    grey: &Grey<'_, T>,
    place: [f32; 3],
    gradient: [f32; 3],
    steepest: impl Fn([f32; 3]) -> [f32; 3],
) -> Option<Edge> {
    let inward = unit(steepest(gradient))?;
    let along = |step: f32| std::array::from_fn(|axis| place[axis] + step * inward[axis]);
    let sample = |i: usize| grey.between(along(STEP * (i as f32 - REACH as f32)));
    let found = Profile {
        sample,
        known: Default::default(),
    };
    let span = found.span()?;
    let middle = found.crossing(span.middle_hu(), span.outer..span.inner)?;
    let voxels = |samples: f32| STEP * samples;
    let rise: f32 = (0..3).map(|axis| gradient[axis] * inward[axis]).sum();
    Some(Edge {
        at: along(voxels(middle - REACH as f32)),
        outward: gradient.map(|g| -g / rise),
        across_slices: inward[2].abs(),
        low_hu: span.low_hu,
        high_hu: span.high_hu,
        slope: span.slope / STEP,
        inner: voxels(span.inner as f32 - middle),
        outer: voxels(middle - span.outer as f32),
        wall: found.behind(&span).map(|at| voxels(at - middle)),
        gap: found.before(&span).map(|at| voxels(middle - at)),
        layer: found.layer(&span).map(voxels),
    })
}

/// Grey from outside to inside, sampled where it is asked for.
struct Profile<F> {
    sample: F,
    known: [Cell<Option<f32>>; SAMPLES],
}

/// A profile's edge: its first and last sample, and the change between the steepest two.
struct Span {
    outer: usize,
    inner: usize,
    low_hu: f32,
    high_hu: f32,
    slope: f32,
}

impl Span {
    fn middle_hu(&self) -> f32 {
        f32::midpoint(self.low_hu, self.high_hu)
    }
}

impl<F: Fn(usize) -> f32> Profile<F> {
    fn at(&self, i: usize) -> f32 {
        self.known[i].get().unwrap_or_else(|| {
            let hu = (self.sample)(i);
            self.known[i].set(Some(hu));
            hu
        })
    }

    fn slope(&self, i: usize) -> f32 {
        self.at(i + 1) - self.at(i)
    }

    /// The edge to which the middle of the profile belongs, if it is strong enough.
    fn span(&self) -> Option<Span> {
        let steep = self.climb();
        let slope = self.slope(steep);
        let is_flat = |&i: &usize| self.slope(i) < FLAT * slope;
        let outer = (0..steep).rev().find(is_flat).map_or(0, |i| i + 1);
        let inner = (steep + 1..SAMPLES - 1).find(is_flat);
        let inner = inner.unwrap_or(SAMPLES - 1);
        let (low_hu, high_hu) = (self.at(outer), self.at(inner));
        (high_hu - low_hu >= LEAST_CONTRAST_HU).then_some(Span {
            outer,
            inner,
            low_hu,
            high_hu,
            slope,
        })
    }

    /// The interval of the greatest slope that leads up from the middle of the profile.
    fn climb(&self) -> usize {
        let mut here = REACH - usize::from(self.slope(REACH - 1) >= self.slope(REACH));
        loop {
            let is_steeper = |i: usize| self.slope(i) > self.slope(here);
            if here + 2 < SAMPLES && is_steeper(here + 1) {
                here += 1;
            } else if here > 0 && is_steeper(here - 1) {
                here -= 1;
            } else {
                return here;
            }
        }
    }

    /// Where the grey first passes `hu` between two samples, as a fraction of samples.
    fn crossing(&self, hu: f32, mut samples: Range<usize>) -> Option<f32> {
        let passes = |i: &usize| (self.at(*i) > hu) != (self.at(i + 1) > hu);
        samples
            .find(passes)
            .map(|i| i as f32 + (hu - self.at(i)) / self.slope(i))
    }

    /// Samples between the middle of bone and soft tissue and that of soft tissue and air.
    fn layer(&self, span: &Span) -> Option<f32> {
        if !layer::may_hide(span.low_hu, span.high_hu) {
            return None;
        }
        let middle = |hu| f32::midpoint(hu, layer::SOFT_HU);
        let passes = |hu| self.crossing(hu, span.outer..span.inner);
        Some(passes(middle(span.high_hu))? - passes(middle(span.low_hu))?)
    }

    /// Where the grey has fallen to the middle again behind a wall.
    fn behind(&self, span: &Span) -> Option<f32> {
        self.crossing(span.middle_hu(), span.inner..SAMPLES - 1)
    }

    /// Where the grey was still above the middle before a gap.
    fn before(&self, span: &Span) -> Option<f32> {
        let hu = span.middle_hu();
        let last = (0..span.outer).rev().find(|&i| self.at(i) > hu)?;
        self.crossing(hu, last..last + 1)
    }
}

fn unit(v: [f32; 3]) -> Option<[f32; 3]> {
    let length = v.iter().map(|c| c * c).sum::<f32>().sqrt();
    (length > 0.0 && length.is_finite()).then(|| v.map(|c| c / length))
}
