//! Fewer triangles for the same surface.
//!
//! 1. `Bounds`: rims, and vertices that are no part of a manifold, stay where they are.
//! 2. `Run::collapse`: the edge whose removal moves the surface least collapses to one vertex, at the
//!    place with the least sum of squared distances to the planes of the triangles it stands for
//!    (`quadric`); again and again. Collapses that would change the kind of surface, turn a triangle
//!    over or squeeze it to a needle (`collapse`), or take the surface too far from the given vertices
//!    there (`stay`), are passed over.
//! 3. `faults`: triangles of the result that meet, exactly, or are too far from the given surface
//!    (`distances`).
//! 4. `Bounds::narrowed`: what stood for triangles that meet is held with all its triangles; what was
//!    too far gets narrower limits, and is held in the end. The steps that are still allowed are done
//!    again (`Run::repeat`) and others beside them, until there are no faults. Each time more is
//!    bound, so it comes to an end.
//!
//! Collapsing is one thing after another, because each changes what may be done next to it; but what
//! is far apart can be done side by side, and most of a large mesh is (`blocks`).

mod blocks;
mod bounds;
mod collapse;
mod distances;
mod faults;
mod points;
mod quadric;
mod run;
mod stay;

use bonemesh_task::Task;

use crate::stars::Stars;
use crate::{MeshError, TriangleMesh};
use bounds::Bounds;
use faults::Comparison;
use run::Run;

/// Corners are numbered in 32 bits, and one number means none.
const MOST_TRIANGLES: usize = u32::MAX as usize / 3 - 1;

/// How far [`decimate`] goes; with neither, nothing is done.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Decimation {
    /// Stops as soon as there are at most this many triangles.
    pub triangles: Option<usize>,
    /// The surface is not moved further than this (mm).
    pub error_mm: Option<f64>,
}

/// Fewer triangles than this enclose nothing.
const LEAST_TRIANGLES: usize = 4;

impl Decimation {
    /// Refuses what no mesh can be brought to.
    ///
    /// # Errors
    /// [`MeshError::TooFewTriangles`], [`MeshError::Length`]
    pub fn check(&self) -> Result<(), MeshError> {
        if let Some(triangles) = self.triangles.filter(|wanted| *wanted < LEAST_TRIANGLES) {
            return Err(MeshError::TooFewTriangles { triangles });
        }
        if let Some(error_mm) = self.error_mm {
            MeshError::length("error bound", error_mm)?;
        }
        Ok(())
    }
}

/// What [`decimate`] gives.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Decimated {
    /// The mesh, in coordinates that a file's 32-bit floats hold.
    pub mesh: TriangleMesh,
    /// Vertices of the given mesh that kept all their triangles, because otherwise the result would
    /// have passed through itself or left the error bound.
    pub held_vertices: usize,
}

/// Takes triangles away where that moves the surface least (Garland and Heckbert 1997).
///
/// The mesh is taken as its file gives it back ([`TriangleMesh::as_written`]). A closed 2-manifold
/// stays one, with as many parts and holes through them; rims and vertices that are no part of a
/// manifold stay in their places. Triangles of the result meet, exactly, only where those of
/// the given mesh do. So the number asked for may not be reached; then a smaller one may leave a few
/// triangles more.
///
/// [`Decimation::error_mm`] means: every point of the given surface is at most that far from the
/// result, which is proven; and each corner, edge middle and centroid of the result's triangles is
/// at most that far from the given surface, which is measured.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// [`MeshError::TooFewTriangles`] for less than 4, [`MeshError::Length`] for an error bound that is no length, [`MeshError::NotFinite`] for a
/// coordinate too large for a 32-bit float, [`MeshError::TooManyToDecimate`],
/// [`MeshError::Cancelled`].
pub fn decimate(
    mesh: &TriangleMesh,
    goal: Decimation,
    task: &Task,
) -> Result<Decimated, MeshError> {
    goal.check()?;
    let error_mm = goal.error_mm;
    // With a bound alone, as far as it goes.
    let is_bound = error_mm.is_some() && goal.triangles.is_none();
    let all = if is_bound { 0 } else { usize::MAX };
    let end = goal.triangles.unwrap_or(all);
    let given = mesh.as_written(task)?;
    let triangles = given.triangles().len();
    if triangles > MOST_TRIANGLES {
        return Err(MeshError::TooManyToDecimate { triangles });
    }
    let stars = || Stars::new(given.vertices_mm().len(), given.triangles());
    let mut bounds = Bounds::new(&stars(), error_mm, task)?;
    let mut steps = Vec::new();
    let mut is_narrower = Vec::new();
    let mut comparison = Comparison::new(&given, error_mm, task)?;
    for round in 0.. {
        task.begin("decimate", triangles.saturating_sub(end));
        let mut run = Run::new(&given, stars(), &bounds, task)?;
        if round == 0 {
            run.collapse_in_blocks(end, task)?;
            run.collapse(end, None, task)?;
        } else {
            let is_other = run.repeat(&steps, &is_narrower, task)?;
            // A number is reached wherever it costs least; an error bound, only beside what changed.
            let at = is_bound.then_some(&*is_other);
            run.collapse(end, at, task)?;
        }
        let standing = run.standing();
        let result = TriangleMesh::new(run.vertices_mm.clone(), run.stars.triangles().collect())?;
        let faults = comparison.faults(&result, &run.stars, &standing, task)?;
        let reached = run.reached(&faults.meeting);
        steps = run.steps;
        is_narrower = bounds.narrowed(&faults, &standing, &reached);
        if !is_narrower.contains(&true) {
            return Ok(Decimated {
                mesh: result.compacted(),
                held_vertices: bounds.held,
            });
        }
        comparison.remember(result, standing);
    }
    unreachable!("each round narrows bounds, and there is an end to them: going on is a bug")
}
