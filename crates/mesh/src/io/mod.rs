//! Mesh files, chosen by their extension.

mod atomic;
mod frame;
mod obj_read;
mod obj_write;
mod ply_header;
mod ply_read;
mod ply_write;
mod stl_read;
mod stl_write;
mod text_blocks;
mod threemf_model;
mod threemf_read;
mod threemf_write;
mod xml;

use std::ffi::OsStr;
use std::path::Path;

use bonemesh_task::Task;

use crate::{MeshError, TriangleMesh};
pub use frame::PatientFrame;

/// Triangles encoded by one call of rayon and then written: 3 MB, so memory stays small, progress
/// is smooth and a cancel takes effect at once.
const BLOCK: usize = 1 << 16;

/// A mesh file format.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Stereolithography: binary or ASCII when read, binary when written.
    Stl,
    /// Polygon file format: binary little-endian or ASCII when read, the former when written.
    Ply,
    /// Wavefront OBJ, which is text.
    Obj,
    /// 3D Manufacturing Format: a zip archive with a model in XML.
    ThreeMf,
}

impl MeshFormat {
    /// The format that the extension of `path` names, in capitals or not.
    ///
    /// # Errors
    /// [`MeshError::UnknownExtension`]
    pub fn of(path: &Path) -> Result<Self, MeshError> {
        let extension = path.extension().map(OsStr::to_ascii_lowercase);
        match extension.as_ref().and_then(|e| e.to_str()) {
            Some("stl") => Ok(Self::Stl),
            Some("ply") => Ok(Self::Ply),
            Some("obj") => Ok(Self::Obj),
            Some("3mf") => Ok(Self::ThreeMf),
            _ => Err(MeshError::UnknownExtension {
                path: path.to_path_buf(),
            }),
        }
    }
}

/// Tells now whether [`write_mesh`] could write `path`, so that long work is not lost at its end.
///
/// Makes a temporary file in the folder and takes it away again.
///
/// # Errors
/// Those of [`write_mesh`].
pub fn check_target(path: impl AsRef<Path>) -> Result<(), MeshError> {
    let path = path.as_ref();
    MeshFormat::of(path)?;
    atomic::probe(path)
}

/// Reads an STL, PLY, OBJ or 3MF mesh and merges vertices of equal coordinates in file order.
///
/// Vertex numbers: STL corners in the order of the file, other vertices in the order of the file
/// (used or not); the first at its place gets the next number. The same file always gives the same
/// numbers. Lengths are taken as mm, which of these formats only 3MF says; its other units are
/// converted, and its items and components put to their places. Triangles with equal corners stay,
/// so triangle numbers are those of the file too. Normals, colours and names are not read.
/// Coordinates of OBJ and 3MF are read in single precision.
///
/// # Errors
/// [`MeshError`] naming the file: unknown extension, missing or unreadable file, not of its
/// format, cut short, without triangles, or the work was cancelled.
pub fn read_mesh(path: impl AsRef<Path>, task: &Task) -> Result<TriangleMesh, MeshError> {
    let path = path.as_ref();
    if path.is_dir() {
        return Err(MeshError::IsFolder {
            path: path.to_path_buf(),
        });
    }
    let format = MeshFormat::of(path)?;
    // Waiting for a pipe could not be cancelled.
    if path.metadata().is_ok_and(|known| !known.is_file()) {
        return Err(MeshError::NotAFile {
            path: path.to_path_buf(),
        });
    }
    let mesh = match format {
        MeshFormat::Stl => stl_read::read(path, task)?,
        MeshFormat::Ply => ply_read::read(path, task)?,
        MeshFormat::Obj => obj_read::read(path, task)?,
        MeshFormat::ThreeMf => threemf_read::read(path, task)?,
    };
    if mesh.triangles().is_empty() {
        return Err(MeshError::NoTriangles {
            path: path.to_path_buf(),
        });
    }
    Ok(mesh)
}

/// Writes a mesh as binary STL, binary little-endian PLY, OBJ or 3MF, in mm and 32-bit floats.
///
/// The file says its unit and frame: millimetres, patient space LPS. It appears complete or not at
/// all: it is written under another name beside its place and renamed. It says nothing of patient,
/// person or machine. Vertices that are distinct but closer than 32-bit floats tell apart (0.00002 mm
/// at 200 mm) are one vertex when the file is read again. Triangles with two equal vertices, which
/// 3MF forbids, are left out of it.
///
/// # Errors
/// [`MeshError`] naming the file: unknown extension, missing or read-only folder, full disk, mesh
/// without triangles or out of range, or the work was cancelled.
pub fn write_mesh(
    path: impl AsRef<Path>,
    mesh: &TriangleMesh,
    task: &Task,
) -> Result<(), MeshError> {
    write_mesh_in(path, mesh, PatientFrame::Lps, task)
}

/// Writes a mesh, whose coordinates are LPS, as [`write_mesh`] does, in another frame of the patient.
///
/// # Errors
/// Those of [`write_mesh`].
pub fn write_mesh_in(
    path: impl AsRef<Path>,
    mesh: &TriangleMesh,
    frame: PatientFrame,
    task: &Task,
) -> Result<(), MeshError> {
    let path = path.as_ref();
    let format = MeshFormat::of(path)?;
    check_writable(path, mesh)?;
    let mesh = &*frame.of(mesh);
    task.begin("write", mesh.triangles().len());
    atomic::write(path, |file| match format {
        MeshFormat::Stl => stl_write::write(file, mesh, frame, task),
        MeshFormat::Ply => ply_write::write(file, mesh, frame, None, task),
        MeshFormat::Obj => obj_write::write(file, mesh, frame, task),
        MeshFormat::ThreeMf => threemf_write::write(file, mesh, frame, task),
    })
}

/// Writes a mesh as PLY, as [`write_mesh`] does, with a number for each vertex as a property of this
/// name, in which viewers can colour it. What is no number, or infinite, stays so.
///
/// # Errors
/// Those of [`write_mesh`], [`MeshError::NotPly`] for another extension, [`MeshError::Values`] unless
/// there are as many numbers as vertices.
pub fn write_with_values(
    path: impl AsRef<Path>,
    mesh: &TriangleMesh,
    name: &str,
    of_vertices: &[f64],
    task: &Task,
) -> Result<(), MeshError> {
    let values = ply_write::Values {
        name,
        of_vertices,
        colours: None,
    };
    write_values(path.as_ref(), mesh, values, task)
}

/// [`write_with_values`] with a colour (red, green, blue) for each vertex as well.
///
/// # Errors
/// Those of [`write_with_values`]; [`MeshError::Values`] also unless there are as many colours.
pub fn write_with_colours(
    path: impl AsRef<Path>,
    mesh: &TriangleMesh,
    name: &str,
    of_vertices: &[f64],
    colours: &[[u8; 3]],
    task: &Task,
) -> Result<(), MeshError> {
    let values = ply_write::Values {
        name,
        of_vertices,
        colours: Some(colours),
    };
    write_values(path.as_ref(), mesh, values, task)
}

fn write_values(
    path: &Path,
    mesh: &TriangleMesh,
    values: ply_write::Values<'_>,
    task: &Task,
) -> Result<(), MeshError> {
    check_values_target(path)?;
    check_writable(path, mesh)?;
    let vertices = mesh.vertices_mm().len();
    let colours = values.colours.map_or(vertices, <[_]>::len);
    for values in [values.of_vertices.len(), colours] {
        if values != vertices {
            return Err(MeshError::Values { values, vertices });
        }
    }
    task.begin("write", mesh.triangles().len());
    atomic::write(path, |file| {
        ply_write::write(file, mesh, PatientFrame::Lps, Some(values), task)
    })
}

/// Tells now whether [`write_with_values`] could write `path`.
///
/// # Errors
/// Those of [`write_with_values`].
pub fn check_values_target(path: impl AsRef<Path>) -> Result<(), MeshError> {
    let path = path.as_ref();
    match MeshFormat::of(path) {
        Ok(MeshFormat::Ply) => atomic::probe(path),
        _ => Err(MeshError::NotPly {
            path: path.to_path_buf(),
        }),
    }
}

/// Refuses what no file can hold.
fn check_writable(path: &Path, mesh: &TriangleMesh) -> Result<(), MeshError> {
    let path = path.to_path_buf();
    let triangles = mesh.triangles().len();
    if triangles == 0 {
        return Err(MeshError::NothingToWrite { path });
    }
    if u32::try_from(triangles).is_err() {
        return Err(MeshError::TooManyTriangles { path, triangles });
    }
    for (vertex, coordinates) in mesh.vertices_mm().iter().enumerate() {
        if let Some(&value) = coordinates.iter().find(|&&v| !(v as f32).is_finite()) {
            return Err(MeshError::OutOfFileRange {
                path,
                vertex,
                value,
            });
        }
    }
    Ok(())
}

/// The error for a file that is not what its extension says.
fn malformed(path: &Path, format: &'static str, reason: impl Into<String>) -> MeshError {
    MeshError::Malformed {
        path: path.to_path_buf(),
        format,
        reason: reason.into(),
    }
}
