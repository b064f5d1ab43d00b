//! How far a point, and a whole triangle, is from a surface.

mod near;
mod point;

pub(crate) use near::{Near, is_near};
pub(crate) use point::{is_within, squared_distance};
