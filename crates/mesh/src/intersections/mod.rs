//! Triangles of one mesh that pass through, overlap or touch one another.
//!
//! 1. Leaf by leaf of the tree, `Search::begin_at` walks down to all later leaves whose boxes touch.
//! 2. Pairs whose own boxes touch are decided by [`meet`], exactly.
//! 3. `Found` counts them and keeps those with the lowest numbers, whatever the order in which
//!    threads meet them.

mod found;

use std::sync::atomic::{AtomicBool, Ordering};

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::exact::{meet, place};
use crate::tree::{Node, Slot, TriangleTree};
use crate::{MeshError, TriangleMesh};
use found::Found;

/// Leaves searched from between two reports of progress.
const STRIDE: usize = 64;

/// Two triangles that meet beyond a corner or edge that both have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intersection {
    /// Their numbers, the lower first.
    pub triangles: [u32; 2],
    /// A place (mm) that both share, to within rounding.
    pub place_mm: [f64; 3],
}

/// What [`find_intersections`] finds.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Intersections {
    /// Pairs of triangles that meet, all of them.
    pub count: usize,
    /// Triangles that are in at least one pair.
    pub triangles: usize,
    /// Their numbers, ascending.
    pub in_pairs: Vec<u32>,
    /// The pairs of lowest numbers, in order; as many as were asked for.
    pub pairs: Vec<Intersection>,
}

/// Finds all pairs of triangles that meet where they should not, and keeps the first `most` pairs.
///
/// Two triangles may share a corner or an edge of both, nothing else: a pair counts if the two pass
/// through one another, lie on one another (folded neighbours and doubled triangles too), or if a
/// corner or edge of one only touches the other. Corners are the same if their coordinates are
/// equal, whatever their numbers. The decisions are exact; places are rounded.
///
/// Triangles without area are left out (see [`TriangleTree`]). Where one has been squeezed between
/// two neighbours, a corner of one neighbour lies on the other's edge, and that pair counts.
///
/// The result is the same for any number of threads. The time grows with the number of triangles
/// and of pairs that meet.
///
/// # Errors
/// [`MeshError::Cancelled`]
pub fn find_intersections(
    tree: &TriangleTree<'_>,
    most: usize,
    task: &Task,
) -> Result<Intersections, MeshError> {
    let leaves: Vec<&Node> = tree.nodes().iter().filter(|node| node.right == 0).collect();
    task.begin("intersections", leaves.len());
    let is_in_pair: Vec<AtomicBool> = std::iter::repeat_with(AtomicBool::default)
        .take(tree.mesh().triangles().len())
        .collect();
    let found = leaves
        .par_chunks(STRIDE)
        .map(|leaves| {
            let mut search = Search {
                tree,
                task,
                is_in_pair: &is_in_pair,
                found: Found::new(most),
                stack: Vec::new(),
            };
            for leaf in leaves {
                search.begin_at(leaf)?;
            }
            task.advance(leaves.len())?;
            Ok(search.found)
        })
        .try_reduce(|| Found::new(most), |a, b| Ok::<_, Cancelled>(a.plus(b)))?;
    let (count, pairs) = found.into_parts();
    let pairs = pairs.into_par_iter();
    let in_pairs: Vec<u32> = (0..)
        .zip(&is_in_pair)
        .filter(|(_, is)| is.load(Ordering::Relaxed))
        .map(|(triangle, _)| triangle)
        .collect();
    Ok(Intersections {
        count,
        triangles: in_pairs.len(),
        in_pairs,
        pairs: pairs.map(|pair| located(tree.mesh(), pair)).collect(),
    })
}

/// The pair with its place.
fn located(mesh: &TriangleMesh, triangles: [u32; 2]) -> Intersection {
    let [a, b] = triangles.map(|number| mesh.corners_mm(mesh.triangles()[number as usize]));
    Intersection {
        triangles,
        place_mm: place(&a, &b),
    }
}

/// The search of one thread.
struct Search<'a> {
    tree: &'a TriangleTree<'a>,
    task: &'a Task,
    is_in_pair: &'a [AtomicBool],
    found: Found,
    /// Nodes still to be looked into; kept to save allocations.
    stack: Vec<u32>,
}

impl Search<'_> {
    /// Looks for partners of the triangles of `leaf` in it and in the leaves after it.
    fn begin_at(&mut self, leaf: &Node) -> Result<(), Cancelled> {
        self.stack.clear();
        self.stack.push(0);
        while let Some(number) = self.stack.pop() {
            let node = &self.tree.nodes()[number as usize];
            if node.end <= leaf.first || !node.bounds.touches(&leaf.bounds) {
                continue;
            }
            if node.right == 0 {
                self.compare(leaf, node)?;
            } else {
                self.stack.extend([node.right, number + 1]);
            }
        }
        Ok(())
    }

    /// Tries each triangle of `leaf` with those of `other` that come after it.
    fn compare(&mut self, leaf: &Node, other: &Node) -> Result<(), Cancelled> {
        self.task.check()?;
        let slots = self.tree.slots();
        for place in leaf.first..leaf.end {
            let slot = &slots[place as usize];
            if !slot.bounds.touches(&other.bounds) {
                continue;
            }
            let corners = self.tree.corners_mm(slot);
            for partner in &slots[other.first.max(place + 1) as usize..other.end as usize] {
                if slot.bounds.touches(&partner.bounds)
                    && meet(&corners, &self.tree.corners_mm(partner))
                {
                    self.note(slot, partner);
                }
            }
        }
        Ok(())
    }

    fn note(&mut self, a: &Slot, b: &Slot) {
        let pair = [a.triangle.min(b.triangle), a.triangle.max(b.triangle)];
        for triangle in pair {
            self.is_in_pair[triangle as usize].store(true, Ordering::Relaxed);
        }
        self.found.add(pair);
    }
}
