//! Bone surfaces, one file or folder a method: triangles that face outward, in mm.
//!
//! - [`isosurface`] goes between the voxels of a volume, at the true edges of the bone, nearly
//!   whatever the threshold: a closed 2-manifold without self-intersections. Limits: stairs show
//!   on slices much thicker than the bone's detail; a wall thinner than twice the scan's blur
//!   comes out too thick.
//! - [`labelled_surface`] takes the boundary of Delaunay tetrahedra, each bone or not by what lies
//!   in it: as closed as the isosurface, on curved bone a quarter fewer triangles, and weaker
//!   stairs where slices are thick (the table below). Limits: four to five times the time and
//!   twice the memory; flat bone thinner than a slice is as wrong as in every method; where bone
//!   only touched itself, a little air is filled, and said.
//! - [`alpha_surface`] is the published method, for point clouds. Limits: its surface is closed,
//!   but may touch itself in edges and vertices, where a check reports it as not manifold; and
//!   alpha is one length for the whole cloud, so thin gaps close where it is large and holes open
//!   where it is small.
//!
//! ```
//! use bonemesh_cloud::PointCloud;
//! use bonemesh_surface::alpha_surface;
//! use bonemesh_task::Task;
//!
//! let corners = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
//! let cube = PointCloud::from_points(corners)?;
//! let surface = alpha_surface(&cube, 1.0, &Task::default())?;
//! assert_eq!(surface.mesh.triangles().len(), 12);
//! assert!((surface.volume_mm3 - 1.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What the isosurface's parts bring, on scans of 0.5 x 0.5 x 1.5 mm (0.6 x 0.6 x 2 for the femur),
//! blurred by 0.8 pixel, noise of 15 HU; mean distance of vertices to the true surface in mm at
//! thresholds from 250 to 800 HU:
//!
//! | body | at the threshold | at the true edges |
//! |---|---|---|
//! | tube | 0.013 (at 640 HU) to 0.434 | 0.014 at each |
//! | box with hole | 0.009 to 0.449 | 0.009 at each |
//! | sphere shell | 0.034 to 0.521 | 0.036 at each |
//! | femur | | 0.033 to 0.034 |
//!
//! At 350 HU, isosurface and labelled tetrahedra, on slices of 1.5 mm and of 5 mm; distance of
//! triangles' middles to the true surface, mean and 95th percentile by area, in mm, and the mean
//! angle between neighbouring triangles in degrees:
//!
//! | body | slices | isosurface | | | labelled | | |
//! |---|---|---|---|---|---|---|---|
//! | tube | 1.5 mm | 0.012 | 0.029 | 2.5 | 0.013 | 0.031 | 2.4 |
//! | sphere shell | 1.5 mm | 0.030 | 0.103 | 5.4 | 0.015 | 0.032 | 3.0 |
//! | tube | 5 mm | 0.021 | 0.064 | 3.5 | 0.021 | 0.066 | 4.0 |
//! | sphere shell | 5 mm | 0.258 | 1.187 | 10.1 | 0.225 | 0.929 | 7.2 |
//! | femur | 5 mm | 0.070 | 0.280 | 5.5 | 0.070 | 0.210 | 5.1 |
//!
//! Between slices, after S. P. Raya and J. K. Udupa, *Shape-based interpolation of multidimensional
//! objects*, 1990.
//!
//! Method with alpha: E. Rier, *Generation and segmentation of 3D models of bone from CT images based on 3D
//! point clouds* (`MASc` thesis, `McMaster` University), after H. Edelsbrunner and E. P. Muecke,
//! *Three-dimensional alpha shapes*, 1994.

mod alpha;
mod isosurface;
mod labelled;

pub use alpha::{AlphaSurface, alpha_boundary, alpha_surface, boundary_surface};
use bonemesh_delaunay::DelaunayError;
use bonemesh_mesh::MeshError;
use bonemesh_task::Cancelled;
pub use isosurface::{IsosurfaceSettings, isosurface};
pub use labelled::{LabelledSurface, labelled_surface};

/// Why no surface could be made, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum SurfaceError {
    /// The points cannot be tetrahedralised.
    #[error(transparent)]
    Delaunay(DelaunayError),
    /// The triangles do not fit the vertices.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Alpha is no length.
    #[error("alpha is {0} mm; it must be a length above 0")]
    Alpha(f64),
    /// No tetrahedron is small enough.
    #[error(
        "no tetrahedron has a circumradius of {alpha_mm} mm or less; raise alpha (the mean distance to 100 neighbours is the default)"
    )]
    NothingKept {
        /// The alpha asked for.
        alpha_mm: f64,
    },
    /// No voxel is bone.
    #[error("no voxel is above {threshold_hu} HU; lower the threshold")]
    NothingAbove {
        /// The threshold asked for.
        threshold_hu: f64,
    },
    /// More vertices than an index can name.
    #[error("the surface has more than 4 billion vertices; crop the volume")]
    TooLarge,
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<DelaunayError> for SurfaceError {
    fn from(error: DelaunayError) -> Self {
        // A cancel is one thing wherever it was noticed.
        match error {
            DelaunayError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Delaunay(error),
        }
    }
}
