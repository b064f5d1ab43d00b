//! Is all of a triangle within a distance of a surface?

use super::squared_distance;
use crate::tree::{Bounds, TriangleTree};
use crate::vector::Vector;

/// Halvings after which a piece that is not proven near counts as far.
const MOST_HALVINGS: u32 = 6;

/// Asks one surface; kept from question to question to save allocations.
pub(crate) struct Near<'a> {
    tree: &'a TriangleTree<'a>,
    distance_mm: f64,
    /// Corners of the surface's triangles that may be near enough.
    nearby: Vec<[Vector; 3]>,
    stack: Vec<u32>,
}

impl<'a> Near<'a> {
    pub(crate) fn new(tree: &'a TriangleTree<'a>, distance_mm: f64) -> Self {
        Self {
            tree,
            distance_mm,
            nearby: Vec::new(),
            stack: Vec::new(),
        }
    }

    /// Whether a point is within the distance.
    pub(crate) fn holds_point(&mut self, point: Vector) -> bool {
        self.look_around(&[point]);
        let limit = self.distance_mm * self.distance_mm;
        let mut nearby = self.nearby.iter();
        nearby.any(|&corners| squared_distance(point, corners) <= limit)
    }

    /// Whether all points of a triangle are within the distance; a no may be wrong by a hair.
    ///
    /// The distance to one triangle is convex, so a piece whose corners are all near the same one is
    /// near it as a whole; a piece that lies over several is cut into four.
    pub(crate) fn holds_triangle(&mut self, corners: [Vector; 3]) -> bool {
        self.look_around(&corners);
        let limit = self.distance_mm * self.distance_mm;
        is_covered(&self.nearby, corners, limit, MOST_HALVINGS)
    }

    /// Finds the triangles whose boxes come within the distance of the points' box.
    fn look_around(&mut self, points: &[Vector]) {
        self.nearby.clear();
        let grown = points.iter().flat_map(|point| {
            [-self.distance_mm, self.distance_mm].map(|by| point.map(|value| value + by))
        });
        let grown: Vec<Vector> = grown.collect();
        let bounds = Bounds::of(&grown);
        self.stack.clear();
        if !self.tree.nodes().is_empty() {
            self.stack.push(0);
        }
        while let Some(number) = self.stack.pop() {
            let node = &self.tree.nodes()[number as usize];
            if !node.bounds.touches(&bounds) {
                continue;
            }
            if node.right != 0 {
                self.stack.extend([node.right, number + 1]);
                continue;
            }
            let slots = &self.tree.slots()[node.first as usize..node.end as usize];
            let touching = slots.iter().filter(|slot| slot.bounds.touches(&bounds));
            let tree = self.tree;
            self.nearby
                .extend(touching.map(|slot| tree.corners_mm(slot)));
        }
    }
}

/// Whether pieces of the triangle, each near one of `nearby`, make up all of it.
fn is_covered(nearby: &[[Vector; 3]], corners: [Vector; 3], limit: f64, halvings: u32) -> bool {
    let is_near = |other: &[Vector; 3]| {
        corners
            .iter()
            .all(|&corner| squared_distance(corner, *other) <= limit)
    };
    if nearby.iter().any(is_near) {
        return true;
    }
    let is_lost = |&corner: &Vector| {
        let mut nearby = nearby.iter();
        !nearby.any(|other| squared_distance(corner, *other) <= limit)
    };
    if halvings == 0 || corners.iter().any(is_lost) {
        return false;
    }
    let [a, b, c] = corners;
    let middle = |p: Vector, q: Vector| [0, 1, 2].map(|axis| f64::midpoint(p[axis], q[axis]));
    let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        .into_iter()
        .all(|piece| is_covered(nearby, piece, limit, halvings - 1))
}

#[cfg(test)]
mod tests {
    use bonemesh_task::Task;

    use super::*;
    use crate::TriangleMesh;

    #[test]
    fn a_triangle_over_two_others_is_near_and_one_over_their_gap_is_not() {
        let square = |x: f64| {
            [
                [x, 0.0, 0.0],
                [x + 1.0, 0.0, 0.0],
                [x + 1.0, 1.0, 0.0],
                [x, 1.0, 0.0],
            ]
        };
        let over = [[0.1, 0.2, 0.1], [1.9, 0.2, 0.1], [1.0, 0.8, 0.1]];
        for (gap, wanted) in [(0.0, true), (0.5, false)] {
            let vertices = [square(0.0), square(1.0 + gap)].concat();
            let triangles = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
            let mesh = TriangleMesh::new(vertices, triangles).unwrap();
            let tree = TriangleTree::new(&mesh, &Task::default()).unwrap();
            assert_eq!(Near::new(&tree, 0.11).holds_triangle(over), wanted);
            assert!(!Near::new(&tree, 0.09).holds_triangle(over));
            assert!(Near::new(&tree, 0.11).holds_point(over[0]));
            assert!(!Near::new(&tree, 0.09).holds_point(over[0]));
        }
    }
}
