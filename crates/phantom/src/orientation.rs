//! How the slices lie in the patient.

use std::fmt;
use std::str::FromStr;

use crate::PhantomError;
use crate::vector::{Vec3, dot, length, rotate};

/// Directions of the grid in the patient (DICOM LPS); each a unit vector.
///
/// Columns and rows are at right angles; the step from slice to slice need not be at right
/// angles to them (gantry tilt).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    /// Where the column index grows.
    pub column_direction: [f64; 3],
    /// Where the row index grows.
    pub row_direction: [f64; 3],
    /// Where the slice index grows.
    pub slice_direction: [f64; 3],
    /// How the patient lies on the table.
    pub patient_position: PatientPosition,
}

/// How the patient lies on the scanner's table; written as DICOM's `PatientPosition`.
///
/// It says which side the table was on, nothing more: directions are the patient's in any case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum PatientPosition {
    /// Head first, on the back.
    #[default]
    HeadFirstSupine,
    /// Head first, on the belly.
    HeadFirstProne,
    /// Head first, on the left side.
    HeadFirstDecubitusLeft,
    /// Head first, on the right side.
    HeadFirstDecubitusRight,
    /// Feet first, on the back.
    FeetFirstSupine,
}

impl PatientPosition {
    /// The defined term of DICOM PS3.3 C.7.3.1.1.2.
    pub fn code(self) -> &'static str {
        match self {
            Self::HeadFirstSupine => "HFS",
            Self::HeadFirstProne => "HFP",
            Self::HeadFirstDecubitusLeft => "HFDL",
            Self::HeadFirstDecubitusRight => "HFDR",
            Self::FeetFirstSupine => "FFS",
        }
    }
}

const X: Vec3 = [1.0, 0.0, 0.0];
const Y: Vec3 = [0.0, 1.0, 0.0];
const Z: Vec3 = [0.0, 0.0, 1.0];

fn opposite(direction: Vec3) -> Vec3 {
    // 0 minus 0 is 0, its negative is not: the axes stay free of -0.
    direction.map(|v| 0.0 - v)
}

/// Orientations by name, with one line each.
pub const ORIENTATIONS: [(&str, &str); 10] = [
    ("axial", "feet to head, as most scanners write it"),
    ("reversed", "axial, but head to feet (a left-handed grid)"),
    ("sagittal", "slices from the patient's left to the right"),
    ("coronal", "slices from front to back"),
    (
        "oblique",
        "axial, turned by 20 degrees about a slanted axis",
    ),
    (
        "tilted",
        "axial with 15 degrees of gantry tilt (a sheared grid)",
    ),
    (
        "feet-first",
        "feet first, columns from the patient's left to the right",
    ),
    (
        "prone",
        "axial, the patient on the belly: rows run from back to front",
    ),
    (
        "decubitus-left",
        "axial, the patient on the left side: rows run from right to left",
    ),
    (
        "decubitus-right",
        "axial, the patient on the right side: rows run from left to right",
    ),
];

impl Orientation {
    /// Axial slices from the feet to the head.
    pub fn axial() -> Self {
        Self::of(X, Y, Z)
    }

    /// Sagittal slices from left to right: columns run to the back, rows down.
    pub fn sagittal() -> Self {
        Self::of(Y, opposite(Z), opposite(X))
    }

    /// Coronal slices from front to back: columns run to the left, rows down.
    pub fn coronal() -> Self {
        Self::of(X, opposite(Z), Y)
    }

    /// Axial slices of a patient who lies in `position`: rows run down to the table, and the
    /// slices, seen from the feet, to the head.
    pub fn lying(position: PatientPosition) -> Self {
        let (columns, rows) = match position {
            PatientPosition::HeadFirstSupine => (X, Y),
            PatientPosition::HeadFirstProne => (opposite(X), opposite(Y)),
            PatientPosition::HeadFirstDecubitusLeft => (opposite(Y), X),
            PatientPosition::HeadFirstDecubitusRight => (Y, opposite(X)),
            // The scanner is looked into from its other end.
            PatientPosition::FeetFirstSupine => (opposite(X), Y),
        };
        Self {
            patient_position: position,
            ..Self::of(columns, rows, Z)
        }
    }

    /// The same grid, its slices counted from the other end.
    #[must_use]
    pub fn reversed(self) -> Self {
        let slice_direction = opposite(self.slice_direction);
        Self {
            slice_direction,
            ..self
        }
    }

    /// Columns and rows turned about the column direction; the table still moves as before.
    #[must_use]
    pub fn tilted(self, degrees: f64) -> Self {
        let turn = degrees.to_radians();
        let row_direction = rotate(self.row_direction, self.column_direction, turn);
        Self {
            row_direction,
            ..self
        }
    }

    /// The whole grid turned about a unit vector.
    #[must_use]
    pub fn rotated(self, axis: [f64; 3], degrees: f64) -> Self {
        let turn = |v| rotate(v, axis, degrees.to_radians());
        Self {
            column_direction: turn(self.column_direction),
            row_direction: turn(self.row_direction),
            slice_direction: turn(self.slice_direction),
            ..self
        }
    }

    fn of(column_direction: Vec3, row_direction: Vec3, slice_direction: Vec3) -> Self {
        Self {
            column_direction,
            row_direction,
            slice_direction,
            patient_position: PatientPosition::default(),
        }
    }

    pub(crate) fn check(&self) -> Result<(), PhantomError> {
        let (u, v, w) = (
            self.column_direction,
            self.row_direction,
            self.slice_direction,
        );
        for direction in [u, v, w] {
            let long = length(direction);
            if (long - 1.0).abs() > 1e-9 || long.is_nan() {
                return Err(PhantomError::Setting {
                    setting: "length of an orientation's direction",
                    value: long,
                    allowed: "1",
                });
            }
        }
        let slant = dot(u, v);
        if slant.abs() > 1e-9 {
            return Err(PhantomError::Setting {
                setting: "cosine between columns and rows",
                value: slant,
                allowed: "0: DICOM has no other images",
            });
        }
        Ok(())
    }
}

impl Default for Orientation {
    fn default() -> Self {
        Self::axial()
    }
}

impl FromStr for Orientation {
    type Err = PhantomError;

    fn from_str(name: &str) -> Result<Self, PhantomError> {
        let axial = Self::axial();
        Ok(match name {
            "axial" => axial,
            "reversed" => axial.reversed(),
            "sagittal" => Self::sagittal(),
            "coronal" => Self::coronal(),
            "oblique" => axial.rotated([0.48, 0.64, 0.6], 20.0),
            "tilted" => axial.tilted(15.0),
            "feet-first" => Self::lying(PatientPosition::FeetFirstSupine),
            "prone" => Self::lying(PatientPosition::HeadFirstProne),
            "decubitus-left" => Self::lying(PatientPosition::HeadFirstDecubitusLeft),
            "decubitus-right" => Self::lying(PatientPosition::HeadFirstDecubitusRight),
            _ => {
                return Err(PhantomError::UnknownOrientation {
                    name: name.to_owned(),
                    known: ORIENTATIONS.map(|(n, _)| n).join(", "),
                });
            }
        })
    }
}

impl fmt::Display for Orientation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = ORIENTATIONS
            .iter()
            .find(|(name, _)| name.parse().is_ok_and(|o: Self| o == *self));
        f.write_str(named.map_or("of its own", |(name, _)| name))
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "directions are whole numbers")]
mod tests {
    use super::*;
    use crate::vector::cross;

    #[test]
    fn rows_run_down_to_the_table_and_images_are_seen_from_the_feet() {
        for (name, code, down) in [
            ("axial", "HFS", Y),
            ("prone", "HFP", opposite(Y)),
            ("decubitus-left", "HFDL", X),
            ("decubitus-right", "HFDR", opposite(X)),
        ] {
            let lying: Orientation = name.parse().unwrap();
            assert_eq!(lying.patient_position.code(), code);
            assert_eq!(lying.row_direction, down, "{name}");
            let normal = cross(lying.column_direction, lying.row_direction);
            assert_eq!(normal, Z, "{name}");
        }
    }

    #[test]
    fn every_named_orientation_is_found_and_says_its_name() {
        for (name, _) in ORIENTATIONS {
            let found: Orientation = name.parse().unwrap();
            found.check().unwrap();
            assert_eq!(found.to_string(), name);
        }
    }
}
