//! The fields of a header that matter, of both versions in one form.

use ::nifti::{Endianness, NiftiHeader};

use crate::sniff::{NIFTI_1, NIFTI_2};

/// Fields of a `NIfTI` header, named as in the standard where it has a good name.
#[derive(Clone, Debug)]
pub(super) struct Fields {
    /// Bytes of the header.
    pub(super) size: u64,
    pub(super) is_big_endian: bool,
    /// Number of sides, then the sides.
    pub(super) dim: [i64; 8],
    pub(super) datatype: i16,
    /// Sign of the third axis of the quaternion, then the spacings.
    pub(super) pixdim: [f64; 8],
    /// Bytes before the voxels.
    pub(super) offset: f64,
    pub(super) slope: f64,
    pub(super) intercept: f64,
    pub(super) xyzt_units: i32,
    pub(super) qform_code: i32,
    pub(super) sform_code: i32,
    /// b, c and d.
    pub(super) quaternion: [f64; 3],
    pub(super) quaternion_offset: [f64; 3],
    pub(super) srow: [[f64; 4]; 3],
    pub(super) description: Vec<u8>,
}

impl Fields {
    /// Fields of a `NIfTI-1` header; the reason where it cannot be parsed.
    pub(super) fn version_1(bytes: &[u8; NIFTI_1]) -> Result<Self, String> {
        let h = NiftiHeader::from_reader(&bytes[..]).map_err(|e| e.to_string())?;
        if h.sizeof_hdr != NIFTI_1 as i32 {
            return Err("its size and its number of dimensions differ in byte order".to_owned());
        }
        let row = |row: [f32; 4]| row.map(f64::from);
        Ok(Self {
            size: NIFTI_1 as u64,
            is_big_endian: h.endianness == Endianness::Big,
            // Signed in the standard, unsigned in the crate.
            dim: h.dim.map(|n| i64::from(n.cast_signed())),
            datatype: h.datatype,
            pixdim: h.pixdim.map(f64::from),
            offset: f64::from(h.vox_offset),
            slope: f64::from(h.scl_slope),
            intercept: f64::from(h.scl_inter),
            xyzt_units: i32::from(h.xyzt_units),
            qform_code: i32::from(h.qform_code),
            sform_code: i32::from(h.sform_code),
            quaternion: [h.quatern_b, h.quatern_c, h.quatern_d].map(f64::from),
            quaternion_offset: [h.quatern_x, h.quatern_y, h.quatern_z].map(f64::from),
            srow: [row(h.srow_x), row(h.srow_y), row(h.srow_z)],
            description: h.descrip,
        })
    }

    /// Fields of a `NIfTI-2` header, by their places in the standard.
    pub(super) fn version_2(bytes: &[u8; NIFTI_2]) -> Self {
        let is_big_endian = bytes[..4] == (NIFTI_2 as u32).to_be_bytes();
        let at = At {
            bytes,
            is_big_endian,
        };
        Self {
            size: NIFTI_2 as u64,
            is_big_endian,
            dim: std::array::from_fn(|n| i64::from_le_bytes(at.take(16 + 8 * n))),
            datatype: i16::from_le_bytes(at.take(12)),
            pixdim: at.reals(104),
            offset: i64::from_le_bytes(at.take(168)) as f64,
            slope: at.real(176),
            intercept: at.real(184),
            xyzt_units: at.whole(500),
            qform_code: at.whole(344),
            sform_code: at.whole(348),
            quaternion: at.reals(352),
            quaternion_offset: at.reals(376),
            srow: [at.reals(400), at.reals(432), at.reals(464)],
            description: bytes[240..320].to_vec(),
        }
    }
}

/// Numbers at places of a header.
struct At<'a> {
    bytes: &'a [u8; NIFTI_2],
    is_big_endian: bool,
}

impl At<'_> {
    /// Bytes at a place, least first.
    fn take<const N: usize>(&self, place: usize) -> [u8; N] {
        let mut bytes: [u8; N] = std::array::from_fn(|n| self.bytes[place + n]);
        if self.is_big_endian {
            bytes.reverse();
        }
        bytes
    }

    fn whole(&self, place: usize) -> i32 {
        i32::from_le_bytes(self.take(place))
    }

    fn real(&self, place: usize) -> f64 {
        f64::from_le_bytes(self.take(place))
    }

    fn reals<const N: usize>(&self, place: usize) -> [f64; N] {
        std::array::from_fn(|n| self.real(place + 8 * n))
    }
}
