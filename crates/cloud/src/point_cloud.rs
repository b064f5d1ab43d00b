//! The cloud itself.

use bonemesh_volume::Affine;

use crate::CloudError;

/// The frame in which a cloud's millimetres are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Frame {
    /// DICOM patient frame (LPS).
    #[default]
    Patient,
    /// The published method's frame, see [`bonemesh_volume::Geometry::image_from_voxel`].
    Image,
}

/// Points in mm, with their integer lattice where they came from voxels.
///
/// All coordinates are finite and there are at most `u32::MAX` points.
#[derive(Clone, Debug, PartialEq)]
pub struct PointCloud {
    points_mm: Vec<[f64; 3]>,
    lattice: Option<Lattice>,
}

/// Integer coordinates `(column, row, slice)` of a cloud's points and the map to mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// `(column, row, slice)` of each point.
    pub coordinates: Vec<[i32; 3]>,
    /// Lattice coordinates to mm.
    pub frame_from_lattice: Affine,
}

impl PointCloud {
    /// Points in mm.
    pub fn points_mm(&self) -> &[[f64; 3]] {
        &self.points_mm
    }

    /// How many points there are.
    pub fn len(&self) -> usize {
        self.points_mm.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.points_mm.is_empty()
    }

    /// The lattice, where the points came from voxels.
    pub fn lattice(&self) -> Option<&Lattice> {
        self.lattice.as_ref()
    }

    /// A cloud of free points.
    ///
    /// # Errors
    /// [`CloudError::NotFinite`] and [`CloudError::TooMany`].
    pub fn from_points(points_mm: Vec<[f64; 3]>) -> Result<Self, CloudError> {
        Self::checked(points_mm, None)
    }

    /// A cloud of lattice points.
    ///
    /// # Errors
    /// [`CloudError::NotFinite`] when the lattice's map leads to infinity or is not finite itself,
    /// and [`CloudError::TooMany`].
    pub fn from_lattice(lattice: Lattice) -> Result<Self, CloudError> {
        let map = lattice.frame_from_lattice;
        let points_mm = lattice
            .coordinates
            .iter()
            .map(|at| map.apply(at.map(f64::from)))
            .collect();
        Self::checked(points_mm, Some(lattice))
    }

    /// The points of `indices`, in that order, with their lattice coordinates.
    ///
    /// # Panics
    /// When an index is not below [`PointCloud::len`].
    #[must_use]
    pub fn subset(&self, indices: &[u32]) -> Self {
        let points_mm = indices
            .iter()
            .map(|i| self.points_mm[*i as usize])
            .collect();
        let lattice = self.lattice.as_ref().map(|lattice| Lattice {
            coordinates: indices
                .iter()
                .map(|i| lattice.coordinates[*i as usize])
                .collect(),
            frame_from_lattice: lattice.frame_from_lattice,
        });
        Self { points_mm, lattice }
    }

    /// The same points on their lattice.
    pub(crate) fn on(self, lattice: Lattice) -> Self {
        Self {
            points_mm: self.points_mm,
            lattice: Some(lattice),
        }
    }

    fn checked(points_mm: Vec<[f64; 3]>, lattice: Option<Lattice>) -> Result<Self, CloudError> {
        if points_mm.len() > u32::MAX as usize {
            return Err(CloudError::TooMany(points_mm.len()));
        }
        let is_finite = |p: &[f64; 3]| p.iter().all(|c| c.is_finite());
        if let Some(index) = points_mm.iter().position(|p| !is_finite(p)) {
            let point = points_mm[index];
            return Err(CloudError::NotFinite { index, point });
        }
        Ok(Self { points_mm, lattice })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_are_not_finite_are_named() {
        let points = vec![[0.0; 3], [1.0, f64::NAN, 0.0]];
        let error = PointCloud::from_points(points).unwrap_err();
        assert!(matches!(error, CloudError::NotFinite { index: 1, .. }));
        let steep = Affine::from_axes([1e308, 0.0, 0.0], [0.0; 3], [0.0; 3], [0.0; 3]);
        let lattice = Lattice {
            coordinates: vec![[1, 0, 0], [100, 0, 0]],
            frame_from_lattice: steep,
        };
        assert!(PointCloud::from_lattice(lattice).is_err());
    }

    #[test]
    fn a_subset_keeps_points_and_lattice_together() {
        let frame_from_lattice =
            Affine::from_axes([0.5, 0.0, 0.0], [0.0, 0.25, 0.0], [0.1, 0.0, 2.0], [7.0; 3]);
        let cloud = PointCloud::from_lattice(Lattice {
            coordinates: vec![[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 4, 5]],
            frame_from_lattice,
        })
        .unwrap();
        let part = cloud.subset(&[3, 1]);
        let lattice = part.lattice().unwrap();
        assert_eq!(lattice.coordinates, [[3, 4, 5], [1, 0, 0]]);
        assert_eq!(part, PointCloud::from_lattice(lattice.clone()).unwrap());
        let expected = [9.0, 8.0, 17.0];
        assert!((0..3).all(|i| (part.points_mm()[0][i] - expected[i]).abs() < 1e-12));
    }
}
