//! Slices at the same place: copies of one another, or images of different times.

use std::hash::{DefaultHasher, Hash, Hasher};

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::group::Stack;
use crate::phases::{Sorted, sorted};
use crate::slice::Slice;

/// Slices closer than this (mm) are at the same place.
pub(crate) const SAME_PLACE_MM: f64 = 1e-3;

/// Most slices at one place that are looked at: scans of moving or perfused organs reach 60, and
/// a folder of any number of files must not keep us for hours.
const MAX_AT_ONE_PLACE: usize = 256;

/// The slices of one place.
pub(crate) struct Place {
    /// Those that can be read, each with a number that only slices with the same pixels share.
    pub(crate) images: Vec<(Slice, usize)>,
    /// How many different images there are.
    pub(crate) kinds: usize,
    /// Those that cannot be read.
    pub(crate) unreadable: Vec<Slice>,
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
    let Sorted {
        volumes,
        copies,
        is_guessed,
    } = sorted(&places);
    let surplus: Vec<Slice> = places.into_iter().flat_map(|p| p.surplus).collect();
    let notes = notes(&copies, &surplus);
    let count = volumes.len();
    let with_notes = |(index, slices): (usize, Vec<Slice>)| {
        let mut notes = notes.clone();
        if count > 1 {
            notes.push(format!(
                "the series has different slices at the same places; this is image {} of {count} there",
                index + 1
            ));
        }
        if is_guessed {
            notes.push(
                "nothing in the files tells the times apart, so images of different times may be mixed; look at the result"
                    .to_owned(),
            );
        }
        Stack {
            slices,
            notes,
            copies: Vec::new(),
            surplus: Vec::new(),
        }
    };
    let mut stacks: Vec<Stack> = volumes.into_iter().enumerate().map(with_notes).collect();
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
    let mut found = Place {
        images: Vec::new(),
        kinds: 0,
        unreadable: Vec::new(),
        surplus: surplus.to_vec(),
    };
    // The first slice of each kind.
    let mut kinds: Vec<(Slice, u64)> = Vec::new();
    for slice in seen {
        task.check()?;
        let kind = if place.len() == 1 {
            Some(0)
        } else {
            kind(slice, &mut kinds)
        };
        match kind {
            Some(kind) => found.images.push((slice.clone(), kind)),
            None => found.unreadable.push(slice.clone()),
        }
    }
    if found.images.is_empty() {
        // Reading says what is wrong with it.
        found.images.push((found.unreadable.remove(0), 0));
    }
    found.kinds = kinds.len().max(1);
    Ok(found)
}

/// Which of `kinds` the slice's pixels are, a new one if none; nothing if they cannot be read.
///
/// Digests instead of pixels are kept, so that any number of slices takes the memory of two;
/// equal digests are confirmed by the pixels themselves.
fn kind(slice: &Slice, kinds: &mut Vec<(Slice, u64)>) -> Option<usize> {
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
    Some(kinds.iter().position(is_same).unwrap_or_else(|| {
        kinds.push((slice.clone(), digest));
        kinds.len() - 1
    }))
}
