//! Clouds on disk: `.npy` (`NumPy`), `.ply` and `.xyz`, in millimetres.

mod npy;
mod ply;
mod scalar;
mod xyz;

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::{CloudError, PointCloud};

/// A file format for clouds.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CloudFormat {
    /// `NumPy`'s array file.
    Npy,
    /// Polygon file format, of which the vertices count.
    Ply,
    /// Text, three numbers a line.
    Xyz,
}

impl CloudFormat {
    /// The format that the extension of `path` names, in capitals or not.
    ///
    /// # Errors
    /// [`CloudError::Extension`].
    pub fn of(path: &Path) -> Result<Self, CloudError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("npy") => Ok(Self::Npy),
            Some("ply") => Ok(Self::Ply),
            Some("xyz") => Ok(Self::Xyz),
            _ => Err(CloudError::Extension {
                path: path.to_owned(),
            }),
        }
    }
}

/// Tells now whether [`write_cloud`] could write `path`, so that long work is not lost at its end.
///
/// Makes a temporary file in the folder and takes it away again.
///
/// # Errors
/// Those of [`write_cloud`].
pub fn check_target(path: &Path) -> Result<(), CloudError> {
    CloudFormat::of(path)?;
    let temporary = destination(path).and_then(|target| create_beside(&target));
    temporary.map(drop).map_err(|source| CloudError::Write {
        path: path.to_owned(),
        source,
    })
}

/// Reads a cloud of points (mm), with their lattice if they lie on one along the axes; the file's
/// ending names the format.
///
/// `.npy`: an array of N rows and 3 columns, floating point or whole numbers. `.ply`: the
/// vertices, text or binary, other elements are left out. `.xyz`: three numbers a line; further
/// columns and lines that begin with `#` are left out.
///
/// # Errors
/// [`CloudError::Extension`], [`CloudError::Read`], [`CloudError::Format`],
/// [`CloudError::NotFinite`] and [`CloudError::TooMany`].
pub fn read_cloud(path: &Path) -> Result<PointCloud, CloudError> {
    let format = CloudFormat::of(path)?;
    let bytes = fs::read(path).map_err(|source| CloudError::Read {
        path: path.to_owned(),
        source,
    })?;
    let points = match format {
        CloudFormat::Npy => npy::parse(&bytes),
        CloudFormat::Ply => ply::parse(&bytes),
        CloudFormat::Xyz => xyz::parse(&bytes),
    };
    let points = points.map_err(|reason| CloudError::Format {
        path: path.to_owned(),
        reason,
    })?;
    Ok(PointCloud::from_points(points)?.with_lattice_recognised())
}

/// Writes a cloud's points (mm); the file's ending names the format.
///
/// `.npy`: float64, N rows and 3 columns. `.ply`: binary vertices, double precision. `.xyz`:
/// text, three numbers a line, which read back are the same bits. The file appears only when it
/// is complete.
///
/// # Errors
/// [`CloudError::Extension`] and [`CloudError::Write`].
pub fn write_cloud(cloud: &PointCloud, path: &Path) -> Result<(), CloudError> {
    let format = CloudFormat::of(path)?;
    let points = cloud.points_mm();
    write_whole(path, |out| match format {
        CloudFormat::Npy => npy::write(points, out),
        CloudFormat::Ply => ply::write(points, out),
        CloudFormat::Xyz => xyz::write(points, out),
    })
    .map_err(|source| CloudError::Write {
        path: path.to_owned(),
        source,
    })
}

/// Writes into a temporary file beside `path` and moves it there when it is complete.
fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let path = &destination(path)?;
    let mut out = BufWriter::new(create_beside(path)?);
    write(&mut out)?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.persist(path)?;
    Ok(())
}

/// A temporary file in the folder of `target`.
fn create_beside(target: &Path) -> io::Result<NamedTempFile> {
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".bonemesh-");
    #[cfg(unix)]
    {
        // A temporary file is private by default; this one is to become an ordinary file.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// Where the file goes, links followed; a rename would replace links, devices, pipes and
/// write-protected files without asking.
fn destination(path: &Path) -> io::Result<PathBuf> {
    let Ok(existing) = fs::metadata(path) else {
        return Ok(path.to_owned());
    };
    if !existing.is_file() {
        return Err(io::Error::other("it is no ordinary file"));
    }
    if existing.permissions().readonly() {
        return Err(io::Error::new(
            io::ErrorKind::PermissionDenied,
            "the file is write-protected",
        ));
    }
    fs::canonicalize(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FORMATS: [&str; 3] = ["npy", "ply", "xyz"];

    fn cloud(points: &[[f64; 3]]) -> PointCloud {
        PointCloud::from_points(points.to_vec()).unwrap()
    }

    #[test]
    fn what_a_rename_would_destroy_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let one = cloud(&[[1.0, 2.0, 3.0]]);
        fs::create_dir(at("folder.xyz")).unwrap();
        assert!(write_cloud(&one, &at("folder.xyz")).is_err());
        fs::write(at("kept.xyz"), "mine").unwrap();
        let mut permissions = fs::metadata(at("kept.xyz")).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(at("kept.xyz"), permissions).unwrap();
        assert!(write_cloud(&one, &at("kept.xyz")).is_err());
        assert_eq!(fs::read(at("kept.xyz")).unwrap(), b"mine");
    }

    fn read_bytes(name: &str, bytes: &[u8]) -> Result<PointCloud, CloudError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        read_cloud(&path)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn every_format_gives_back_the_same_bits(
            points in prop::collection::vec(
                prop::array::uniform3(prop::num::f64::NORMAL | prop::num::f64::ZERO), 0..40)
        ) {
            let folder = tempfile::tempdir().unwrap();
            for format in FORMATS {
                let path = folder.path().join(format!("cloud.{format}"));
                write_cloud(&cloud(&points), &path).unwrap();
                let back = read_cloud(&path).unwrap();
                prop_assert_eq!(back.points_mm(), &points[..], "{}", format);
            }
        }

        #[test]
        fn no_bytes_make_a_reader_panic(
            bytes in prop::collection::vec(any::<u8>(), 0..200),
            cut in 0..400_usize,
            at in 0..400_usize,
        ) {
            let points = [[1.0, 2.0, 3.0], [4.0, 5.5, -6.0]];
            let folder = tempfile::tempdir().unwrap();
            for format in FORMATS {
                let _ = read_bytes(&format!("a.{format}"), &bytes);
                let path = folder.path().join(format!("b.{format}"));
                write_cloud(&cloud(&points), &path).unwrap();
                let mut whole = fs::read(&path).unwrap();
                let at = at % whole.len();
                whole[at] = bytes.first().copied().unwrap_or(0);
                whole.truncate(cut);
                fs::write(&path, whole).unwrap();
                let _ = read_cloud(&path);
            }
        }
    }

    #[test]
    fn unknown_endings_and_missing_files_are_named() {
        let points = cloud(&[[0.0; 3]]);
        for name in ["cloud", "cloud.stl", ".npy"] {
            let path = Path::new("no-such-folder").join(name);
            for result in [write_cloud(&points, &path), check_target(&path)] {
                let error = result.unwrap_err();
                assert!(matches!(error, CloudError::Extension { .. }), "{name}");
            }
        }
        let path = Path::new("no-such-folder/cloud.npy");
        let message = read_cloud(path).unwrap_err().to_string();
        assert!(message.contains("no-such-folder") && message.contains("check"));
        for result in [write_cloud(&points, path), check_target(path)] {
            let message = result.unwrap_err().to_string();
            assert!(message.contains("no-such-folder") && message.contains("check"));
        }
        let folder = tempfile::tempdir().unwrap();
        check_target(&folder.path().join("CLOUD.NPY")).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("taken.npy");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("inside"), b"x").unwrap();
        assert!(write_cloud(&cloud(&[[0.0; 3]]), &path).is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        let failed = write_whole(&folder.path().join("half.xyz"), |out| {
            out.write_all(b"1 2")?;
            Err(io::Error::other("the disk is full"))
        });
        assert!(failed.is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_point_that_is_not_finite_is_named() {
        let error = read_bytes("a.xyz", b"1 2 3\n1 nan 3\n").unwrap_err();
        assert!(matches!(error, CloudError::NotFinite { index: 1, .. }));
    }
}
