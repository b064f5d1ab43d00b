//! The nearest place on a surface.

use super::{Bounds, LEAF, Node, Ray, Start, TriangleTree, first_hit};
use crate::exact::Corners;
use crate::vector::{Vector, dot, minus, plus_scaled};

/// The place of a surface that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The triangle it lies on.
    pub triangle: u32,
    /// The place.
    pub place_mm: [f64; 3],
    /// Weights of the triangle's corners that make the place; those of corners that have no part in it
    /// are exactly 0.
    pub weights: [f64; 3],
    /// The squared distance (mm2) from the point.
    pub squared_mm2: f64,
}

impl TriangleTree<'_> {
    /// The place nearest to `point_mm`, if it is within `within_mm`.
    ///
    /// Of equally near places on several triangles, such as those of a common edge, one is given.
    pub fn nearest(&self, point_mm: [f64; 3], within_mm: f64) -> Option<Nearest> {
        let nodes = self.nodes();
        let mut found: Option<Nearest> = None;
        let mut limit = within_mm * within_mm;
        // A balanced tree of at most 2^32 leaves is less than 64 deep.
        let mut stack = [(0_u32, 0.0); 64];
        let mut height = usize::from(!nodes.is_empty());
        while height > 0 {
            height -= 1;
            let (number, least) = stack[height];
            if least > limit {
                continue;
            }
            let node = &nodes[number as usize];
            if node.right == 0 {
                if self.leaf_is_farther(node, point_mm, limit) {
                    continue;
                }
                for number in node.first as usize..node.end as usize {
                    let slot = &self.slots()[number];
                    if self.slot_is_farther(number, point_mm, limit) {
                        continue;
                    }
                    let corners = self.corners_mm(slot);
                    let weights = nearest_weights(point_mm, corners);
                    let place_mm = weighted(weights, corners);
                    let away = minus(point_mm, place_mm);
                    let squared_mm2 = dot(away, away);
                    if squared_mm2 <= limit {
                        limit = squared_mm2;
                        found = Some(Nearest {
                            triangle: slot.triangle,
                            place_mm,
                            weights,
                            squared_mm2,
                        });
                    }
                }
                continue;
            }
            let mut children = [number + 1, node.right].map(|child| {
                let bounds = &nodes[child as usize].bounds;
                (child, squared_to_box(point_mm, bounds))
            });
            // The nearer child goes on top of the stack.
            if children[0].1 < children[1].1 {
                children.swap(0, 1);
            }
            for child in children.into_iter().filter(|child| child.1 <= limit) {
                stack[height] = child;
                height += 1;
            }
        }
        found
    }
}

impl TriangleTree<'_> {
    /// Whether all triangles of a leaf are surely farther from a place than the root of `limit` (mm2).
    fn leaf_is_farther(&self, leaf: &Node, place: Vector, limit: f64) -> bool {
        self.cylinders.as_ref().is_some_and(|cylinders| {
            cylinders.of_leaves[leaf.first as usize / LEAF].squared_at_least(place) > limit
        })
    }

    /// Whether the triangle of a slot is surely farther.
    fn slot_is_farther(&self, number: usize, place: Vector, limit: f64) -> bool {
        match &self.cylinders {
            Some(cylinders) => cylinders.of_slots[number].squared_at_least(place) > limit,
            None => squared_to_box(place, &self.slots[number].bounds) > limit,
        }
    }

    /// The first triangle that the ray from a place in a direction of length 1 meets before `within_mm`,
    /// and how far (mm) away.
    pub fn first_hit(
        &self,
        from_mm: [f64; 3],
        direction: [f64; 3],
        within_mm: f64,
    ) -> Option<(f64, u32)> {
        let ray = Ray::new(from_mm, direction, Start::Free);
        first_hit(self, &ray, within_mm).map(|hit| (hit.distance_mm, hit.triangle))
    }
}

/// The squared distance (mm2) from a point to a box.
fn squared_to_box(point: Vector, bounds: &Bounds) -> f64 {
    (0..3)
        .map(|axis| {
            let [low, high] = [bounds.low[axis], bounds.high[axis]].map(f64::from);
            let out = (low - point[axis]).max(point[axis] - high).max(0.0);
            out * out
        })
        .sum()
}

fn weighted(weights: [f64; 3], corners: Corners) -> Vector {
    [0, 1, 2].map(|axis| (0..3).map(|i| weights[i] * corners[i][axis]).sum())
}

/// The weights of the corners that make the place of a triangle nearest to a point: inside it, or on
/// the nearest of its edges.
fn nearest_weights(point: Vector, corners: Corners) -> [f64; 3] {
    let [a, b, c] = corners;
    let (ab, ac, ap) = (minus(b, a), minus(c, a), minus(point, a));
    let (bb, bc, cc) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
    let (pb, pc) = (dot(ap, ab), dot(ap, ac));
    let determinant = bb * cc - bc * bc;
    let v = (cc * pb - bc * pc) / determinant;
    let w = (bb * pc - bc * pb) / determinant;
    // No number where the triangle has no area; then one of its edges is nearest.
    if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
        return [1.0 - v - w, v, w];
    }
    let on_edge = |from: usize| {
        let to = (from + 1) % 3;
        let along = minus(corners[to], corners[from]);
        let length = dot(along, along);
        let part = if length > 0.0 {
            (dot(minus(point, corners[from]), along) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let mut weights = [0.0; 3];
        weights[from] = 1.0 - part;
        weights[to] = part;
        let away = minus(point, plus_scaled(corners[from], part, along));
        (dot(away, away), weights)
    };
    let edges = [0, 1, 2].map(on_edge);
    let nearest = edges.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map_or([1.0, 0.0, 0.0], |(_, weights)| weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TriangleMesh;
    use crate::distance::squared_distance;
    use bonemesh_task::Task;

    fn bumpy() -> TriangleMesh {
        let side = 20_u32;
        let vertices = (0..side * side).map(|v| {
            let [x, y] = [v % side, v / side].map(f64::from);
            [x, y, (x * 1.3).sin() + (y * 0.7 + x).cos()]
        });
        let triangles = (0..(side - 1) * (side - 1)).flat_map(|cell| {
            let corner = cell / (side - 1) * side + cell % (side - 1);
            let [a, b, c, d] = [corner, corner + 1, corner + side, corner + side + 1];
            [[a, b, d], [a, d, c]]
        });
        TriangleMesh::new(vertices.collect(), triangles.collect()).expect("numbers are in range")
    }

    #[test]
    fn the_nearest_place_is_as_near_as_trying_all_triangles_says() {
        let mesh = bumpy();
        let tree = TriangleTree::new(&mesh, &Task::default()).expect("nobody cancels");
        let far = TriangleTree::new(&mesh, &Task::default()).expect("nobody cancels");
        let far = far.for_far_places();
        for i in 0..2000 {
            let point = [7, 11, 13].map(|step| f64::from(i * step % 260) / 10.0 - 3.0);
            let all = mesh.triangles().iter();
            let least = all.map(|t| squared_distance(point, mesh.corners_mm(*t)));
            let least = least.fold(f64::INFINITY, f64::min);
            let found = tree.nearest(point, 100.0).expect("it is within reach");
            assert!((found.squared_mm2 - least).abs() < 1e-9 * (1.0 + least));
            let corners = mesh.corners_mm(mesh.triangles()[found.triangle as usize]);
            let place = weighted(found.weights, corners);
            assert_eq!(place.map(f64::to_bits), found.place_mm.map(f64::to_bits));
            assert!((found.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let within = least.sqrt();
            assert!(tree.nearest(point, within * 1.001 + 1e-9).is_some());
            assert_eq!(tree.nearest(point, within * 0.999), None);
            assert_eq!(far.nearest(point, 100.0), Some(found));
            assert_eq!(far.nearest(point, within * 0.999), None);
        }
    }

    #[test]
    fn nothing_is_near_an_empty_surface() {
        let mesh = TriangleMesh::default();
        let tree = TriangleTree::new(&mesh, &Task::default()).expect("nobody cancels");
        assert_eq!(tree.nearest([0.0; 3], 1e9), None);
    }
}
