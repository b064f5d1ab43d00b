//! How far a point, and a whole triangle, is from a surface.

mod near;
mod point;

pub(crate) use near::Near;
pub(crate) use point::squared_distance;
