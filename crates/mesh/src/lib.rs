//! Triangle meshes whose indices and coordinates are valid by construction, their files and their
//! topology.
//!
//! [`check_topology`] looks at connections, [`find_faults`] finds where they are broken; [`find_intersections`] finds, exactly, triangles that pass
//! through, overlap or touch one another; [`wall_thickness`] measures through the body; [`section`]
//! cuts along a plane.
//! [`keep_islands`], [`fill_cavities`], [`smooth`] and [`decimate`] give a new mesh: what was a closed
//! 2-manifold that passes through itself nowhere still is one, with the coordinates that a file holds.
//! [`clean`] takes out triangles without area or given twice, [`fill_holes`] closes what is open,
//! [`face_outward`] turns over what faces the wrong way.
//!
//! Limits: files hold 32-bit floats, so a mesh comes back rounded to them (about 0.00002 mm at
//! 200 mm from the origin). Only STL, PLY, OBJ and 3MF are read and written.
//! Triangles with two equal corners or no area are kept, and [`check_topology`] counts them.
//!
//! ```
//! use bonemesh_mesh::{
//!     TriangleMesh, TriangleTree, check_topology, find_intersections, read_mesh, write_mesh,
//! };
//! use bonemesh_task::Task;
//!
//! let tetrahedron = TriangleMesh::new(
//!     vec![[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]],
//!     vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
//! )?;
//! let topology = check_topology(&tetrahedron, &Task::default())?;
//! assert!(topology.watertight && topology.manifold);
//! assert!((topology.volume_mm3 - 4.5).abs() < 1e-12);
//! let tree = TriangleTree::new(&tetrahedron, &Task::default())?;
//! assert_eq!(find_intersections(&tree, 10, &Task::default())?.count, 0);
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("tetrahedron.stl");
//! write_mesh(&path, &tetrahedron, &Task::default())?;
//! assert_eq!(read_mesh(&path, &Task::default())?.triangles().len(), 4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Formats: 3D Systems, *Stereolithography Interface Specification* (1989), for STL; Turk, *The
//! PLY Polygon File Format* (1994); Wavefront, *Advanced Visualizer* manual, appendix B1, for OBJ;
//! 3MF Consortium, *3D Manufacturing Format Core Specification* 1.3 (2021). Exact signs: Shewchuk,
//! *Adaptive precision floating-point arithmetic and fast robust geometric predicates* (1997). Rays:
//! Möller and Trumbore, *Fast, minimum storage ray/triangle intersection* (1997); the cone of rays
//! after Shapira, Shamir and Cohen-Or, *Consistent mesh partitioning and skeletonisation using the
//! shape diameter function* (2008). Volume by the divergence theorem: Zhang and Chen, *Efficient
//! feature extraction for 2D/3D objects in mesh representation* (2001). Decimation: Garland and
//! Heckbert, *Surface simplification using quadric error metrics* (1997); link condition: Dey,
//! Edelsbrunner, Guha and Nekhayev, *Topology preserving edge contraction* (1999). Smoothing: Taubin,
//! *A signal processing approach to fair surface design* (1995). Holes: Barequet and Sharir, *Filling gaps
//! in the boundary of a polyhedron* (1995); Liepa, *Filling holes in meshes* (2003).

mod clean;
mod decimate;
mod distance;
mod error;
mod exact;
mod holes;
mod intersections;
mod io;
mod merge;
mod mesh;
mod parts;
mod plane;
mod section;
mod smooth;
mod stars;
mod thickness;
mod topology;
mod tree;
pub mod vector;

pub use clean::{Cleaned, clean};
pub use decimate::{Decimated, Decimation, decimate};
pub use distance::least_distance;
pub use error::MeshError;
pub use holes::{HoleLeft, HoleLimits, HoleReason, HolesFilled, fill_holes};
pub use intersections::{Intersection, Intersections, find_intersections};
pub use io::{
    MeshFormat, PatientFrame, check_target, check_values_target, read_mesh, write_mesh,
    write_mesh_in, write_with_colours, write_with_values,
};
pub use mesh::TriangleMesh;
pub use parts::{
    FacedOutward, Island, Islands, Kept, Nesting, RemovedPart, check_nesting, face_outward,
    fill_cavities, keep_islands, take_islands,
};
pub use plane::Plane;
pub use section::{Outline, section};
pub use smooth::{Smoothed, smooth};
pub use thickness::{Thinnest, WallThickness, wall_thickness, wall_thickness_at};
pub use topology::{Faults, Sets, Topology, check_topology, find_faults};
pub use tree::{Nearest, TriangleTree};
