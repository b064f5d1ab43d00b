//! Bodies of known shape, scanned as CT volumes and written as DICOM series.
//!
//! Every claim about a mesh needs a body whose surface is known exactly. A [`Phantom`] is either
//! one of the binary models of Rier's thesis, drawn in pixels, or a [`Body`] that gives the
//! signed distance of any point to its bone surface. [`scan`] turns it into Hounsfield units
//! with partial volume, the scanner's blur and seeded noise, on any grid: axial, sagittal,
//! coronal, oblique, tilted, reversed, prone, on the side. [`write_phantom`] adds a DICOM series and a JSON file
//! with the truth. [`BoneSurface`] measures how far a mesh is from it.
//!
//! A scan is the same to the last bit for any number of threads.
//!
//! Limits: blur acts in the slice only, across slices there is the slice's own thickness; noise
//! is white, without streaks or beam hardening. Distances of femur and head are lower bounds
//! near blends and where several parts are near; sign and surface are right everywhere, and
//! [`BoneSurface`] finds the nearest point of the surface wherever one asks. The head is drawn by
//! hand to look like one, with adult lengths; it is nobody's.
//!
//! ```
//! use bonemesh_phantom::{Phantom, scan, write_phantom};
//! use bonemesh_task::Task;
//!
//! let phantom: Phantom = "head".parse()?;
//! let settings = phantom.settings().coarser(8.0);
//! let volume = scan(phantom, &settings, &Task::default())?;
//! assert_eq!(volume.geometry().shape(), [18, 40, 40]);
//!
//! let dir = tempfile::tempdir()?;
//! let written = write_phantom(phantom, &dir.path().join("head"), &settings, &Task::default())?;
//! assert_eq!(written.files.len(), 18);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Source of the models: E. Rier, *Generation and segmentation of 3D models of bone from CT
//! images based on 3D point clouds*, `MASc` thesis, `McMaster` University.

mod bodies;
mod body;
mod catalog;
mod dicom;
mod error;
mod models;
mod orientation;
mod primitives;
mod scan;
mod settings;
mod shape;
mod surface;
mod truth;
mod vector;

pub use body::{AIR_HU, BONE_HU, Body, SOFT_HU};
pub use catalog::Phantom;
pub use dicom::{SeriesLabels, write_dicom_series};
pub use error::PhantomError;
pub use models::model_images;
pub use orientation::{ORIENTATIONS, Orientation, PatientPosition};
pub use scan::scan;
pub use settings::ScanSettings;
pub use surface::{BoneSurface, Nearest};
pub use truth::{WrittenPhantom, truth, write_phantom};
