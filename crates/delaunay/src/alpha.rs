//! Whole triangulations and alpha complexes, in an order that only the points decide.

use bonemesh_task::Task;
use rayon::prelude::*;

use crate::boundary::single_facets_sorted;
use crate::kept::Kept;
use crate::numbered::numbered;
use crate::pieces::whole;
use crate::points::{AnySites, Points, Sites};
use crate::predicates::Kernel;
use crate::slabs::Slabs;
use crate::{AlphaBoundary, DelaunayError, Tetrahedra};

/// Calls a function of the sites, whatever their kind.
macro_rules! for_any_sites {
    ($points:expr, $task:expr, $sites:ident => $call:expr) => {
        match AnySites::new($points, $task)? {
            AnySites::Upright($sites) => $call,
            AnySites::Tilted($sites) => $call,
            AnySites::Free($sites) => $call,
        }
    };
}

/// The Delaunay tetrahedra of `points`.
///
/// Of equal points the lowest index is used. Cells come sorted by the order of their points'
/// coordinates (z, y, x), and so do each cell's vertices, but for the last two, which
/// orientation places: the result depends on the set of points only. The stages are `tetrahedra`
/// and, for many points, `borders`.
///
/// # Errors
/// Every [`DelaunayError`] but [`DelaunayError::Alpha`].
pub fn tetrahedralize(points: Points<'_>, task: &Task) -> Result<Tetrahedra, DelaunayError> {
    fn all<K: Kernel>(sites: &Sites<K>, task: &Task) -> Result<Tetrahedra, DelaunayError> {
        let cells = whole(sites, task)?;
        Ok(numbered(&[cells], &sites.input, task)?)
    }
    for_any_sites!(points, task, sites => all(&sites, task))
}

/// The Delaunay tetrahedra of `points` with a circumradius of at most `alpha` (mm).
///
/// Exactly those of [`tetrahedralize`], in the same order, but found slab by slab in parallel,
/// which neither their number nor their order shows. An infinite alpha keeps all. The stage is
/// `tetrahedra`.
///
/// # Errors
/// Every [`DelaunayError`]; no tetrahedron small enough is no error but an empty result.
pub fn alpha_complex(
    points: Points<'_>,
    alpha: f64,
    task: &Task,
) -> Result<Tetrahedra, DelaunayError> {
    fn small<K: Kernel>(
        sites: &Sites<K>,
        alpha: f64,
        task: &Task,
    ) -> Result<Tetrahedra, DelaunayError> {
        let slabs = Slabs::plan(sites, alpha);
        let cells = slabs.triangulate(sites, task, |slab, found| {
            let kept = Kept::new(found, alpha, &slabs, slab, task)?;
            Ok(kept.ranks())
        })?;
        Ok(numbered(&cells, &sites.input, task)?)
    }
    checked(alpha)?;
    if alpha == f64::INFINITY {
        return tetrahedralize(points, task);
    }
    for_any_sites!(points, task, sites => small(&sites, alpha, task))
}

/// The boundary of [`alpha_complex`], without the time and memory that a list of its tetrahedra
/// takes.
///
/// The same triangles as [`Tetrahedra::boundary`] of that complex, in the same order. The stage
/// is `tetrahedra`.
///
/// # Errors
/// Every [`DelaunayError`]; no tetrahedron small enough is no error but an empty result.
pub fn alpha_boundary(
    points: Points<'_>,
    alpha: f64,
    task: &Task,
) -> Result<AlphaBoundary, DelaunayError> {
    fn small<K: Kernel>(
        sites: &Sites<K>,
        alpha: f64,
        task: &Task,
    ) -> Result<AlphaBoundary, DelaunayError> {
        let slabs = Slabs::plan(sites, alpha);
        let found = slabs.triangulate(sites, task, |slab, found| {
            let kept = Kept::new(found, alpha, &slabs, slab, task)?;
            Ok((kept.count(), kept.facets()))
        })?;
        let facets = found.par_iter().flat_map_iter(|(_, facets)| facets);
        let named = facets.map(|facet| facet.map(|rank| sites.input[rank as usize]));
        let triangles = single_facets_sorted(named, task)?;
        Ok(AlphaBoundary {
            triangles,
            tetrahedra: found.iter().map(|(count, _)| count).sum(),
        })
    }
    checked(alpha)?;
    if alpha == f64::INFINITY {
        let all = tetrahedralize(points, task)?;
        return Ok(AlphaBoundary {
            triangles: all.boundary(task)?,
            tetrahedra: all.cells.len(),
        });
    }
    for_any_sites!(points, task, sites => small(&sites, alpha, task))
}

fn checked(alpha: f64) -> Result<(), DelaunayError> {
    if alpha.is_nan() || alpha <= 0.0 {
        return Err(DelaunayError::Alpha(alpha));
    }
    Ok(())
}
