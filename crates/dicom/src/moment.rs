//! When a frame was taken, as far as its header says: only to order and to tell apart, never shown.

use std::fmt;

use dicom_core::Tag;
use dicom_dictionary_std::tags;

use crate::elements::{Elements, Values, text};

/// Most dimension indices of a frame that are looked at; real files have 2 to 5.
const MAX_DIMENSIONS: usize = 8;

/// Kinds of [`Moment::times`]: those that count phases first, clocks last.
const TIMES: [(Tag, Form); 8] = [
    (tags::TEMPORAL_POSITION_IDENTIFIER, Form::Number),
    (tags::TEMPORAL_POSITION_INDEX, Form::Binary),
    (tags::ACQUISITION_TIME, Form::Time),
    (tags::ACQUISITION_DATE_TIME, Form::DateTime),
    (tags::TRIGGER_TIME, Form::Number),
    (tags::FRAME_REFERENCE_DATE_TIME, Form::DateTime),
    (tags::FRAME_ACQUISITION_DATE_TIME, Form::DateTime),
    (tags::CONTENT_TIME, Form::Time),
];

/// Number of kinds of times.
pub(crate) const KINDS: usize = TIMES.len();

/// The kind of time that says when an image was made from the measurement, in any order.
pub(crate) const MADE: usize = KINDS - 1;

#[derive(Clone, Copy)]
enum Form {
    Number,
    Binary,
    Time,
    DateTime,
}

/// What tells when a frame was taken.
#[derive(Clone, Default)]
pub(crate) struct Moment {
    /// Each kind of time as a number that grows with time, of no further meaning.
    pub(crate) times: [Option<i64>; KINDS],
    /// Place among the frames in each of the dimensions the file has chosen.
    pub(crate) dimensions: Vec<u32>,
}

/// Nothing: times are nobody's business.
impl fmt::Debug for Moment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Moment")
    }
}

/// The moments of all frames of a data set.
pub(crate) fn moments(e: &Elements) -> Vec<Moment> {
    if e.frames.is_empty() {
        return vec![moment(e, [&e.values, &e.values, &e.values])];
    }
    let frames = e.frames.iter();
    frames
        .map(|own| moment(e, [own, &e.shared, &e.values]))
        .collect()
}

fn moment(e: &Elements, values: [&Values; 3]) -> Moment {
    let first = |(tag, form): (Tag, Form)| values.into_iter().find_map(|v| number(e, v, tag, form));
    let mut dimensions = e.u32s(values[0], tags::DIMENSION_INDEX_VALUES);
    dimensions.truncate(MAX_DIMENSIONS);
    Moment {
        times: TIMES.map(first),
        dimensions,
    }
}

fn number(e: &Elements, values: &Values, tag: Tag, form: Form) -> Option<i64> {
    if let Form::Binary = form {
        return e.u32s(values, tag).first().map(|n| i64::from(*n));
    }
    let text = text(values, tag)?;
    let text = match form {
        Form::DateTime => {
            // Without century and time zone, so that microseconds fit.
            let end = text.find(['+', '-', '&']).unwrap_or(text.len());
            text.get(2..end)?.to_owned()
        }
        Form::Time => text.replace(':', ""),
        _ => text,
    };
    let number = text.parse::<f64>().ok().filter(|n| n.is_finite())?;
    Some((number * 1e6).round() as i64)
}
