//! The one error of the facade.

use std::path::PathBuf;

use bonemesh_cloud::CloudError;
use bonemesh_dicom::DicomError;
use bonemesh_measure::MeasureError;
use bonemesh_mesh::MeshError;
use bonemesh_metal::MetalError;
use bonemesh_phantom::PhantomError;
use bonemesh_roi::RoiError;
use bonemesh_segment::SegmentError;
use bonemesh_surface::SurfaceError;
use bonemesh_task::{Cancelled, PoolError};
use bonemesh_volume::VolumeError;
use bonemesh_volume_file::VolumeFileError;

/// Why a step failed; every message names the file or value and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Reading the CT folder.
    #[error(transparent)]
    Dicom(#[from] DicomError),
    /// Reading a file with a whole volume.
    #[error(transparent)]
    VolumeFile(#[from] VolumeFileError),
    /// The volume or its crop box.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// Metal in the volume.
    #[error(transparent)]
    Metal(#[from] MetalError),
    /// Threshold or edges.
    #[error(transparent)]
    Segment(#[from] SegmentError),
    /// The point cloud.
    #[error(transparent)]
    Cloud(#[from] CloudError),
    /// The surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The mesh or its file.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// What cannot be measured.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// The region of interest.
    #[error(transparent)]
    Roi(#[from] RoiError),
    /// The phantom.
    #[error(transparent)]
    Phantom(#[from] PhantomError),
    /// Canny found next to nothing.
    #[error(
        "only {points} edge points were found at sigma {sigma}; lower sigma, or choose another threshold or crop box"
    )]
    FewEdges {
        /// Edge points found.
        points: usize,
        /// Canny's smoothing, pixels.
        sigma: f64,
    },
    /// Sampling left next to nothing.
    #[error("sampling {of} points by `{sampler}` keeps only {points}; raise the percentage")]
    FewSamples {
        /// Points kept.
        points: usize,
        /// Points before.
        of: usize,
        /// Name of the sampler.
        sampler: &'static str,
    },
    /// A sampler without a percentage.
    #[error("the sampler `{0}` is to keep how many points? give the percentage with --sample")]
    NoPercent(&'static str),
    /// A choice that the method has no use for.
    #[error("{choice} means nothing to the method `{method}`; leave it out, or choose {instead}")]
    NotForMethod {
        /// What was chosen.
        choice: &'static str,
        /// Name of the method.
        method: &'static str,
        /// The methods that have it.
        instead: String,
    },
    /// A clearance without a plate.
    #[error(
        "a clearance is the gap under a plate; leave it out, or choose the direction `outward`"
    )]
    NoPlate,
    /// No island is as large as asked for.
    #[error("no island is that large, the largest has {largest_mm3:.3} mm3; ask for less")]
    NoIslandLeft {
        /// Volume of the largest.
        largest_mm3: f64,
    },
    /// Points of one place have no neighbour distance.
    #[error(
        "every point has its nearest neighbours in its own place, so there is no alpha; take repeated points out or set alpha"
    )]
    NoAlpha,
    /// Alpha cannot be matched to the volume of voxels that are not there.
    #[error(
        "a cloud has no voxels whose volume alpha could be matched to; give alpha in mm, or render the images"
    )]
    NoVoxels,
    /// Walls of what has no inside.
    #[error(
        "the surface encloses no volume, so its walls cannot be measured and {path} was not written; leave --walls out to see why"
    )]
    NoWalls {
        /// The file that was to be written.
        path: PathBuf,
    },
    /// A picture that cannot be written.
    #[error("cannot write {path}: {source}; choose another place or name, such as histogram.png")]
    Picture {
        /// The file.
        path: PathBuf,
        /// What stands against it.
        source: std::io::Error,
    },
    /// A file beside a mesh that cannot be written.
    #[error("cannot write {path}: {source}; choose another place or name for the mesh")]
    Sidecar {
        /// The file.
        path: PathBuf,
        /// What stands against it.
        source: std::io::Error,
    },
    /// The worker threads.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Error {
    /// Whether choices cannot go together, whatever the data.
    pub fn is_of_choices(&self) -> bool {
        matches!(
            self,
            Self::NotForMethod { .. }
                | Self::NoVoxels
                | Self::NoPlate
                | Self::NoPercent(_)
                | Self::Cloud(CloudError::PercentUnused | CloudError::RangesUnused(_))
        )
    }

    /// Whether the work was stopped on request, in whichever step.
    pub fn is_cancelled(&self) -> bool {
        if let Self::Measure(error) = self {
            return error.is_cancelled();
        }
        matches!(
            self,
            Self::Cancelled(_)
                | Self::Dicom(DicomError::Cancelled(_))
                | Self::VolumeFile(VolumeFileError::Cancelled(_))
                | Self::Metal(MetalError::Cancelled(_))
                | Self::Segment(SegmentError::Cancelled(_))
                | Self::Cloud(CloudError::Cancelled(_))
                | Self::Surface(SurfaceError::Cancelled(_))
                | Self::Mesh(MeshError::Cancelled(_))
                | Self::Roi(RoiError::Cancelled(_))
                | Self::Phantom(PhantomError::Cancelled(_))
        )
    }
}
