//! Point clouds from edge maps, their neighbourhoods and samples.

use bonemesh_segment::EdgeMap;
use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::Affine;

/// What cannot be done with a cloud, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum CloudError {
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

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

    /// The lattice, where the points came from voxels.
    pub fn lattice(&self) -> Option<&Lattice> {
        self.lattice.as_ref()
    }

    /// A cloud of free points.
    ///
    /// # Errors
    /// when a coordinate is not finite
    pub fn from_points(points_mm: Vec<[f64; 3]>) -> Result<Self, CloudError> {
        Ok(Self {
            points_mm,
            lattice: None,
        })
    }

    /// A cloud of lattice points (with lattice).
    ///
    /// # Errors
    /// see CloudError
    pub fn from_lattice(lattice: Lattice) -> Result<Self, CloudError> {
        let _ = lattice;
        todo!()
    }

    /// The points of `indices`, in that order.
    #[must_use]
    pub fn subset(&self, indices: &[u32]) -> Self {
        let _ = indices;
        todo!()
    }
}

/// One point an edge pixel, ordered by slice, row, column.
///
/// # Errors
/// see CloudError
pub fn extract_points(
    edges: &EdgeMap,
    frame: Frame,
    task: &Task,
) -> Result<PointCloud, CloudError> {
    let _ = (edges, frame, task);
    todo!()
}

/// Mean over all points of the mean distance (mm) to the `k` nearest neighbours.
///
/// # Errors
/// see CloudError
pub fn mean_neighbour_distance(
    cloud: &PointCloud,
    k: usize,
    include_self: bool,
    task: &Task,
) -> Result<f64, CloudError> {
    let _ = (cloud, k, include_self, task);
    todo!()
}
