//! How far a point, and a whole triangle, is from a surface.

mod near;
mod pair;
mod point;

pub use pair::least_distance;

pub(crate) use near::{Near, is_near};
pub(crate) use point::{is_within, squared_distance};
