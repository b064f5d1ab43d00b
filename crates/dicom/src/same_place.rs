//! Slices at the same place: copies of one another, or images of different times.

use std::hash::{DefaultHasher, Hash, Hasher};

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::group::Stack;
use crate::slice::Slice;

/// Slices closer than this (mm) are at the same place.
pub(crate) const SAME_PLACE_MM: f64 = 1e-3;

/// Most slices at one place that are looked at: scans of moving or perfused organs reach 60, and
/// a folder of any number of files must not keep us for hours.
const MAX_AT_ONE_PLACE: usize = 256;

/// The slices of one place.
struct Place {
    /// Those that differ.
    kept: Vec<Slice>,
    /// Those that are copies or cannot be read.
    copies: Vec<Slice>,
    /// Those that nobody looked at.
    surplus: Vec<Slice>,
}

/// Drops copies, and makes a stack of each image where those at the same place differ.
pub(crate) fn apart(slices: &[Slice], task: &Task) -> Result<Vec<Stack>, Cancelled> {
    let places: Vec<&[Slice]> = slices
        .chunk_by(|a, b| b.along_mm - a.along_mm <= SAME_PLACE_MM)
        .collect();
    let places = places
        .into_par_iter()
        .map(|place| different(place, task))
        .collect::<Result<Vec<_>, Cancelled>>()?;
    let copies: Vec<Slice> = places.iter().flat_map(|p| p.copies.clone()).collect();
    let surplus: Vec<Slice> = places.iter().flat_map(|p| p.surplus.clone()).collect();
    let notes = notes(&copies, &surplus);
    let layers = places.iter().map(|p| p.kept.len()).max().unwrap_or(0);
    let mut stacks: Vec<Stack> = (0..layers)
        .map(|layer| Stack {
            slices: places
                .iter()
                .filter_map(|p| p.kept.get(layer).cloned())
                .collect(),
            notes: notes.clone(),
            copies: Vec::new(),
            surplus: Vec::new(),
        })
        .collect();
    if layers > 1 {
        for (layer, stack) in stacks.iter_mut().enumerate() {
            stack.notes.push(format!(
                "the series has different slices at the same places; this is image {} of {layers} there",
                layer + 1
            ));
        }
    }
    if let Some(first) = stacks.first_mut() {
        first.copies = copies;
        first.surplus = surplus;
    }
    Ok(stacks)
}

fn notes(copies: &[Slice], surplus: &[Slice]) -> Vec<String> {
    let mut notes = Vec::new();
    if !copies.is_empty() {
        let names: Vec<String> = copies.iter().take(3).map(Slice::name).collect();
        let more = if copies.len() > 3 { ", ..." } else { "" };
        notes.push(format!(
            "{} {} at the place of another and the same or unreadable, dropped ({}{more})",
            copies.len(),
            if copies.len() == 1 {
                "slice is"
            } else {
                "slices are"
            },
            names.join(", ")
        ));
    }
    if !surplus.is_empty() {
        notes.push(format!(
            "more than {MAX_AT_ONE_PLACE} slices are at one place; {} were left out unseen",
            surplus.len()
        ));
    }
    notes
}

fn different(place: &[Slice], task: &Task) -> Result<Place, Cancelled> {
    let (seen, surplus) = place.split_at(place.len().min(MAX_AT_ONE_PLACE));
    let mut kept: Vec<(Slice, u64)> = Vec::new();
    let mut copies = Vec::new();
    for slice in seen {
        task.check()?;
        let digest = if place.len() == 1 {
            Some(0)
        } else {
            digest_if_new(slice, &kept)
        };
        match digest {
            Some(digest) => kept.push((slice.clone(), digest)),
            None => copies.push(slice.clone()),
        }
    }
    if kept.is_empty() {
        // Reading says what is wrong with it.
        kept.push((copies.remove(0), 0));
    }
    Ok(Place {
        kept: kept.into_iter().map(|(slice, _)| slice).collect(),
        copies,
        surplus: surplus.to_vec(),
    })
}

/// A digest of the slice's pixels, if they can be read and none of `kept` has the same.
///
/// Digests instead of pixels are kept, so that any number of slices takes the memory of two;
/// equal digests are confirmed by the pixels themselves.
fn digest_if_new(slice: &Slice, kept: &[(Slice, u64)]) -> Option<u64> {
    let hu: Vec<f32> = slice.decode_whole().ok()?;
    let mut hasher = DefaultHasher::new();
    for value in &hu {
        // Plus and minus zero are the same value.
        (value + 0.0).to_bits().hash(&mut hasher);
    }
    let digest = hasher.finish();
    let is_same = |(other, of_other): &(Slice, u64)| {
        *of_other == digest
            && other
                .decode_whole()
                .is_ok_and(|other: Vec<f32>| other == hu)
    };
    (!kept.iter().any(is_same)).then_some(digest)
}
