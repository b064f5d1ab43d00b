//! What can go wrong between a folder and a volume.

use std::path::PathBuf;

use bonemesh_task::Cancelled;
use bonemesh_volume::VolumeError;

/// Why a folder or a series gives no volume.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum DicomError {
    /// The folder does not exist.
    #[error("the folder {} does not exist; check the path", .0.display())]
    NotFound(PathBuf),
    /// A file was given that is no volume by itself.
    #[error(
        "{} is a file, no volume by itself ({reason}); give the folder that holds the slices of the CT series",
        path.display()
    )]
    NotAFolder {
        /// The file.
        path: PathBuf,
        /// Why it makes no volume.
        reason: String,
    },
    /// The folder cannot be listed.
    #[error("the folder {} cannot be read ({reason}); check its permissions", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the operating system said.
        reason: String,
    },
    /// Nothing in the folder is a CT series.
    #[error(
        "no CT series in {} ({summary}); choose the folder that holds the slices of the scan",
        path.display()
    )]
    NoSeries {
        /// The folder.
        path: PathBuf,
        /// How many files were left out, and why.
        summary: String,
    },
    /// Several series could be meant.
    #[error("several series could be meant: {choices}; choose one by its number or UID")]
    Ambiguous {
        /// The choices, one after the other.
        choices: String,
    },
    /// The series asked for is not there.
    #[error("there is no series {wanted} here; there is {choices}")]
    NoSuchSeries {
        /// Number or UID as it was given.
        wanted: String,
        /// The choices, one after the other.
        choices: String,
    },
    /// Neither a number nor a UID.
    #[error("`{0}` names no series; write its number (1 is the largest) or its UID")]
    Choice(String),
    /// Pixels in a form that cannot be read.
    #[error(
        "the pixels are stored as {name} ({uid}), which cannot be read; export the series uncompressed (Explicit VR Little Endian)"
    )]
    TransferSyntax {
        /// Name of the transfer syntax.
        name: String,
        /// UID of the transfer syntax.
        uid: String,
    },
    /// Compressed pixels that the files cannot hold.
    #[error(
        "{slices} slices of {rows} x {columns} cannot be in files as small as these; copy the series again from its source"
    )]
    Implausible {
        /// Slices of the volume.
        slices: usize,
        /// Rows of a slice.
        rows: usize,
        /// Columns of a slice.
        columns: usize,
    },
    /// Too few slices could be read.
    #[error(
        "only {readable} of {slices} slices can be read, {} is the first that cannot ({reason}); copy the series again from its source",
        path.display()
    )]
    Unreadable {
        /// Slices that can be read.
        readable: usize,
        /// Slices of the series.
        slices: usize,
        /// First file that cannot be read.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The volume does not fit into memory.
    #[error(
        "a volume of {slices} slices of {rows} x {columns} needs {bytes} bytes, more than can be had; close other programs or use a smaller series"
    )]
    Memory {
        /// Slices of the volume.
        slices: usize,
        /// Rows of a slice.
        rows: usize,
        /// Columns of a slice.
        columns: usize,
        /// Bytes asked for.
        bytes: u64,
    },
    /// Shape or geometry that no volume can have.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Why one file is left out; the text goes into reports.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FileError {
    #[error("cannot be read ({0})")]
    Io(#[from] std::io::Error),
    #[error("empty file")]
    Empty,
    #[error("not a regular file")]
    Special,
    #[error("not a DICOM file")]
    NotDicom,
    #[error("a directory of files, no image")]
    Directory,
    #[error("damaged header ({0})")]
    Header(&'static str),
    #[error("cut off: {found} of {needed} bytes are there")]
    CutOff { needed: u64, found: u64 },
    #[error("no image: {0}")]
    NoImage(String),
    #[error("unknown transfer syntax {0}")]
    UnknownSyntax(String),
    #[error("modality {0}, not CT")]
    Modality(String),
    #[error("localizer")]
    Localizer,
    #[error("{0}")]
    Geometry(String),
    #[error("pixels cannot be decoded ({0})")]
    Codec(String),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
