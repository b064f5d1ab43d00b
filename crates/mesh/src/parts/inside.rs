//! Which part lies in which, by rays along x.

use std::collections::BTreeMap;

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::label::{Labels, Part};
use crate::exact::{Corners, Passing, passing};
use crate::tree::TriangleTree;
use crate::vector::Vector;

/// Finds each part's parent and whether it is a cavity.
///
/// From a part's tip, the ray crosses what encloses the part once more outward than inward. The
/// innermost of these encloses least.
pub(super) fn find_parents(
    tree: &TriangleTree<'_>,
    labels: &Labels,
    parts: &mut [Part],
    task: &Task,
) -> Result<(), Cancelled> {
    task.begin("containment", parts.len());
    let known = &*parts;
    let parents = known
        .par_iter()
        .zip(0_u32..(known.len() as u32))
        .map(|(part, number)| {
            let around = enclosing(tree, labels, part.tip);
            task.advance(1)?;
            let closed = around.into_iter().filter(|&other| {
                let other_part = &known[other as usize];
                other != number
                    && other_part.is_closed
                    && other_part.volume_mm3.abs() > part.volume_mm3.abs()
            });
            Ok(closed.min_by(|a, b| {
                let [a, b] = [a, b].map(|n| known[*n as usize].volume_mm3.abs());
                a.total_cmp(&b)
            }))
        });
    let parents = parents.collect::<Result<Vec<Option<u32>>, Cancelled>>()?;
    let is_outward = |parent: u32| known[parent as usize].volume_mm3 > 0.0;
    let cavities = known.iter().zip(&parents).map(|(part, parent)| {
        part.is_closed && part.volume_mm3 < 0.0 && parent.is_some_and(is_outward)
    });
    let cavities: Vec<bool> = cavities.collect();
    for ((part, parent), is_cavity) in parts.iter_mut().zip(parents).zip(cavities) {
        part.parent = parent;
        part.is_cavity = is_cavity;
    }
    Ok(())
}

/// The parts that a ray from `from` along x leaves more or less often than it enters them.
fn enclosing(tree: &TriangleTree<'_>, labels: &Labels, from: Vector) -> Vec<u32> {
    let mut turns: BTreeMap<u32, i64> = BTreeMap::new();
    let mut stack = Vec::new();
    if !tree.nodes().is_empty() {
        stack.push(0);
    }
    while let Some(number) = stack.pop() {
        let node = &tree.nodes()[number as usize];
        let (low, high) = (
            node.bounds.low.map(f64::from),
            node.bounds.high.map(f64::from),
        );
        let is_beside = |axis: usize| from[axis] < low[axis] || from[axis] > high[axis];
        if high[0] < from[0] || is_beside(1) || is_beside(2) {
            continue;
        }
        if node.right != 0 {
            stack.extend([node.right, number + 1]);
            continue;
        }
        for slot in &tree.slots()[node.first as usize..node.end as usize] {
            let corners: Corners = tree.corners_mm(slot);
            let turn = match passing(&corners, &from) {
                Passing::Not => continue,
                Passing::Outward => 1,
                Passing::Inward => -1,
            };
            *turns
                .entry(labels.of_triangles[slot.triangle as usize])
                .or_default() += turn;
        }
    }
    turns
        .into_iter()
        .filter(|(_, turns)| *turns != 0)
        .map(|(part, _)| part)
        .collect()
}
