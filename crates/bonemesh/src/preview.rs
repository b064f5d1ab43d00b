//! A coarse surface at any threshold, in less time than it takes to see it: what a threshold does
//! before a rendering takes its time.
//!
//! 1. `Preview::of`: the volume is coarsened once, and what comes of that again and again; then the
//!    volume itself is no longer needed.
//! 2. `Preview::surface`: the isosurface of the finest of these whose triangles are few enough to be
//!    handed over and shown at once.
//!
//! Limits: bone is thicker than it is, by up to half a coarse voxel on each side
//! ([`Volume::coarsened`]); table and specks are there; nothing is at its true edge.

use std::num::{NonZero, NonZeroUsize};
use std::ops::Range;
use std::time::Instant;

use bonemesh_mesh::TriangleMesh;
use bonemesh_segment::{HuThreshold, SegmentError};
use bonemesh_surface::{IsosurfaceSettings, SurfaceError, isosurface};
use bonemesh_task::{Task, pool};
use bonemesh_volume::{CropBox, Geometry, Volume, VolumeError};
use serde::Serialize;

use crate::{Error, VERSION};

/// Voxels of the finest coarse volume: its surface takes two or three hundredths of a second.
const MOST_VOXELS: NonZeroUsize = NonZero::new(750_000).expect("more than none");
/// Coarse volumes, each an eighth of the one before.
const LEVELS: usize = 3;
/// Triangles that a program can take over and draw within a tenth of a second; noise at a low
/// threshold makes ten times as many.
const MOST_TRIANGLES: usize = 200_000;
const TWICE: NonZeroUsize = NonZero::new(2).expect("more than none");

/// Coarse volumes of a scan, kept for surfaces at many thresholds.
#[derive(Clone, Debug)]
pub struct Preview {
    geometry: Geometry,
    range_hu: (f64, f64),
    finest: Level,
    /// Each of larger voxels than the one before.
    coarser: Vec<Level>,
}

#[derive(Clone, Debug)]
struct Level {
    volume: Volume,
    /// Columns, rows and slices of the scan that are one here.
    block: [NonZeroUsize; 3],
}

/// A coarse surface and what is to be said of it.
#[derive(Clone, Debug)]
pub struct PreviewSurface {
    /// In patient millimetres (LPS), outward-oriented.
    pub mesh: TriangleMesh,
    /// What is to be said of it.
    pub report: PreviewReport,
}

/// What is to be said of a coarse surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PreviewReport {
    /// Version of this program.
    pub version: &'static str,
    /// Bone is strictly above this.
    pub threshold_hu: f64,
    /// Distance of the coarse voxels: between columns, rows and slices.
    pub spacing_mm: [f64; 3],
    /// Its vertices.
    pub vertices: usize,
    /// Its triangles.
    pub triangles: usize,
    /// How long it took.
    pub seconds: f64,
}

impl Preview {
    /// Coarsens `volume`, with so many worker threads or one for each core; the result does not
    /// depend on them.
    ///
    /// # Errors
    /// [`Error::Cancelled`] or its like.
    pub fn of(volume: &Volume, threads: Option<NonZeroUsize>, task: &Task) -> Result<Self, Error> {
        pool(threads)?.install(|| {
            let block = volume.geometry().block_for(MOST_VOXELS);
            let finest = Level {
                volume: volume.coarsened(block, task)?,
                block,
            };
            let mut coarser: Vec<Level> = Vec::new();
            for _ in 1..LEVELS {
                let level = coarser.last().unwrap_or(&finest).coarser(task)?;
                coarser.push(level);
            }
            Ok(Self {
                geometry: volume.geometry().clone(),
                range_hu: volume.hu_range(),
                finest,
                coarser,
            })
        })
    }

    /// Shape and place of the whole scan.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The surface of what is above `threshold`, in a part of the scan if `crop` (in voxels of the
    /// scan) says so.
    ///
    /// # Errors
    /// [`Error::Segment`] where all of the scan is bone or nothing is, [`Error::Surface`] where what
    /// is bone is too little to show, [`Error::Volume`] for a crop box that does not fit.
    pub fn surface(
        &self,
        threshold: HuThreshold,
        crop: Option<&CropBox>,
        threads: Option<NonZeroUsize>,
        task: &Task,
    ) -> Result<PreviewSurface, Error> {
        let clock = Instant::now();
        self.refuse_all_or_nothing(threshold.hu())?;
        if let Some(crop) = crop {
            crop.check(self.geometry.shape())
                .map_err(VolumeError::from)?;
        }
        pool(threads)?.install(|| {
            let mut level = &self.finest;
            let mut mesh = level.surface(threshold, crop, task)?;
            for coarser in &self.coarser {
                if mesh.triangles().len() <= MOST_TRIANGLES {
                    break;
                }
                level = coarser;
                mesh = level.surface(threshold, crop, task)?;
            }
            let report = PreviewReport {
                version: VERSION,
                threshold_hu: threshold.hu(),
                spacing_mm: level.volume.geometry().spacing_mm(),
                vertices: mesh.vertices_mm().len(),
                triangles: mesh.triangles().len(),
                seconds: clock.elapsed().as_secs_f64(),
            };
            Ok(PreviewSurface { mesh, report })
        })
    }

    fn refuse_all_or_nothing(&self, threshold_hu: f64) -> Result<(), Error> {
        let (lowest_hu, highest_hu) = self.range_hu;
        let refused = if threshold_hu >= highest_hu {
            SegmentError::NothingAbove {
                threshold_hu,
                lowest_hu,
                highest_hu,
            }
        } else if threshold_hu < lowest_hu {
            SegmentError::NothingBelow {
                threshold_hu,
                lowest_hu,
                highest_hu,
            }
        } else {
            return Ok(());
        };
        Err(refused.into())
    }
}

impl Level {
    /// Blocks of eight; sides of one voxel stay.
    fn coarser(&self, task: &Task) -> Result<Self, Error> {
        let [slices, rows, columns] = self.volume.geometry().shape();
        let shape = [columns, rows, slices];
        let twice = shape.map(|n| if n > 1 { TWICE } else { NonZeroUsize::MIN });
        Ok(Self {
            volume: self.volume.coarsened(twice, task)?,
            block: std::array::from_fn(|axis| self.block[axis].saturating_mul(twice[axis])),
        })
    }

    fn surface(
        &self,
        threshold: HuThreshold,
        crop: Option<&CropBox>,
        task: &Task,
    ) -> Result<TriangleMesh, Error> {
        let cropped = crop
            .map(|crop| self.volume.cropped(&self.cropped(crop)))
            .transpose()?;
        let settings = IsosurfaceSettings {
            threshold_hu: threshold.hu(),
            leveled: None,
            true_edges: false,
        };
        isosurface(cropped.as_ref().unwrap_or(&self.volume), settings, task).map_err(|error| {
            match error {
                // The scan has brighter voxels, but too few to count in a block.
                SurfaceError::NothingAbove { threshold_hu } => {
                    SurfaceError::TooSmall { threshold_hu }.into()
                }
                error => error.into(),
            }
        })
    }

    /// The blocks that hold any voxel of a crop box that fits the scan.
    fn cropped(&self, crop: &CropBox) -> CropBox {
        let [columns, rows, slices] = self.block.map(NonZeroUsize::get);
        let blocks =
            |range: &Range<usize>, block: usize| range.start / block..range.end.div_ceil(block);
        CropBox {
            columns: blocks(&crop.columns, columns),
            rows: blocks(&crop.rows, rows),
            slices: blocks(&crop.slices, slices),
        }
    }
}
