//! What is measured of bodies for which it is known.

#![allow(clippy::unwrap_used, reason = "tests")]
#![allow(
    clippy::float_cmp,
    reason = "levels are equal to the bit, or are different ones"
)]

mod bodies;
mod distances;
mod edge_midpoints;
mod residual;
