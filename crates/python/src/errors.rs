//! The only place where an error becomes a Python exception.
//!
//! - Arguments that cannot be used: `ArgumentError`, which is a `ValueError` too.
//! - Files and folders that cannot be read or written: `OSError` or its fitting subclass.
//! - A CT folder or a mesh file with unusable content: `DicomError`, `MeshError`.
//! - Work stopped through a `Cancel`: `Cancelled`.
//! - Everything else, our own bugs included: `BonemeshError`, the base of all but `OSError`.

use bonemesh::{
    CloudError, DelaunayError, DicomError, Error, MeshError, RoiError, SegmentError, SurfaceError,
    VolumeFileError,
};
use bonemesh_phantom::PhantomError;
use pyo3::exceptions::{
    PyException, PyFileExistsError, PyFileNotFoundError, PyIsADirectoryError, PyNotADirectoryError,
    PyOSError, PyPermissionError, PyValueError,
};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple, PyType};

/// Our exception types; made once, when the module is first imported.
struct Types {
    base: Py<PyType>,
    argument: Py<PyType>,
    dicom: Py<PyType>,
    mesh: Py<PyType>,
    cancelled: Py<PyType>,
}

static TYPES: PyOnceLock<Types> = PyOnceLock::new();

impl Types {
    fn get(py: Python<'_>) -> PyResult<&Self> {
        TYPES.get_or_try_init(py, || {
            let exception = py.get_type::<PyException>();
            let value_error = py.get_type::<PyValueError>();
            let base = new_type(
                py,
                "BonemeshError",
                "Something cannot be done; the message says what and names the remedy.",
                &[&exception],
            )?;
            let make = |name, doc| new_type(py, name, doc, &[&base]).map(Bound::unbind);
            Ok(Self {
                argument: new_type(
                    py,
                    "ArgumentError",
                    "An argument that cannot be used.",
                    &[&base, &value_error],
                )?
                .unbind(),
                dicom: make("DicomError", "A folder or series that gives no volume.")?,
                mesh: make(
                    "MeshError",
                    "A mesh, or the content of a mesh file, that cannot be used.",
                )?,
                cancelled: make(
                    "Cancelled",
                    "The work was stopped through its `Cancel`; nothing was written.",
                )?,
                base: base.unbind(),
            })
        })
    }

    fn all(&self) -> [&Py<PyType>; 5] {
        [
            &self.base,
            &self.argument,
            &self.dicom,
            &self.mesh,
            &self.cancelled,
        ]
    }
}

fn new_type<'py>(
    py: Python<'py>,
    name: &str,
    doc: &str,
    bases: &[&Bound<'py, PyType>],
) -> PyResult<Bound<'py, PyType>> {
    let attributes = PyDict::new(py);
    attributes.set_item("__module__", "bonemesh")?;
    attributes.set_item("__doc__", doc)?;
    let made = py
        .get_type::<PyType>()
        .call1((name, PyTuple::new(py, bases)?, attributes))?;
    Ok(made.cast_into()?)
}

/// Puts the exception types into `module`.
pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    for class in Types::get(py)?.all() {
        let class = class.bind(py);
        module.add(class.name()?, class)?;
    }
    Ok(())
}

/// An `ArgumentError`.
pub(crate) fn argument(py: Python<'_>, message: &str) -> PyErr {
    ours(py, message, |types| &types.argument)
}

/// The `ArgumentError` of a value that refuses to be made.
pub(crate) fn unusable(py: Python<'_>, error: impl std::fmt::Display) -> PyErr {
    argument(py, &error.to_string())
}

/// A `Cancelled`.
pub(crate) fn cancelled(py: Python<'_>) -> PyErr {
    ours(py, "cancelled", |types| &types.cancelled)
}

/// The error of a panic, which must not end the program that we are a guest in.
pub(crate) fn bug(py: Python<'_>, message: &str) -> PyErr {
    let line = message.lines().next().unwrap_or_default();
    let message =
        format!("a bug in Bonemesh stopped the work ({line}); please report it with what you did");
    ours(py, &message, |types| &types.base)
}

/// The error of a system without room for one more thread.
pub(crate) fn no_thread(py: Python<'_>, error: &std::io::Error) -> PyErr {
    let message = format!("cannot start a worker thread ({error}); close other programs");
    ours(py, &message, |types| &types.base)
}

/// The exception for an `error` of the library.
pub(crate) fn raised(py: Python<'_>, error: &Error) -> PyErr {
    if error.is_cancelled() {
        return cancelled(py);
    }
    let message = error.to_string();
    if let Some(trouble) = FileTrouble::of(error) {
        return trouble.exception(py, message).unwrap_or_else(|e| e);
    }
    ours(py, &message, |types| match error {
        _ if is_argument(error) => &types.argument,
        Error::Dicom(_) => &types.dicom,
        Error::Mesh(_) | Error::Measure(_) | Error::Surface(SurfaceError::Mesh(_)) => &types.mesh,
        _ => &types.base,
    })
}

/// Whether the caller's argument, not the data, is what `error` speaks of.
fn is_argument(error: &Error) -> bool {
    use DelaunayError as D;
    match error {
        Error::Volume(_)
        | Error::Surface(
            SurfaceError::Alpha(_)
            | SurfaceError::Radii(_)
            | SurfaceError::Depth(_)
            | SurfaceError::Scale(_),
        ) => true,
        Error::Segment(e) => matches!(
            e,
            SegmentError::Threshold(_)
                | SegmentError::Sigma(_)
                | SegmentError::Pixel { .. }
                | SegmentError::CannyThresholds { .. }
                | SegmentError::Classes(_)
        ),
        Error::Cloud(e) => matches!(e, CloudError::NeighbourCount(_) | CloudError::NoPixels),
        Error::Surface(SurfaceError::Delaunay(e)) => matches!(
            e,
            D::Alpha(_) | D::Coordinate { .. } | D::Span { .. } | D::Gram { .. }
        ),
        Error::Dicom(e) => matches!(e, DicomError::Choice(_) | DicomError::NoSuchSeries { .. }),
        Error::Mesh(e) => matches!(
            e,
            MeshError::Index { .. }
                | MeshError::NotFinite { .. }
                | MeshError::TooManyVertices(_)
                | MeshError::UnknownExtension { .. }
        ),
        Error::Roi(e) => matches!(
            e,
            RoiError::NoSelection | RoiError::OneVertex | RoiError::Index { .. }
        ),
        Error::Phantom(e) => matches!(e, PhantomError::MatrixTooSmall { .. }),
        _ => false,
    }
}

/// What is wrong with a file or folder itself, not with what is in it.
#[derive(Clone, Copy)]
enum FileTrouble {
    Missing,
    IsFolder,
    NoFolder,
    InUse,
    Forbidden,
    DiskFull,
    Other,
}

impl FileTrouble {
    fn of(error: &Error) -> Option<Self> {
        Some(match error {
            Error::Dicom(DicomError::NotFound(_))
            | Error::VolumeFile(VolumeFileError::NotFound(_))
            | Error::Mesh(MeshError::NotFound { .. } | MeshError::NoFolder { .. }) => Self::Missing,
            Error::Dicom(DicomError::NotAFolder { .. })
            | Error::Phantom(PhantomError::NotAFolder(_)) => Self::NoFolder,
            Error::Phantom(PhantomError::FolderInUse(_)) => Self::InUse,
            Error::Mesh(MeshError::IsFolder { .. }) => Self::IsFolder,
            Error::Mesh(MeshError::ReadOnly { .. }) => Self::Forbidden,
            Error::Mesh(MeshError::DiskFull { .. }) => Self::DiskFull,
            Error::Dicom(DicomError::Folder { .. })
            | Error::VolumeFile(VolumeFileError::Io { .. })
            | Error::Phantom(PhantomError::Write { .. })
            | Error::Mesh(MeshError::Unreadable { .. } | MeshError::Unwritable { .. }) => {
                Self::Other
            }
            Error::Sidecar { source, .. } => match source.kind() {
                std::io::ErrorKind::NotFound => Self::Missing,
                std::io::ErrorKind::PermissionDenied => Self::Forbidden,
                _ => Self::Other,
            },
            _ => return None,
        })
    }

    /// The `OSError` with `message` as its text and the system's number as its `errno`.
    ///
    /// The number is set afterwards, because an `OSError` made of both hides the text behind
    /// "[Errno ..]".
    fn exception(self, py: Python<'_>, message: String) -> PyResult<PyErr> {
        let (number, exception) = match self {
            Self::Missing => ("ENOENT", PyFileNotFoundError::new_err(message)),
            Self::IsFolder => ("EISDIR", PyIsADirectoryError::new_err(message)),
            Self::InUse => ("EEXIST", PyFileExistsError::new_err(message)),
            Self::NoFolder => ("ENOTDIR", PyNotADirectoryError::new_err(message)),
            Self::Forbidden => ("EACCES", PyPermissionError::new_err(message)),
            Self::DiskFull => ("ENOSPC", PyOSError::new_err(message)),
            Self::Other => ("EIO", PyOSError::new_err(message)),
        };
        let number = py.import("errno")?.getattr(number)?;
        exception.value(py).setattr("errno", number)?;
        Ok(exception)
    }
}

/// An exception of one of our types.
fn ours(py: Python<'_>, message: &str, choose: impl FnOnce(&Types) -> &Py<PyType>) -> PyErr {
    match Types::get(py) {
        Ok(types) => PyErr::from_type(choose(types).bind(py).clone(), message.to_owned()),
        Err(error) => error,
    }
}
