//! Pictures and reports that appear complete or not at all.

use std::io;
use std::path::Path;

use tempfile::NamedTempFile;

/// Lets `fill` write a temporary file beside `path`, then gives it that name.
pub(crate) fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut NamedTempFile) -> io::Result<()>,
) -> io::Result<()> {
    // A link is followed, so it stays a link.
    let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let mut file = create_beside(&target)?;
    fill(&mut file)?;
    file.persist(target)?;
    Ok(())
}

/// Whether a file could be written at `path`.
pub(crate) fn probe(path: &Path) -> io::Result<()> {
    create_beside(path).map(drop)
}

/// A temporary file in the folder of `path`, which a rename would not refuse to replace.
fn create_beside(path: &Path) -> io::Result<NamedTempFile> {
    if let Ok(existing) = std::fs::metadata(path) {
        if !existing.is_file() {
            return Err(io::Error::other("it is no ordinary file"));
        }
        if existing.permissions().readonly() {
            return Err(io::Error::new(
                io::ErrorKind::PermissionDenied,
                "the file is write-protected",
            ));
        }
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        let missing = format!("there is no folder {}", folder.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, missing));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".bonemesh-");
    #[cfg(unix)]
    {
        // A temporary file is private by default; this one is to become an ordinary file.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
