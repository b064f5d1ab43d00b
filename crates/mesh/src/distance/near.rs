//! Is all of a triangle within a distance of a surface?

use super::{is_within, squared_distance};
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
        self.look_around(&[point], |other| is_within(point, *other, limit))
    }

    /// Whether all points of a triangle are within the distance; a no may be wrong by a hair.
    pub(crate) fn holds_triangle(&mut self, corners: [Vector; 3]) -> bool {
        let limit = self.distance_mm * self.distance_mm;
        let piece = Piece::of(corners);
        let is_whole = |other: &[Vector; 3]| piece.is_near(other, limit);
        self.look_around(&corners, is_whole) || is_near(corners, &self.nearby, self.distance_mm)
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

/// Whether all points of a triangle are this near some `others`; a no may be wrong by a hair.
pub(crate) fn is_near(corners: [Vector; 3], others: &[[Vector; 3]], distance_mm: f64) -> bool {
    let limit = distance_mm * distance_mm;
    let piece = Piece::of(corners);
    if others.iter().any(|o| piece.is_near(o, limit)) {
        return true;
    }
    // No point of the triangle is near what is further from its centre than this.
    let centre = piece.centre();
    let away = corners.map(|corner| minus(corner, centre));
    let radius = away
        .map(|a| dot(a, a))
        .into_iter()
        .fold(0.0, f64::max)
        .sqrt();
    let reach = radius + distance_mm;
    let reachable = others
        .iter()
        .filter(|o| is_within(centre, **o, reach * reach));
    let mut reachable: Vec<[Vector; 3]> = reachable.copied().collect();
    reachable.sort_by_cached_key(|o| squared_distance(centre, *o).to_bits());
    let mut covering = Covering {
        all: &reachable,
        limit,
        cuts: MOST_CUTS,
    };
    covering.is_whole(&piece, &reachable)
}

/// Triangles that are to be near a whole piece.
///
/// The distance to one triangle is convex, so a piece whose corners are all near the same one is near
/// it as a whole; a piece that lies over several is cut at their borders.
struct Covering<'a> {
    all: &'a [[Vector; 3]],
    limit: f64,
    /// How many cuts are left.
    cuts: u32,
}

impl Covering<'_> {
    /// Whether parts of `piece`, each near one of all, make up the whole of it.
    ///
    /// What lies above or below the first of `rest` is near one of all or not; what lies beside it is
    /// cut by the others. Each cut takes one triangle off `rest`, so it comes to an end.
    fn is_whole(&mut self, piece: &Piece, rest: &[[Vector; 3]]) -> bool {
        if self
            .all
            .iter()
            .any(|other| piece.is_near(other, self.limit))
        {
            return true;
        }
        let Some((&[a, b, c], rest)) = rest.split_first() else {
            return false;
        };
        if self.cuts == 0 {
            return false;
        }
        self.cuts -= 1;
        let normal = cross(minus(b, a), minus(c, a));
        let mut within = *piece;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let outward = cross(minus(to, from), normal);
            let height = |place: Vector| dot(minus(place, from), outward);
            let (Some(beside), Some(below)) = (
                within.part_above(height),
                within.part_above(|place| -height(place)),
            ) else {
                return false;
            };
            if beside.count > 2 && !self.is_whole(&beside, rest) {
                return false;
            }
            within = below;
        }
        within.count < 3
            || self
                .all
                .iter()
                .any(|other| within.is_near(other, self.limit))
    }
}

/// Most corners of a piece; one with more counts as far.
const MOST_CORNERS: usize = 12;

/// A convex part of a triangle.
#[derive(Clone, Copy)]
struct Piece {
    corners: [Vector; MOST_CORNERS],
    count: usize,
}

impl Piece {
    fn of(triangle: [Vector; 3]) -> Self {
        let mut corners = [[0.0; 3]; MOST_CORNERS];
        corners[..3].copy_from_slice(&triangle);
        Self { corners, count: 3 }
    }

    fn corners(&self) -> &[Vector] {
        &self.corners[..self.count]
    }

    /// Whether all corners are this near (squared) a triangle.
    fn is_near(&self, triangle: &[Vector; 3], limit: f64) -> bool {
        self.corners()
            .iter()
            .all(|&corner| is_within(corner, *triangle, limit))
    }

    fn centre(&self) -> Vector {
        let sum = |axis: usize| self.corners().iter().map(|c| c[axis]).sum::<f64>();
        [0, 1, 2].map(|axis| sum(axis) / self.count as f64)
    }

    /// The part where a linear function is not below 0; `None` if it has too many corners.
    fn part_above(&self, height: impl Fn(Vector) -> f64) -> Option<Self> {
        let mut part = Self {
            corners: [[0.0; 3]; MOST_CORNERS],
            count: 0,
        };
        let mut add = |corner: Vector| {
            *part.corners.get_mut(part.count)? = corner;
            part.count += 1;
            Some(())
        };
        for (number, &corner) in self.corners().iter().enumerate() {
            let next = self.corners[(number + 1) % self.count];
            let (here, there) = (height(corner), height(next));
            if here >= 0.0 {
                add(corner)?;
            }
            if here < 0.0 && there > 0.0 || here > 0.0 && there < 0.0 {
                let way = here / (here - there);
                add(plus_scaled(corner, way, minus(next, corner)))?;
            }
        }
        Some(part)
    }
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
