//! The triangles of a mesh in a tree of boxes, for everything that asks what is near.
//!
//! 1. `Slot`: the box of every triangle that has an area.
//! 2. `Branch::grow`: slots cut in two halves at the median of their middles along the longest
//!    side, again and again, down to leaves; the halves in parallel.
//!
//! All leaves but the last are full and a half holds whole leaves, so that a subtree of k leaves
//! takes exactly 2k - 1 nodes, and each half knows its place in the array before it is grown. Ties
//! of middles are settled by the triangles' numbers, so the tree is the same for any number of
//! threads.

mod bounds;
mod cylinder;
mod nearest;
mod ray;

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

pub(crate) use bounds::Bounds;
use cylinder::Cylinder;
pub use nearest::Nearest;
pub(crate) use ray::{Ray, Start, first_hit};

use crate::exact::{Corners, has_area};
use crate::{MeshError, TriangleMesh};

/// Triangles in a leaf.
const LEAF: usize = 8;
/// Slots of a branch below which its halves are grown by one thread.
const SHARED: usize = 1 << 12;
/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// The triangles of one mesh, sorted by place.
///
/// Made once, it answers [`crate::find_intersections`] and [`crate::wall_thickness`]. Triangles
/// without area (two equal corners, or three exactly on one line) are left out: they are no
/// surface, and [`crate::check_topology`] counts them.
#[derive(Debug)]
pub struct TriangleTree<'a> {
    mesh: &'a TriangleMesh,
    /// Triangles in the order of the leaves.
    slots: Vec<Slot>,
    /// The root first; a left child follows its parent.
    nodes: Vec<Node>,
    /// None unless they are asked for.
    cylinders: Option<Cylinders>,
}

/// What lies closer around triangles than boxes.
#[derive(Debug)]
struct Cylinders {
    of_slots: Vec<Cylinder>,
    of_leaves: Vec<Cylinder>,
}

/// A triangle and its box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    pub(crate) bounds: Bounds,
    pub(crate) triangle: u32,
}

/// A box around the slots `first..end`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) bounds: Bounds,
    pub(crate) first: u32,
    pub(crate) end: u32,
    /// The number of the right child; 0 in a leaf.
    pub(crate) right: u32,
}

impl<'a> TriangleTree<'a> {
    /// Sorts the triangles of `mesh`.
    ///
    /// # Errors
    /// [`MeshError::Cancelled`]
    pub fn new(mesh: &'a TriangleMesh, task: &Task) -> Result<Self, MeshError> {
        task.begin("sort triangles", mesh.triangles().len());
        let mut slots = slots(mesh, task)?;
        let leaves = slots.len().div_ceil(LEAF);
        let empty = Node {
            bounds: Bounds::of(&[]),
            first: 0,
            end: 0,
            right: 0,
        };
        let mut nodes = vec![empty; (2 * leaves).saturating_sub(1)];
        if !nodes.is_empty() {
            let root = Branch {
                slots: &mut slots,
                first: 0,
                nodes: &mut nodes,
                number: 0,
            };
            root.grow(task)?;
        }
        Ok(Self {
            mesh,
            slots,
            nodes,
            cylinders: None,
        })
    }

    /// The same tree, prepared so that [`TriangleTree::nearest`] is two to three times faster for places far
    /// from the surface, for some 40 more bytes a triangle.
    #[must_use]
    pub fn for_far_places(mut self) -> Self {
        let around = |slots: &[Slot]| {
            let corners: Vec<Corners> = slots.iter().map(|s| self.corners_mm(s)).collect();
            Cylinder::around(&corners)
        };
        self.cylinders = Some(Cylinders {
            of_slots: self.slots.par_chunks(1).map(around).collect(),
            of_leaves: self.slots.par_chunks(LEAF).map(around).collect(),
        });
        self
    }

    /// The mesh whose triangles these are.
    pub fn mesh(&self) -> &'a TriangleMesh {
        self.mesh
    }

    pub(crate) fn slots(&self) -> &[Slot] {
        &self.slots
    }

    pub(crate) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Calls `visit` with each slot whose box touches `bounds`; `stack` is kept to save allocations.
    pub(crate) fn visit_touching(
        &self,
        bounds: &Bounds,
        stack: &mut Vec<u32>,
        mut visit: impl FnMut(&Slot),
    ) {
        stack.clear();
        stack.extend((!self.nodes.is_empty()).then_some(0));
        while let Some(number) = stack.pop() {
            let node = &self.nodes[number as usize];
            if !node.bounds.touches(bounds) {
                continue;
            }
            if node.right != 0 {
                stack.extend([node.right, number + 1]);
                continue;
            }
            let slots = &self.slots[node.first as usize..node.end as usize];
            let touching = slots.iter().filter(|slot| slot.bounds.touches(bounds));
            touching.for_each(&mut visit);
        }
    }

    /// The corners (mm) of a slot's triangle.
    #[inline]
    pub(crate) fn corners_mm(&self, slot: &Slot) -> Corners {
        self.mesh
            .corners_mm(self.mesh.triangles()[slot.triangle as usize])
    }
}

/// A slot for each triangle with an area, in the order of the triangles.
fn slots(mesh: &TriangleMesh, task: &Task) -> Result<Vec<Slot>, MeshError> {
    let chunks = mesh
        .triangles()
        .par_chunks(STRIDE)
        .enumerate()
        .map(|(chunk, triangles)| {
            let numbered = ((chunk * STRIDE) as u32..).zip(triangles);
            let slots = numbered.filter_map(|(triangle, &vertices)| {
                let corners = mesh.corners_mm(vertices);
                has_area(&corners).then(|| Slot {
                    bounds: Bounds::of(&corners),
                    triangle,
                })
            });
            let slots: Vec<Slot> = slots.collect();
            task.advance(triangles.len())?;
            Ok(slots)
        })
        .collect::<Result<Vec<_>, Cancelled>>()?;
    Ok(chunks.concat())
}

/// A subtree that is still to be grown.
struct Branch<'a> {
    slots: &'a mut [Slot],
    /// Place of the first of them among all slots.
    first: usize,
    nodes: &'a mut [Node],
    /// Number of the first of them among all nodes.
    number: usize,
}

impl Branch<'_> {
    fn grow(self, task: &Task) -> Result<(), Cancelled> {
        let Some((node, below)) = self.nodes.split_first_mut() else {
            return Ok(());
        };
        *node = Node {
            bounds: Bounds::around(self.slots.iter().map(|slot| &slot.bounds)),
            first: self.first as u32,
            end: (self.first + self.slots.len()) as u32,
            right: 0,
        };
        if self.slots.len() <= LEAF {
            return Ok(());
        }
        let left_leaves = self.slots.len().div_ceil(LEAF) / 2;
        let (left_slots, left_nodes) = (left_leaves * LEAF, 2 * left_leaves - 1);
        let is_shared = self.slots.len() > SHARED;
        if is_shared {
            task.check()?;
        }
        halve(self.slots, left_slots);
        let right = self.number + 1 + left_nodes;
        node.right = right as u32;
        let (slots, right_slots) = self.slots.split_at_mut(left_slots);
        let (nodes, right_nodes) = below.split_at_mut(left_nodes);
        let left = Branch {
            slots,
            first: self.first,
            nodes,
            number: self.number + 1,
        };
        let right = Branch {
            slots: right_slots,
            first: self.first + left_slots,
            nodes: right_nodes,
            number: right,
        };
        if is_shared {
            let (left, right) = rayon::join(|| left.grow(task), || right.grow(task));
            left.and(right)
        } else {
            left.grow(task)?;
            right.grow(task)
        }
    }
}

/// Brings the `count` slots with the lowest middles along the longest side of all to the front.
fn halve(slots: &mut [Slot], count: usize) {
    let middles = slots.iter().map(|slot| {
        let middle = [0, 1, 2].map(|axis| slot.bounds.doubled_middle(axis));
        (middle, middle)
    });
    let span = middles.reduce(|(low, high), (other, _)| {
        (
            [0, 1, 2].map(|axis| low[axis].min(other[axis])),
            [0, 1, 2].map(|axis| high[axis].max(other[axis])),
        )
    });
    let Some((low, high)) = span else { return };
    let side = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let axis = (0..3)
        .max_by(|a, b| side[*a].total_cmp(&side[*b]))
        .unwrap_or(0);
    slots.select_nth_unstable_by(count, |a, b| {
        let (u, v) = (a.bounds.doubled_middle(axis), b.bounds.doubled_middle(axis));
        u.total_cmp(&v).then(a.triangle.cmp(&b.triangle))
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of `count` triangles and one without area.
    fn strip(count: u32) -> TriangleMesh {
        let vertices = (0..count + 3).map(|i| [f64::from(i), f64::from(i % 2), 0.5]);
        let triangles = (0..count).map(|i| [i, i + 1, i + 2]).chain([[0, 2, 2]]);
        TriangleMesh::new(vertices.collect(), triangles.collect()).unwrap()
    }

    #[test]
    fn every_triangle_with_area_is_in_one_leaf_whose_boxes_hold_it() {
        for count in [0, 1, 7, 8, 9, 16, 17, 1000] {
            let mesh = strip(count);
            let tree = TriangleTree::new(&mesh, &Task::default()).unwrap();
            let mut met = vec![0; count as usize];
            for (number, node) in tree.nodes().iter().enumerate() {
                let slots = &tree.slots()[node.first as usize..node.end as usize];
                assert_eq!(node.bounds, Bounds::around(slots.iter().map(|s| &s.bounds)));
                if node.right == 0 {
                    assert!(slots.len() <= LEAF && !slots.is_empty());
                    for slot in slots {
                        met[slot.triangle as usize] += 1;
                    }
                } else {
                    let (left, right) =
                        (tree.nodes()[number + 1], tree.nodes()[node.right as usize]);
                    assert_eq!([left.first, right.end], [node.first, node.end]);
                    assert_eq!(left.end, right.first);
                }
            }
            assert!(met.iter().all(|times| *times == 1), "{count}: {met:?}");
        }
    }
}
