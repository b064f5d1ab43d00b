//! Which way a solid is cut.

use std::fmt;
use std::str::FromStr;

use crate::RoiError;
use bonemesh_mesh::vector::{Vector, length, unit_or_zero};

/// Which way it goes from the patch.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
pub enum Direction {
    /// Along the surface's own inward normals, to the first far side of the bone.
    #[default]
    Normal,
    /// Straight along the patch's mean inward normal, through hollows and whatever lies behind them.
    Through,
    /// Away from the bone: a plate that lies on it.
    Outward,
    /// Straight along this direction of length 1, such as that of a view, to the first far side.
    Along([f64; 3]),
}

impl Direction {
    /// Straight along `direction`, whatever its length.
    ///
    /// # Errors
    /// [`RoiError::Direction`] for one that is 0 or no number.
    pub fn along(direction: [f64; 3]) -> Result<Self, RoiError> {
        let size = length(direction);
        if size > 0.0 && size.is_finite() {
            Ok(Self::Along(unit_or_zero(direction)))
        } else {
            Err(RoiError::Direction(text(direction)))
        }
    }

    /// The direction of straight cuts that is given.
    pub(crate) fn given(self) -> Option<Vector> {
        match self {
            Self::Along(direction) => Some(direction),
            _ => None,
        }
    }
}

fn text(direction: Vector) -> String {
    let [x, y, z] = direction;
    format!("{x},{y},{z}")
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Normal => f.write_str("normal"),
            Self::Through => f.write_str("through"),
            Self::Outward => f.write_str("outward"),
            Self::Along(direction) => f.write_str(&text(*direction)),
        }
    }
}

impl FromStr for Direction {
    type Err = RoiError;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        match name {
            "normal" => return Ok(Self::Normal),
            "through" => return Ok(Self::Through),
            "outward" => return Ok(Self::Outward),
            _ => {}
        }
        let numbers = name.split(',').map(|number| number.trim().parse());
        match numbers.collect::<Result<Vec<f64>, _>>().as_deref() {
            Ok([x, y, z]) => {
                Self::along([*x, *y, *z]).map_err(|_| RoiError::Direction(name.into()))
            }
            _ => Err(RoiError::Direction(name.into())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_told_by_name_or_by_three_numbers() {
        for direction in [
            Direction::Normal,
            Direction::Through,
            Direction::Outward,
            Direction::Along([0.0, 0.6, -0.8]),
        ] {
            assert_eq!(
                direction.to_string().parse::<Direction>().unwrap(),
                direction
            );
        }
        let long = " 0, 0 ,-7".parse::<Direction>().unwrap();
        assert_eq!(long, Direction::Along([0.0, 0.0, -1.0]));
        for wrong in ["", "down", "1,2", "0,0,0", "1,2,nan", "1,2,3,4", "inf,0,0"] {
            let error = wrong.parse::<Direction>().unwrap_err().to_string();
            assert!(error.contains("normal") && error.contains(wrong), "{error}");
        }
    }
}
