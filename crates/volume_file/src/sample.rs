//! Stored numbers to Hounsfield units.

use rayon::prelude::*;

/// Hounsfield units of air, which stands for voxels without a number.
pub(crate) const AIR_HU: f32 = -1000.0;

/// Voxels that one thread converts at a time.
const CHUNK: usize = 1 << 15;

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
}

impl Element {
    /// Bytes of one number.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::U64 | Self::I64 | Self::F64 => 8,
        }
    }

    fn is_whole(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// How stored numbers become Hounsfield units: `stored * slope + intercept`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Conversion {
    pub(crate) element: Element,
    pub(crate) is_big_endian: bool,
    pub(crate) slope: f64,
    pub(crate) intercept: f64,
}

/// What was seen while numbers were converted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Summary {
    /// Whether all values fit the voxel type.
    pub(crate) fits: bool,
    /// Smallest finite value.
    pub(crate) lowest_hu: f32,
    /// Voxels that are no finite number.
    pub(crate) not_finite: u64,
}

impl Summary {
    pub(crate) const EMPTY: Self = Self {
        fits: true,
        lowest_hu: f32::INFINITY,
        not_finite: 0,
    };

    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            fits: self.fits && other.fits,
            lowest_hu: self.lowest_hu.min(other.lowest_hu),
            not_finite: self.not_finite + other.not_finite,
        }
    }
}

impl Conversion {
    /// Whether the values are whole for sure.
    pub(crate) fn is_whole(&self) -> bool {
        self.element.is_whole() && self.slope.fract() == 0.0 && self.intercept.fract() == 0.0
    }

    /// Hounsfield units of `bytes`, which hold one number for each voxel, on every core.
    pub(crate) fn convert<T: Voxel>(&self, bytes: &[u8], voxels: &mut [T]) -> Summary {
        if self.is_big_endian {
            self.ordered::<true, T>(bytes, voxels)
        } else {
            self.ordered::<false, T>(bytes, voxels)
        }
    }

    fn ordered<const BIG: bool, T: Voxel>(&self, bytes: &[u8], voxels: &mut [T]) -> Summary {
        match self.element {
            Element::U8 => self.all::<BIG, 1, T>(bytes, voxels, |[b]| f64::from(b)),
            Element::I8 => self.all::<BIG, 1, T>(bytes, voxels, |b| i8::from_le_bytes(b).into()),
            Element::U16 => self.all::<BIG, 2, T>(bytes, voxels, |b| u16::from_le_bytes(b).into()),
            Element::I16 => self.all::<BIG, 2, T>(bytes, voxels, |b| i16::from_le_bytes(b).into()),
            Element::U32 => self.all::<BIG, 4, T>(bytes, voxels, |b| u32::from_le_bytes(b).into()),
            Element::I32 => self.all::<BIG, 4, T>(bytes, voxels, |b| i32::from_le_bytes(b).into()),
            Element::U64 => self.all::<BIG, 8, T>(bytes, voxels, |b| u64::from_le_bytes(b) as f64),
            Element::I64 => self.all::<BIG, 8, T>(bytes, voxels, |b| i64::from_le_bytes(b) as f64),
            Element::F32 => self.all::<BIG, 4, T>(bytes, voxels, |b| f32::from_le_bytes(b).into()),
            Element::F64 => self.all::<BIG, 8, T>(bytes, voxels, f64::from_le_bytes),
        }
    }

    /// `number` takes the bytes of one number, least first.
    fn all<const BIG: bool, const N: usize, T: Voxel>(
        &self,
        bytes: &[u8],
        voxels: &mut [T],
        number: impl Fn([u8; N]) -> f64 + Sync,
    ) -> Summary {
        let (numbers, _) = bytes.as_chunks::<N>();
        let (slope, intercept) = (self.slope, self.intercept);
        numbers
            .par_chunks(CHUNK)
            .zip(voxels.par_chunks_mut(CHUNK))
            .map(|(numbers, voxels)| {
                let mut seen = Summary::EMPTY;
                for (bytes, voxel) in numbers.iter().zip(voxels) {
                    let mut bytes = *bytes;
                    if BIG {
                        bytes.reverse();
                    }
                    let mut hu = (number(bytes) * slope + intercept) as f32;
                    if !hu.is_finite() {
                        seen.not_finite += 1;
                        hu = AIR_HU;
                    } else if hu < seen.lowest_hu {
                        seen.lowest_hu = hu;
                    }
                    let (value, fits) = T::from_hu(hu);
                    *voxel = value;
                    seen.fits &= fits;
                }
                seen
            })
            .reduce(|| Summary::EMPTY, Summary::and)
    }
}

/// A voxel of a volume.
pub(crate) trait Voxel: Copy + Send + Sync {
    /// The voxel, and whether it holds the value exactly.
    fn from_hu(hu: f32) -> (Self, bool);
}

impl Voxel for i16 {
    #[allow(
        clippy::float_cmp,
        reason = "only the very same number is held exactly"
    )]
    fn from_hu(hu: f32) -> (Self, bool) {
        // The cast saturates, so only values that are whole and in range come back unchanged.
        let value = hu as i16;
        (value, f32::from(value) == hu)
    }
}

impl Voxel for f32 {
    fn from_hu(hu: f32) -> (Self, bool) {
        (hu, true)
    }
}
