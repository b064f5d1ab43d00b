//! Bodies of known shape as CT volumes and DICOM series.

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
mod truth;
mod vector;

pub use body::{AIR_HU, BONE_HU, Body, SOFT_HU};
pub use catalog::Phantom;
pub use dicom::{SeriesLabels, write_dicom_series};
pub use error::PhantomError;
pub use models::model_images;
pub use orientation::{ORIENTATIONS, Orientation};
pub use scan::scan;
pub use settings::ScanSettings;
pub use truth::{WrittenPhantom, truth, write_phantom};
