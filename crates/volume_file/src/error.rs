//! What can go wrong between a file and its volume.

use std::io;
use std::path::{Path, PathBuf};

use bonemesh_task::Cancelled;
use bonemesh_volume::VolumeError;

/// Why a file gives no volume.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum VolumeFileError {
    /// The file does not exist.
    #[error("the file {} does not exist; check the path", .0.display())]
    NotFound(PathBuf),
    /// A folder, a pipe or a device.
    #[error("{} is no regular file; give a NIfTI or NRRD file", .0.display())]
    NotAFile(PathBuf),
    /// The operating system refused.
    #[error("the file {} cannot be read ({reason}); check its permissions and its disk", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        reason: String,
    },
    /// The content is of no known format.
    #[error(
        "{} is neither NIfTI nor NRRD; give such a file, or the folder of a DICOM series",
        .0.display()
    )]
    UnknownFormat(PathBuf),
    /// The header contradicts itself or the format.
    #[error("the header of {} is damaged ({reason}); copy or export the file again", path.display())]
    Header {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A kind of file that this reader does not know.
    #[error("{} holds {what}, which cannot be read; {remedy}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What was found.
        what: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// Several volumes in one file.
    #[error(
        "{} holds {volumes} volumes; save the one that is meant as a file of its own",
        path.display()
    )]
    SeveralVolumes {
        /// The file.
        path: PathBuf,
        /// How many volumes it holds.
        volumes: u64,
    },
    /// A picture, no volume.
    #[error("{} holds {slices} slice; a volume needs at least 2", path.display())]
    TooFewSlices {
        /// The file.
        path: PathBuf,
        /// Slices that it holds.
        slices: u64,
    },
    /// The file holds less than its header says.
    #[error(
        "{} is cut off: its header claims {needed} bytes of voxels, at most {found} are there; copy or export the file again",
        path.display()
    )]
    CutOff {
        /// The file.
        path: PathBuf,
        /// Bytes that the header claims.
        needed: u64,
        /// Bytes that are there, or that compressed data of this size can hold at most.
        found: u64,
    },
    /// Compressed data that would grow as no scan does.
    #[error(
        "{} claims {needed} bytes of voxels in {stored} bytes of gzip, which no scan fits into; if it is a good file, save it uncompressed",
        path.display()
    )]
    Inflated {
        /// The file.
        path: PathBuf,
        /// Bytes that the header claims.
        needed: u64,
        /// Bytes of compressed data.
        stored: u64,
    },
    /// The file that a header names for its voxels.
    #[error(
        "the header {} names the data file `{data}`, {reason}; put the data file beside its header",
        path.display()
    )]
    DataFile {
        /// The header.
        path: PathBuf,
        /// The data file as the header names it.
        data: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Compressed or written numbers that make no sense.
    #[error("the voxels of {} are damaged ({reason}); copy or export the file again", path.display())]
    Data {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The volume does not fit into memory.
    #[error(
        "the volume of {} needs {bytes} bytes, more than can be had; close other programs or use a smaller volume",
        path.display()
    )]
    Memory {
        /// The file.
        path: PathBuf,
        /// Bytes asked for.
        bytes: u64,
    },
    /// Shape or geometry that no volume can have.
    #[error("{}: {source}", path.display())]
    Volume {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: VolumeError,
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl VolumeFileError {
    pub(crate) fn io(path: &Path, error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::NotFound(path.to_owned()),
            _ => Self::Io {
                path: path.to_owned(),
                reason: error.to_string(),
            },
        }
    }

    pub(crate) fn header(path: &Path, reason: impl Into<String>) -> Self {
        Self::Header {
            path: path.to_owned(),
            reason: reason.into(),
        }
    }

    pub(crate) fn unsupported(path: &Path, what: impl Into<String>, remedy: &'static str) -> Self {
        Self::Unsupported {
            path: path.to_owned(),
            what: what.into(),
            remedy,
        }
    }
}
