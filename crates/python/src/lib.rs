//! The Python extension module of Bonemesh.
