//! A given number of points, spread over walks by weight.
//!
//! 1. `parts`: what each point is due, at most a whole point; what that cuts off is shared by the others.
//! 2. Each walk gets a whole number of pairs. Parts are added up from walk to walk and slice to slice, so
//!    the sum is exact and small contours get their share; none of two steps or more goes without.
//! 3. Along each walk these are spread anew by the parts, in pairs: steps of 0.4 and 1.6 of the mean take
//!    turns. A pair tells the direction of its contour, which single points do not where two contours are
//!    nearer to each other than a step: of a skull at 10 %, the published distance to the mesh of all
//!    points is half of what it is with equal steps, and the distance of the surfaces the same to 3 %. The
//!    ends of an open walk get half a step, and a closed one has no seam.

use rustc_hash::FxHashSet;

use super::contours::Walk;

/// Shortest length a point is taken to stand for, in usual ones: points that crowd still count.
const SHORTEST: f64 = 0.25;
/// From one point of a pair to the other, as a part of the mean step.
const WITHIN_PAIR: f64 = 0.4;
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
    let mut kept = Vec::with_capacity(wanted as usize);
    let (mut at, mut due) = (0, 0.0);
    for walk in walks {
        let own = &mut parts[at..at + walk.points.len()];
        at += walk.points.len();
        due += own.iter().sum::<f64>();
        let missing = due - kept.len() as f64;
        let most = (wanted - kept.len() as f64).min(own.len() as f64);
        let number = (2.0 * (0.5 * missing + ROUNDING).round()).min(most);
        if number >= 1.0 {
            scale_to(own, number);
            spread_over(walk, own, number as usize, &mut kept);
        }
    }
    // The last pair may have been half of one.
    let are_kept: FxHashSet<u32> = kept.iter().copied().collect();
    let others = walks.iter().flat_map(|w| &w.points);
    let others = others.filter(|p| !are_kept.contains(p)).copied();
    let missing = wanted as usize - kept.len();
    kept.extend(others.take(missing));
    kept
}

/// Takes points of a walk in pairs: whenever the sum of their parts passes the middle of one more, moved
/// to the other of the pair.
fn spread_over(walk: &Walk, parts: &[f64], number: usize, kept: &mut Vec<u32>) {
    let (mut sum, mut taken) = (ROUNDING, 0);
    for (point, part) in walk.points.iter().zip(parts) {
        sum += part;
        let apart = (1.0 - part.max(WITHIN_PAIR)) / 2.0;
        let moved = match taken % 2 {
            0 if taken + 1 == number => 0.0,
            0 => apart,
            _ => -apart,
        };
        if taken < number && sum >= taken as f64 + 0.5 + moved {
            taken += 1;
            kept.push(*point);
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
