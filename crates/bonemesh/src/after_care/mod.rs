//! What is done to a finished mesh: triangles that are no surface, winding, holes, islands, cavities, smoothing, fewer triangles.

mod report;
mod reshaped;
mod steps;

use bonemesh_mesh::{Decimation, Islands};

pub use report::{AfterCareReport, LeftHole, MOST_NAMED};
pub use steps::care_for;
pub(crate) use steps::cared_for;

use crate::Error;

/// Which cavities are filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cavities {
    /// All: medullary canals, sinuses, pores.
    All,
    /// Those of at most this volume (mm3).
    AtMostMm3(f64),
}

/// Which holes are filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Holes {
    /// All.
    All,
    /// Those whose box along the axes has no side longer than this (mm).
    AtMostMm(f64),
}

/// What is done to a finished mesh, in the order of the fields; by default nothing.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct AfterCare {
    /// Whether triangles without area and those given twice are taken out. Meshes that are rendered have none.
    pub clean: bool,
    /// Whether triangles that face another way than their neighbours, and parts that are inside out, are
    /// turned over. Meshes that are rendered have none.
    pub face_outward: bool,
    /// Which holes are filled; `None` fills none.
    pub holes: Option<Holes>,
    /// Which islands are kept; `None` keeps all, but of an isosurface or labelled one that is
    /// rendered leaves out specks, of less than 1 mm3 and 8 voxels.
    pub islands: Option<Islands>,
    /// Which cavities are filled; `None` fills none.
    pub cavities: Option<Cavities>,
    /// Smooths, and moves no vertex further than this (mm); `None` does not smooth.
    pub smooth_mm: Option<f64>,
    /// Takes triangles away until there are this many, or as far as an error bound allows.
    pub decimation: Decimation,
}

impl AfterCare {
    /// Whether nothing is to be done.
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }

    /// Whether the surface is moved.
    fn reshapes(&self) -> bool {
        self.smooth_mm.is_some() || self.decimation != Decimation::default()
    }

    /// Refuses what cannot be done to any mesh, before long work begins.
    ///
    /// # Errors
    /// [`Error::Mesh`] for a number of triangles or a length that is none.
    pub fn check(&self) -> Result<(), Error> {
        Ok(self.decimation.check()?)
    }
}
