//! Hounsfield units between voxels.

use std::borrow::Cow;

use rayon::prelude::*;

/// The greatest size of a value: squares and sums of such ones are still numbers.
const GREATEST_HU: f32 = 1e9;

/// What a voxel is stored as.
pub(crate) trait Voxel: Copy + Send + Sync + Into<f32> {
    /// Whether it can be calculated with.
    fn is_usable(self) -> bool;
    /// The nearest value that can be calculated with; of what is no number, `otherwise`.
    fn usable_or(self, otherwise: Self) -> Self;
}

impl Voxel for i16 {
    fn is_usable(self) -> bool {
        true
    }

    fn usable_or(self, _: Self) -> Self {
        self
    }
}

impl Voxel for f32 {
    fn is_usable(self) -> bool {
        self.abs() <= GREATEST_HU
    }

    fn usable_or(self, otherwise: Self) -> Self {
        if self.is_nan() {
            otherwise
        } else {
            self.clamp(-GREATEST_HU, GREATEST_HU)
        }
    }
}

/// Voxels that can be calculated with: values beyond all measure are cut off, and what is no
/// number is as dark as the darkest.
pub(crate) fn usable<T: Voxel>(voxels: &[T]) -> Cow<'_, [T]> {
    if voxels.par_iter().all(|voxel| voxel.is_usable()) {
        return Cow::Borrowed(voxels);
    }
    let number = |voxel: &&T| !Into::<f32>::into(**voxel).is_nan();
    let darkest = voxels
        .iter()
        .filter(number)
        .copied()
        .reduce(|a, b| if b.into() < a.into() { b } else { a });
    let Some(darkest) = darkest else {
        return Cow::Borrowed(voxels);
    };
    let darkest = darkest.usable_or(darkest);
    Cow::Owned(voxels.par_iter().map(|v| v.usable_or(darkest)).collect())
}

/// Voxels in the order slice, row, column, read by column, row, slice.
#[derive(Clone, Copy)]
pub(crate) struct Grey<'a, T> {
    voxels: &'a [T],
    shape: [usize; 3],
}

impl<'a, T: Voxel> Grey<'a, T> {
    /// `shape` counts columns, rows and slices.
    pub(crate) fn new(voxels: &'a [T], shape: [usize; 3]) -> Self {
        assert_eq!(voxels.len(), shape.iter().product::<usize>(), "a bug");
        Self { voxels, shape }
    }

    /// Columns, rows, slices.
    #[inline]
    pub(crate) fn shape(&self) -> [usize; 3] {
        self.shape
    }

    /// Of a voxel.
    #[inline]
    pub(crate) fn at(&self, [i, j, k]: [usize; 3]) -> f32 {
        let [columns, rows, _] = self.shape;
        self.voxels[(k * rows + j) * columns + i].into()
    }

    /// At any place, in voxels: linear between the eight around it, that of the border beyond it.
    #[inline]
    pub(crate) fn between(&self, place: [f32; 3]) -> f32 {
        let mut stride = 1;
        let mut first = 0;
        let mut part = [0.0; 3];
        let mut step = [0; 3];
        for axis in 0..3 {
            let last = self.shape[axis] - 1;
            let p = place[axis].clamp(0.0, last as f32);
            let low = p as usize;
            part[axis] = p - low as f32;
            step[axis] = if low < last { stride } else { 0 };
            first += low * stride;
            stride *= self.shape[axis];
        }
        let line = |at: usize| {
            let (a, b) = (self.voxels[at].into(), self.voxels[at + step[0]].into());
            a + part[0] * (b - a)
        };
        let face = |at: usize| {
            let (a, b) = (line(at), line(at + step[1]));
            a + part[1] * (b - a)
        };
        let (a, b) = (face(first), face(first + step[2]));
        a + part[2] * (b - a)
    }

    /// [`gradient`](Self::gradient) at a part of the way from one voxel to the next.
    #[inline]
    pub(crate) fn gradient_between(&self, a: [usize; 3], b: [usize; 3], part: f32) -> [f32; 3] {
        let (a, b) = (self.gradient(a), self.gradient(b));
        [0, 1, 2].map(|axis| a[axis] + part * (b[axis] - a[axis]))
    }

    /// Change for each voxel along columns, rows and slices, across two voxels.
    #[inline]
    pub(crate) fn gradient(&self, voxel: [usize; 3]) -> [f32; 3] {
        std::array::from_fn(|axis| {
            let beside = |at: usize| {
                let mut place = voxel;
                place[axis] = at;
                self.at(place)
            };
            let (here, last) = (voxel[axis], self.shape[axis] - 1);
            0.5 * (beside(last.min(here + 1)) - beside(here.saturating_sub(1)))
        })
    }
}
