//! Clouds on disk: `.npy` (`NumPy`), `.ply` and `.xyz`, in millimetres.

mod npy;
mod ply;
mod scalar;
mod xyz;

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::{CloudError, PointCloud};

/// A file format for clouds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Npy,
    Ply,
    Xyz,
}

impl Format {
    fn of(path: &Path) -> Result<Self, CloudError> {
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

/// Reads a cloud of free points (mm); the file's ending names the format.
///
/// `.npy`: an array of N rows and 3 columns, floating point or whole numbers. `.ply`: the
/// vertices, text or binary, other elements are left out. `.xyz`: three numbers a line; further
/// columns and lines that begin with `#` are left out.
///
/// # Errors
/// [`CloudError::Extension`], [`CloudError::Read`], [`CloudError::Format`],
/// [`CloudError::NotFinite`] and [`CloudError::TooMany`].
pub fn read_cloud(path: &Path) -> Result<PointCloud, CloudError> {
    let format = Format::of(path)?;
    let bytes = fs::read(path).map_err(|source| CloudError::Read {
        path: path.to_owned(),
        source,
    })?;
    let points = match format {
        Format::Npy => npy::parse(&bytes),
        Format::Ply => ply::parse(&bytes),
        Format::Xyz => xyz::parse(&bytes),
    };
    PointCloud::from_points(points.map_err(|reason| CloudError::Format {
        path: path.to_owned(),
        reason,
    })?)
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
    let format = Format::of(path)?;
    let points = cloud.points_mm();
    write_whole(path, |out| match format {
        Format::Npy => npy::write(points, out),
        Format::Ply => ply::write(points, out),
        Format::Xyz => xyz::write(points, out),
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
    let folder = match path.parent() {
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
    let mut out = BufWriter::new(builder.tempfile_in(folder)?);
    write(&mut out)?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.persist(path)?;
    Ok(())
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
            let error = write_cloud(&points, &path).unwrap_err();
            assert!(matches!(error, CloudError::Extension { .. }), "{name}");
        }
        let path = Path::new("no-such-folder/cloud.npy");
        let message = read_cloud(path).unwrap_err().to_string();
        assert!(message.contains("no-such-folder") && message.contains("check"));
        let message = write_cloud(&points, path).unwrap_err().to_string();
        assert!(message.contains("no-such-folder") && message.contains("check"));
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
