//! The first triangle on a ray.

use super::{Bounds, TriangleTree};
use crate::vector::{Vector, cross, dot, minus};

/// Part of a triangle's size by which it is taken for larger, so that a ray through a common corner or
/// edge does not slip between the neighbours by rounding.
const SLACK: f64 = 1e-9;

/// Where a ray begins: what is there is not looked at.
#[derive(Clone, Copy)]
pub(crate) enum Start {
    /// At a vertex, and so at its triangles.
    Vertex(u32),
    /// On a triangle, and so beside its neighbours: at a crease they would be very near.
    Triangle([u32; 3]),
    /// Anywhere: all triangles are looked at.
    Free,
}

impl Start {
    fn is_at(self, triangle: [u32; 3]) -> bool {
        match self {
            Self::Vertex(vertex) => triangle.contains(&vertex),
            Self::Free => false,
            Self::Triangle(own) => own.iter().any(|vertex| triangle.contains(vertex)),
        }
    }
}

/// A ray from the surface.
pub(crate) struct Ray {
    origin: Vector,
    direction: Vector,
    /// Length of the ray for a step along each axis; infinite for an axis it never moves along.
    per_axis: Vector,
    start: Start,
}

/// Where a ray meets a triangle.
pub(crate) struct Hit {
    pub(crate) distance_mm: f64,
    /// The triangle's number.
    pub(crate) triangle: u32,
}

impl Ray {
    /// `direction` has the length 1.
    pub(crate) fn new(origin: Vector, direction: Vector, start: Start) -> Self {
        Self {
            origin,
            direction,
            per_axis: direction.map(f64::recip),
            start,
        }
    }

    /// The length (mm) at which the ray enters a box, if that is before `end`.
    fn enters(&self, bounds: &Bounds, end: f64) -> Option<f64> {
        // What grazes the border or lies at the end must not be lost by rounding.
        const GRAZING: f64 = 1.0 + 1e-12;
        let (mut first, mut last) = (0.0_f64, end * GRAZING);
        for axis in 0..3 {
            let [low, high] = [bounds.low[axis], bounds.high[axis]].map(f64::from);
            let origin = self.origin[axis];
            if self.direction[axis] == 0.0 {
                if origin < low || origin > high {
                    return None;
                }
                continue;
            }
            let [low, high] = [low, high].map(|border| (border - origin) * self.per_axis[axis]);
            first = first.max(low.min(high));
            last = last.min(low.max(high) * GRAZING);
        }
        (first <= last).then_some(first)
    }

    /// The length (mm) at which the ray meets a triangle, borders included (Möller and Trumbore).
    fn meets(&self, [a, b, c]: [Vector; 3]) -> Option<f64> {
        let (ab, ac) = (minus(b, a), minus(c, a));
        let upright = cross(self.direction, ac);
        let determinant = dot(ab, upright);
        if determinant == 0.0 {
            return None;
        }
        let from_a = minus(self.origin, a);
        let u = dot(from_a, upright) / determinant;
        let across = cross(from_a, ab);
        let v = dot(self.direction, across) / determinant;
        let distance_mm = dot(ac, across) / determinant;
        let is_inside = u >= -SLACK && v >= -SLACK && u + v <= 1.0 + SLACK;
        (is_inside && distance_mm > 0.0).then_some(distance_mm)
    }
}

/// The nearest triangle on the ray before `end` (mm) that is not where the ray starts.
pub(crate) fn first_hit(tree: &TriangleTree<'_>, ray: &Ray, end: f64) -> Option<Hit> {
    let nodes = tree.nodes();
    let mut nearest: Option<Hit> = None;
    let mut end = end;
    // A balanced tree of at most 2^32 leaves is less than 64 deep.
    let mut stack = [(0_u32, 0.0); 64];
    let mut height = 0;
    if let Some(root) = nodes.first()
        && let Some(from) = ray.enters(&root.bounds, end)
    {
        stack[0] = (0, from);
        height = 1;
    }
    while height > 0 {
        height -= 1;
        let (number, from) = stack[height];
        if from > end {
            continue;
        }
        let node = &nodes[number as usize];
        if node.right == 0 {
            for slot in &tree.slots()[node.first as usize..node.end as usize] {
                let triangle = tree.mesh().triangles()[slot.triangle as usize];
                if ray.start.is_at(triangle) || ray.enters(&slot.bounds, end).is_none() {
                    continue;
                }
                if let Some(distance_mm) = ray.meets(tree.mesh().corners_mm(triangle))
                    && distance_mm < end
                {
                    end = distance_mm;
                    nearest = Some(Hit {
                        distance_mm,
                        triangle: slot.triangle,
                    });
                }
            }
            continue;
        }
        let mut children = [number + 1, node.right]
            .map(|child| (child, ray.enters(&nodes[child as usize].bounds, end)));
        // The nearer child goes on top of the stack.
        if children[0].1 < children[1].1 {
            children.swap(0, 1);
        }
        for (child, from) in children {
            if let Some(from) = from {
                stack[height] = (child, from);
                height += 1;
            }
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use bonemesh_task::Task;
    use proptest::prelude::*;

    use super::*;
    use crate::TriangleMesh;
    use crate::vector::unit;

    proptest! {
        #[test]
        fn the_tree_gives_what_trying_all_triangles_gives(
            corners in prop::collection::vec([-9_i32..9, -9_i32..9, -9_i32..9], 3..300),
            aims in prop::collection::vec([-9_i32..9, -9_i32..9, -9_i32..9], 20),
            end in prop::sample::select(vec![f64::INFINITY, 6.0]),
        ) {
            let vertices: Vec<Vector> = corners.iter().map(|v| v.map(f64::from)).collect();
            let triangles = (0..vertices.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
            let mesh = TriangleMesh::new(vertices, triangles.collect()).unwrap();
            let tree = TriangleTree::new(&mesh, &Task::default()).unwrap();
            let directions = aims.iter().filter_map(|aim| unit(aim.map(f64::from)));
            for (vertex, direction) in (0..).zip(directions).take(corners.len()) {
                let ray = Ray::new(mesh.vertices_mm()[vertex as usize], direction, Start::Vertex(vertex));
                let others = mesh.triangles().iter().filter(|t| !t.contains(&vertex));
                let lengths = others.filter_map(|t| ray.meets(mesh.corners_mm(*t)));
                let least = lengths.fold(end, f64::min);
                let found = first_hit(&tree, &ray, end).map_or(end, |hit| hit.distance_mm);
                prop_assert_eq!(found.to_bits(), least.to_bits());
            }
        }
    }
}
