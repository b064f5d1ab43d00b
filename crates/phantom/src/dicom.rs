//! A volume as a DICOM CT series, one file a slice.
//!
//! CT Image Storage, explicit VR little endian, 16 bits. Everything is worked out in a folder
//! beside the target and moved into place at the end.

mod attributes;
mod decimal;
mod stored;
mod uid;

use std::fs;
use std::path::{Path, PathBuf};

use bonemesh_task::Task;
use bonemesh_volume::Volume;
use rayon::prelude::*;

use crate::{PatientPosition, PhantomError};
use attributes::Series;

/// The words in a series' header; the defaults say that nobody's body is shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeriesLabels {
    /// `PatientName`, family^given.
    pub patient_name: String,
    /// `PatientID`.
    pub patient_id: String,
    /// `StudyDescription`.
    pub study_description: String,
    /// `SeriesDescription`.
    pub series_description: String,
    /// `SeriesNumber`.
    pub series_number: u32,
    /// How the patient lies on the table.
    pub patient_position: PatientPosition,
}

impl Default for SeriesLabels {
    fn default() -> Self {
        Self {
            patient_name: "Phantom".to_owned(),
            patient_id: "PHANTOM".to_owned(),
            study_description: "Artificial body".to_owned(),
            series_description: "Phantom".to_owned(),
            series_number: 1,
            patient_position: PatientPosition::default(),
        }
    }
}

/// Writes `volume` into the folder `dir` and returns its files in slice order.
///
/// The folder is made where it is missing. Whole Hounsfield units come back exactly; fractional
/// ones are spread over 16 bits. UIDs follow from the labels and the content alone: the same
/// volume gives the same files.
///
/// # Errors
/// [`PhantomError::FolderInUse`] where the folder holds anything already,
/// [`PhantomError::NotAFolder`], [`PhantomError::Write`], [`PhantomError::Dicom`] for values
/// that do not fit, and when cancelled; nothing is left behind then.
pub fn write_dicom_series(
    volume: &Volume,
    dir: &Path,
    labels: &SeriesLabels,
    task: &Task,
) -> Result<Vec<PathBuf>, PhantomError> {
    check_target(dir)?;
    let series = Series::new(volume, labels)?;
    let workshop = workshop_beside(dir)?;
    let fresh = workshop.path().join("series");
    fs::create_dir(&fresh).map_err(|e| PhantomError::write(&fresh, &e))?;
    let slices = volume.geometry().shape()[0];
    task.begin("write", slices);
    let names: Vec<String> = (0..slices)
        .into_par_iter()
        .map(|k| {
            let name = format!("IM{:05}.dcm", k + 1);
            let bytes = series.file(k)?;
            let path = fresh.join(&name);
            fs::write(&path, bytes).map_err(|e| PhantomError::write(&dir.join(&name), &e))?;
            task.advance(1)?;
            Ok(name)
        })
        .collect::<Result<_, PhantomError>>()?;
    move_into_place(&fresh, dir)?;
    Ok(names.into_iter().map(|name| dir.join(name)).collect())
}

/// Refuses a target that is a file or holds anything.
pub(crate) fn check_target(dir: &Path) -> Result<(), PhantomError> {
    if !dir.exists() {
        return Ok(());
    }
    if !dir.is_dir() {
        return Err(PhantomError::NotAFolder(dir.to_owned()));
    }
    let mut entries = fs::read_dir(dir).map_err(|e| PhantomError::write(dir, &e))?;
    if entries.next().is_some() {
        return Err(PhantomError::FolderInUse(dir.to_owned()));
    }
    Ok(())
}

/// A temporary folder on the same disk as `dir`, so that moving is renaming.
pub(crate) fn workshop_beside(dir: &Path) -> Result<tempfile::TempDir, PhantomError> {
    let parent = match dir.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(parent).map_err(|e| PhantomError::write(parent, &e))?;
    tempfile::Builder::new()
        .prefix(".bonemesh-phantom-")
        .tempdir_in(parent)
        .map_err(|e| PhantomError::write(parent, &e))
}

/// Puts the finished folder where the checked target is missing or empty.
pub(crate) fn move_into_place(fresh: &Path, dir: &Path) -> Result<(), PhantomError> {
    if dir.exists() {
        fs::remove_dir(dir).map_err(|e| PhantomError::write(dir, &e))?;
    }
    fs::rename(fresh, dir).map_err(|e| PhantomError::write(dir, &e))
}
