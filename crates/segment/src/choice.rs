//! A threshold as it is chosen: a number, a name, or a way to find it.

use std::fmt;
use std::str::FromStr;

use crate::{HuThreshold, SegmentError, ThresholdPreset};

/// How a threshold is found in a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ThresholdFinder {
    /// The first of the others that finds one.
    Auto,
    /// Halfway between soft tissue and bone at their edges ([`edge_threshold`](crate::edge_threshold)).
    Edges,
    /// The upper of three classes ([`multi_otsu`](crate::multi_otsu)).
    MultiOtsu,
    /// Between two classes ([`otsu`](crate::otsu)): of a patient in air, the body.
    Otsu,
}

impl ThresholdFinder {
    /// Every way, the recommended one first.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Edges, Self::MultiOtsu, Self::Otsu];

    /// The name used on the command line, in Python and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Edges => "edges",
            Self::MultiOtsu => "multi-otsu",
            Self::Otsu => "otsu",
        }
    }
}

impl fmt::Display for ThresholdFinder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A threshold as it is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ThresholdChoice {
    /// A number.
    Given(HuThreshold),
    /// A published one.
    Preset(ThresholdPreset),
    /// To be found in the volume.
    Found(ThresholdFinder),
}

impl ThresholdChoice {
    /// Every name that stands for a threshold.
    pub fn names() -> impl Iterator<Item = &'static str> {
        let finders = ThresholdFinder::ALL.map(ThresholdFinder::name);
        let presets = ThresholdPreset::ALL.map(ThresholdPreset::name);
        finders.into_iter().chain(presets)
    }
}

impl FromStr for ThresholdChoice {
    type Err = SegmentError;

    fn from_str(text: &str) -> Result<Self, SegmentError> {
        if let Ok(hu) = text.parse() {
            return HuThreshold::new(hu).map(Self::Given);
        }
        let found = ThresholdFinder::ALL.into_iter().find(|f| f.name() == text);
        let given = || ThresholdPreset::ALL.into_iter().find(|p| p.name() == text);
        found
            .map(Self::Found)
            .or_else(|| given().map(Self::Preset))
            .ok_or_else(|| SegmentError::NoSuchThreshold(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_and_number_is_a_choice() {
        for name in ThresholdChoice::names() {
            match name.parse::<ThresholdChoice>().expect("it is a name") {
                ThresholdChoice::Found(finder) => assert_eq!(finder.to_string(), name),
                ThresholdChoice::Preset(preset) => assert_eq!(preset.to_string(), name),
                ThresholdChoice::Given(_) => panic!("{name} is no number"),
            }
        }
        let number = HuThreshold::new(-12.5).expect("it is finite");
        let choice: ThresholdChoice = "-12.5".parse().expect("it is a number");
        assert_eq!(choice, ThresholdChoice::Given(number));
    }

    #[test]
    fn anything_else_is_refused_with_all_names() {
        let message = "bones".parse::<ThresholdChoice>().unwrap_err().to_string();
        assert!(ThresholdChoice::names().all(|name| message.contains(name)));
        for text in ["nan", "inf", "-inf"] {
            let refused = text.parse::<ThresholdChoice>();
            assert!(matches!(refused, Err(SegmentError::Threshold(_))));
        }
    }
}
