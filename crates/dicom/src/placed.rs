//! Files that say less than the other files of their series.
//!
//! What such a file does not say could only be guessed, and a guess beside knowledge shows
//! nowhere: a slice placed by its location among slices placed by their positions lies somewhere
//! else than they do. It is left out, and its place is filled as that of any missing slice.

use std::collections::BTreeMap;

use crate::group::Grouping;
use crate::header::{Header, Placing};
use crate::hounsfield::Known;
use crate::scan::LeftOut;

/// How much a header says of one subject, and why saying less than others is too little.
struct Subject {
    amount: fn(&Header) -> u8,
    reason: &'static str,
}

const SUBJECTS: [Subject; 3] = [
    Subject {
        amount: |h| u8::from(h.placing == Placing::Position),
        reason: "no position (Image Position Patient), which the other slices of its series have",
    },
    Subject {
        amount: |h| u8::from(h.placing != Placing::Location),
        reason: "no orientation (Image Orientation Patient), which the other slices of its series have",
    },
    Subject {
        amount: |h| {
            let known = h.frames.iter().map(|f| f.rescale.known).min();
            match known.unwrap_or(Known::Nothing) {
                Known::Nothing => 0,
                Known::Slope => 1,
                Known::Intercept => 2,
                Known::Both => 3,
            }
        },
        reason: "no rescale (Rescale Slope, Rescale Intercept), which the other slices of its series have",
    },
];

/// Keeps those files of each series that say as much as any; the others are left out.
pub(crate) fn consistent(
    headers: Vec<Header>,
    grouping: Grouping,
    left_out: &mut Vec<LeftOut>,
) -> Vec<Header> {
    let mut series: BTreeMap<_, Vec<Header>> = BTreeMap::new();
    for header in headers {
        let name = match grouping {
            Grouping::ByUid => (header.series_uid.clone(), header.image_type.clone()),
            Grouping::WholeFolder => Default::default(),
        };
        let key = (name, header.layout.rows, header.layout.columns);
        series.entry(key).or_default().push(header);
    }
    let mut kept = Vec::new();
    for mut headers in series.into_values() {
        for subject in &SUBJECTS {
            headers = best(headers, subject, left_out);
        }
        kept.extend(headers);
    }
    kept
}

/// Headers that say the most of one subject; they are told of those that do not.
fn best(headers: Vec<Header>, subject: &Subject, left_out: &mut Vec<LeftOut>) -> Vec<Header> {
    let most = headers.iter().map(subject.amount).max();
    let is_best = |h: &Header| Some((subject.amount)(h)) == most;
    let (mut best, poor): (Vec<Header>, Vec<Header>) = headers.into_iter().partition(is_best);
    let Some(first) = poor.first() else {
        return best;
    };
    let name = first.path.file_name().unwrap_or_default().to_string_lossy();
    let note = format!(
        "{} {} left out, first {name}: {}",
        poor.len(),
        if poor.len() == 1 {
            "file is"
        } else {
            "files are"
        },
        subject.reason
    );
    for header in &mut best {
        header.notes.push(note.clone());
    }
    left_out.extend(poor.into_iter().map(|header| LeftOut {
        path: header.path,
        reason: subject.reason.to_owned(),
    }));
    best
}
