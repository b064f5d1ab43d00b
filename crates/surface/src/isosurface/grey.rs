//! Hounsfield units between voxels.

use bonemesh_volume::{Volume, Voxels};
use ndarray::{CowArray, Ix3};

/// Voxels in the order slice, row, column: a volume's own, or a copy where they are stored in
/// another order.
pub(crate) enum Ordered<'a> {
    I16(CowArray<'a, i16, Ix3>),
    F32(CowArray<'a, f32, Ix3>),
}

impl<'a> Ordered<'a> {
    pub(crate) fn of(volume: &'a Volume) -> Self {
        match volume.voxels() {
            Voxels::I16(hu) => Self::I16(hu.as_standard_layout()),
            Voxels::F32(hu) => Self::F32(hu.as_standard_layout()),
        }
    }

    pub(crate) fn grey(&self) -> Grey<'_> {
        const ORDERED: &str = "the voxels were put in order, else it is a bug";
        let shape = |(slices, rows, columns): (usize, usize, usize)| [columns, rows, slices];
        match self {
            Self::I16(hu) => Grey::I16(hu.as_slice().expect(ORDERED), shape(hu.dim())),
            Self::F32(hu) => Grey::F32(hu.as_slice().expect(ORDERED), shape(hu.dim())),
        }
    }
}

/// Hounsfield units of a volume, read by column, row, slice.
#[derive(Clone, Copy)]
pub(crate) enum Grey<'a> {
    I16(&'a [i16], [usize; 3]),
    F32(&'a [f32], [usize; 3]),
}

impl Grey<'_> {
    /// Columns, rows, slices.
    #[inline]
    pub(crate) fn shape(&self) -> [usize; 3] {
        match self {
            Self::I16(_, shape) | Self::F32(_, shape) => *shape,
        }
    }

    /// Of a voxel.
    #[inline]
    pub(crate) fn at(&self, [i, j, k]: [usize; 3]) -> f32 {
        let [columns, rows, _] = self.shape();
        let place = (k * rows + j) * columns + i;
        match self {
            Self::I16(hu, _) => f32::from(hu[place]),
            Self::F32(hu, _) => hu[place],
        }
    }

    /// At any place, in voxels: linear between the eight around it, that of the border beyond it.
    #[inline]
    pub(crate) fn between(&self, place: [f32; 3]) -> f32 {
        let shape = self.shape();
        let mut low = [0; 3];
        let mut part = [0.0; 3];
        let mut step = [0; 3];
        for axis in 0..3 {
            let p = place[axis].clamp(0.0, (shape[axis] - 1) as f32);
            low[axis] = p as usize;
            part[axis] = p - low[axis] as f32;
            step[axis] = usize::from(low[axis] + 1 < shape[axis]);
        }
        let [i, j, k] = low;
        let line = |j: usize, k: usize| {
            let (a, b) = (self.at([i, j, k]), self.at([i + step[0], j, k]));
            a + part[0] * (b - a)
        };
        let face = |k: usize| {
            let (a, b) = (line(j, k), line(j + step[1], k));
            a + part[1] * (b - a)
        };
        let (a, b) = (face(k), face(k + step[2]));
        a + part[2] * (b - a)
    }

    /// Change for each voxel along columns, rows and slices, across two voxels.
    #[inline]
    pub(crate) fn gradient(&self, place: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|axis| {
            let beside = |by: f32| {
                let mut p = place;
                p[axis] += by;
                self.between(p)
            };
            0.5 * (beside(1.0) - beside(-1.0))
        })
    }
}
