//! Files that appear complete or not at all.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use bonemesh_task::Cancelled;
use tempfile::NamedTempFile;

use crate::MeshError;

/// Why the writing of a file stopped.
#[derive(Debug)]
pub(super) enum Fault {
    /// The operating system refused.
    Io(io::Error),
    /// Stopped on request.
    Cancelled(Cancelled),
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<Cancelled> for Fault {
    fn from(cancelled: Cancelled) -> Self {
        Self::Cancelled(cancelled)
    }
}

/// Lets `fill` write a temporary file beside `path`, then gives it that name.
///
/// No fsync: it would cost more than the writing, and a rename keeps the old or the new file, never
/// a mixture, on the file systems in use. A link is followed, so it stays a link.
pub(super) fn write(
    path: &Path,
    fill: impl FnOnce(&mut File) -> Result<(), Fault>,
) -> Result<(), MeshError> {
    let target = destination(path)?;
    let mut temporary = create_beside(&target).map_err(|e| MeshError::writing(path, &e))?;
    match fill(temporary.as_file_mut()) {
        Ok(()) => {}
        Err(Fault::Io(error)) => return Err(MeshError::writing(path, &error)),
        Err(Fault::Cancelled(cancelled)) => return Err(cancelled.into()),
    }
    temporary
        .persist(&target)
        .map_err(|e| MeshError::writing(path, &e.error))?;
    Ok(())
}

/// Whether a file could be written at `path`.
pub(super) fn probe(path: &Path) -> Result<(), MeshError> {
    let target = destination(path)?;
    create_beside(&target).map_err(|e| MeshError::writing(path, &e))?;
    Ok(())
}

/// Where the file goes, links followed, after the checks that a rename would not make.
fn destination(path: &Path) -> Result<PathBuf, MeshError> {
    if path.is_dir() {
        return Err(MeshError::IsFolder {
            path: path.to_path_buf(),
        });
    }
    if let Some(folder) = path.parent()
        && !folder.as_os_str().is_empty()
        && !folder.is_dir()
    {
        return Err(MeshError::NoFolder {
            path: path.to_path_buf(),
            folder: folder.to_path_buf(),
        });
    }
    let Ok(existing) = fs::metadata(path) else {
        return Ok(path.to_path_buf());
    };
    // A rename replaces devices, pipes and write-protected files without asking.
    if !existing.is_file() {
        return Err(MeshError::NotAFile {
            path: path.to_path_buf(),
        });
    }
    if existing.permissions().readonly() {
        return Err(MeshError::ReadOnly {
            path: path.to_path_buf(),
            reason: "the file is write-protected".into(),
        });
    }
    fs::canonicalize(path).map_err(|e| MeshError::writing(path, &e))
}

/// A temporary file beside `target` that others may read as far as the user's settings allow.
fn create_beside(target: &Path) -> io::Result<NamedTempFile> {
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".bonemesh-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The default, 0600, would stay after the rename and keep colleagues from reading.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
