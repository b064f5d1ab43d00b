//! One file that holds a whole volume, to that volume in Hounsfield units and patient millimetres.
//!
//! [`VolumeFile::is_one`] looks at a file's first bytes, [`VolumeFile::open`] reads and checks its
//! header, [`VolumeFile::read`] its voxels. `NIfTI-1` and `NIfTI-2` (`.nii`, `.nii.gz`, `.hdr` with
//! `.img`) and NRRD (`.nrrd`, `.nhdr` with its data file; raw, gzip or text) are known, in both byte
//! orders. The content decides the format, never the name.
//!
//! Values are those of the file with its slope and intercept: scaled numbers are taken as
//! Hounsfield units, and [`VolumeFile::read`] warns where they do not look like them. NIfTI and
//! many NRRD files count to the right and to the front (RAS); the volume is in LPS millimetres, so
//! left stays left. The map from voxels to the patient may be oblique, sheared and left-handed.
//!
//! A header is checked against the bytes of its file before memory is asked for: at most 1032
//! times the compressed size, which is the most that gzip can hold, and 200 times beyond 256 MiB,
//! which no scan reaches. Reading takes the volume, a few
//! megabytes and, while 16-bit voxels turn out not to be enough, a half more.
//!
//! Limits: one volume a file, numbers only (no complex, colour or vector voxels), at least two
//! slices. NRRD data in several files, bzip2 and hex are refused by name, and so is ANALYZE 7.5,
//! whose files do not say where left is.
//!
//! ```
//! use bonemesh_task::Task;
//! use bonemesh_volume_file::VolumeFile;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("block.nrrd");
//! let header = "NRRD0004\ntype: int16\ndimension: 3\nsizes: 2 1 2\nspace: RAS\nencoding: text\n\
//!     space directions: (0.5,0,0) (0,0.5,0) (0,0,2)\nspace origin: (10,20,30)\n\n";
//! std::fs::write(&path, format!("{header}-1000 300 40 1200\n"))?;
//!
//! assert!(VolumeFile::is_one(&path));
//! let file = VolumeFile::open(&path)?;
//! assert_eq!(file.geometry().shape(), [2, 1, 2]);
//! assert_eq!(file.geometry().patient_from_voxel().origin(), [-10.0, -20.0, 30.0]);
//! let (volume, warnings) = file.read(&Task::default())?;
//! assert_eq!(volume.hu_range(), (-1000.0, 1200.0));
//! assert!(warnings.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Sources: the NIfTI-1 standard (<https://nifti.nimh.nih.gov/nifti-1>; its header is parsed by
//! nifti-rs), the NIfTI-2 header (<https://nifti.nimh.nih.gov/nifti-2>) and the definition of the
//! NRRD file format (<https://teem.sourceforge.net/nrrd/format.html>).

#![forbid(unsafe_code)]

mod data;
mod error;
mod file;
mod gzip;
mod header;
mod nifti;
mod nrrd;
mod read;
mod sample;
mod sniff;
mod text;

pub use error::VolumeFileError;
pub use file::VolumeFile;
