//! Headers to stacks: groups of slices that make one volume.
//!
//! 1. [`alike`]: same series, image type and size; orientation and pixel spacing within rounding.
//! 2. [`by_acquisition`]: acquisitions stay together where they make one stack (scanners that
//!    step through the body count every rotation as an acquisition), and apart where they overlap.
//! 3. [`apart`](crate::same_place::apart): slices at the same place are dropped if their pixels are the same, else each
//!    copy goes to a stack of its own.
//! 4. [`without_gaps`]: a stack ends where the next slice is too far away to be a neighbour.

use std::collections::BTreeMap;
use std::sync::Arc;

use bonemesh_task::{Cancelled, Task};

use crate::header::{Frame, Header};
use crate::same_place::{SAME_PLACE_MM, apart};
use crate::slice::Slice;
use crate::vector::{cross, dot};

/// Largest difference of two orientations' components that is rounding.
const SAME_ORIENTATION: f64 = 1e-3;

/// Largest relative difference of two spacings that is rounding.
const SAME_SPACING: f64 = 1e-3;

/// Gap, in typical steps, up to which two acquisitions are one stack.
const MAX_ACQUISITION_GAP: f64 = 3.0;

/// Gap, in typical steps, from which a stack is two: filling it would invent anatomy.
const MAX_GAP: f64 = 10.0;

/// What keeps slices of the same orientation, size and spacing apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Grouping {
    /// Series, image type and acquisition.
    ByUid,
    /// Nothing: UIDs are not to be trusted.
    WholeFolder,
}

/// Slices of one volume, ordered along their normal, and what was noticed.
pub(crate) struct Stack {
    pub(crate) slices: Vec<Slice>,
    pub(crate) notes: Vec<String>,
    /// Copies of slices that are not needed.
    pub(crate) copies: Vec<Slice>,
    /// Slices that nobody looked at: there are too many at their place.
    pub(crate) surplus: Vec<Slice>,
}

/// Groups the frames of all headers into stacks.
pub(crate) fn stacks(
    headers: Vec<Header>,
    grouping: Grouping,
    task: &Task,
) -> Result<Vec<Stack>, Cancelled> {
    let groups = alike(headers.into_iter().map(Arc::new).collect(), grouping);
    let parts: Vec<Vec<Slice>> = match grouping {
        Grouping::ByUid => groups.into_iter().flat_map(by_acquisition).collect(),
        Grouping::WholeFolder => groups,
    };
    let mut stacks = Vec::new();
    for part in parts {
        stacks.extend(apart(&part, task)?.into_iter().flat_map(without_gaps));
    }
    Ok(stacks)
}

fn alike(headers: Vec<Arc<Header>>, grouping: Grouping) -> Vec<Vec<Slice>> {
    let mut by_name: BTreeMap<_, Vec<(Frame, Vec<Slice>)>> = BTreeMap::new();
    for header in headers {
        let (uid, image_type) = match grouping {
            Grouping::ByUid => (header.series_uid.clone(), header.image_type.clone()),
            Grouping::WholeFolder => Default::default(),
        };
        let key = (uid, image_type, header.layout.rows, header.layout.columns);
        let groups = by_name.entry(key).or_default();
        for (index, frame) in header.frames.iter().enumerate() {
            let at = groups
                .iter()
                .position(|(first, _)| is_alike(first, frame))
                .unwrap_or_else(|| {
                    groups.push((frame.clone(), Vec::new()));
                    groups.len() - 1
                });
            let [x, y] = groups[at].0.orientation;
            // One normal for all, or rounding would disorder the slices.
            let along_mm = dot(frame.position, cross(x, y));
            groups[at].1.push(Slice {
                header: Arc::clone(&header),
                frame: index,
                along_mm,
            });
        }
    }
    by_name
        .into_values()
        .flatten()
        .map(|(_, slices)| ordered(slices))
        .collect()
}

fn is_alike(a: &Frame, b: &Frame) -> bool {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME_ORIENTATION;
    let (u, v) = (a.orientation.as_flattened(), b.orientation.as_flattened());
    let same = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME_SPACING * a;
    u.iter().zip(v).all(near) && a.spacing.iter().zip(&b.spacing).all(same)
}

/// Along the normal; copies of one place as they were taken.
fn ordered(mut slices: Vec<Slice>) -> Vec<Slice> {
    slices.sort_by(|a, b| {
        let (g, h) = (&a.header, &b.header);
        a.along_mm
            .total_cmp(&b.along_mm)
            .then(g.acquisition.cmp(&h.acquisition))
            .then(g.instance.cmp(&h.instance))
            .then_with(|| g.path.cmp(&h.path))
            .then(a.frame.cmp(&b.frame))
    });
    slices
}

fn by_acquisition(slices: Vec<Slice>) -> Vec<Vec<Slice>> {
    let mut parts: BTreeMap<Option<i64>, Vec<Slice>> = BTreeMap::new();
    for slice in &slices {
        let part = parts.entry(slice.header.acquisition).or_default();
        part.push(slice.clone());
    }
    let steps = steps(&slices);
    let largest = steps.iter().copied().fold(0.0, f64::max);
    let is_one_stack = steps.iter().all(|s| *s > SAME_PLACE_MM)
        && largest <= MAX_ACQUISITION_GAP * median(&steps).unwrap_or(0.0);
    let are_single = parts.values().all(|p| p.len() == 1);
    if parts.len() == 1 || is_one_stack || are_single {
        vec![slices]
    } else {
        parts.into_values().collect()
    }
}

fn steps(slices: &[Slice]) -> Vec<f64> {
    let pairs = slices.windows(2);
    pairs.map(|w| w[1].along_mm - w[0].along_mm).collect()
}

fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

fn without_gaps(stack: Stack) -> Vec<Stack> {
    let steps = steps(&stack.slices);
    let largest = median(&steps).map_or(f64::INFINITY, |m| m * MAX_GAP);
    let mut gaps = stack
        .slices
        .windows(2)
        .map(|w| w[1].along_mm - w[0].along_mm > largest);
    if !gaps.any(|is_gap| is_gap) {
        return vec![stack];
    }
    stack
        .slices
        .chunk_by(|a, b| b.along_mm - a.along_mm <= largest)
        .enumerate()
        .map(|(i, part)| {
            // Told once, with the first part.
            let only_first =
                |slices: &[Slice]| slices[..if i == 0 { slices.len() } else { 0 }].to_vec();
            let mut notes = stack.notes.clone();
            notes.push("the series has a wide gap; this is one side of it".to_owned());
            Stack {
                slices: part.to_vec(),
                notes,
                copies: only_first(&stack.copies),
                surplus: only_first(&stack.surplus),
            }
        })
        .collect()
}
