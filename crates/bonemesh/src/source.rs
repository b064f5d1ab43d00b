//! What a path holds: the series of a folder, or one file with a whole volume.

use std::path::Path;

use bonemesh_dicom::{
    DicomError, LeftOut, Scan, SeriesChoice, SeriesReport, find_one_series, find_series,
    read_series,
};
use bonemesh_task::Task;
use bonemesh_volume::Volume;
use bonemesh_volume_file::VolumeFile;
use serde::Serialize;

use crate::Error;

/// What a path holds, before any pixel is decoded.
#[derive(Debug)]
pub struct Source {
    contents: Contents,
    pixels: Pixels,
}

/// What is said of the series that a path holds.
#[derive(Clone, Debug, Serialize)]
pub struct Contents {
    /// Number of the series that is most likely meant: the largest.
    pub recommended: usize,
    /// Numbers of the others that could be meant as well.
    pub alternatives: Vec<usize>,
    /// Largest first.
    pub series: Vec<SeriesReport>,
    /// Files and folders that are in no series.
    pub left_out: Vec<LeftOut>,
}

/// A volume, and what is to be said of it.
#[derive(Debug)]
pub struct Reading {
    /// The voxels, at their place in the patient.
    pub volume: Volume,
    /// The series that was read, its `hu_range` and what reading found included.
    pub series: SeriesReport,
}

#[derive(Debug)]
enum Pixels {
    Folder(Scan),
    File(Box<VolumeFile>),
}

impl Source {
    /// Looks at what `path` holds: a folder of DICOM files, one multi-frame DICOM file, a NIfTI or
    /// an NRRD file. With `one_series`, all slices of a folder that fit together are one series,
    /// whatever UIDs they name. Headers only; runs in the current thread pool.
    ///
    /// # Errors
    /// [`Error::Dicom`], [`Error::VolumeFile`].
    pub fn open(path: &Path, one_series: bool, task: &Task) -> Result<Self, Error> {
        if VolumeFile::is_one(path) || is_named_as_volume(path) {
            let file = VolumeFile::open(path)?;
            return Ok(Self {
                contents: Contents {
                    recommended: 1,
                    alternatives: Vec::new(),
                    series: vec![report(&file)],
                    left_out: Vec::new(),
                },
                pixels: Pixels::File(Box::new(file)),
            });
        }
        let scan = if one_series {
            find_one_series(path, task)?
        } else {
            find_series(path, task)?
        };
        let series = scan.series.iter().map(|s| SeriesReport::clone(s));
        Ok(Self {
            contents: Contents {
                recommended: scan.recommended,
                alternatives: scan.alternatives.clone(),
                series: series.collect(),
                left_out: scan.left_out.clone(),
            },
            pixels: Pixels::Folder(scan),
        })
    }

    /// What is said of the series.
    pub fn contents(&self) -> &Contents {
        &self.contents
    }

    /// Decodes every series, one after the other, to say the range of its values too.
    ///
    /// A series that cannot be decoded says so among its warnings.
    ///
    /// # Errors
    /// [`Error::Cancelled`] or its like.
    pub fn decoded_contents(&self, task: &Task) -> Result<Contents, Error> {
        let mut contents = self.contents.clone();
        for series in &mut contents.series {
            match self.read(Some(&SeriesChoice::Number(series.number)), task) {
                Ok(reading) => *series = reading.series,
                Err(error) if error.is_cancelled() => return Err(error),
                Err(error) => series.warnings.push(error.to_string()),
            }
        }
        Ok(contents)
    }

    /// Reads the series that is chosen, or the only one that can be meant.
    ///
    /// # Errors
    /// [`Error::Dicom`], [`Error::VolumeFile`].
    pub fn read(&self, choice: Option<&SeriesChoice>, task: &Task) -> Result<Reading, Error> {
        let (mut series, volume, mut warnings) = match &self.pixels {
            Pixels::Folder(scan) => {
                let series = scan.choose(choice)?;
                let (volume, warnings) = read_series(series, task)?;
                (SeriesReport::clone(series), volume, warnings)
            }
            Pixels::File(file) => {
                let [series] = &self.contents.series[..] else {
                    unreachable!("a file holds one series: anything else is a bug")
                };
                if !matches!(choice, None | Some(SeriesChoice::Number(1))) {
                    return Err(no_such_series(choice, series));
                }
                let (volume, warnings) = file.read(task)?;
                (series.clone(), volume, warnings)
            }
        };
        let (low, high) = volume.hu_range();
        // Files with a whole volume say it themselves.
        if matches!(self.pixels, Pixels::Folder(_)) {
            warnings.extend(doubts((low, high)));
        }
        series.hu_range = Some([low, high]);
        series.warnings = warnings;
        Ok(Reading { volume, series })
    }
}

/// Whether a file's name says that it is a volume: one too damaged to be known by its content is
/// then told to be that, and not a DICOM file that fails.
fn is_named_as_volume(path: &Path) -> bool {
    const ENDINGS: [&str; 4] = [".nii", ".nii.gz", ".nrrd", ".nhdr"];
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_ascii_lowercase();
    path.is_file() && ENDINGS.iter().any(|ending| name.ends_with(ending))
}

/// Highest value (HU) that scanners give: metal on the extended scale ends at 30710.
const MAX_HU: f64 = 31_000.0;

/// What the values of a DICOM series say against their being Hounsfield units.
fn doubts((low, high): (f64, f64)) -> Option<String> {
    if low >= 0.0 {
        Some(format!(
            "no value is below {low:.0}: these may not be Hounsfield units (air is at -1000); check the threshold"
        ))
    } else if high > MAX_HU {
        Some(format!(
            "values up to {high} HU: padding or the sign of the pixels may be missing from the files; check the threshold"
        ))
    } else {
        None
    }
}

fn no_such_series(choice: Option<&SeriesChoice>, series: &SeriesReport) -> Error {
    Error::Dicom(DicomError::NoSuchSeries {
        wanted: choice.map_or_else(String::new, ToString::to_string),
        choices: series.in_words(),
    })
}

/// The report of a file that holds one volume.
fn report(file: &VolumeFile) -> SeriesReport {
    let geometry = file.geometry();
    let [slices, rows, columns] = geometry.shape();
    let affine = geometry.patient_from_voxel();
    let normal = geometry.slice_normal();
    let along = |p: [f64; 3]| (0..3).map(|i| p[i] * normal[i]).sum::<f64>();
    let first_mm = along(affine.origin());
    let step_mm = geometry.spacing_mm()[2];
    SeriesReport {
        number: 1,
        uid: String::new(),
        description: file.description().to_owned(),
        modality: String::new(),
        slices,
        slices_found: slices,
        rows,
        columns,
        spacing_mm: geometry.spacing_mm(),
        patient_from_voxel: affine.matrix(),
        orientation: geometry.orientation_in_words(),
        tilt_degrees: geometry.tilt_degrees(),
        slice_positions_mm: (0..slices).map(|k| first_mm + step_mm * k as f64).collect(),
        gaps: Vec::new(),
        is_resampled: false,
        duplicates: Vec::new(),
        transfer_syntax: file.format(),
        estimated_memory_bytes: file.estimated_memory_bytes(),
        hu_range: None,
        warnings: file.warnings().to_vec(),
        files: vec![file.path().to_owned()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_no_ct_has_are_doubted() {
        assert_eq!(doubts((-1024.0, 3071.0)), None);
        assert_eq!(doubts((-10_240.0, 30_710.0)), None);
        assert!(doubts((0.0, 4095.0)).is_some_and(|d| d.contains("no value is below 0")));
        assert!(doubts((-1024.0, 64_511.0)).is_some_and(|d| d.contains("up to 64511 HU")));
    }
}
