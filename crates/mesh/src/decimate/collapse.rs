//! May this edge collapse to that place?

use crate::exact::has_area;
use crate::stars::{MOST, Stars};
use crate::vector::{Vector, cross, dot, minus};

/// Least cosine between a triangle's normals before and after.
const LEAST_TURN: f64 = 0.5;
/// Least cosine between the normals of neighbours after the collapse: no ridge like a knife.
const LEAST_FOLD: f64 = -0.5;
/// Least shape of a triangle: doubled area by longest edge squared, 0.87 if all edges are equal.
const LEAST_SHAPE: f64 = 0.05;
/// Most triangles at the vertex that a collapse leaves.
const MOST_AROUND: usize = 16;

/// What is looked at around an edge; kept from edge to edge to save allocations.
#[derive(Default)]
pub(super) struct Surroundings {
    /// Triangles at the end that stays, then at the end that goes, each with that end first.
    ends: [Vec<[u32; 3]>; 2],
    /// Normals (not of length 1) after the collapse, with the other vertices of the triangle.
    fans: Vec<([u32; 2], Vector)>,
}

impl Surroundings {
    /// Looks up what meets the ends of the edge.
    pub(super) fn load(&mut self, stars: &Stars, kept: u32, gone: u32) {
        let [at_kept, at_gone] = &mut self.ends;
        stars.at(kept, at_kept);
        stars.at(gone, at_gone);
    }

    /// The vertices around the edge; some more than once, the ends among them.
    pub(super) fn around(&self) -> impl Iterator<Item = u32> + '_ {
        self.ends.iter().flatten().flatten().copied()
    }

    /// Whether the surface stays the same kind of surface: the two ends have no common neighbour but the
    /// tips of the edge's two triangles, which are no triangle with either end (link condition).
    pub(super) fn keeps_topology(&self, kept: u32, gone: u32) -> bool {
        let [at_kept, at_gone] = &self.ends;
        let most = at_kept.len() + at_gone.len();
        // Two triangles with both ends go, each from both stars.
        let is_crowded = most > MOST_AROUND + 4 && most > at_kept.len().max(at_gone.len()) + 4;
        if is_crowded || most > MOST {
            return false;
        }
        let mut tips = at_gone.iter().filter(|t| t.contains(&kept));
        let (Some(first), Some(second), None) = (tips.next(), tips.next(), tips.next()) else {
            return false;
        };
        let tip = |triangle: &[u32; 3]| triangle.iter().copied().find(|&v| v != kept && v != gone);
        let (Some(a), Some(b)) = (tip(first), tip(second)) else {
            return false;
        };
        // The star of `gone` is one closed fan, so each neighbour follows it in one triangle.
        let is_free = |v: u32| v == kept || v == a || v == b;
        let shared = at_gone.iter().map(|t| t[1]).filter(|&v| !is_free(v));
        let mut others = shared.filter(|v| at_kept.iter().any(|t| t.contains(v)));
        let has_bridge = |star: &[[u32; 3]]| star.iter().any(|t| t.contains(&a) && t.contains(&b));
        a != b && others.next().is_none() && !(has_bridge(at_kept) && has_bridge(at_gone))
    }

    /// Whether all triangles that stay keep facing their way and have a shape, with both ends at
    /// `place`, and no two neighbours among them fold together.
    pub(super) fn keeps_shape(
        &mut self,
        vertices_mm: &[Vector],
        [kept, gone]: [u32; 2],
        place: Vector,
    ) -> bool {
        self.fans.clear();
        let at = |vertex: u32| vertices_mm[vertex as usize];
        let usual = self.mean_normal(vertices_mm);
        for triangle in self.ends.iter().flatten() {
            if triangle.contains(&kept) && triangle.contains(&gone) {
                continue;
            }
            let [from, q, r] = triangle.map(at);
            let after = [place, q, r];
            let normal = cross(minus(q, place), minus(r, place));
            let doubled = dot(normal, normal).sqrt();
            let longest = longest_squared(&after);
            let before = cross(minus(q, from), minus(r, from));
            let doubled_before = dot(before, before).sqrt();
            let shape_before =
                doubled_before / longest_squared(&[from, q, r]).max(f64::MIN_POSITIVE);
            if doubled < LEAST_SHAPE.min(shape_before) * longest || !has_area(&after) {
                return false;
            }
            // A triangle that is next to nothing says nothing of the surface's direction.
            let is_facing = if shape_before < LEAST_SHAPE / 10.0 {
                dot(normal, usual) > 0.0
            } else {
                dot(normal, before) > LEAST_TURN * doubled * doubled_before
            };
            if !is_facing {
                return false;
            }
            self.fans.push(([triangle[1], triangle[2]], normal));
        }
        self.is_unfolded()
    }

    /// The triangles that [`Self::keeps_shape`] has looked at, without the vertex that all share.
    pub(super) fn rim(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + '_ {
        self.fans.iter().map(|(rim, _)| *rim)
    }

    /// The sum of all normals, long ones of large triangles.
    fn mean_normal(&self, vertices_mm: &[Vector]) -> Vector {
        self.ends.iter().flatten().fold([0.0; 3], |sum, triangle| {
            let [p, q, r] = triangle.map(|v| vertices_mm[v as usize]);
            let normal = cross(minus(q, p), minus(r, p));
            [0, 1, 2].map(|axis| sum[axis] + normal[axis])
        })
    }

    /// Whether neighbours around the new vertex do not fold together.
    fn is_unfolded(&self) -> bool {
        self.fans.iter().all(|([_, previous], normal)| {
            let mut beside = self.fans.iter().filter(|([next, _], _)| next == previous);
            beside.all(|(_, other)| {
                let lengths = (dot(*normal, *normal) * dot(*other, *other)).sqrt();
                dot(*normal, *other) >= LEAST_FOLD * lengths
            })
        })
    }
}

/// The longest edge of a triangle, squared.
fn longest_squared([a, b, c]: &[Vector; 3]) -> f64 {
    let squared = |from: Vector, to: Vector| {
        let edge = minus(to, from);
        dot(edge, edge)
    };
    squared(*a, *b).max(squared(*b, *c)).max(squared(*c, *a))
}
