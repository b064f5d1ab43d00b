//! The Python extension module of Bonemesh: a thin skin over the facade crate.
//!
//! Promise: no algorithm is here. Each file translates one type or step: arguments are checked and
//! copied, the work runs with the GIL released (`detach`), results come back as frozen objects
//! whose arrays are read-only views, errors become exceptions (`errors`), and a panic becomes an
//! exception too.
//!
//! Limits: the module is private; `bonemesh`, the package around it, is what people import. Its
//! signatures are written down in `python/bonemesh/__init__.pyi`.

mod after_care;
mod arrays;
mod cancel;
mod check;
mod cloud;
mod command;
mod compare;
mod detach;
mod edges;
mod errors;
mod lattice;
mod mesh;
mod mirror;
mod options;
mod phantom;
mod planes;
mod preview;
mod region;
mod render;
mod report;
mod sampling;
mod section;
mod series;
mod surface;
mod tetrahedra;
mod thresholds;
mod views;
mod volume;

use pyo3::prelude::*;

/// What the package `bonemesh` is made of.
#[pymodule(gil_used = true)]
mod _native {
    use super::{Bound, PyModule, PyModuleMethods, PyResult};

    #[pymodule_export]
    use crate::after_care::{
        clean, decimate, face_outward, fill_cavities, fill_holes, keep_islands, smooth,
    };
    #[pymodule_export]
    use crate::cancel::Cancel;
    #[pymodule_export]
    use crate::check::{check, faults, wall_thickness};
    #[pymodule_export]
    use crate::cloud::{mean_neighbour_distance, point_cloud};
    #[pymodule_export]
    use crate::command::main;
    #[pymodule_export]
    use crate::compare::{compare, signed_distances};
    #[pymodule_export]
    use crate::edges::canny;
    #[pymodule_export]
    use crate::mesh::{Mesh, read_mesh};
    #[pymodule_export]
    use crate::mirror::{mirror, symmetry_plane};
    #[pymodule_export]
    use crate::phantom::{phantom, write_phantom};
    #[pymodule_export]
    use crate::planes::SlicePlane;
    #[pymodule_export]
    use crate::preview::Preview;
    #[pymodule_export]
    use crate::region::{local_thickness, select_roi};
    #[pymodule_export]
    use crate::render::{methods, render};
    #[pymodule_export]
    use crate::sampling::{normal_similarity, sample, similarity_ranges};
    #[pymodule_export]
    use crate::section::section;
    #[pymodule_export]
    use crate::series::{LeftOut, Scan, Series, find_series, read_series, scan};
    #[pymodule_export]
    use crate::surface::PhantomSurface;
    #[pymodule_export]
    use crate::tetrahedra::{alpha_surface, tetrahedralize};
    #[pymodule_export]
    use crate::thresholds::{Histogram, histogram, label_components, suggest_thresholds};
    #[pymodule_export]
    use crate::volume::Volume;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        bonemesh::hush_foreign_panics();
        module.add("__version__", bonemesh::VERSION)?;
        crate::errors::add_to(module)
    }
}
