//! What can be wrong with a mesh or its file.

use std::io;
use std::path::{Path, PathBuf};

use bonemesh_task::Cancelled;

/// A mesh or mesh file that cannot be used, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// A triangle names a vertex that does not exist.
    #[error(
        "triangle {triangle} names vertex {vertex}, but there are {vertices}; number vertices from 0"
    )]
    Index {
        /// Number of the triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A coordinate is infinite or no number.
    #[error("vertex {vertex} has the coordinate {value}; give finite lengths in mm")]
    NotFinite {
        /// Number of the vertex.
        vertex: usize,
        /// The coordinate.
        value: f64,
    },
    /// More vertices than an index can name.
    #[error("{0} vertices are more than 32-bit indices can name (4,294,967,295); split the mesh")]
    TooManyVertices(usize),
    /// Numbers or places that make no plane.
    #[error(
        "this makes no plane; give a normal that is not 0, or three places that are not in a line"
    )]
    NoPlane,
    /// The file's extension names no format we know.
    #[error("{} ends in none of .stl, .ply, .obj, .3mf; give the file one of these extensions", path.display())]
    UnknownExtension {
        /// The file.
        path: PathBuf,
    },
    /// Only PLY files hold numbers of vertices.
    #[error("{} does not end in .ply, and no other mesh file holds a number for each vertex; give it this extension", path.display())]
    NotPly {
        /// The file.
        path: PathBuf,
    },
    /// Not a number for each vertex.
    #[error("{values} values are not one for each of {vertices} vertices; give one for each")]
    Values {
        /// How many values.
        values: usize,
        /// How many vertices.
        vertices: usize,
    },
    /// There is no such file to read.
    #[error("there is no file {}; check the path", path.display())]
    NotFound {
        /// The file.
        path: PathBuf,
    },
    /// A folder was named where a file is wanted.
    #[error("{} is a folder; name a file in it", path.display())]
    IsFolder {
        /// The folder.
        path: PathBuf,
    },
    /// The file exists but cannot be read.
    #[error("cannot read {} ({reason}); check its permissions or copy it to this computer's disk", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        reason: String,
    },
    /// The bytes of the file are not what its extension says.
    #[error("{} is no usable {format} file: {reason}; export it again", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The format that its extension names, for example `STL`.
        format: &'static str,
        /// What is wrong with it.
        reason: String,
    },
    /// The file is of its format but holds no triangle.
    #[error("{} holds no triangles; export a mesh with faces", path.display())]
    NoTriangles {
        /// The file.
        path: PathBuf,
    },
    /// Fewer triangles asked for than enclose a volume.
    #[error(
        "fewer than 4 triangles enclose nothing, so {triangles} cannot be asked for; ask for at least 4"
    )]
    TooFewTriangles {
        /// How many were asked for.
        triangles: usize,
    },
    /// An empty mesh was to be written.
    #[error("the mesh has no triangles, so {} was not written; check the step that made it", path.display())]
    NothingToWrite {
        /// The file.
        path: PathBuf,
    },
    /// A coordinate is too large for the file's 32-bit floats.
    #[error("vertex {vertex} is too far out for {} ({value} mm); move the mesh to the origin", path.display())]
    OutOfFileRange {
        /// The file.
        path: PathBuf,
        /// Number of the vertex.
        vertex: usize,
        /// The coordinate.
        value: f64,
    },
    /// More triangles than the file's 32-bit count can say.
    #[error("{triangles} triangles are too many for {} (4,294,967,295); split the mesh", path.display())]
    TooManyTriangles {
        /// The file.
        path: PathBuf,
        /// How many there are.
        triangles: usize,
    },
    /// The folder to write into does not exist.
    #[error("there is no folder {} for {}; create it or choose another", folder.display(), path.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The missing folder.
        folder: PathBuf,
    },
    /// The file or its folder may not be written.
    #[error("{} may not be written ({reason}); choose a folder and file that are not read-only", path.display())]
    ReadOnly {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        reason: String,
    },
    /// What is there is a device, a pipe or the like: a rename would destroy it, and waiting for it could not be cancelled.
    #[error("{} is no ordinary file; choose another name", path.display())]
    NotAFile {
        /// The file.
        path: PathBuf,
    },
    /// The disk has no room.
    #[error("no room on the disk for {}; free some space or choose another disk", path.display())]
    DiskFull {
        /// The file.
        path: PathBuf,
    },
    /// Writing failed for another reason.
    #[error("cannot write {} ({reason}); try another folder", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        reason: String,
    },
    /// A place that is nowhere near the mesh.
    #[error(
        "the place {} is not near the mesh, which reaches from {} to {} mm; give one on the bone, in the mesh's frame",
        place(place_mm), place(&bounds_mm[0]), place(&bounds_mm[1])
    )]
    FarPlace {
        /// The place.
        place_mm: [f64; 3],
        /// Lowest and highest coordinates of the mesh.
        bounds_mm: [[f64; 3]; 2],
    },
    /// A length that is negative, infinite or no number.
    #[error("the {name} is {value}; give a length in mm from 0")]
    Length {
        /// What was to be a length.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A volume that is negative, infinite or no number.
    #[error("the volume is {value}; give one in mm3 from 0")]
    Volume {
        /// What was to be a volume.
        value: f64,
    },
    /// More triangles than decimation can number.
    #[error("{triangles} triangles are too many to decimate (1,431,655,764); split the mesh")]
    TooManyToDecimate {
        /// How many there are.
        triangles: usize,
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Coordinates as a user writes them.
fn place([x, y, z]: &[f64; 3]) -> String {
    format!("{x:.1},{y:.1},{z:.1}")
}

impl MeshError {
    /// `value` if it is a volume, from 0.
    pub(crate) fn volume(value: f64) -> Result<f64, Self> {
        if value >= 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::Volume { value })
        }
    }

    /// `value` if it is a length, from 0.
    pub(crate) fn length(name: &'static str, value: f64) -> Result<f64, Self> {
        if value >= 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::Length { name, value })
        }
    }

    /// The error for `path`, which could not be read because of `error`.
    pub(crate) fn reading(path: &Path, error: &io::Error) -> Self {
        let path = path.to_path_buf();
        if path.is_dir() {
            return Self::IsFolder { path };
        }
        match error.kind() {
            io::ErrorKind::NotFound => Self::NotFound { path },
            _ => Self::Unreadable {
                path,
                reason: error.to_string(),
            },
        }
    }

    /// The error for `path`, which could not be written because of `error`.
    pub(crate) fn writing(path: &Path, error: &io::Error) -> Self {
        let path = path.to_path_buf();
        match error.kind() {
            io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => Self::ReadOnly {
                path,
                reason: error.to_string(),
            },
            io::ErrorKind::StorageFull
            | io::ErrorKind::QuotaExceeded
            | io::ErrorKind::FileTooLarge => Self::DiskFull { path },
            _ => Self::Unwritable {
                path,
                reason: error.to_string(),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_operating_system_says_becomes_a_remedy() {
        let message = |kind: io::ErrorKind| {
            MeshError::writing(Path::new("skull.stl"), &io::Error::from(kind)).to_string()
        };
        assert!(message(io::ErrorKind::StorageFull).contains("free some space"));
        assert!(message(io::ErrorKind::PermissionDenied).contains("not read-only"));
        assert!(message(io::ErrorKind::ReadOnlyFilesystem).contains("not read-only"));
        assert!(message(io::ErrorKind::BrokenPipe).contains("another folder"));
    }
}
