//! How far two surfaces are apart, in both directions.

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;

use crate::samples::{areas_mm2, places_mm};
use crate::spread::Spread;
use crate::{MOST_SAMPLES, MeasureError, Reference, signed_distances};

/// Distances between two surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceDistances {
    /// From places on the mesh to the reference; signs are those of the reference's side.
    pub to_reference: Spread,
    /// From places on the reference to the mesh; signs are those of the mesh's side.
    pub from_reference: Spread,
    /// The largest distance from either surface to the other (symmetric Hausdorff distance).
    pub hausdorff_mm: f64,
    /// Mean of both directions, by area.
    pub mean_mm: f64,
    /// Root mean square of both directions, by area.
    pub rms_mm: f64,
    /// 95 % of both surfaces are at most so far from the other.
    pub p95_mm: f64,
    /// Signed distances of the places on the mesh to the reference, which lie evenly by area.
    pub signed_mm: Vec<f64>,
}

/// Distances between two surfaces at `samples` places of each, evenly spread by area; for the largest
/// distance also at every vertex that a triangle uses.
///
/// # Errors
/// [`MeasureError::NoSurface`], [`MeasureError::TooManySamples`], or the work was cancelled.
pub fn compare_surfaces(
    mesh: &TriangleMesh,
    reference: &TriangleMesh,
    samples: usize,
    task: &Task,
) -> Result<SurfaceDistances, MeasureError> {
    if samples > MOST_SAMPLES {
        return Err(MeasureError::TooManySamples(samples));
    }
    let mesh = mesh.merged(task)?.compacted();
    let reference = reference.merged(task)?.compacted();
    let to = one_way(&mesh, &reference, "mesh", samples, task)?;
    let from = one_way(&reference, &mesh, "reference", samples, task)?;
    let weighted = |way: &OneWay| {
        let weight = way.area_mm2 / way.signed_mm.len() as f64;
        way.signed_mm.clone().into_iter().map(move |d| (d, weight))
    };
    let both = Spread::weighted(weighted(&to).chain(weighted(&from)));
    Ok(SurfaceDistances {
        hausdorff_mm: to.spread.max_mm.max(from.spread.max_mm),
        mean_mm: both.mean_mm,
        rms_mm: both.rms_mm,
        p95_mm: both.p95_mm,
        to_reference: to.spread,
        from_reference: from.spread,
        signed_mm: to.signed_mm,
    })
}

/// From one surface to another.
struct OneWay {
    area_mm2: f64,
    signed_mm: Vec<f64>,
    spread: Spread,
}

fn one_way(
    from: &TriangleMesh,
    to: &TriangleMesh,
    what: &'static str,
    samples: usize,
    task: &Task,
) -> Result<OneWay, MeasureError> {
    let areas = areas_mm2(from);
    let places = places_mm(from, &areas, samples.max(1));
    if places.is_empty() {
        return Err(MeasureError::NoSurface(what));
    }
    let reference = Reference::new(to, task)?;
    let signed_mm = signed_distances(&places, &reference, task)?;
    let of_vertices = signed_distances(from.vertices_mm(), &reference, task)?;
    let mut spread = Spread::of(&signed_mm);
    spread.max_mm = of_vertices
        .iter()
        .fold(spread.max_mm, |most, d| most.max(d.abs()));
    Ok(OneWay {
        area_mm2: areas.iter().sum(),
        signed_mm,
        spread,
    })
}
