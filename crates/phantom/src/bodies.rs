//! The bodies of known distance field.

mod femur;
mod head;
mod simple;

pub(crate) use femur::{FEMUR_CENTRE, femur};
pub(crate) use head::head;
pub(crate) use simple::{box_with_hole, sphere_shell, tube};

use crate::body::Layers;
use crate::shape::build::Solid;

/// A body with the figures that its shape fixes.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    pub(crate) layers: Layers,
    /// Volume of the bone where a formula gives it.
    pub(crate) volume_mm3: Option<f64>,
    pub(crate) parameters: Vec<(&'static str, f64)>,
    pub(crate) landmarks: Vec<(&'static str, [f64; 3])>,
    /// Parts of the surface by name, where there are several.
    pub(crate) structures: Vec<(&'static str, Solid)>,
}
