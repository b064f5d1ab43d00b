//! A given number of points, spread over walks by weight.
//!
//! 1. `parts`: what each point is due, at most a whole point; what that cuts off is shared by the others.
//! 2. `Pairs::take`: the parts are added up along open walks, from one to the next, and points are kept in
//!    pairs: steps of 0.4 and 1.6 of the mean take turns. A closed walk gets pairs of its own, so that it
//!    has no seam. So the sum is exact, and small contours get their share.
//!
//! Why pairs: they tell the direction of a contour, which single points do not where two contours are
//! nearer to each other than a step. Of a skull at 10 %, the published distance to the mesh of all points
//! is half of what it is with equal steps, and the distance of the surfaces the same to 3 %.

use rustc_hash::FxHashSet;

use super::contours::Walk;

/// Shortest length a point is taken to stand for, in usual ones: points that crowd still count.
const SHORTEST: f64 = 0.25;
/// From one point of a pair to the other, as a part of the mean step.
const WITHIN_PAIR: f64 = 0.4;
/// Points that a closed walk is due at least to get pairs of its own.
const LEAST_OF_CLOSED: f64 = 2.0;
/// What sums may have lost to rounding.
const ROUNDING: f64 = 1e-9;

/// The points kept of `walks`: the `fraction` of all, one at least.
///
/// `density` gives, for each walk, how many times as densely as elsewhere its points are to lie.
pub(super) fn spread(walks: &[Walk], densities: &[Vec<f64>], fraction: f64) -> Vec<u32> {
    let count: usize = walks.iter().map(|w| w.points.len()).sum();
    if count == 0 {
        return Vec::new();
    }
    // The tiny part keeps a sum of tenths from being rounded down at a half.
    let wanted = (fraction * count as f64 + ROUNDING).round().max(1.0);
    let mut parts = parts(walks, densities, wanted);
    let wanted = wanted as usize;
    let mut kept = Vec::with_capacity(wanted);
    let mut at = 0;
    // What open walks are due so far, and what they got; what closed ones are still due.
    let (mut open, mut closed_due) = (Pairs::default(), 0.0);
    for walk in walks {
        let own = &mut parts[at..at + walk.points.len()];
        at += walk.points.len();
        let due: f64 = own.iter().sum();
        if walk.is_closed() && due >= LEAST_OF_CLOSED {
            closed_due += due;
            let number = (2.0 * (0.5 * closed_due).round()).min(own.len() as f64);
            scale_to(own, number);
            let before = kept.len();
            Pairs::default().take(walk, own, wanted, &mut kept);
            closed_due -= (kept.len() - before) as f64;
        } else {
            open.take(walk, own, wanted, &mut kept);
        }
    }
    // The last pair may have been half of one.
    let are_kept: FxHashSet<u32> = kept.iter().copied().collect();
    let others = walks.iter().flat_map(|w| &w.points);
    let others = others.filter(|p| !are_kept.contains(p)).copied();
    let missing = wanted - kept.len();
    kept.extend(others.take(missing));
    kept
}

/// Points taken in pairs.
#[derive(Default)]
struct Pairs {
    /// Sum of the parts so far.
    due: f64,
    taken: usize,
}

impl Pairs {
    /// Takes points of a walk, up to `wanted` in all: whenever the sum of their parts passes the middle of
    /// one more, moved to the other of the pair.
    fn take(&mut self, walk: &Walk, parts: &[f64], wanted: usize, kept: &mut Vec<u32>) {
        for (point, part) in walk.points.iter().zip(parts) {
            self.due += part;
            let apart = 0.5 * (1.0 - part.max(WITHIN_PAIR));
            let moved = if self.taken.is_multiple_of(2) {
                apart
            } else {
                -apart
            };
            let middle = self.taken as f64 + 0.5 + moved;
            if self.due + ROUNDING >= middle && kept.len() < wanted {
                self.taken += 1;
                kept.push(*point);
            }
        }
    }
}

/// Parts of a point, at most 1 each, that add up to `wanted` and follow lengths of contour and density.
fn parts(walks: &[Walk], densities: &[Vec<f64>], wanted: f64) -> Vec<f64> {
    let arcs: Vec<Option<f64>> = walks.iter().flat_map(Walk::arcs_mm).collect();
    let known: Vec<f64> = arcs.iter().filter_map(|arc| *arc).collect();
    let usual_mm = known.iter().sum::<f64>() / known.len().max(1) as f64;
    let length = |arc: Option<f64>| match arc {
        Some(mm) if usual_mm > 0.0 => (mm / usual_mm).max(SHORTEST),
        _ => 1.0,
    };
    let weights = arcs.into_iter().map(length).zip(densities.iter().flatten());
    let mut parts: Vec<f64> = weights.map(|(length, density)| length * density).collect();
    scale_to(&mut parts, wanted);
    parts
}

/// Scales parts so that they add up to `wanted`, which is at most their number, and none is above 1.
fn scale_to(parts: &mut [f64], wanted: f64) {
    if wanted >= parts.len() as f64 {
        parts.fill(1.0);
        return;
    }
    // Each round the scale grows a little, until no further part passes 1.
    let mut scale = 0.0;
    loop {
        let is_whole = |part: &f64| part * scale >= 1.0;
        let whole = parts.iter().filter(|p| is_whole(p)).count();
        let open: f64 = parts.iter().filter(|p| !is_whole(p)).sum();
        let next = (wanted - whole as f64) / open;
        if !(next.is_finite() && next > scale * (1.0 + 1e-12)) {
            break;
        }
        scale = next;
    }
    for part in parts {
        *part = (*part * scale).min(1.0);
    }
}
