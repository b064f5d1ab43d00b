//! What can go wrong when a phantom is scanned or written.

use std::path::PathBuf;

use bonemesh_task::Cancelled;
use bonemesh_volume::VolumeError;

/// A phantom that could not be made or written; nothing was left on disk.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum PhantomError {
    /// No phantom has this name.
    #[error("there is no phantom `{name}`; choose one of {known}")]
    UnknownPhantom {
        /// The name asked for.
        name: String,
        /// All names.
        known: String,
    },
    /// No orientation has this name.
    #[error("there is no orientation `{name}`; choose one of {known}")]
    UnknownOrientation {
        /// The name asked for.
        name: String,
        /// All names.
        known: String,
    },
    /// A scan setting that makes no scan.
    #[error("{setting} = {value} cannot be used; it must be {allowed}")]
    Setting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A model drawn in pixels that the matrix cannot hold.
    #[error(
        "the {phantom} model needs {needed} columns and rows, the matrix has {columns} x {rows}; enlarge the matrix"
    )]
    MatrixTooSmall {
        /// The model's name.
        phantom: &'static str,
        /// Columns and rows needed.
        needed: usize,
        /// Columns of the matrix.
        columns: usize,
        /// Rows of the matrix.
        rows: usize,
    },
    /// Binary images were asked of a body.
    #[error("{0} is a body, not a model drawn in pixels; scan it and take a threshold")]
    NoModel(crate::Phantom),
    /// The grid is unusable.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// The target folder holds files already.
    #[error("{0} already holds files; choose an empty or a new folder for the phantom")]
    FolderInUse(PathBuf),
    /// The target is a file.
    #[error("{0} is a file, not a folder; choose a folder for the phantom")]
    NotAFolder(PathBuf),
    /// The system refused to write.
    #[error(
        "cannot write {path} ({reason}); check that the folder is writable and the disk has room"
    )]
    Write {
        /// What was to be written.
        path: PathBuf,
        /// The system's reason.
        reason: String,
    },
    /// A value that DICOM cannot hold.
    #[error("{what} = {value} does not fit a DICOM file; {remedy}")]
    Dicom {
        /// The attribute.
        what: &'static str,
        /// Its value.
        value: String,
        /// What to do.
        remedy: &'static str,
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl PhantomError {
    pub(crate) fn write(path: &std::path::Path, error: &impl ToString) -> Self {
        Self::Write {
            path: path.to_owned(),
            reason: error.to_string(),
        }
    }
}
