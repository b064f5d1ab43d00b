//! How large a mesh is, and how two meshes differ: volumes, distances, the published comparison.
//!
//! [`residual_volume`] is exact to rounding: the union less the intersection of two closed bodies, by an
//! exact boolean. [`compare_surfaces`] samples both surfaces evenly by area and measures each sample's
//! distance to the other surface; [`signed_distances`] does so for given places, positive outside.
//! [`edge_midpoints`] is the comparison of the published method. Results are the same for any number of
//! threads.
//!
//! Limits: a volume says something of a closed, outward mesh only, and [`residual_volume`] refuses
//! others. Means and percentiles are those of samples, and a Hausdorff distance that of samples and
//! vertices, so it may be short by what lies between them. Signs near a surface that is not closed mean the
//! side of its nearest triangle. [`edge_midpoints`] needs meshes whose vertices lie on common levels of z.
//!
//! ```
//! use bonemesh_measure::{compare_surfaces, residual_volume};
//! use bonemesh_mesh::TriangleMesh;
//! use bonemesh_task::Task;
//!
//! let tetrahedron = |x: f64| {
//!     let corners = vec![[x, 0.0, 0.0], [x + 3.0, 0.0, 0.0], [x, 3.0, 0.0], [x, 0.0, 3.0]];
//!     TriangleMesh::new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
//! };
//! let (mesh, moved) = (tetrahedron(0.0)?, tetrahedron(1.0)?);
//! let volumes = residual_volume(&mesh, &moved, &Task::default())?;
//! // What they have in common is a tetrahedron of two thirds of the size.
//! let common = 4.5 * (2.0_f64 / 3.0).powi(3);
//! assert!((volumes.residual_mm3 - 2.0 * (4.5 - common)).abs() < 1e-9);
//! let distances = compare_surfaces(&mesh, &moved, 1000, &Task::default())?;
//! assert!(distances.hausdorff_mm <= 1.0 && distances.mean_mm > 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Sources: E. Rier, *Generation and segmentation of 3D models of bone from CT images based on 3D point
//! clouds* (master's thesis), for the edge midpoints; E. George et al., *Measuring and establishing the
//! accuracy and reproducibility of 3D printed medical models*, 2017, for the residual volume; P. Cignoni,
//! C. Rocchini, R. Scopigno, *Metro: measuring error on simplified surfaces*, 1998, for the distances;
//! J. A. Baerentzen, H. Aanaes, *Signed distance computation using the angle weighted pseudonormal*, 2005,
//! for their signs.
#![forbid(unsafe_code)]

mod edge_midpoints;
mod heat_map;
mod residual;
mod samples;
mod signed;
mod spread;
mod surfaces;
mod volume;

use bonemesh_mesh::MeshError;
use bonemesh_task::Cancelled;

pub use edge_midpoints::{EdgeMidpoint, EdgeMidpoints, edge_midpoints};
pub use heat_map::heat_colours;
pub use residual::{ResidualVolume, residual_volume};
pub use signed::{Reference, signed_distances};
pub use spread::Spread;
pub use surfaces::{SurfaceDistances, compare_surfaces};
pub use volume::{mesh_volume_mm3, tetrahedra_volume_mm3};

/// Most places of a surface that distances are measured at: some gigabytes.
pub const MOST_SAMPLES: usize = 100_000_000;

/// Why something cannot be measured.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// A mesh without a surface.
    #[error("the {0} has no triangle with an area, so nothing can be measured on it; give another")]
    NoSurface(&'static str),
    /// A mesh with no inside.
    #[error(
        "the {0} is not closed, so it has no volume; fill its holes (`bonemesh repair --fill-holes all`) or leave the residual volume out"
    )]
    Open(&'static str),
    /// The boolean gave up.
    #[error(
        "what the two meshes have in common cannot be found ({0}); look for the fault with `bonemesh check`, or leave the residual volume out"
    )]
    Boolean(&'static str),
    /// More places than memory holds.
    #[error("{0} places to measure at are too many; give at most {MOST_SAMPLES}")]
    TooManySamples(usize),
    /// A mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl MeasureError {
    /// Whether the work was stopped on request.
    pub fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Cancelled(_) | Self::Mesh(MeshError::Cancelled(_))
        )
    }
}
