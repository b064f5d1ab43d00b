//! Points that lie on a lattice, where neighbourhoods and spheres are decided exactly.

use bonemesh::{Affine, CloudError, PointCloud};
use bonemesh_cloud::Lattice;
use pyo3::prelude::*;

use crate::arrays::Input;
use crate::errors;

/// Distance of a point from its place on the lattice, as a part of the spacing, that is rounding.
const ROUNDING: f64 = 1e-6;

/// Distances between the points of a lattice along x, y and z (mm).
pub(crate) struct Spacing([f64; 3]);

impl FromPyObject<'_, '_> for Spacing {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let spacing = value.extract::<[f64; 3]>().ok();
        let usable = |s: &[f64; 3]| s.iter().all(|mm| mm.is_finite() && *mm > 0.0);
        spacing.filter(usable).map(Self).ok_or_else(|| {
            let what = value.repr().map(|r| r.to_string()).unwrap_or_default();
            let remedy = "give three lengths above 0 mm: along x, y and z";
            errors::argument(value.py(), &format!("spacing_mm is {what}; {remedy}"))
        })
    }
}

/// Points as people hand them in.
pub(crate) enum PointSet {
    OnLattice(Lattice),
    Free(Vec<[f64; 3]>),
}

impl PointSet {
    /// The same points as a cloud, free ones on their lattice if they have one along the axes.
    ///
    /// # Errors
    /// Those of the cloud.
    pub(crate) fn into_cloud(self) -> Result<PointCloud, CloudError> {
        match self {
            Self::OnLattice(lattice) => PointCloud::from_lattice(lattice),
            Self::Free(points_mm) => {
                Ok(PointCloud::from_points(points_mm)?.with_lattice_recognised())
            }
        }
    }
}

/// Whole numbers are lattice coordinates, with steps of `spacing` or 1 mm. Floating-point numbers
/// are millimetres: free points without `spacing`, else on a lattice with it.
pub(crate) fn point_set(input: &Input<'_>, spacing: Option<Spacing>) -> PyResult<PointSet> {
    if input.is_whole() {
        let Spacing(spacing) = spacing.unwrap_or(Spacing([1.0; 3]));
        return Ok(PointSet::OnLattice(Lattice {
            coordinates: input.whole_vectors()?,
            frame_from_lattice: affine(spacing, [0.0; 3]),
        }));
    }
    let points_mm = input.vectors()?;
    let (Some(Spacing(spacing)), Some(&origin)) = (spacing, points_mm.first()) else {
        return Ok(PointSet::Free(points_mm));
    };
    let on_lattice = |point: &[f64; 3]| coordinates(*point, origin, spacing);
    let found: Option<Vec<[i32; 3]>> = points_mm.iter().map(on_lattice).collect();
    found.map_or_else(
        || {
            let message = format!(
                "the points are not on a lattice with steps of {spacing:?} mm; leave spacing_mm out or give the true one"
            );
            Err(errors::argument(input.py(), &message))
        },
        |coordinates| {
            let frame_from_lattice = affine(spacing, origin);
            Ok(PointSet::OnLattice(Lattice { coordinates, frame_from_lattice }))
        },
    )
}

fn affine([x, y, z]: [f64; 3], origin: [f64; 3]) -> Affine {
    Affine::from_axes([x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z], origin)
}

/// Steps from `origin` to `point`, if they are whole.
fn coordinates(point: [f64; 3], origin: [f64; 3], spacing: [f64; 3]) -> Option<[i32; 3]> {
    let mut whole = [0; 3];
    for axis in 0..3 {
        let steps = (point[axis] - origin[axis]) / spacing[axis];
        let nearest = steps.round();
        if (steps - nearest).abs() > ROUNDING || nearest.abs() > f64::from(i32::MAX) {
            return None;
        }
        whole[axis] = nearest as i32;
    }
    Some(whole)
}
