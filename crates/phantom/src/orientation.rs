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
    /// Whether the patient lies with the feet to the scanner; written as `PatientPosition`.
    pub feet_first: bool,
}

const X: Vec3 = [1.0, 0.0, 0.0];
const Y: Vec3 = [0.0, 1.0, 0.0];
const Z: Vec3 = [0.0, 0.0, 1.0];

/// Orientations by name, with one line each.
pub const ORIENTATIONS: [(&str, &str); 7] = [
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
];

impl Orientation {
    /// Axial slices from the feet to the head.
    pub fn axial() -> Self {
        Self::of(X, Y, Z)
    }

    /// Sagittal slices from left to right: columns run to the back, rows down.
    pub fn sagittal() -> Self {
        Self::of(Y, Z.map(|v| -v), X.map(|v| -v))
    }

    /// Coronal slices from front to back: columns run to the left, rows down.
    pub fn coronal() -> Self {
        Self::of(X, Z.map(|v| -v), Y)
    }

    /// The same grid, its slices counted from the other end.
    #[must_use]
    pub fn reversed(self) -> Self {
        let slice_direction = self.slice_direction.map(|v| -v);
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
            feet_first: false,
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
            "feet-first" => Self {
                column_direction: X.map(|v| -v),
                feet_first: true,
                ..axial
            },
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
