//! Boxes.

use bonemesh_mesh::TriangleMesh;

use bonemesh_mesh::vector::Vector;

/// A box along the axes (mm).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Space {
    pub(crate) low: Vector,
    pub(crate) high: Vector,
}

impl Space {
    /// The box of some points; `None` without points.
    pub(crate) fn of(points: impl IntoIterator<Item = Vector>) -> Option<Self> {
        points.into_iter().fold(None, |space: Option<Self>, point| {
            let space = space.unwrap_or(Self {
                low: point,
                high: point,
            });
            Some(Self {
                low: [0, 1, 2].map(|axis| space.low[axis].min(point[axis])),
                high: [0, 1, 2].map(|axis| space.high[axis].max(point[axis])),
            })
        })
    }

    /// The box with so much more on all sides.
    pub(crate) fn wider(self, by_mm: f64) -> Self {
        Self {
            low: self.low.map(|low| low - by_mm),
            high: self.high.map(|high| high + by_mm),
        }
    }

    /// What it has in common with another, at least a place of its own.
    pub(super) fn common(&self, other: &Self) -> Self {
        let clamped = |end: Vector| {
            [0, 1, 2].map(|axis| end[axis].max(other.low[axis]).min(other.high[axis]))
        };
        Self {
            low: clamped(self.low),
            high: clamped(self.high),
        }
    }

    /// The axis along which it is the smallest part of a mesh.
    pub(super) fn narrowest(&self, mesh: &TriangleMesh) -> usize {
        let Some([low, high]) = mesh.bounds_mm() else {
            return 0;
        };
        let part = |axis: usize| (self.high[axis] - self.low[axis]) / (high[axis] - low[axis]);
        (0..3)
            .min_by(|a, b| part(*a).total_cmp(&part(*b)))
            .unwrap_or(0)
    }

    /// The slab of all places that are in it along one axis.
    pub(super) fn along(&self, axis: usize) -> Self {
        let mut slab = Self {
            low: [f64::NEG_INFINITY; 3],
            high: [f64::INFINITY; 3],
        };
        slab.low[axis] = self.low[axis];
        slab.high[axis] = self.high[axis];
        slab
    }

    pub(super) fn meets(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.high[axis] && other.low[axis] <= self.high[axis])
    }

    pub(super) fn holds(&self, place: Vector) -> bool {
        (0..3).all(|axis| (self.low[axis]..=self.high[axis]).contains(&place[axis]))
    }

    pub(super) fn touches(&self, corners: [Vector; 3]) -> bool {
        (0..3).all(|axis| {
            corners.iter().any(|c| c[axis] >= self.low[axis])
                && corners.iter().any(|c| c[axis] <= self.high[axis])
        })
    }
}
