//! Which of the different images at each place belong together: the same phase of a moving
//! patient, the same acquisition, the same file.
//!
//! 1. The first attribute that has as many values as there are different images, and never the
//!    same value for two different images of one place: its values are the volumes.
//! 2. The numbers of the instances, if counting them runs through the places once a volume.
//! 3. The order in time at each place, if there are equally many everywhere and no clock reads
//!    the same twice at one place.
//! 4. The order of the files, and a warning.

use std::collections::{BTreeMap, BTreeSet};

use crate::moment::{KINDS, MADE};
use crate::same_place::Place;
use crate::slice::Slice;

/// Which volume each image belongs to, by place and image.
type Volumes = Vec<Vec<usize>>;

/// What tells different images of one place apart.
#[derive(Clone, Copy)]
enum Key {
    Study,
    Series,
    Acquisition,
    Time(usize),
    Dimension(usize),
    File,
    Folder,
}

#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Value {
    Number(i64),
    Text(String),
}

/// The slices of one volume at each place, and those that are not needed.
pub(crate) struct Sorted {
    /// By volume.
    pub(crate) volumes: Vec<Vec<Slice>>,
    pub(crate) copies: Vec<Slice>,
    /// Whether a volume may hold images of different times.
    pub(crate) is_guessed: bool,
}

/// Sorts the images of all places into as many volumes as needed.
pub(crate) fn sorted(places: &[Place]) -> Sorted {
    let count = places.iter().map(|p| p.kinds).max().unwrap_or(0);
    let (volumes, is_guessed) = match count {
        0 | 1 => (by_kind(places), false),
        _ => match told_apart(places, count) {
            Some(volumes) => (volumes, false),
            None => (by_kind(places), true),
        },
    };
    let mut sorted = Sorted {
        volumes: vec![Vec::new(); count],
        copies: Vec::new(),
        is_guessed,
    };
    for (place, volumes) in places.iter().zip(&volumes) {
        let mut taken = vec![false; count];
        for ((slice, _), volume) in place.images.iter().zip(volumes) {
            if std::mem::replace(&mut taken[*volume], true) {
                sorted.copies.push(slice.clone());
            } else {
                sorted.volumes[*volume].push(slice.clone());
            }
        }
        sorted.copies.extend(place.unreadable.iter().cloned());
    }
    sorted
}

/// The n-th different image of each place.
fn by_kind(places: &[Place]) -> Volumes {
    let kinds = |place: &Place| place.images.iter().map(|(_, kind)| *kind).collect();
    places.iter().map(kinds).collect()
}

fn told_apart(places: &[Place], count: usize) -> Option<Volumes> {
    let mut keys = vec![Key::Study, Key::Series, Key::Time(0), Key::Time(1)];
    keys.push(Key::Acquisition);
    keys.extend((2..KINDS).map(Key::Time));
    let images = || places.iter().flat_map(|p| &p.images);
    let dimensions = |(slice, _): &(Slice, usize)| {
        let moment = slice.header.moments.get(slice.frame);
        moment.map_or(0, |m| m.dimensions.len())
    };
    keys.extend((0..images().map(dimensions).max().unwrap_or(0)).map(Key::Dimension));
    keys.extend([Key::File, Key::Folder]);
    let clocks = (2..KINDS).filter(|kind| *kind != MADE).map(Key::Time);
    keys.iter()
        .find_map(|key| by_value(places, count, *key))
        .or_else(|| by_instance(places, count))
        .or_else(|| {
            let mut clocks = [Key::Acquisition].into_iter().chain(clocks);
            clocks.find_map(|key| by_order(places, count, key))
        })
}

/// The values of `key` as volumes, if there are `count` and each names one image of a place.
fn by_value(places: &[Place], count: usize, key: Key) -> Option<Volumes> {
    let mut values = BTreeSet::new();
    for place in places {
        let mut kinds = BTreeMap::new();
        for (slice, kind) in &place.images {
            let value = value(slice, key)?;
            if *kinds.entry(value.clone()).or_insert(*kind) != *kind {
                return None;
            }
            values.insert(value);
            if values.len() > count {
                return None;
            }
        }
    }
    if values.len() != count {
        return None;
    }
    let numbers: BTreeMap<Value, usize> = values.into_iter().zip(0..).collect();
    let number = |(slice, _): &(Slice, usize)| Some(numbers[&value(slice, key)?]);
    let volumes = |place: &Place| place.images.iter().map(number).collect();
    places.iter().map(volumes).collect()
}

/// Volumes by counting the instances: a new one begins where the count turns back or stays at a
/// place. Copies are counted only where they may be images of another time that look the same.
fn by_instance(places: &[Place], count: usize) -> Option<Volumes> {
    counted(places, count, true).or_else(|| counted(places, count, false))
}

fn counted(places: &[Place], count: usize, with_copies: bool) -> Option<Volumes> {
    let mut order = Vec::new();
    for (at, place) in places.iter().enumerate() {
        let mut kinds = BTreeSet::new();
        for (number, (slice, kind)) in place.images.iter().enumerate() {
            if kinds.insert(*kind) || with_copies {
                let id = if with_copies { number } else { *kind };
                order.push((slice.header.instance?, slice.frame, at, id));
            }
        }
    }
    order.sort_unstable();
    let is_counted = order
        .windows(2)
        .all(|w| (w[0].0, w[0].1) != (w[1].0, w[1].1));
    let mut numbers = BTreeMap::new();
    let (mut volume, mut last, mut is_rising, mut stayed) = (0, None, None, None);
    for (_, _, at, id) in order {
        if let Some(last) = last {
            let rises = at > last;
            if at == last || is_rising.is_some_and(|r| r != rises) {
                stayed = is_rising.filter(|_| at == last);
                (volume, is_rising) = (volume + 1, None);
            } else if stayed.take() == Some(rises) {
                // Counted on from place to place, not from volume to volume.
                return None;
            } else {
                is_rising = Some(rises);
            }
        }
        last = Some(at);
        numbers.insert((at, id), volume);
    }
    let volumes = |(at, place): (usize, &Place)| {
        let images = place.images.iter().enumerate();
        let id = |number: usize, kind: usize| if with_copies { number } else { kind };
        images
            .map(|(number, (_, kind))| numbers[&(at, id(number, *kind))])
            .collect()
    };
    (is_counted && volume + 1 == count).then(|| places.iter().enumerate().map(volumes).collect())
}

/// The n-th in time at each place.
fn by_order(places: &[Place], count: usize, key: Key) -> Option<Volumes> {
    let volumes = |place: &Place| {
        let values: Option<Vec<Value>> = place.images.iter().map(|(s, _)| value(s, key)).collect();
        let values = values?;
        let ranks: BTreeMap<&Value, usize> = {
            let all: BTreeSet<&Value> = values.iter().collect();
            all.into_iter().zip(0..).collect()
        };
        let is_separate = ranks.len() == count && values.len() == count;
        is_separate.then(|| values.iter().map(|v| ranks[v]).collect())
    };
    places.iter().map(volumes).collect()
}

fn value(slice: &Slice, key: Key) -> Option<Value> {
    let header = &slice.header;
    let moment = header.moments.get(slice.frame)?;
    let path = |path: &std::path::Path| Value::Text(path.to_string_lossy().into_owned());
    Some(match key {
        Key::Study => Value::Text(header.study_uid.clone()),
        Key::Series => Value::Text(header.series_uid.clone()),
        Key::Acquisition => Value::Number(header.acquisition?),
        Key::Time(kind) => Value::Number(moment.times[kind]?),
        Key::Dimension(index) => Value::Number(i64::from(*moment.dimensions.get(index)?)),
        Key::File => path(&header.path),
        Key::Folder => path(header.path.parent()?),
    })
}
