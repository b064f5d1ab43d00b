//! Thresholds from the literature, by name.
//!
//! Only values that a publication used on clinical CT in Hounsfield units are here. They hold for
//! its scanners and patients: other tube voltages and kernels move them by tens of HU, and
//! cone-beam scanners have other units altogether. None is given for trabecular bone or soft
//! tissue: what is published of them are mean values, not borders.

use std::fmt;

use crate::HuThreshold;

/// A threshold from the literature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ThresholdPreset {
    /// Skulls, 350 HU.
    Skull,
    /// Compact bone of limbs, 600 HU.
    Cortical,
    /// Skulls with their thin walls, 150 HU.
    ThinBone,
    /// Dentine and enamel, 1400 HU.
    Teeth,
}

impl ThresholdPreset {
    /// Every preset, the most usual first.
    pub const ALL: [Self; 4] = [Self::Skull, Self::Cortical, Self::ThinBone, Self::Teeth];

    /// The name used on the command line, in Python and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Skull => "skull",
            Self::Cortical => "cortical",
            Self::ThinBone => "thin-bone",
            Self::Teeth => "teeth",
        }
    }

    /// What it is for, and its limits, in one line.
    pub fn description(self) -> &'static str {
        match self {
            Self::Skull => "skulls; walls thinner than a pixel or two get holes",
            Self::Cortical => "compact bone of femur and humerus; leaves spongy bone out",
            Self::ThinBone => {
                "skulls with thin walls kept; lets calcified and contrast-filled soft tissue in"
            }
            Self::Teeth => "dentine and enamel against the pulp; bone stays out",
        }
    }

    /// The publication that used it.
    pub fn source(self) -> &'static str {
        match self {
            Self::Skull => "Tilotta et al., Forensic Science International 191, 2009",
            Self::Cortical => {
                "Aamodt et al., Journal of Bone and Joint Surgery 81-B, 1999; Lim Fat et al., Skeletal Radiology 41, 2012"
            }
            Self::ThinBone => "Li et al., Scientific Data 8:36, 2021",
            Self::Teeth => "Sakuma et al., Journal of Forensic Sciences 58, 2013",
        }
    }

    /// Its value.
    #[expect(clippy::missing_panics_doc, reason = "the values are finite")]
    pub fn threshold(self) -> HuThreshold {
        let hu = match self {
            Self::Skull => 350.0,
            Self::Cortical => 600.0,
            Self::ThinBone => 150.0,
            Self::Teeth => 1400.0,
        };
        HuThreshold::new(hu).expect("presets are finite: anything else is a bug")
    }
}

impl fmt::Display for ThresholdPreset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_has_a_source_with_its_year() {
        for preset in ThresholdPreset::ALL {
            assert!(preset.source().contains(char::is_numeric));
        }
    }
}
