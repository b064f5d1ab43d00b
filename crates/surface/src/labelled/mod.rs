//! Delaunay tetrahedra of the surface's own points, each bone or not.
//!
//! 1. `above_level` (of the isosurface): the grey of every voxel above that of the bone's true
//!    edge.
//! 2. `field`: the distance of every voxel from that edge, which also tells what happens between
//!    thick slices.
//! 3. `points`: where the surface crosses the edges between voxels, on a fine grid of the
//!    patient's frame; some points far from it, and a box of air.
//! 4. The Delaunay tetrahedra of these points.
//! 5. `labels`: each tetrahedron is bone where most of it lies inside.
//! 6. `shallow`: those that lie on the surface are what makes it smoother.
//! 7. `manifold`: where bone or air only touches itself in an edge or a vertex, air is filled.
//! 8. The facets between bone and air.
//!
//! Tetrahedra overlap nowhere, exactly, and their corners are written as they are, so the surface
//! passes through itself nowhere, also as a file of 32-bit coordinates.

mod field;
mod labels;
mod manifold;
mod points;
mod shallow;

use bonemesh_delaunay::{Points, Tetrahedra, tetrahedralize};
use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;
use bonemesh_volume::Volume;

use crate::isosurface::grey::Grey;
use crate::isosurface::{above_level, nothing, shape};
use crate::{IsosurfaceSettings, SurfaceError};
use field::Field;
use points::Grid;

/// Tetrahedra that lie in the bone or in the air by less than this part of a pixel are neither.
const SHALLOW: f32 = 0.15;
/// A vertex that no triangle uses.
const UNUSED: u32 = u32::MAX;

/// The boundary of the tetrahedra that are bone, and what is to be said of them.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelledSurface {
    /// Closed, 2-manifold, outward-oriented, in patient space (mm); 32-bit coordinates hold its
    /// vertices exactly.
    pub mesh: TriangleMesh,
    /// How many tetrahedra are bone.
    pub tetrahedra: usize,
    /// Volume of air that was filled where bone or air only touched itself.
    pub filled_mm3: f64,
}

/// The surface of the bone in `volume` by labelled Delaunay tetrahedra.
///
/// It goes through the points in which an [`isosurface`](crate::isosurface) crosses the edges
/// between voxels of a slice, but goes from one thick slice to the next with weaker stairs.
/// The stages are `edges`, `distances`, `tetrahedra`, `borders`, `labels` and `surface`.
///
/// # Errors
/// [`SurfaceError::NothingAbove`], [`SurfaceError::TooSmall`] (bone of less than a voxel may be
/// less than a tetrahedron), [`SurfaceError::TooLarge`], [`SurfaceError::Delaunay`] where there are
/// too many points, [`SurfaceError::Cancelled`].
pub fn labelled_surface(
    volume: &Volume,
    settings: IsosurfaceSettings<'_>,
    task: &Task,
) -> Result<LabelledSurface, SurfaceError> {
    let geometry = volume.geometry();
    let voxel_mm = geometry.spacing_mm().map(|mm| mm as f32);
    let shape = shape(volume);
    let values = above_level(volume, settings, task)?;
    let above = Grey::new(&values, shape);
    let field = Field::of(&above, settings.crossing(), voxel_mm, task)?;
    let mut places = points::crossings(&above, settings.crossing(), &field, voxel_mm, task)?;
    drop(values);
    if places.is_empty() {
        return Err(nothing(volume, settings));
    }
    places.extend(points::far_points(&field, shape, voxel_mm));
    if places.len() >= UNUSED as usize - 8 {
        return Err(SurfaceError::TooLarge);
    }
    let grid = Grid::around(&places, geometry.patient_from_voxel());
    let points = Points::Lattice {
        coordinates: &grid.coordinates,
        gram: grid.gram(),
    };
    let Tetrahedra { cells } = tetrahedralize(points, task)?;
    let depths = labels::depths(&cells, &places, &field, task)?;
    drop(places);
    drop(field);
    let mut is_bone: Vec<bool> = depths.iter().map(|mm| *mm > 0.0).collect();
    let within_mm = SHALLOW * voxel_mm.into_iter().fold(f32::INFINITY, f32::min);
    let shallow = (0..).zip(&depths).filter(|(_, mm)| mm.abs() < within_mm);
    let shallow: Vec<u32> = shallow.map(|(cell, _)| cell).collect();
    drop(depths);
    let surface = manifold::surface(&cells, &shallow, &mut is_bone, &grid, task)?;
    let mut triangles = surface.triangles;
    if triangles.is_empty() {
        // Less than a tetrahedron of bone.
        return Err(nothing(volume, settings));
    }
    let vertices_mm = used(&grid, &mut triangles);
    Ok(LabelledSurface {
        mesh: TriangleMesh::new(vertices_mm, triangles)?,
        tetrahedra: is_bone.iter().filter(|bone| **bone).count(),
        filled_mm3: surface.filled_mm3,
    })
}

/// The points that triangles name, in order; renumbers the triangles.
fn used(grid: &Grid, triangles: &mut [[u32; 3]]) -> Vec<[f64; 3]> {
    let mut place = vec![UNUSED; grid.coordinates.len()];
    for &v in triangles.as_flattened() {
        place[v as usize] = 0;
    }
    let mut used = Vec::new();
    for (point, place) in (0..).zip(&mut place) {
        if *place != UNUSED {
            *place = used.len() as u32;
            used.push(grid.point_mm(point));
        }
    }
    for v in triangles.as_flattened_mut() {
        *v = place[*v as usize];
    }
    used
}
