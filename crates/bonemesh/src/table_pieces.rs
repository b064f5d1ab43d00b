//! Pieces of the scanner's table at a threshold that breaks it up.
//!
//! A table is known as a whole, by the outline that it repeats all along the scan. Where the threshold is
//! so high that only pieces are left, the whole is looked for at a lower one; what lies in it there is
//! table.

use bonemesh_mesh::{Island, TriangleMesh, TriangleTree, take_islands};
use bonemesh_surface::{IsosurfaceSettings, SurfaceError, isosurface};
use bonemesh_task::Task;
use bonemesh_volume::Volume;
use rayon::prelude::*;

use crate::Error;
use crate::table::judge;

/// Tables are whole at this threshold, and do not hang together with what lies on them.
const WHOLE_HU: f64 = 250.0;
/// Triangles of a piece that are looked at.
const SAMPLES: usize = 16;
/// How far (mm) from the whole's surface a piece may lie.
const WITHIN_MM: f64 = 50.0;

/// Whether a table may have been broken up by a threshold.
pub(crate) fn may_break(threshold_hu: f64) -> bool {
    threshold_hu > WHOLE_HU
}

/// Which islands are pieces of a table of `volume`, the part of the scan that they come from; `whole`: all
/// of it.
pub(crate) fn are_pieces(
    islands: &[Island<'_>],
    volume: &Volume,
    whole: &Volume,
    stack_mm: f64,
    task: &Task,
) -> Result<Vec<bool>, Error> {
    let none = || vec![false; islands.len()];
    let lower = IsosurfaceSettings {
        threshold_hu: WHOLE_HU,
        leveled: None,
        true_edges: false,
    };
    let lower = match isosurface(volume, lower, task) {
        Ok(mesh) => mesh,
        Err(SurfaceError::Cancelled(cancelled)) => return Err(cancelled.into()),
        // Without a surface at that threshold there is no table to know pieces by.
        Err(_) => return Ok(none()),
    };
    let mut table = Vec::new();
    take_islands(
        &lower,
        |islands| -> Result<Vec<bool>, Error> {
            let verdict = judge(islands, whole, stack_mm, task)?;
            let of_table = islands.iter().zip(&verdict.are_table);
            for (island, _) in of_table.filter(|(_, is_table)| **is_table) {
                table.extend_from_slice(island.numbers());
            }
            Ok(vec![false; islands.len()])
        },
        task,
    )?;
    if table.is_empty() {
        return Ok(none());
    }
    let mut is_table = vec![false; lower.triangles().len()];
    for triangle in table {
        is_table[triangle as usize] = true;
    }
    in_table(islands, &lower, &is_table, task)
}

/// Whether most of the nearest triangles of another surface are table.
fn in_table(
    islands: &[Island<'_>],
    lower: &TriangleMesh,
    is_table: &[bool],
    task: &Task,
) -> Result<Vec<bool>, Error> {
    let tree = TriangleTree::new(lower, task)?;
    let is_piece = |island: &Island<'_>| {
        task.check()?;
        let samples = || island.triangles_mm(island.len().div_ceil(SAMPLES));
        let of_table = samples().filter(|[place, ..]| {
            let nearest = tree.nearest(*place, WITHIN_MM);
            nearest.is_some_and(|nearest| is_table[nearest.triangle as usize])
        });
        Ok(2 * of_table.count() > samples().count())
    };
    islands.par_iter().map(is_piece).collect()
}
