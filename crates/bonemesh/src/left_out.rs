//! What a closed surface is made without, unless it is asked for: the scanner's table, and specks.

use bonemesh_mesh::{Island, TriangleMesh, take_islands};
use bonemesh_task::Task;
use bonemesh_volume::Volume;

use crate::report::{LeftOut, LeftOutIslands};
use crate::table::judge;
use crate::table_pieces::{are_pieces, may_break};
use crate::{Error, Settings};

/// A loose speck of less than this is noise, or too small to print and to plan with; the smallest
/// bone of the body, the stapes, weighs some 3 mg, which is more. Specks are half of all islands in
/// scans of heads, and 0.004 percent of their bone.
const SPECK_MM3: f64 = 1.0;
/// In scans of small things a speck is as many voxels.
const SPECK_VOXELS: f64 = 8.0;

/// The mesh of `volume` without table and specks, as far as `settings` leave them out; `whole`: the scan
/// before it was cropped.
pub(crate) fn leave_out(
    mesh: &TriangleMesh,
    volume: &Volume,
    whole: &Volume,
    settings: &Settings,
    task: &Task,
) -> Result<(TriangleMesh, LeftOut), Error> {
    let mut left_out = LeftOut::default();
    // Who says which islands stay has said it of specks as well.
    let least_mm3 = match settings.after_care.islands {
        None => speck_mm3(volume),
        Some(_) => 0.0,
    };
    let are_taken = |islands: &[Island<'_>]| -> Result<Vec<bool>, Error> {
        let specks = are_specks(islands, least_mm3);
        let table = if settings.leave_out_table {
            are_table(
                islands,
                &specks,
                volume,
                whole,
                settings.threshold.hu(),
                task,
            )?
        } else {
            vec![false; islands.len()]
        };
        let taken: Vec<bool> = specks.iter().zip(&table).map(|(a, b)| a | b).collect();
        if taken.iter().all(|taken| *taken) {
            // Nothing but specks beside what looks like a table: then that is what was scanned.
            return Ok(vec![false; islands.len()]);
        }
        left_out.specks = LeftOutIslands::of(islands, &specks);
        left_out.table = LeftOutIslands::of(islands, &table);
        Ok(taken)
    };
    let kept = take_islands(mesh, are_taken, task)?;
    Ok((kept.mesh, left_out))
}

/// Which islands are table, or pieces of one.
fn are_table(
    islands: &[Island<'_>],
    specks: &[bool],
    volume: &Volume,
    whole: &Volume,
    threshold_hu: f64,
    task: &Task,
) -> Result<Vec<bool>, Error> {
    let [slices, ..] = volume.geometry().shape();
    let stack_mm = volume.geometry().spacing_mm()[2] * slices as f64;
    let verdict = judge(islands, whole, stack_mm, task)?;
    let is_found = verdict.are_table.contains(&true);
    let is_doubtful = (verdict.are_bare.iter().zip(specks)).any(|(bare, speck)| *bare && !speck);
    if is_found || !is_doubtful || !may_break(threshold_hu) {
        return Ok(verdict.are_table);
    }
    let pieces = are_pieces(islands, volume, whole, stack_mm, task)?;
    // The bone itself may be as bare as a table.
    let bare = pieces.into_iter().zip(&verdict.are_bare);
    Ok(bare.map(|(piece, bare)| piece && *bare).collect())
}

/// Islands of less than this volume are specks.
fn speck_mm3(volume: &Volume) -> f64 {
    let voxel_mm3 = volume.geometry().patient_from_voxel().determinant().abs();
    SPECK_MM3.min(SPECK_VOXELS * voxel_mm3)
}

/// Which islands are smaller than `least_mm3`; never the largest.
fn are_specks(islands: &[Island<'_>], least_mm3: f64) -> Vec<bool> {
    let size = |island: &Island<'_>| island.volume_mm3.abs();
    let largest_mm3 = islands.iter().map(size).fold(0.0, f64::max);
    let least_mm3 = least_mm3.min(largest_mm3);
    islands.iter().map(|i| size(i) < least_mm3).collect()
}
