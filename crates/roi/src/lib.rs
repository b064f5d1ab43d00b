//! The bone under a selected patch of its surface, down to a thickness, as a mesh of its own.
//!
//! [`select_solid`] cuts the bone under the patch out: a closed 2-manifold without self-intersections,
//! whose front are the mesh's own triangles and whose sides stand upright on the surface. Limits: the
//! surface must be closed near the selection, and its triangles smaller than the thickness and the
//! patch's features; on a rough one the sides are a little rough, too.
//!
//! [`select_region`], [`Method::Thesis`], finds the vertices of the mesh that lie behind the selection, slice by slice,
//! and meshes them and the selection as a point cloud. Its limits are those of the published
//! method: the mesh must consist of slices of equal z, because levels are matched with levels; one
//! normal is guessed for the whole patch, which is wrong where the patch curls or faces inward;
//! corners are rounded; where the bone is thicker than the thickness, its back is ragged. The mesh
//! lies in the axes of the images (x along rows, y along columns, z along the patient) with equal
//! vertices merged, as [`bonemesh_mesh::read_mesh`] returns it.
//!
//! ```no_run
//! use bonemesh_mesh::{read_mesh, write_mesh};
//! use bonemesh_roi::{SolidRequest, ThicknessMm, read_selection, select_solid, select_solids};
//! use bonemesh_task::Task;
//!
//! let task = Task::default();
//! let mesh = read_mesh("skull.stl", &task)?;
//! let selected = read_selection("selection.txt")?;
//! let request = SolidRequest::new(ThicknessMm::new(5.0)?);
//! let solid = select_solid(&mesh, &selected, &request, &task)?;
//! write_mesh("region.stl", &solid.mesh, &task)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Source: E. Rier, *Generation and segmentation of 3D models of bone from CT images based on 3D
//! point clouds* (master's thesis, called "the thesis" here).

mod counterpart;
mod direction;
mod error;
mod local_thickness;
mod method;
mod region;
mod selection;
mod solid;
mod symmetry;
mod thesis;
mod thickness;

pub use counterpart::{Counterparts, counterparts};
pub use direction::Direction;
pub use error::RoiError;
pub use local_thickness::{LocalThickness, local_thickness};
pub use method::Method;
pub use region::{Region, select_region};
pub use selection::read_selection;
pub use solid::{Solid, SolidRequest, select_solid, select_solids};
pub use symmetry::{Symmetry, symmetry_plane};
pub use thickness::{ClearanceMm, ThicknessMm};
