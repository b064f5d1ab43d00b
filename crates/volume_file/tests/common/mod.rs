//! Volume files, written byte by byte as the tests need them.

#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

use std::io::Write;
use std::path::{Path, PathBuf};

use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};
use bonemesh_volume_file::{VolumeFile, VolumeFileError};
use flate2::Compression;
use flate2::write::GzEncoder;

/// Columns, rows, slices of most test volumes.
pub(crate) const SIDES: [usize; 3] = [4, 3, 2];

/// Rows of a map from voxels to coordinates.
pub(crate) type Rows = [[f64; 4]; 3];

/// Every stored type: its `NIfTI` code, one of its NRRD names and its size.
pub(crate) const TYPES: [(i16, &str, usize); 10] = [
    (2, "uchar", 1),
    (256, "int8", 1),
    (512, "unsigned short", 2),
    (4, "short", 2),
    (768, "uint32_t", 4),
    (8, "int", 4),
    (1280, "ulonglong", 8),
    (1024, "int64", 8),
    (16, "float", 4),
    (64, "double", 8),
];

/// Numbers of a stored type; those that do not fit it are clamped by the casts.
pub(crate) fn stored(code: i16, values: &[f64], is_big_endian: bool) -> Vec<u8> {
    let number = |v: f64| match code {
        2 => vec![v as u8],
        256 => (v as i8).to_le_bytes().to_vec(),
        512 => (v as u16).to_le_bytes().to_vec(),
        4 => (v as i16).to_le_bytes().to_vec(),
        768 => (v as u32).to_le_bytes().to_vec(),
        8 => (v as i32).to_le_bytes().to_vec(),
        1280 => (v as u64).to_le_bytes().to_vec(),
        1024 => (v as i64).to_le_bytes().to_vec(),
        16 => (v as f32).to_le_bytes().to_vec(),
        64 => v.to_le_bytes().to_vec(),
        _ => panic!("no such type"),
    };
    values
        .iter()
        .flat_map(|v| {
            let mut bytes = number(*v);
            if is_big_endian {
                bytes.reverse();
            }
            bytes
        })
        .collect()
}

/// Values that every type holds and no two mirror images share.
pub(crate) fn small_values() -> Vec<f64> {
    (0..24).map(|n| f64::from(n * 5 % 24)).collect()
}

pub(crate) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// A `NIfTI` file to be changed and written.
#[derive(Clone)]
pub(crate) struct Nifti {
    pub(crate) version: u8,
    pub(crate) is_big_endian: bool,
    pub(crate) is_pair: bool,
    /// Number of sides, then the sides.
    pub(crate) dim: [i64; 8],
    pub(crate) datatype: i16,
    pub(crate) pixdim: [f64; 8],
    pub(crate) offset: f64,
    pub(crate) slope: f64,
    pub(crate) intercept: f64,
    pub(crate) units: u8,
    pub(crate) qform_code: i16,
    pub(crate) sform_code: i16,
    pub(crate) quaternion: [f64; 3],
    pub(crate) quaternion_offset: [f64; 3],
    pub(crate) srow: Rows,
    pub(crate) description: &'static str,
    pub(crate) data: Vec<u8>,
}

impl Nifti {
    /// 16-bit values, half a millimetre wide, 0.75 high, slices 2 apart, counted as RAS.
    pub(crate) fn new(version: u8) -> Self {
        Self {
            version,
            is_big_endian: false,
            is_pair: false,
            dim: [3, 4, 3, 2, 1, 1, 1, 1],
            datatype: 4,
            pixdim: [1.0, 0.5, 0.75, 2.0, 0.0, 0.0, 0.0, 0.0],
            offset: if version == 1 { 352.0 } else { 544.0 },
            slope: 0.0,
            intercept: 0.0,
            units: 2,
            qform_code: 0,
            sform_code: 1,
            quaternion: [0.0; 3],
            quaternion_offset: [0.0; 3],
            srow: [
                [0.5, 0.0, 0.0, 10.0],
                [0.0, 0.75, 0.0, 20.0],
                [0.0, 0.0, 2.0, 30.0],
            ],
            description: "test head",
            data: stored(4, &small_values(), false),
        }
    }

    /// The same with other numbers of another type.
    pub(crate) fn with(mut self, datatype: i16, values: &[f64]) -> Self {
        self.datatype = datatype;
        self.data = stored(datatype, values, self.is_big_endian);
        self
    }

    pub(crate) fn header(&self) -> Vec<u8> {
        let mut h = Fields {
            bytes: vec![0; if self.version == 1 { 348 } else { 540 }],
            is_big_endian: self.is_big_endian,
        };
        if self.version == 1 {
            self.version_1(&mut h);
        } else {
            self.version_2(&mut h);
        }
        h.bytes
    }

    fn version_1(&self, h: &mut Fields) {
        h.put(0, 348_i32.to_le_bytes());
        for n in 0..8 {
            h.put(40 + 2 * n, (self.dim[n] as i16).to_le_bytes());
            h.put(76 + 4 * n, (self.pixdim[n] as f32).to_le_bytes());
        }
        h.put(70, self.datatype.to_le_bytes());
        h.put(108, (self.offset as f32).to_le_bytes());
        h.put(112, (self.slope as f32).to_le_bytes());
        h.put(116, (self.intercept as f32).to_le_bytes());
        h.bytes[123] = self.units;
        h.bytes[148..148 + self.description.len()].copy_from_slice(self.description.as_bytes());
        h.put(252, self.qform_code.to_le_bytes());
        h.put(254, self.sform_code.to_le_bytes());
        for n in 0..3 {
            h.put(256 + 4 * n, (self.quaternion[n] as f32).to_le_bytes());
            h.put(
                268 + 4 * n,
                (self.quaternion_offset[n] as f32).to_le_bytes(),
            );
            for m in 0..4 {
                h.put(280 + 16 * n + 4 * m, (self.srow[n][m] as f32).to_le_bytes());
            }
        }
        h.bytes[344..348].copy_from_slice(if self.is_pair { b"ni1\0" } else { b"n+1\0" });
    }

    fn version_2(&self, h: &mut Fields) {
        h.put(0, 540_i32.to_le_bytes());
        let magic = if self.is_pair { b"ni2\0" } else { b"n+2\0" };
        h.bytes[4..8].copy_from_slice(magic);
        h.bytes[8..12].copy_from_slice(b"\r\n\x1a\n");
        h.put(12, self.datatype.to_le_bytes());
        for n in 0..8 {
            h.put(16 + 8 * n, self.dim[n].to_le_bytes());
            h.put(104 + 8 * n, self.pixdim[n].to_le_bytes());
        }
        h.put(168, (self.offset as i64).to_le_bytes());
        h.put(176, self.slope.to_le_bytes());
        h.put(184, self.intercept.to_le_bytes());
        h.bytes[240..240 + self.description.len()].copy_from_slice(self.description.as_bytes());
        h.put(344, i32::from(self.qform_code).to_le_bytes());
        h.put(348, i32::from(self.sform_code).to_le_bytes());
        for n in 0..3 {
            h.put(352 + 8 * n, self.quaternion[n].to_le_bytes());
            h.put(376 + 8 * n, self.quaternion_offset[n].to_le_bytes());
            for m in 0..4 {
                h.put(400 + 32 * n + 8 * m, self.srow[n][m].to_le_bytes());
            }
        }
        h.put(500, i32::from(self.units).to_le_bytes());
    }

    /// Header and voxels in one file.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.header();
        bytes.resize(bytes.len() + 4, 0);
        bytes.extend(&self.data);
        bytes
    }
}

struct Fields {
    bytes: Vec<u8>,
    is_big_endian: bool,
}

impl Fields {
    fn put<const N: usize>(&mut self, place: usize, mut bytes: [u8; N]) {
        if self.is_big_endian {
            bytes.reverse();
        }
        self.bytes[place..place + N].copy_from_slice(&bytes);
    }
}

/// Lines of an NRRD header of 16-bit values in LPS, without the empty line at its end.
pub(crate) const NRRD: &str = "NRRD0004\n# a comment\ntype: short\ndimension: 3\n\
    space: left-posterior-superior\nsizes: 4 3 2\n\
    space directions: (0.5,0,0) (0,0.75,0) (0,0,2)\nkinds: domain domain domain\n\
    endian: little\nencoding: raw\nspace origin: (10,20,30)\ncontent: test head\nkey:=value\n";

/// The header, an empty line and the data.
pub(crate) fn nrrd(header: &str, data: &[u8]) -> Vec<u8> {
    [header.as_bytes(), b"\n", data].concat()
}

/// A folder for test files.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

pub(crate) fn open(name: &str, bytes: &[u8]) -> Result<VolumeFile, VolumeFileError> {
    let folder = Folder::new();
    VolumeFile::open(&folder.write(name, bytes))
}

pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<(Volume, Vec<String>), VolumeFileError> {
    let folder = Folder::new();
    VolumeFile::open(&folder.write(name, bytes))?.read(&Task::default())
}

/// Hounsfield units in the order of the file.
pub(crate) fn values(volume: &Volume) -> Vec<f64> {
    match volume.voxels() {
        Voxels::I16(a) => a.iter().map(|v| f64::from(*v)).collect(),
        Voxels::F32(a) => a.iter().map(|v| f64::from(*v)).collect(),
    }
}

/// Asserts that a map has these rows, up to the rounding of 32-bit header fields.
pub(crate) fn assert_rows(volume: &bonemesh_volume::Geometry, rows: Rows) {
    let found = volume.patient_from_voxel().matrix();
    for (found, row) in found.iter().zip(rows) {
        for (a, b) in found.iter().zip(row) {
            assert!((a - b).abs() < 1e-4, "{found:?} is not {row:?}");
        }
    }
}
