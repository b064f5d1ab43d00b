//! Is all of a triangle within a distance of a surface?

use super::squared_distance;
use crate::tree::{Bounds, TriangleTree};
use crate::vector::{Vector, cross, dot, minus, plus_scaled};

/// Cuts after which a triangle that is not proven near counts as far.
const MOST_CUTS: u32 = 1000;

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
        let limit = self.distance_mm * self.distance_mm;
        self.look_around(&[point], |other| squared_distance(point, *other) <= limit)
    }

    /// Whether all points of a triangle are within the distance; a no may be wrong by a hair.
    ///
    /// The distance to one triangle is convex, so a piece whose corners are all near the same one is
    /// near it as a whole; a piece that lies over several is cut at their borders.
    pub(crate) fn holds_triangle(&mut self, corners: [Vector; 3]) -> bool {
        let limit = self.distance_mm * self.distance_mm;
        let is_near = |other: &[Vector; 3]| {
            corners
                .iter()
                .all(|&corner| squared_distance(corner, *other) <= limit)
        };
        if self.look_around(&corners, is_near) {
            return true;
        }
        let mut cuts = MOST_CUTS;
        is_covered(
            &self.nearby,
            self.nearby.clone(),
            corners.to_vec(),
            limit,
            &mut cuts,
        )
    }

    /// Whether the box of any triangle comes within the distance of the points' box.
    pub(crate) fn reaches(&mut self, points: &[Vector]) -> bool {
        self.look_around(points, |_| true)
    }

    /// Finds the triangles whose boxes come within the distance of the points' box, until one is
    /// `enough`; says whether one was.
    fn look_around(&mut self, points: &[Vector], enough: impl Fn(&[Vector; 3]) -> bool) -> bool {
        self.nearby.clear();
        let extreme = |axis: usize, pick: fn(f64, f64) -> f64, by: f64| {
            let values = points.iter().map(|point| point[axis]);
            values.reduce(pick).map_or(by, |value| value + by)
        };
        let bounds = Bounds::of(&[
            [0, 1, 2].map(|axis| extreme(axis, f64::min, -self.distance_mm)),
            [0, 1, 2].map(|axis| extreme(axis, f64::max, self.distance_mm)),
        ]);
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
            for slot in slots.iter().filter(|slot| slot.bounds.touches(&bounds)) {
                let corners = self.tree.corners_mm(slot);
                if enough(&corners) {
                    return true;
                }
                self.nearby.push(corners);
            }
        }
        false
    }
}

/// Whether pieces of `piece`, each near one of `all`, make up the whole of it.
///
/// What lies above or below the nearest triangle of `rest` is near it or not; what lies beside it is
/// for the others to cover. Each cut takes one triangle off `rest`, so it comes to an end.
fn is_covered(
    all: &[[Vector; 3]],
    mut rest: Vec<[Vector; 3]>,
    piece: Vec<Vector>,
    limit: f64,
    cuts: &mut u32,
) -> bool {
    let holds = |other: &[Vector; 3], piece: &[Vector]| {
        piece
            .iter()
            .all(|&corner| squared_distance(corner, *other) <= limit)
    };
    if all.iter().any(|other| holds(other, &piece)) {
        return true;
    }
    let centre = [0, 1, 2]
        .map(|axis| piece.iter().map(|corner| corner[axis]).sum::<f64>() / piece.len() as f64);
    let distances = rest
        .iter()
        .map(|other| squared_distance(centre, *other))
        .enumerate();
    let Some((nearest, _)) = distances.min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return false;
    };
    if *cuts == 0 {
        return false;
    }
    *cuts -= 1;
    let nearest = rest.swap_remove(nearest);
    let [a, b, c] = nearest;
    let normal = cross(minus(b, a), minus(c, a));
    let mut within = piece;
    for (from, to) in [(a, b), (b, c), (c, a)] {
        let outward = cross(minus(to, from), normal);
        let height = |place: Vector| dot(minus(place, from), outward);
        let beside = part_above(&within, height);
        within = part_above(&within, |place| -height(place));
        if beside.len() > 2 && !is_covered(all, rest.clone(), beside, limit, cuts) {
            return false;
        }
    }
    within.len() < 3 || all.iter().any(|other| holds(other, &within))
}

/// The part of a convex piece where a linear function is not below 0.
fn part_above(piece: &[Vector], height: impl Fn(Vector) -> f64) -> Vec<Vector> {
    let mut part = Vec::with_capacity(piece.len() + 1);
    for (number, &corner) in piece.iter().enumerate() {
        let next = piece[(number + 1) % piece.len()];
        let (here, there) = (height(corner), height(next));
        if here >= 0.0 {
            part.push(corner);
        }
        if here < 0.0 && there > 0.0 || here > 0.0 && there < 0.0 {
            part.push(plus_scaled(
                corner,
                here / (here - there),
                minus(next, corner),
            ));
        }
    }
    part
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
