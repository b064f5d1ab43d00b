//! Which of several series is meant.

use std::fmt;
use std::str::FromStr;

use crate::{DicomError, Scan, Series};

/// Slices up to which a series is no rival of a longer one: localizers, dose marks.
const MAX_LOCALIZER: usize = 3;

/// How many times longer a series must be for a short one not to be its rival.
const FAR_LONGER: usize = 20;

/// Series that an error message lists.
const MAX_LISTED: usize = 8;

/// Longest UID that the standard allows.
const MAX_UID: usize = 64;

/// A series by its number or its UID.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum SeriesChoice {
    /// Number in the [`Scan`], 1 is the largest.
    Number(usize),
    /// Series Instance UID.
    Uid(String),
}

impl fmt::Display for SeriesChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Uid(uid) => write!(f, "{uid}"),
        }
    }
}

impl FromStr for SeriesChoice {
    type Err = DicomError;

    fn from_str(text: &str) -> Result<Self, DicomError> {
        let text = text.trim();
        let unusable = || DicomError::Choice(text.to_owned());
        if text.contains('.') {
            let is_uid = text.len() <= MAX_UID
                && text
                    .split('.')
                    .all(|part| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit()));
            return is_uid
                .then(|| Self::Uid(text.to_owned()))
                .ok_or_else(unusable);
        }
        match text.parse() {
            Ok(number) if number > 0 => Ok(Self::Number(number)),
            _ => Err(unusable()),
        }
    }
}

impl Scan {
    /// The series asked for, or the only one that can be meant.
    ///
    /// # Errors
    /// [`DicomError::NoSuchSeries`], and [`DicomError::Ambiguous`] where nothing (or the UID of
    /// several volumes) was asked for and more than one volume is plausible: all but those of
    /// three slices or fewer and those twenty times shorter than the longest.
    pub fn choose(&self, choice: Option<&SeriesChoice>) -> Result<&Series, DicomError> {
        let candidates: Vec<&Series> = match choice {
            None => self.series.iter().collect(),
            Some(SeriesChoice::Number(n)) => {
                let chosen = n.checked_sub(1).and_then(|i| self.series.get(i));
                chosen.into_iter().collect()
            }
            Some(SeriesChoice::Uid(uid)) => self.series.iter().filter(|s| s.uid == *uid).collect(),
        };
        match (&plausible(candidates.into_iter())[..], choice) {
            ([only], _) => Ok(only),
            ([], choice) => Err(DicomError::NoSuchSeries {
                wanted: choice.map_or_else(String::new, ToString::to_string),
                choices: listed(&self.series.iter().collect::<Vec<_>>()),
            }),
            (several, _) => Err(DicomError::Ambiguous {
                choices: listed(several),
            }),
        }
    }
}

/// The series that could be meant: no localizers, nothing far shorter than the longest.
pub(crate) fn plausible<'a>(
    candidates: impl Iterator<Item = &'a Series> + Clone,
) -> Vec<&'a Series> {
    let slices = candidates.clone().map(|s| s.slices_found);
    let longest = slices.max().unwrap_or(0);
    let is_plausible = |s: &&Series| {
        longest <= MAX_LOCALIZER
            || (s.slices_found > MAX_LOCALIZER && s.slices_found * FAR_LONGER > longest)
    };
    candidates.filter(is_plausible).collect()
}

fn listed(series: &[&Series]) -> String {
    if series.is_empty() {
        return "none".to_owned();
    }
    let mut lines: Vec<String> = series
        .iter()
        .take(MAX_LISTED)
        .map(|s| s.in_words())
        .collect();
    if series.len() > MAX_LISTED {
        lines.push(format!("and {} more", series.len() - MAX_LISTED));
    }
    lines.join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_and_a_uid_are_told_apart() {
        assert_eq!(
            "2".parse::<SeriesChoice>().unwrap(),
            SeriesChoice::Number(2)
        );
        let uid = "1.2.840.113619".parse::<SeriesChoice>().unwrap();
        assert_eq!(uid, SeriesChoice::Uid("1.2.840.113619".to_owned()));
        for text in ["", "0", "-1", "head", "1..2", "1.2.x", &"1.".repeat(40)] {
            assert!(
                matches!(text.parse::<SeriesChoice>(), Err(DicomError::Choice(_))),
                "{text}"
            );
        }
    }
}
