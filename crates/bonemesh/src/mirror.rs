//! The plane that a body is mirrored in: given, or found.

use std::num::NonZeroUsize;
use std::str::FromStr;

use bonemesh_mesh::{Plane, TriangleMesh};
use bonemesh_roi::{Symmetry, symmetry_plane};
use bonemesh_task::{Task, pool};
use serde::Serialize;

use crate::Error;

/// How the plane is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PlaneChoice {
    /// The mesh's own plane of symmetry, found.
    Auto,
    /// Across the patient's x (0), y (1) or z (2) axis, through the middle of the mesh's box.
    Across(usize),
    /// This one.
    Given(Plane),
}

/// What is said of the plane that was used.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlaneReport {
    /// Its normal, of length 1.
    pub normal: [f64; 3],
    /// How far (mm) from the origin it lies along its normal.
    pub offset_mm: f64,
    /// If it was found: root mean square of the distances (mm) between surface and mirrored surface, of
    /// the best 70 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_mm: Option<f64>,
    /// If it was found: the mean of all these distances (mm), capped; what is not symmetric shows here.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_mm: Option<f64>,
}

/// A plane, and what is said of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChosenPlane {
    /// The plane.
    pub plane: Plane,
    /// What is said of it.
    pub report: PlaneReport,
}

impl ChosenPlane {
    fn new(plane: Plane, symmetry: Option<&Symmetry>) -> Self {
        Self {
            plane,
            report: PlaneReport {
                normal: plane.normal(),
                offset_mm: plane.offset_mm(),
                error_mm: symmetry.map(|s| s.error_mm),
                mean_mm: symmetry.map(|s| s.mean_mm),
            },
        }
    }
}

impl PlaneChoice {
    /// The plane for a mesh.
    ///
    /// # Errors
    /// [`Error::Roi`] where none follows from the mesh, or the work was cancelled.
    pub fn choose(
        self,
        mesh: &TriangleMesh,
        threads: Option<NonZeroUsize>,
        task: &Task,
    ) -> Result<ChosenPlane, Error> {
        pool(threads)?.install(|| match self {
            Self::Auto => {
                let symmetry = symmetry_plane(mesh, task)?;
                Ok(ChosenPlane::new(symmetry.plane, Some(&symmetry)))
            }
            Self::Across(axis) => {
                let mut normal = [0.0; 3];
                normal[axis] = 1.0;
                let middle = mesh
                    .bounds_mm()
                    .map(|[low, high]| f64::midpoint(low[axis], high[axis]));
                let plane = Plane::new(normal, middle.unwrap_or(0.0))?;
                Ok(ChosenPlane::new(plane, None))
            }
            Self::Given(plane) => Ok(ChosenPlane::new(plane, None)),
        })
    }
}

impl FromStr for PlaneChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => return Ok(Self::Auto),
            "x" => return Ok(Self::Across(0)),
            "y" => return Ok(Self::Across(1)),
            "z" => return Ok(Self::Across(2)),
            _ => {}
        }
        let refused = || {
            format!(
                "`{text}` is no plane; write auto, x, y, z, NX,NY,NZ,D (the places p with N · p = D, in mm) or three places X,Y,Z;X,Y,Z;X,Y,Z that are not in a line"
            )
        };
        let numbers = |part: &str| -> Option<Vec<f64>> {
            part.split(',').map(|n| n.trim().parse().ok()).collect()
        };
        let parts: Option<Vec<Vec<f64>>> = text.split(';').map(numbers).collect();
        let plane = match parts.ok_or_else(refused)?.as_slice() {
            [one] => match one[..] {
                [x, y, z, offset] => Plane::new([x, y, z], offset),
                _ => return Err(refused()),
            },
            [a, b, c] => {
                let place = |p: &[f64]| <[f64; 3]>::try_from(p).map_err(|_| refused());
                Plane::through([place(a)?, place(b)?, place(c)?])
            }
            _ => return Err(refused()),
        };
        plane.map(Self::Given).map_err(|_| refused())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_told_by_name_by_four_numbers_or_by_three_places() {
        let given = |text: &str| text.parse::<PlaneChoice>();
        assert_eq!(given("auto"), Ok(PlaneChoice::Auto));
        assert_eq!(given("y"), Ok(PlaneChoice::Across(1)));
        let plane = Plane::new([0.0, 0.0, 1.0], 5.0).unwrap();
        assert_eq!(given("0,0,2,10"), Ok(PlaneChoice::Given(plane)));
        assert_eq!(given("0,0,5; 1,0,5; 0,1,5"), Ok(PlaneChoice::Given(plane)));
        for wrong in [
            "",
            "w",
            "1,2,3",
            "0,0,0,1",
            "nan,0,0,1",
            "0,0,0;1,1,1;2,2,2",
            "1,2,3;4,5,6",
            "1,2;3,4;5,6",
        ] {
            let error = given(wrong).unwrap_err();
            assert!(error.contains(wrong) && error.contains("auto"), "{error}");
        }
    }

    #[test]
    fn an_axis_goes_through_the_middle_of_the_mesh() {
        let corners = vec![[2.0, 0.0, 0.0], [8.0, 0.0, 0.0], [2.0, 3.0, 1.0]];
        let mesh = TriangleMesh::new(corners, vec![[0, 1, 2]]).unwrap();
        let chosen = PlaneChoice::Across(0).choose(&mesh, None, &Task::default());
        assert!((chosen.unwrap().report.offset_mm - 5.0).abs() < 1e-12);
    }
}
