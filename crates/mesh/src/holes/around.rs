//! Does a triangle meet the surface, or its like?

use crate::exact::{Corners, meet};
use crate::tree::{Bounds, TriangleTree};

/// Whether a triangle that is not of the surface meets one that is, beyond a common corner or edge.
pub(super) fn meets_surface(tree: &TriangleTree<'_>, corners: &Corners) -> bool {
    let bounds = Bounds::of(corners);
    let mut stack = if tree.nodes().is_empty() {
        Vec::new()
    } else {
        vec![0_u32]
    };
    while let Some(number) = stack.pop() {
        let node = &tree.nodes()[number as usize];
        if !node.bounds.touches(&bounds) {
            continue;
        }
        if node.right != 0 {
            stack.extend([node.right, number + 1]);
            continue;
        }
        let slots = &tree.slots()[node.first as usize..node.end as usize];
        let mut near = slots.iter().filter(|slot| slot.bounds.touches(&bounds));
        if near.any(|slot| meet(corners, &tree.corners_mm(slot))) {
            return true;
        }
    }
    false
}

/// Pairs of triangles, all with an area, that meet one another.
pub(super) fn meeting_pairs(triangles: &[Corners]) -> Vec<[usize; 2]> {
    let bounds: Vec<Bounds> = triangles.iter().map(|t| Bounds::of(t)).collect();
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|a, b| bounds[*a].low[0].total_cmp(&bounds[*b].low[0]));
    let mut pairs = Vec::new();
    for (place, &a) in order.iter().enumerate() {
        for &b in &order[place + 1..] {
            if bounds[b].low[0] > bounds[a].high[0] {
                break;
            }
            if bounds[a].touches(&bounds[b]) && meet(&triangles[a], &triangles[b]) {
                pairs.push([a.min(b), a.max(b)]);
            }
        }
    }
    pairs
}
