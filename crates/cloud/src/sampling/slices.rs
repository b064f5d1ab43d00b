//! Which points share a slice, and how far apart they are in it.

use bonemesh_volume::Affine;
use rayon::prelude::*;

use crate::PointCloud;

/// Relative differences below this are rounding, not geometry.
const ROUNDING: f64 = 1e-9;

/// The points of a cloud, slice by slice.
///
/// A lattice says which points share a slice; free points share one where their z is equal.
pub(super) struct Slices<'a> {
    cloud: &'a PointCloud,
    /// Whether places are `(column, row)` of the lattice rather than mm.
    is_lattice: bool,
    metric: [f64; 3],
    members: Vec<Vec<u32>>,
}

impl<'a> Slices<'a> {
    /// Slices by rising number or z, points in the cloud's order.
    pub(super) fn of(cloud: &'a PointCloud) -> Self {
        let metric = cloud
            .lattice()
            .and_then(|lattice| in_plane_metric(&lattice.frame_from_lattice));
        Self {
            cloud,
            is_lattice: metric.is_some(),
            metric: metric.unwrap_or([1.0; 3]),
            members: members(cloud),
        }
    }

    /// Each slice's point indices.
    pub(super) fn par_iter(&self) -> rayon::slice::Iter<'_, Vec<u32>> {
        self.members.par_iter()
    }

    /// Squared length (mm2) of a unit step along each axis of [`Slices::places`].
    pub(super) fn metric(&self) -> [f64; 3] {
        self.metric
    }

    /// Where the points lie: whole lattice coordinates if those have right angles, so that equal
    /// distances are exactly equal; otherwise mm.
    pub(super) fn places(&self, members: &[u32]) -> Vec<[f64; 3]> {
        let members = members.iter().map(|i| *i as usize);
        match self.cloud.lattice() {
            Some(lattice) if self.is_lattice => members
                .map(|i| {
                    let [column, row, _] = lattice.coordinates[i];
                    [f64::from(column), f64::from(row), 0.0]
                })
                .collect(),
            _ => members.map(|i| self.cloud.points_mm()[i]).collect(),
        }
    }

    /// Where one point lies in the plane of its slice, in mm along two axes at right angles.
    pub(super) fn in_plane_mm(&self, point: u32) -> [f64; 2] {
        let point = point as usize;
        let Some(lattice) = self.cloud.lattice() else {
            let [x, y, _] = self.cloud.points_mm()[point];
            return [x, y];
        };
        let [column, row, _] = lattice.coordinates[point].map(f64::from);
        let gram = lattice.frame_from_lattice.gram();
        let along = gram[0][0].sqrt();
        let slant = gram[0][1] / along;
        let across = (gram[1][1] - slant * slant).max(0.0).sqrt();
        [column * along + row * slant, row * across]
    }

    /// `(column, row)` of lattice points whose rows and columns are at right angles.
    pub(super) fn pixels(&self, members: &[u32]) -> Option<Vec<[i32; 2]>> {
        let lattice = self.cloud.lattice().filter(|_| self.is_lattice)?;
        let place = |i: &u32| {
            let [column, row, _] = lattice.coordinates[*i as usize];
            [column, row]
        };
        Some(members.iter().map(place).collect())
    }
}

/// Squared column and row spacing, or `None` where columns and rows are not at right angles.
fn in_plane_metric(map: &Affine) -> Option<[f64; 3]> {
    let gram = map.gram();
    let (columns, rows) = (gram[0][0], gram[1][1]);
    let is_square = (columns - rows).abs() <= ROUNDING * columns;
    let is_right_angled = gram[0][1].abs() <= ROUNDING * (columns * rows).sqrt();
    is_right_angled.then_some([columns, if is_square { columns } else { rows }, 0.0])
}

fn members(cloud: &PointCloud) -> Vec<Vec<u32>> {
    let mut order: Vec<u32> = (0..cloud.len() as u32).collect();
    // Stable sorts: inside a slice the cloud's order stays.
    let split = |order: &[u32], is_same: &dyn Fn(u32, u32) -> bool| {
        order
            .chunk_by(|a, b| is_same(*a, *b))
            .map(<[u32]>::to_vec)
            .collect()
    };
    if let Some(lattice) = cloud.lattice() {
        let slice = |i: u32| lattice.coordinates[i as usize][2];
        order.sort_by_key(|i| slice(*i));
        split(&order, &|a, b| slice(a) == slice(b))
    } else {
        // Adding zero makes -0 and 0, which are the same height, the same value.
        let height = |i: u32| cloud.points_mm()[i as usize][2] + 0.0;
        order.sort_by(|a, b| height(*a).total_cmp(&height(*b)));
        split(&order, &|a, b| height(a).total_cmp(&height(b)).is_eq())
    }
}
