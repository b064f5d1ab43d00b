//! Bone surfaces, one file or folder a method: triangles that face outward, in mm.
//!
//! - [`isosurface`] goes between the voxels of a volume, at the true edges of the bone, nearly
//!   whatever the threshold: a closed 2-manifold without self-intersections. Limits: stairs show
//!   on slices much thicker than the bone's detail; a wall thinner than twice the scan's blur
//!   comes out too thick.
//! - [`labelled_surface`] takes the boundary of Delaunay tetrahedra, each bone or not by what lies
//!   in it: as closed as the isosurface, on curved bone a quarter fewer triangles, and weaker
//!   stairs on straight slopes where slices are thick. Limits: three to seven times the time and
//!   twice the memory; of curved bone no truer (the table below); flat bone thinner than a slice is as wrong as in every method; where bone
//!   only touched itself, a little air is filled, and said.
//! - [`alpha_surface`] is the published method, for point clouds. Limits: its surface is closed,
//!   but may touch itself in edges and vertices, where a check reports it as not manifold; and
//!   alpha is one length for the whole cloud, so thin gaps close where it is large and holes open
//!   where it is small. [`volume_matched_boundary`] finds the alpha with which the tetrahedra have
//!   the volume of the bone's voxels; a solid body's may not be had.
//!
//! The other methods that the published study tried are here for study, not for use:
//!
//! - [`ball_pivoting`]: a ball rolls from point to point. Limits: borders wherever points lie further
//!   apart than a ball is wide, so slices 5 mm apart hardly join; gaps narrower than a ball are
//!   bridged; only edges are sure to be manifold.
//! - [`poisson`]: screened Poisson, a smooth function that fits the normals. Limits: a regular grid of
//!   at most 256 cells a side, not an octree; closed at any price, so it invents what it does not
//!   see; one slice becomes a sheet through the middle.
//! - [`tetrahedra_surface`]: the tetrahedra without alpha, whose boundary is the convex hull. Limits:
//!   bores, orbits and dents are filled.
//! - [`planar_surface`]: plane Delaunay triangles seen along z. Limits: one sheet, never a body.
//!
//! Ball pivoting and Poisson need normals (`bonemesh_cloud::estimate_normals`), and share their
//! limits: of one slice alone, or slices further apart than the neighbourhood reaches, these stand
//! across the slice.
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
//! How far isosurfaces are from the true one, on scans of 0.5 x 0.5 x 1.5 mm with a blur of 0.8
//! pixel and noise of 15 HU, at thresholds from 250 to 800 HU, away from creases (mm):
//!
//! | body | mean | signed | 95 of 100 below |
//! |---|---|---|---|
//! | tube | 0.012 | +0.004 | 0.032 |
//! | box with hole | 0.008 | +0.006 | 0.031 |
//! | sphere shell | 0.012 | -0.001 | 0.027 |
//! | femur | 0.013 | -0.003 | 0.031 |
//! | head | 0.024 | -0.004 | 0.086 |
//!
//! Where the grey equals the threshold instead, the tube's mean is 0.013 at 640 HU and 0.434 at
//! 250.
//!
//! At 350 HU, isosurface and labelled tetrahedra, on slices of 1.5 mm and of 5 mm; distance of
//! triangles' middles to the true surface, mean and 95th percentile by area, in mm, and the mean
//! angle between neighbouring triangles in degrees:
//!
//! | body | slices | isosurface | | | labelled | | |
//! |---|---|---|---|---|---|---|---|
//! | tube | 1.5 mm | 0.012 | 0.031 | 3.2 | 0.013 | 0.031 | 3.3 |
//! | sphere shell | 1.5 mm | 0.012 | 0.027 | 2.3 | 0.015 | 0.032 | 2.7 |
//! | femur | 1.5 mm | 0.012 | 0.031 | 2.5 | 0.016 | 0.039 | 2.8 |
//! | tube | 5 mm | 0.016 | 0.045 | 7.6 | 0.019 | 0.058 | 8.0 |
//! | sphere shell | 5 mm | 0.173 | 0.812 | 5.2 | 0.195 | 0.816 | 6.8 |
//! | femur | 5 mm | 0.054 | 0.218 | 4.7 | 0.071 | 0.236 | 5.9 |
//!
//! On a cone of 35 degrees without noise, in slices of 5 mm, labelled tetrahedra halve angles and errors.
//!
//! Between slices, after S. P. Raya and J. K. Udupa, *Shape-based interpolation of multidimensional
//! objects*, 1990.
//!
//! Method with alpha: E. Rier, *Generation and segmentation of 3D models of bone from CT images based on 3D
//! point clouds* (`MASc` thesis, `McMaster` University), after H. Edelsbrunner and E. P. Muecke,
//! *Three-dimensional alpha shapes*, 1994.

mod alpha;
mod ball_pivoting;
mod isosurface;
mod labelled;
mod planar;
mod poisson;
mod sorted;
#[cfg(test)]
mod synthetic;
mod tetrahedra;
mod volume_matched;

pub use alpha::{AlphaSurface, alpha_boundary, alpha_surface, boundary_surface};
pub use ball_pivoting::{BallPivoted, BallPivotingSettings, ball_pivoting};
use bonemesh_cloud::CloudError;
use bonemesh_delaunay::DelaunayError;
use bonemesh_mesh::MeshError;
use bonemesh_task::Cancelled;
pub use isosurface::{IsosurfaceSettings, isosurface, level_surface};
pub use labelled::{LabelledSurface, labelled_surface};
pub use planar::planar_surface;
pub use poisson::{PoissonSettings, poisson};
pub use tetrahedra::tetrahedra_surface;
pub use volume_matched::{VolumeMatched, volume_matched_boundary};

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
    /// Voxels are bone, but a surface encloses none of them.
    #[error(
        "what lies above {threshold_hu} HU is too small or too faint for a surface; lower the threshold, or take an isosurface at the threshold itself"
    )]
    TooSmall {
        /// The threshold asked for.
        threshold_hu: f64,
    },
    /// More vertices than an index can name.
    #[error("the surface has more than 4 billion vertices; crop the volume")]
    TooLarge,
    /// The cloud has no normals or distances.
    #[error(transparent)]
    Cloud(CloudError),
    /// Radii that are no lengths.
    #[error("{0:?} are no radii for ball pivoting; give one length above 0 (mm) or more")]
    Radii(Vec<f64>),
    /// Points of one place have no distance from which radii or cells could follow.
    #[error(
        "the points all share one place, or lie too far out to be told apart; give points that differ, in mm"
    )]
    NoDistance,
    /// No ball touches three points from outside.
    #[error(
        "no ball of up to {radius_mm} mm touches three points from outside; give larger radii, or points of several slices"
    )]
    NothingPivoted {
        /// The largest radius.
        radius_mm: f64,
    },
    /// A volume that tetrahedra cannot have.
    #[error("{0} mm3 is no volume to match alpha to; give one above 0")]
    Volume(f64),
    /// A depth that is not offered.
    #[error("a depth of {0} is not possible; give 3 to 8 (8: 256 cells a side, some 700 MB)")]
    Depth(u32),
    /// A scale that leaves points out, or no room for them.
    #[error("a scale of {0} is not possible; give 1 to 10 (1.1 leaves a tenth of the cube free)")]
    Scale(f64),
    /// The function is level.
    #[error("the points and their normals enclose nothing; give points of several slices")]
    NothingEnclosed,
    /// Nothing to triangulate in the plane.
    #[error(
        "seen along z the {points} points lie on one line or in fewer than three places; give points side by side, or choose another method"
    )]
    Upright {
        /// Points given.
        points: usize,
    },
    /// A coordinate outside the range in which the plane's predicates are exact.
    #[error(
        "the point {place:?} mm is too far out or too near the origin for exact triangles; coordinates must be 0 or between 1e-42 and 1e60 in size"
    )]
    Coordinate {
        /// The point in mm.
        place: [f64; 3],
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<CloudError> for SurfaceError {
    fn from(error: CloudError) -> Self {
        match error {
            CloudError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Cloud(error),
        }
    }
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
