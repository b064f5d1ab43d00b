//! Solids cut out of meshes.

#![allow(clippy::unwrap_used, reason = "tests")]

mod bodies;
mod coarse;
mod directions;
mod mirror;
mod requests;
mod walls;
