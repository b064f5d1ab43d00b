//! A folder of files to its CT series, and a series to its volume in Hounsfield units.
//!
//! [`find_series`] looks at every file of a folder and its sub-folders by content, reads headers
//! only, and groups the slices it finds into [`Series`]; what belongs to none is listed with the
//! reason. [`Scan::choose`] picks the series that is meant and refuses to guess between two.
//! [`read_series`] decodes the pixels on every core.
//!
//! Slices are ordered by their positions along the normal of their plane, never by name or
//! number. The volume's map from voxels to the patient holds any orientation and a tilted
//! gantry's shear. Missing slices are filled and uneven ones resampled, linearly along the
//! stack, and [`SeriesReport::warnings`] says so. Rescale, bit depth, sign and padding are honoured
//! slice by slice.
//!
//! Limits: modality CT (or none given), one sample a pixel. Transfer syntaxes: uncompressed,
//! deflated, RLE, JPEG (8 and 12 bit, and lossless), JPEG-LS, JPEG 2000 and its high-throughput
//! form; others are named and refused.
//! Nothing that identifies the patient is read from the files.
//!
//! ```no_run
//! use bonemesh_dicom::{find_series, read_series};
//! use bonemesh_task::Task;
//!
//! let task = Task::default();
//! let scan = find_series("scans/head".as_ref(), &task)?;
//! for series in &scan.series {
//!     println!("{} {} {:?} mm", series.number, series.description, series.spacing_mm);
//! }
//! let (volume, warnings) = read_series(scan.choose(None)?, &task)?;
//! println!("{:?} voxels, {warnings:?}", volume.voxels().shape());
//! # Ok::<(), bonemesh_dicom::DicomError>(())
//! ```
//!
//! Source: the DICOM standard, PS3.3 (C.7.6.2 image plane, C.7.6.3 image pixel, C.11.1 modality
//! LUT, C.7.6.16 multi-frame functional groups) and PS3.5 (encodings). Element headers and codecs
//! are those of dicom-rs; JPEG-LS is `CharLS`, JPEG of 12 bits libjpeg-turbo.

mod acquisitions;
mod choice;
mod codec;
mod codestream;
mod elements;
mod error;
mod file;
mod fragments;
mod frame;
mod group;
mod header;
mod hounsfield;
mod inflated;
mod jpeg_12;
mod jpeg_2000;
mod line;
mod moment;
mod phases;
mod placed;
mod plausible;
mod read;
mod report;
mod rle;
mod same_place;
mod scan;
mod series;
mod slice;
mod stack;
mod vector;

pub use choice::SeriesChoice;
pub use error::DicomError;
pub use read::read_series;
pub use report::{Gap, SeriesReport};
pub use scan::{LeftOut, Scan, find_one_series, find_series};
pub use series::Series;
