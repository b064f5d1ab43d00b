//! After-care, one step after the other.

use std::time::Instant;

use bonemesh_mesh::{
    Decimation, HoleLimits, TriangleMesh, clean, decimate, face_outward, fill_cavities, fill_holes,
    keep_islands, smooth,
};
use bonemesh_task::Task;

use super::reshaped::{largest_distance_mm, volume_change_percent};
use super::{AfterCare, AfterCareReport, Cavities, Holes};
use crate::Error;
use crate::render::Rendered;
use crate::report::check;

/// Does to `mesh` what `care` asks for.
///
/// # Errors
/// [`Error::NoIslandLeft`], [`Error::Mesh`] for a value that is no length or volume, or a
/// cancelled task.
pub fn care_for(
    mesh: TriangleMesh,
    care: &AfterCare,
    task: &Task,
) -> Result<(TriangleMesh, AfterCareReport), Error> {
    let clock = Instant::now();
    care.check()?;
    let mut report = AfterCareReport::default();
    let mended = mended(mesh, care, &mut report, task)?;
    let chosen = without_parts(mended, care, &mut report, task)?;
    let mesh = if care.reshapes() {
        reshaped(&chosen, care, &mut report, task)?
    } else {
        chosen
    };
    report.seconds = clock.elapsed().as_secs_f64();
    Ok((mesh, report))
}

/// Without triangles that are no surface, winding of one kind, holes filled.
fn mended(
    mut mesh: TriangleMesh,
    care: &AfterCare,
    report: &mut AfterCareReport,
    task: &Task,
) -> Result<TriangleMesh, Error> {
    if care.clean {
        let cleaned = clean(&mesh, task)?;
        report.removed_degenerate = cleaned.degenerate;
        report.removed_doubled = cleaned.doubled;
        mesh = cleaned.mesh;
    }
    if care.face_outward {
        mesh = report.turned(face_outward(&mesh, task)?);
    }
    if let Some(holes) = care.holes {
        let limits = HoleLimits {
            at_most_mm: match holes {
                Holes::All => None,
                Holes::AtMostMm(most) => Some(most),
            },
            at_most_edges: None,
        };
        mesh = report.with_lids(fill_holes(&mesh, limits, task)?);
        if care.face_outward {
            // Of an open part it is not known which way is out.
            mesh = report.turned(face_outward(&mesh, task)?);
        }
    }
    Ok(mesh)
}

/// Without islands and cavities that are not wanted.
fn without_parts(
    mut mesh: TriangleMesh,
    care: &AfterCare,
    report: &mut AfterCareReport,
    task: &Task,
) -> Result<TriangleMesh, Error> {
    if let Some(islands) = &care.islands {
        let had_triangles = !mesh.triangles().is_empty();
        let kept = keep_islands(&mesh, islands, task)?;
        if had_triangles && kept.mesh.triangles().is_empty() {
            let largest_mm3 = kept.removed.first().map_or(0.0, |part| part.volume_mm3);
            return Err(Error::NoIslandLeft { largest_mm3 });
        }
        mesh = report.without(kept);
    }
    if let Some(cavities) = care.cavities {
        let most = match cavities {
            Cavities::All => None,
            Cavities::AtMostMm3(most) => Some(most),
        };
        mesh = report.without(fill_cavities(&mesh, most, task)?);
    }
    Ok(mesh)
}

/// Smoothed, and with fewer triangles.
fn reshaped(
    given: &TriangleMesh,
    care: &AfterCare,
    report: &mut AfterCareReport,
    task: &Task,
) -> Result<TriangleMesh, Error> {
    let mut smoothed = None;
    if let Some(tolerance_mm) = care.smooth_mm {
        let done = smooth(given, tolerance_mm, task)?;
        report.largest_move_mm = Some(done.largest_move_mm);
        report.put_back_vertices = Some(done.put_back);
        smoothed = Some(done.mesh);
    }
    let mut mesh = smoothed.unwrap_or_else(|| given.clone());
    if care.decimation != Decimation::default() {
        let decimated = decimate(&mesh, care.decimation, task)?;
        let left = decimated.mesh.triangles().len();
        report.removed_triangles = Some(mesh.triangles().len() - left);
        report.missed_triangles = care.decimation.triangles.filter(|wanted| left > *wanted);
        report.held_vertices = Some(decimated.held_vertices);
        report.largest_distance_mm = largest_distance_mm(&mesh, &decimated.mesh, task)?;
        mesh = decimated.mesh;
    }
    report.volume_change_percent = volume_change_percent(given, &mesh, task)?;
    Ok(mesh)
}

/// The rendered mesh after `care`, its report brought up to date.
pub(crate) fn cared_for(
    rendered: Rendered,
    care: &AfterCare,
    task: &Task,
) -> Result<Rendered, Error> {
    if care.is_nothing() {
        return Ok(rendered);
    }
    let Rendered { mesh, mut report } = rendered;
    let (mesh, done) = care_for(mesh, care, task)?;
    let topology = check(&mesh, task)?;
    report.vertices = topology.vertices;
    report.triangles = topology.triangles;
    report.watertight = topology.watertight;
    report.manifold = topology.manifold;
    report.components = topology.components;
    report.cavities = topology.cavities;
    report.volume_mm3 = topology.volume_mm3;
    report.seconds.total += done.seconds;
    report.after_care = Some(done);
    Ok(Rendered { mesh, report })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron, 9 mm and 3 mm long, that lacks one side each.
    fn open_tetrahedra() -> TriangleMesh {
        let corners = |at: f64, size: f64| {
            [
                [at, 0.0, 0.0],
                [at + size, 0.0, 0.0],
                [at, size, 0.0],
                [at, 0.0, size],
            ]
        };
        let vertices = [corners(0.0, 9.0), corners(20.0, 3.0)].concat();
        let sides = [[0, 2, 1], [0, 1, 3], [0, 3, 2]];
        let triangles = [0, 4].map(|first| sides.map(|side| side.map(|v| v + first)));
        TriangleMesh::new(vertices, triangles.concat()).expect("the numbers are those of vertices")
    }

    #[test]
    fn holes_are_filled_up_to_a_length_and_the_report_names_the_others() {
        for (holes, filled) in [
            (Holes::All, 2),
            (Holes::AtMostMm(5.0), 1),
            (Holes::AtMostMm(0.5), 0),
        ] {
            let care = AfterCare {
                holes: Some(holes),
                ..AfterCare::default()
            };
            let cared = care_for(open_tetrahedra(), &care, &Task::default());
            let (mesh, report) = cared.expect("the length is one");
            assert_eq!(mesh.triangles().len(), 6 + filled);
            assert_eq!(report.filled_holes, Some(filled));
            assert_eq!(report.left_holes, Some(2 - filled));
            assert_eq!(report.largest_left_holes.len(), 2 - filled);
            let reasons = report.largest_left_holes.iter().map(|left| left.reason);
            assert!(
                reasons
                    .into_iter()
                    .all(|why| why == "larger than asked for")
            );
        }
    }
}
