//! Which acquisitions of a series are one stack.
//!
//! Scanners that step through the body count every rotation as an acquisition: acquisitions that
//! follow one another along the normal are one stack. Acquisitions over the same part of the body
//! are different times, and are kept apart even where their slices lie between one another's.

use std::collections::BTreeMap;

use crate::group::{median, steps};
use crate::same_place::SAME_PLACE_MM;
use crate::slice::Slice;

/// Overlap, in steps, below which acquisitions follow one another: they may share one place.
const MAX_OVERLAP: f64 = 0.9;

/// Gap, in typical steps, up to which slices of acquisitions lying across one another are one
/// stack.
const MAX_GAP: f64 = 3.0;

/// Fewest slices of an acquisition that is a stack by itself.
const MIN_SLICES: usize = 4;

/// Relative deviation of a step that is even.
const EVEN: f64 = 0.05;

/// One acquisition's part of the normal (mm).
#[derive(Clone, Copy)]
struct Span {
    low: f64,
    high: f64,
    is_stack: bool,
}

/// Parts a series, ordered along the normal, into stacks.
pub(crate) fn by_acquisition(slices: Vec<Slice>) -> Vec<Vec<Slice>> {
    let mut places: BTreeMap<Option<i64>, Vec<f64>> = BTreeMap::new();
    for slice in &slices {
        let places = places.entry(slice.header.acquisition).or_default();
        // Copies do not count.
        if places
            .last()
            .is_none_or(|last| slice.along_mm - last > SAME_PLACE_MM)
        {
            places.push(slice.along_mm);
        }
    }
    if places.len() == 1 || places.values().all(|p| p.len() == 1) {
        return vec![slices];
    }
    let within: Vec<f64> = places.values().flat_map(|p| steps(p)).collect();
    let overlap = MAX_OVERLAP * median(&within).unwrap_or(0.0);
    let spans: Vec<Span> = places.values().map(|p| span(p)).collect();
    let volumes = volumes(&spans, overlap);
    let count = volumes.iter().max().map_or(1, |last| last + 1);
    let are_stacks = spans.iter().all(|s| s.is_stack);
    if !are_stacks && is_one_stack(&slices) {
        return vec![slices];
    }
    let volumes: BTreeMap<Option<i64>, usize> = places.into_keys().zip(volumes).collect();
    let mut parts = vec![Vec::new(); count];
    for slice in slices {
        parts[volumes[&slice.header.acquisition]].push(slice);
    }
    parts.into_iter().flat_map(without_shared).collect()
}

/// Takes out the slices at places where an acquisition begins that another ends at: they are
/// few, and would be mistaken for another time of the whole.
fn without_shared(part: Vec<Slice>) -> Vec<Vec<Slice>> {
    let mut parts = [Vec::new(), Vec::new()];
    for slice in part {
        let own: &Vec<Slice> = &parts[0];
        let is_shared = own.last().is_some_and(|last| {
            slice.along_mm - last.along_mm <= SAME_PLACE_MM
                && last.header.acquisition != slice.header.acquisition
        });
        parts[usize::from(is_shared)].push(slice);
    }
    parts.into_iter().filter(|part| !part.is_empty()).collect()
}

fn span(places: &[f64]) -> Span {
    let steps = steps(places);
    let typical = median(&steps).unwrap_or(0.0);
    let is_even = |s: &&f64| (*s - typical).abs() <= EVEN * typical;
    let even = steps.iter().filter(is_even).count();
    Span {
        low: places[0],
        high: places[places.len() - 1],
        // Some may be missing.
        is_stack: places.len() >= MIN_SLICES && 4 * even >= 3 * steps.len(),
    }
}

/// The volume of each acquisition, in the order of their numbers.
///
/// Where every part of the body was scanned equally often, the n-th scans of all are one volume;
/// else a new one begins where an acquisition goes back over one of the current volume.
fn volumes(spans: &[Span], overlap: f64) -> Vec<usize> {
    let mut often: BTreeMap<[i64; 2], usize> = BTreeMap::new();
    let rank = |span: &Span| {
        let place = [span.low, span.high].map(order);
        let seen = often.entry(place).or_default();
        *seen += 1;
        *seen - 1
    };
    let ranks: Vec<usize> = spans.iter().map(rank).collect();
    let mut counts = often.values();
    let first = counts.next();
    let mut parts: Vec<Span> = spans
        .iter()
        .zip(&ranks)
        .filter(|(_, r)| **r == 0)
        .map(|(s, _)| *s)
        .collect();
    parts.sort_by(|a, b| a.low.total_cmp(&b.low));
    let follow = parts.windows(2).all(|w| w[0].high - w[1].low <= overlap);
    if follow && counts.all(|c| Some(c) == first) {
        return ranks;
    }
    let (mut volume, mut current) = (0, BTreeMap::new());
    let number = |span: &Span| {
        // A single place within the other's is an overlap as well, of no length.
        let crosses = |other: &Span| {
            let shared = span.high.min(other.high) - span.low.max(other.low);
            let within = (span.low >= other.low && span.high <= other.high)
                || (other.low >= span.low && other.high <= span.high);
            shared > overlap || (within && shared >= 0.0)
        };
        let key = order(span.low);
        let before = current.range(..=key).next_back().map(|(_, s)| s);
        let after = current.range(key..).next().map(|(_, s)| s);
        if before.into_iter().chain(after).any(crosses) {
            volume += 1;
            current.clear();
        }
        current.insert(key, *span);
        volume
    };
    spans.iter().map(number).collect()
}

/// A whole number in the order of places.
fn order(mm: f64) -> i64 {
    (mm / SAME_PLACE_MM / 10.0).round() as i64
}

/// Whether all slices together are as even as those of one acquisition.
fn is_one_stack(slices: &[Slice]) -> bool {
    let places: Vec<f64> = slices.iter().map(|s| s.along_mm).collect();
    let steps = steps(&places);
    let largest = steps.iter().copied().fold(0.0, f64::max);
    steps.iter().all(|s| *s > SAME_PLACE_MM) && largest <= MAX_GAP * median(&steps).unwrap_or(0.0)
}
