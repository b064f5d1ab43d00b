//! The part of a mesh that a cut can touch, closed again.
//!
//! 1. [`Neighbourhood::around`]: the triangles whose boxes touch a box, with their own numbers for vertices;
//!    open where the box ends.
//! 2. [`Part::of`]: what lies in a box, cut off at its sides, one after the other (`cut_off`), and closed
//!    there. First the two sides along the axis on which the box is the smallest part of the mesh, so
//!    that little is left for the others.
//!
//! The lids are fans over the rims, which may overlap in their plane. That is enough: they lie outside
//! of all that is cut, and what lies inside of a closed surface depends on its rims alone.

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::space::Space;
use bonemesh_mesh::vector::{Vector, cross, length, minus, plus_scaled};

/// Triangles looked at between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// A part of a mesh.
#[derive(Clone)]
pub(crate) struct Neighbourhood {
    pub(crate) vertices_mm: Vec<Vector>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The number of each vertex in the whole mesh.
    pub(crate) of_mesh: Vec<u32>,
}

impl Neighbourhood {
    /// The triangles of `mesh` whose boxes touch `space`, in their order.
    pub(crate) fn around(
        mesh: &TriangleMesh,
        space: &Space,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let near = mesh
            .triangles()
            .par_chunks(STRIDE)
            .map(|triangles| {
                task.check()?;
                let is_near = |t: &&[u32; 3]| space.touches(mesh.corners_mm(**t));
                Ok(triangles.iter().filter(is_near).copied().collect())
            })
            .collect::<Result<Vec<Vec<[u32; 3]>>, Cancelled>>()?
            .concat();
        let (triangles, of_mesh) = numbered(mesh.vertices_mm().len(), near);
        let place = |vertex: &u32| mesh.vertices_mm()[*vertex as usize];
        Ok(Self {
            vertices_mm: of_mesh.iter().map(place).collect(),
            triangles,
            of_mesh,
        })
    }

    /// Some of its triangles, in the order given, and the numbers that their vertices had.
    pub(super) fn part(&self, triangles: impl Iterator<Item = u32>) -> (Self, Vec<u32>) {
        let corners = triangles.map(|t| self.triangles[t as usize]);
        let (triangles, members) = numbered(self.vertices_mm.len(), corners);
        let each = || members.iter().map(|v| *v as usize);
        let part = Self {
            triangles,
            vertices_mm: each().map(|v| self.vertices_mm[v]).collect(),
            of_mesh: each().map(|v| self.of_mesh[v]).collect(),
        };
        (part, members)
    }

    /// The box of some of its triangles; `None` of no triangles.
    pub(super) fn space(&self, triangles: impl Iterator<Item = u32>) -> Option<Space> {
        let corners = triangles.flat_map(|t| self.triangles[t as usize]);
        Space::of(corners.map(|v| self.vertices_mm[v as usize]))
    }

    /// Twice the area of a triangle in the direction that it faces.
    pub(crate) fn facing(&self, triangle: [u32; 3]) -> Vector {
        let [a, b, c] = triangle.map(|v| self.vertices_mm[v as usize]);
        cross(minus(b, a), minus(c, a))
    }

    /// The area of the triangle of that number.
    pub(super) fn area_mm2(&self, triangle: u32) -> f64 {
        0.5 * length(self.facing(self.triangles[triangle as usize]))
    }

    /// The middle (mm) of the triangle of that number.
    pub(super) fn middle(&self, triangle: u32) -> Vector {
        let [a, b, c] = self.triangles[triangle as usize].map(|v| self.vertices_mm[v as usize]);
        [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0)
    }
}

/// Triangles with new numbers for their vertices, from 0 in the order in which they come, and the old number of
/// each. `vertices`: how many there were.
pub(super) fn numbered(
    vertices: usize,
    triangles: impl IntoIterator<Item = [u32; 3]>,
) -> (Vec<[u32; 3]>, Vec<u32>) {
    let mut numbers = vec![u32::MAX; vertices];
    let mut members = Vec::new();
    let mut number = |vertex: u32| {
        let number = &mut numbers[vertex as usize];
        if *number == u32::MAX {
            *number = members.len() as u32;
            members.push(vertex);
        }
        *number
    };
    let triangles = triangles.into_iter().map(|t| t.map(&mut number)).collect();
    (triangles, members)
}

/// A part of a body, closed.
pub(super) struct Part {
    pub(super) vertices_mm: Vec<Vector>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The number of each vertex in the whole mesh; the others were made by cutting.
    pub(super) of_mesh: Vec<Option<u32>>,
}

impl Part {
    /// What of the closed `mesh` lies in `space`.
    pub(super) fn of(mesh: &TriangleMesh, space: &Space, task: &Task) -> Result<Self, Cancelled> {
        let first = space.narrowest(mesh);
        let Neighbourhood {
            mut vertices_mm,
            mut triangles,
            of_mesh,
        } = Neighbourhood::around(mesh, &space.along(first), task)?;
        for axis in [first, (first + 1) % 3, (first + 2) % 3] {
            for side in [
                Side::above(axis, space.low[axis]),
                Side::below(axis, space.high[axis]),
            ] {
                task.check()?;
                triangles = cut_off(&mut vertices_mm, &triangles, side);
            }
        }
        let (triangles, used) = numbered(vertices_mm.len(), triangles);
        Ok(Self {
            triangles,
            vertices_mm: used.iter().map(|v| vertices_mm[*v as usize]).collect(),
            of_mesh: used
                .iter()
                .map(|v| of_mesh.get(*v as usize).copied())
                .collect(),
        })
    }

    /// Which of its triangles are these of the whole mesh, uncut.
    pub(super) fn is_of(&self, triangles: &FxHashSet<[u32; 3]>) -> Vec<bool> {
        let whole = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| self.of_mesh[v as usize]);
            Some([a?, b?, c?])
        };
        let own = self.triangles.iter().map(whole);
        own.map(|t| t.is_some_and(|t| triangles.contains(&t)))
            .collect()
    }
}

/// The side of a plane that is kept.
#[derive(Clone, Copy)]
struct Side {
    axis: usize,
    at_mm: f64,
    is_above: bool,
}

impl Side {
    fn above(axis: usize, at_mm: f64) -> Self {
        Self {
            axis,
            at_mm,
            is_above: true,
        }
    }

    fn below(axis: usize, at_mm: f64) -> Self {
        Self {
            axis,
            at_mm,
            is_above: false,
        }
    }

    /// Whether a place is kept; in the plane it is not.
    fn keeps(self, place: Vector) -> bool {
        let value = place[self.axis];
        if self.is_above {
            value > self.at_mm
        } else {
            value < self.at_mm
        }
    }
}

/// The triangles on one side of a plane, closed in it.
fn cut_off(vertices_mm: &mut Vec<Vector>, triangles: &[[u32; 3]], side: Side) -> Vec<[u32; 3]> {
    let is_kept: Vec<bool> = vertices_mm.iter().map(|v| side.keeps(*v)).collect();
    let mut cuts: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    let mut cut = |vertices_mm: &mut Vec<Vector>, from: u32, to: u32| {
        let edge = [from.min(to), from.max(to)];
        *cuts.entry(edge).or_insert_with(|| {
            let [a, b] = edge.map(|v| vertices_mm[v as usize]);
            let part = (side.at_mm - a[side.axis]) / (b[side.axis] - a[side.axis]);
            let mut place = plus_scaled(a, part, minus(b, a));
            place[side.axis] = side.at_mm;
            vertices_mm.push(place);
            vertices_mm.len() as u32 - 1
        })
    };
    let mut left = Vec::with_capacity(triangles.len());
    // From where to where the lids' rims run.
    let mut rims: Vec<[u32; 2]> = Vec::new();
    for triangle in triangles {
        let kept = triangle.map(|v| is_kept[v as usize]);
        let count = kept.iter().filter(|kept| **kept).count();
        if count == 3 {
            left.push(*triangle);
        }
        let (1 | 2, Some(single)) = (count, kept.iter().position(|k| *k == (count == 1))) else {
            continue;
        };
        // The corner that is alone on its side, and the others after it.
        let [alone, next, last] = [0, 1, 2].map(|turn| triangle[(single + turn) % 3]);
        let first_cut = cut(vertices_mm, alone, next);
        let second_cut = cut(vertices_mm, alone, last);
        if count == 1 {
            left.push([alone, first_cut, second_cut]);
            rims.push([second_cut, first_cut]);
        } else {
            left.push([first_cut, next, last]);
            left.push([first_cut, last, second_cut]);
            rims.push([first_cut, second_cut]);
        }
    }
    close(&rims, &mut left);
    left
}

/// Adds fans over closed rims.
///
/// As many rims end at a vertex as begin there, since the surface was closed; so whoever goes on comes
/// back to where they began.
fn close(rims: &[[u32; 2]], triangles: &mut Vec<[u32; 3]>) {
    let mut after: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
    for [from, to] in rims {
        after.entry(*from).or_default().push(*to);
    }
    for [first, _] in rims {
        let mut next_of = |vertex: u32| after.get_mut(&vertex).and_then(Vec::pop);
        let Some(mut last) = next_of(*first) else {
            continue;
        };
        while let Some(next) = next_of(last) {
            if next == *first {
                break;
            }
            triangles.push([*first, last, next]);
            last = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bonemesh_mesh::check_topology;

    /// A ball around the origin.
    fn ball(radius: f64) -> TriangleMesh {
        let (around, up) = (24_u32, 12_u32);
        let mut vertices = vec![[0.0, 0.0, radius], [0.0, 0.0, -radius]];
        for ring in 1..up {
            for step in 0..around {
                let [tilt, turn] = [
                    std::f64::consts::PI * f64::from(ring) / f64::from(up),
                    std::f64::consts::TAU * f64::from(step) / f64::from(around),
                ];
                vertices.push([
                    radius * tilt.sin() * turn.cos(),
                    radius * tilt.sin() * turn.sin(),
                    radius * tilt.cos(),
                ]);
            }
        }
        let at = |ring: u32, step: u32| 2 + (ring - 1) * around + step % around;
        let mut triangles = Vec::new();
        for step in 0..around {
            triangles.push([0, at(1, step), at(1, step + 1)]);
            triangles.push([1, at(up - 1, step + 1), at(up - 1, step)]);
            for ring in 1..up - 1 {
                let [a, b] = [at(ring, step), at(ring, step + 1)];
                let [c, d] = [at(ring + 1, step), at(ring + 1, step + 1)];
                triangles.push([a, c, d]);
                triangles.push([a, d, b]);
            }
        }
        TriangleMesh::new(vertices, triangles).unwrap()
    }

    #[test]
    fn a_part_of_a_ball_is_closed_and_has_the_volume_of_the_part() {
        let task = Task::default();
        let ball = ball(10.0);
        let whole = check_topology(&ball, &task).unwrap().volume_mm3;
        for (low, high, share) in [
            ([-20.0; 3], [20.0; 3], 1.0),
            ([0.0, -20.0, -20.0], [20.0; 3], 0.5),
            ([0.0, 0.0, -20.0], [20.0; 3], 0.25),
            ([0.0; 3], [20.0; 3], 0.125),
        ] {
            let space = Space { low, high };
            let part = Part::of(&ball, &space, &task).unwrap();
            let closed = TriangleMesh::new(part.vertices_mm, part.triangles).unwrap();
            let topology = check_topology(&closed, &task).unwrap();
            assert!(topology.watertight, "{topology:?}");
            let expected = share * whole;
            assert!((topology.volume_mm3 - expected).abs() < 1e-6 * whole);
        }
    }
}
