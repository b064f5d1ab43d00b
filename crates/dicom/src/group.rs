//! Headers to stacks: groups of slices that make one volume.
//!
//! 1. [`alike`]: same study, series, frame of reference, image type and size; orientation and
//!    pixel spacing within rounding.
//! 2. [`by_acquisition`]: acquisitions stay together where they follow one another, and apart
//!    where they overlap.
//! 3. [`apart`](crate::same_place::apart): slices at the same place are dropped if their pixels
//!    are the same, else sorted by time into stacks of their own.
//! 4. [`without_gaps`]: a stack ends where the next slice is too far away to be a neighbour.

use std::collections::BTreeMap;
use std::sync::Arc;

use bonemesh_task::{Cancelled, Task};

use crate::acquisitions::by_acquisition;
use crate::header::{Frame, Header};
use crate::same_place::apart;
use crate::slice::Slice;
use crate::vector::{cross, dot};

/// Largest difference of two orientations' components that is rounding.
const SAME_ORIENTATION: f64 = 1e-3;

/// Largest relative difference of two spacings that is rounding.
const SAME_SPACING: f64 = 1e-3;

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
    let mut by_name: BTreeMap<_, Alike> = BTreeMap::new();
    for header in headers {
        let names = match grouping {
            Grouping::ByUid => [
                &header.study_uid,
                &header.series_uid,
                &header.reference_uid,
                &header.image_type,
            ]
            .map(String::clone),
            Grouping::WholeFolder => Default::default(),
        };
        let key = (names, header.layout.rows, header.layout.columns);
        let groups = by_name.entry(key).or_default();
        for (index, frame) in header.frames.iter().enumerate() {
            let at = groups.find_or_add(frame);
            let (first, slices) = &mut groups.groups[at];
            let [x, y] = first.orientation;
            // One normal for all, or rounding would disorder the slices.
            let along_mm = dot(frame.position, cross(x, y));
            slices.push(Slice {
                header: Arc::clone(&header),
                frame: index,
                along_mm,
            });
        }
    }
    by_name
        .into_values()
        .flat_map(|g| g.groups)
        .map(|(_, slices)| ordered(slices))
        .collect()
}

/// Groups of slices like their first, found without looking at every group.
#[derive(Default)]
struct Alike {
    groups: Vec<(Frame, Vec<Slice>)>,
    /// Numbers of the groups by the hashes of their first frames.
    by_hash: BTreeMap<i64, Vec<usize>>,
}

impl Alike {
    /// The first group that the frame is like.
    fn find_or_add(&mut self, frame: &Frame) -> usize {
        let hash = near_hash(frame);
        let near = self.by_hash.range(hash - HASH_WIDTH..=hash + HASH_WIDTH);
        let alike = near
            .flat_map(|(_, numbers)| numbers)
            .filter(|n| is_alike(&self.groups[**n].0, frame));
        if let Some(first) = alike.min() {
            return *first;
        }
        let number = self.groups.len();
        self.groups.push((frame.clone(), Vec::new()));
        self.by_hash.entry(hash).or_default().push(number);
        number
    }
}

/// Weights of orientation and spacing in [`near_hash`], without common measure so that frames
/// that differ seldom agree in their sum.
const HASH_WEIGHTS: [f64; 8] = [1.0, 0.618, 0.877, 0.472, 0.755, 0.549, 0.926, 0.671];

/// Most that the hashes of frames that are alike differ: each weight, below 6 in all, times what
/// is rounding, in millionths; and as much again for relative differences and rounding.
const HASH_WIDTH: i64 = 12_000;

/// A number that is near for frames that are alike.
fn near_hash(frame: &Frame) -> i64 {
    let spacing = frame.spacing.map(f64::ln);
    let values = frame.orientation.as_flattened().iter().chain(&spacing);
    let sum: f64 = values.zip(HASH_WEIGHTS).map(|(v, w)| v * w).sum();
    (sum * 1e6).round() as i64
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

/// Distances between neighbours.
pub(crate) fn steps(along_mm: &[f64]) -> Vec<f64> {
    along_mm.windows(2).map(|w| w[1] - w[0]).collect()
}

pub(crate) fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

fn without_gaps(stack: Stack) -> Vec<Stack> {
    let along: Vec<f64> = stack.slices.iter().map(|s| s.along_mm).collect();
    let largest = median(&steps(&along)).map_or(f64::INFINITY, |m| m * MAX_GAP);
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
