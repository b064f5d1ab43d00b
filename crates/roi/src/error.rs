//! Why there is no region.

use std::path::PathBuf;

use bonemesh_cloud::CloudError;
use bonemesh_mesh::MeshError;
use bonemesh_surface::SurfaceError;
use bonemesh_task::Cancelled;

/// A region that cannot be made, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum RoiError {
    /// The thickness is no depth.
    #[error("the thickness is {0} mm; give a length above 0 mm")]
    Thickness(f64),
    /// The clearance is no gap.
    #[error("the clearance is {0} mm; give a length from 0 to 20 mm")]
    Clearance(f64),
    /// No direction has this name.
    #[error(
        "there is no direction {0:?}; write normal, through, outward or three numbers X,Y,Z that are not all 0"
    )]
    Direction(String),
    /// No method has this name.
    #[error("there is no region method {0:?}; the methods are: solid, thesis")]
    UnknownMethod(String),
    /// Nothing is selected.
    #[error("no vertex is selected; select a patch of the outer surface first")]
    NoSelection,
    /// A single vertex is selected.
    #[error("only one vertex is selected; select a patch of at least three that are not in a line")]
    OneVertex,
    /// A selected vertex does not exist.
    #[error(
        "vertex {vertex} is selected, but the mesh has {vertices}; number them from 0, of the mesh as read and merged"
    )]
    Index {
        /// The vertex named.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// No second selected vertex gives a direction.
    #[error(
        "all {selected} selected vertices have the same x and y, so no direction into the bone follows; select a wider patch"
    )]
    NoSecondPoint {
        /// How many vertices are selected.
        selected: usize,
    },
    /// The two selected vertices that make the normal lie in a line with the selection's mean.
    #[error(
        "the outermost of the {selected} selected vertices lie in a line with their mean, so no direction into the bone follows; add or remove vertices at the rim of the patch"
    )]
    NoNormal {
        /// How many vertices are selected.
        selected: usize,
    },
    /// The mesh does not consist of slices.
    #[error(
        "the mesh is not made of slices ({vertices} vertices at {levels} different z); render it again with method alpha (in Blender: Advanced > Method), neither smoothed nor reduced, with z as the slice direction"
    )]
    NoLevels {
        /// How many vertices there are.
        vertices: usize,
        /// At how many different z they lie.
        levels: usize,
    },
    /// No vertex of the mesh belongs to the region but the selected ones.
    #[error(
        "nothing was found behind the selection for {thickness_mm} mm; set the thickness to that of the bone (what is nearer than half of it is not found) or select a flatter patch (this method finds nothing behind one that faces straight up)"
    )]
    NothingBehind {
        /// The thickness asked for.
        thickness_mm: f64,
    },
    /// Selected vertices without a selected triangle.
    #[error(
        "the {selected} selected vertices are the corners of no triangle; select a patch (in Blender: Select > Select More)"
    )]
    NoFace {
        /// How many vertices are selected.
        selected: usize,
    },
    /// All selected triangles face away from the eye.
    #[error(
        "all of the selection faces away from where it is looked at along the direction; turn the direction round, or take hidden pieces, too"
    )]
    FacesAway,
    /// The selection is too narrow for a body of its own.
    #[error(
        "the selected patch of {area_mm2:.2} mm2 is too narrow to cut anything out; select more"
    )]
    TooSmall {
        /// Its area.
        area_mm2: f64,
    },
    /// The thickness is next to nothing beside the patch.
    #[error(
        "a thickness of {thickness_mm} mm cannot be cut under a patch of {area_mm2:.0} mm2, which takes {least_mm:.2} mm or more; select less or set a larger thickness"
    )]
    TooThin {
        /// The thickness asked for.
        thickness_mm: f64,
        /// The patch's area.
        area_mm2: f64,
        /// The least thickness of such a patch.
        least_mm: f64,
    },
    /// The surface is open where it is to be cut.
    #[error(
        "the surface near the selection is open or its triangles do not all face one way, so it has no inside to cut out; see what is wrong (bonemesh check), and fill holes first (bonemesh repair --fill-holes all)"
    )]
    Open,
    /// Nothing lies below the patch.
    #[error(
        "nothing lies below the selection; select a patch of the outer side, and see whether the surface is open or inside out (bonemesh check; bonemesh repair mends that)"
    )]
    NothingCut,
    /// What is left touches itself, whatever is tried.
    #[error(
        "the solid would touch itself after {tries} tries; check the surface near the selection (bonemesh check; bonemesh repair mends what can be), select a little more or less, or move a mesh that lies metres away from the origin nearer to it"
    )]
    NoSound {
        /// How often it was tried.
        tries: u32,
    },
    /// The cut failed.
    #[error(
        "the solid cannot be cut out ({0}); check the surface near the selection (bonemesh check; bonemesh repair mends what can be)"
    )]
    Cut(&'static str),
    /// Nothing lies where the mirror shows the selection.
    #[error(
        "the other side has no bone where the mirror shows the selection; check the plane of symmetry, or give another"
    )]
    NoCounterpart,
    /// No plane of symmetry follows from the mesh.
    #[error(
        "no plane of symmetry follows from a mesh without area; give the plane by numbers or three points"
    )]
    NoSymmetry,
    /// The mesh does not do.
    #[error(transparent)]
    Mesh(MeshError),
    /// The selection file cannot be read.
    #[error("cannot read the selection file {} ({reason}); check the path", path.display())]
    SelectionFile {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        reason: String,
    },
    /// A line of the selection file is no vertex index.
    #[error("line {line} of {} is {text:?}; write one vertex index (0, 1, 2, ...) a line", path.display())]
    SelectionLine {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What it says, or the beginning of it.
        text: String,
    },
    /// The selection file holds no index.
    #[error("{} holds no vertex index; write one a line", path.display())]
    SelectionEmpty {
        /// The file.
        path: PathBuf,
    },
    /// The region's points cannot be meshed.
    #[error("the region cannot be meshed: {0}")]
    Surface(SurfaceError),
    /// The region's points make no cloud.
    #[error("the region makes no cloud: {0}")]
    Cloud(CloudError),
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<MeshError> for RoiError {
    fn from(error: MeshError) -> Self {
        match error {
            MeshError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            other => Self::Mesh(other),
        }
    }
}

// A cancel stays a cancel, whichever step it stopped.
impl From<CloudError> for RoiError {
    fn from(error: CloudError) -> Self {
        match error {
            CloudError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            other => Self::Cloud(other),
        }
    }
}

impl From<SurfaceError> for RoiError {
    fn from(error: SurfaceError) -> Self {
        match error {
            SurfaceError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            other => Self::Surface(other),
        }
    }
}
