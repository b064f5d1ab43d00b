//! Triangles with the same three corners.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::topology::Sets;

/// Takes out triangles that lie on others.
pub(super) fn take_out(triangles: &mut Vec<[u32; 3]>, task: &Task) -> Result<(), Cancelled> {
    let sorted = |corners: &[u32; 3]| {
        let mut corners = *corners;
        corners.sort_unstable();
        corners
    };
    let mut numbered: Vec<([u32; 3], u32)> = (triangles.par_iter().map(sorted))
        .zip((0..triangles.len() as u32).into_par_iter())
        .collect();
    task.check()?;
    numbered.par_sort_unstable();
    task.check()?;
    let mut is_kept = vec![true; triangles.len()];
    let mut walls = Vec::new();
    let equals = numbered.chunk_by(|a, b| a.0 == b.0);
    for equal in equals.filter(|equal| equal.len() > 1) {
        let facings = equal
            .iter()
            .map(|(_, number)| facing(triangles[*number as usize]));
        let facing_sum: i64 = facings.clone().sum();
        // The first that faces as most do; where they face each other, the first.
        let stays = facings
            .clone()
            .position(|facing| facing * facing_sum > 0)
            .unwrap_or(0);
        for (_, number) in equal {
            is_kept[*number as usize] = false;
        }
        let stays = equal[stays].1;
        is_kept[stays as usize] = true;
        if facing_sum == 0 {
            walls.push(stays);
        }
    }
    for wall in joining(triangles, &is_kept, &walls) {
        is_kept[wall as usize] = false;
    }
    let mut is_kept = is_kept.into_iter();
    triangles.retain(|_| is_kept.next().unwrap_or(true));
    Ok(())
}

/// Which way round three corners go, in the order of their numbers: 1 upward, -1 downward.
fn facing([a, b, c]: [u32; 3]) -> i64 {
    if (a < b) ^ (b < c) ^ (c < a) { 1 } else { -1 }
}

/// Those of `walls` that join surfaces: parts of them with an edge of three or more triangles.
///
/// What has none is a surface given twice, once for each side.
fn joining(triangles: &[[u32; 3]], is_kept: &[bool], walls: &[u32]) -> Vec<u32> {
    let edges = |number: u32| {
        let [a, b, c] = triangles[number as usize];
        [[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)])
    };
    let mut counts: FxHashMap<[u32; 2], usize> = FxHashMap::default();
    counts.extend(
        walls
            .iter()
            .flat_map(|wall| edges(*wall))
            .map(|edge| (edge, 0)),
    );
    if counts.is_empty() {
        return Vec::new();
    }
    let kept = (0..triangles.len() as u32).filter(|number| is_kept[*number as usize]);
    for edge in kept.flat_map(edges) {
        counts.entry(edge).and_modify(|count| *count += 1);
    }
    let mut sets = Sets::default();
    sets.reset(walls.len());
    let mut first_at: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    for (place, wall) in (0..).zip(walls) {
        for edge in edges(*wall).into_iter().filter(|edge| counts[edge] == 2) {
            sets.join(*first_at.entry(edge).or_insert(place), place);
        }
    }
    let mut joins = vec![false; walls.len()];
    for (place, wall) in (0..).zip(walls) {
        joins[sets.lowest(place) as usize] |= edges(*wall).iter().any(|edge| counts[edge] > 2);
    }
    let joining = (0..)
        .zip(walls)
        .filter(|(place, _)| joins[sets.lowest(*place) as usize]);
    joining.map(|(_, wall)| *wall).collect()
}
