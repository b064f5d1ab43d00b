//! A volume file: its checked header, and the volume on request.

use std::path::{Path, PathBuf};

use bonemesh_task::Task;
use bonemesh_volume::{Geometry, Volume};

use crate::data::Encoding;
use crate::error::VolumeFileError;
use crate::header::Header;
use crate::sample::{AIR_HU, Summary};
use crate::sniff::{Format, damage, sniff};
use crate::{nifti, nrrd, read};

/// A file that holds a whole volume; its header was read and checked, its voxels were not read.
#[derive(Clone, Debug)]
pub struct VolumeFile {
    path: PathBuf,
    header: Header,
}

impl VolumeFile {
    /// Whether the first bytes of a file are those of a known format (a few kilobytes are read).
    ///
    /// False for anything else, and for what cannot be read. An `.img` counts when its `.hdr`
    /// lies beside it.
    pub fn is_one(path: &Path) -> bool {
        match sniff(path) {
            Ok(Some(_)) => true,
            Ok(None) => nifti::header_of_image(path).is_some(),
            Err(_) => false,
        }
    }

    /// Reads and checks the header.
    ///
    /// # Errors
    /// [`VolumeFileError`], all but `Data`, `Memory` and `Cancelled`: what the file is, claims or
    /// lacks is found here, and no memory is asked for on the header's word.
    pub fn open(path: &Path) -> Result<Self, VolumeFileError> {
        let Some(head) = sniff(path)? else {
            let header = nifti::header_of_image(path).ok_or_else(|| unknown(path));
            return Self::open(&header?);
        };
        let header = match head.format {
            Format::Nifti1 { has_pair } => nifti::version_1(path, &head, has_pair)?,
            Format::Nifti2 { has_pair } => nifti::version_2(path, &head, has_pair)?,
            Format::Nrrd => nrrd::header(path)?,
            Format::Analyze => {
                return Err(VolumeFileError::unsupported(
                    path,
                    "an ANALYZE 7.5 volume, which does not say where left is",
                    "export it as NIfTI from the program that made it",
                ));
            }
        };
        header.data.check()?;
        Ok(Self {
            path: path.to_owned(),
            header,
        })
    }

    /// The file, or the header where the voxels are in a file of their own.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Shape and place in the patient (LPS millimetres).
    pub fn geometry(&self) -> &Geometry {
        &self.header.geometry
    }

    /// Name of the format and its encoding, for example `NIfTI-1, gzip`.
    pub fn format(&self) -> String {
        let encoding = match self.header.data.encoding {
            Encoding::Raw => "uncompressed",
            Encoding::Gzip => "gzip",
            Encoding::Text => "text",
        };
        format!("{}, {encoding}", self.header.format)
    }

    /// What the writer noted in the header; printable characters only, often empty.
    pub fn description(&self) -> &str {
        &self.header.description
    }

    /// Memory that the volume takes (bytes): 2 a voxel where the header says that all values are
    /// whole, 4 elsewhere. Whole values beyond 16 bits, and floating-point ones that turn out to be
    /// whole, are known only after reading.
    pub fn estimated_memory_bytes(&self) -> u64 {
        let voxels: u64 = self.geometry().shape().iter().map(|n| *n as u64).product();
        voxels
            * if self.header.conversion.is_whole() {
                2
            } else {
                4
            }
    }

    /// What a user should know before reading.
    pub fn warnings(&self) -> &[String] {
        &self.header.warnings
    }

    /// Reads the voxels; also gives what a user should know, [`VolumeFile::warnings`] included.
    ///
    /// Hounsfield units `[slice, row, column]`, 16-bit where all values are whole and fit, 32-bit
    /// floating point otherwise. Voxels that are no finite number become air (-1000). The stage is
    /// `read`.
    ///
    /// # Errors
    /// [`VolumeFileError::CutOff`] and [`VolumeFileError::Data`] when compressed or written data
    /// end early or are damaged, [`VolumeFileError::Io`], [`VolumeFileError::Memory`],
    /// [`VolumeFileError::Cancelled`].
    pub fn read(&self, task: &Task) -> Result<(Volume, Vec<String>), VolumeFileError> {
        let (voxels, seen) = read::read(&self.path, &self.header, task)?;
        let mut warnings = self.header.warnings.clone();
        warnings.extend(observations(seen));
        let volume = Volume::new(voxels, self.header.geometry.clone()).map_err(|source| {
            VolumeFileError::Volume {
                path: self.path.clone(),
                source,
            }
        })?;
        Ok((volume, warnings))
    }
}

/// Why a file is of no known format: damaged where its name promises one.
fn unknown(path: &Path) -> VolumeFileError {
    const ENDINGS: [(&str, &str); 4] = [
        (".nii", "NIfTI"),
        (".nii.gz", "NIfTI"),
        (".nrrd", "NRRD"),
        (".nhdr", "NRRD"),
    ];
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_ascii_lowercase();
    let promised = ENDINGS.iter().find(|(ending, _)| name.ends_with(ending));
    let Some((_, format)) = promised else {
        return VolumeFileError::UnknownFormat(path.to_owned());
    };
    let reason = match damage(path) {
        Some(reason) => reason.to_owned(),
        None => format!("its first bytes are not those of {format}"),
    };
    VolumeFileError::header(path, reason)
}

/// What the values say.
fn observations(seen: Summary) -> Vec<String> {
    let mut notes = Vec::new();
    if seen.not_finite > 0 {
        notes.push(format!(
            "{} voxels are no finite number; they are taken as air ({AIR_HU} HU)",
            seen.not_finite
        ));
    }
    if seen.lowest_hu.is_finite() && seen.lowest_hu >= 0.0 {
        notes.push(format!(
            "no value is below {}: these may not be Hounsfield units (air is at {AIR_HU}); check the threshold",
            seen.lowest_hu
        ));
    }
    notes
}
