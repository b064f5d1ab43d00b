//! Which triangles meet at each vertex, while edges collapse.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

/// No corner, no vertex.
const NONE: u32 = u32::MAX;
/// More triangles than this at one vertex are not looked through.
pub(crate) const MOST: usize = 64;
/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// The triangles of a mesh as chains of corners, one chain a vertex.
///
/// Corner `c` is corner `c % 3` of triangle `c / 3`. Corners of triangles that are gone may stay in
/// a chain; whoever walks it passes them over.
#[derive(Clone)]
pub(crate) struct Stars {
    triangles: Vec<[u32; 3]>,
    /// The first corner at each vertex.
    first: Vec<u32>,
    /// The corner after each corner.
    next: Vec<u32>,
    alive: usize,
}

impl Stars {
    /// Chains for `vertices` vertices; at most a third of `u32::MAX` triangles.
    pub(crate) fn new(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut first = vec![NONE; vertices];
        let mut next = vec![NONE; 3 * triangles.len()];
        // Backwards, so that each chain runs in the order of the triangles.
        for (corner, &vertex) in triangles.as_flattened().iter().enumerate().rev() {
            next[corner] = std::mem::replace(&mut first[vertex as usize], corner as u32);
        }
        Self {
            triangles: triangles.to_vec(),
            first,
            next,
            alive: triangles.len(),
        }
    }

    /// How many triangles there still are.
    pub(crate) fn alive(&self) -> usize {
        self.alive
    }

    /// All triangles that there still are.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.triangles.iter().filter(|t| t[0] != NONE).copied()
    }

    /// The triangles at a vertex, each turned so that the vertex comes first.
    pub(crate) fn at(&self, vertex: u32, star: &mut Vec<[u32; 3]>) {
        star.clear();
        let mut corner = self.first[vertex as usize];
        while corner != NONE {
            let [a, b, c] = self.triangles[corner as usize / 3];
            if a != NONE {
                star.push(match corner % 3 {
                    0 => [a, b, c],
                    1 => [b, c, a],
                    _ => [c, a, b],
                });
            }
            corner = self.next[corner as usize];
        }
    }

    /// Makes `gone` the same vertex as `kept`: triangles with both disappear, the others at `gone`
    /// go over to `kept`.
    pub(crate) fn collapse(&mut self, kept: u32, gone: u32) {
        let mut chain = NONE;
        for vertex in [gone, kept] {
            let mut corner = self.first[vertex as usize];
            while corner != NONE {
                let after = self.next[corner as usize];
                let triangle = &mut self.triangles[corner as usize / 3];
                if triangle[0] != NONE && triangle.contains(&gone) && triangle.contains(&kept) {
                    *triangle = [NONE; 3];
                    self.alive -= 1;
                }
                if triangle[0] != NONE {
                    triangle[corner as usize % 3] = kept;
                    self.next[corner as usize] = chain;
                    chain = corner;
                }
                corner = after;
            }
        }
        self.first[gone as usize] = NONE;
        self.first[kept as usize] = chain;
    }

    /// Whether the triangles at each vertex form one closed fan, all facing the same way.
    pub(crate) fn closed_fans(&self, task: &Task) -> Result<Vec<bool>, Cancelled> {
        let mut is_closed = vec![false; self.first.len()];
        let chunks = is_closed.par_chunks_mut(STRIDE).enumerate();
        chunks.try_for_each(|(chunk, is_closed)| {
            let mut star = Vec::new();
            for (vertex, is_closed) in ((chunk * STRIDE) as u32..).zip(is_closed) {
                self.at(vertex, &mut star);
                *is_closed = is_closed_fan(&star);
            }
            task.check()
        })?;
        Ok(is_closed)
    }
}

/// Whether triangles `[middle, next, previous]` form one closed fan.
fn is_closed_fan(star: &[[u32; 3]]) -> bool {
    let Some(&[_, start, _]) = star.first() else {
        return false;
    };
    if star.len() > MOST || star.iter().any(|&[a, b, c]| a == b || b == c || c == a) {
        return false;
    }
    let mut at = start;
    for step in 1..=star.len() {
        let mut onward = star.iter().filter(|triangle| triangle[1] == at);
        let (Some(&[_, _, to]), None) = (onward.next(), onward.next()) else {
            return false;
        };
        at = to;
        if at == start {
            return step == star.len() && step > 2;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eight triangles around two poles, 0 and 1, with the ring 2, 3, 4, 5.
    fn octahedron() -> Vec<[u32; 3]> {
        let ring = [[2, 3], [3, 4], [4, 5], [5, 2]];
        let fans = ring.iter().flat_map(|&[a, b]| [[0, a, b], [1, b, a]]);
        fans.collect()
    }

    #[test]
    fn collapsing_takes_two_triangles_and_leaves_closed_fans() {
        let mut stars = Stars::new(6, &octahedron());
        stars.collapse(2, 3);
        assert_eq!(stars.alive(), 6);
        assert_eq!(stars.triangles().count(), 6);
        assert!(stars.triangles().all(|t| !t.contains(&3)));
        let fans = stars.closed_fans(&Task::default()).unwrap();
        assert_eq!(fans, [true, true, true, false, true, true]);
    }

    #[test]
    fn open_crossing_and_turned_fans_are_not_closed() {
        let closed = |triangles: &[[u32; 3]]| {
            let mut star = Vec::new();
            Stars::new(9, triangles).at(0, &mut star);
            is_closed_fan(&star)
        };
        assert!(closed(&[[0, 1, 2], [2, 3, 0], [0, 3, 1]]));
        assert!(!closed(&[[0, 1, 2], [0, 2, 3]]));
        assert!(!closed(&[[0, 1, 2], [0, 2, 3], [0, 1, 3]]));
        let both = [
            [0, 1, 2],
            [0, 2, 3],
            [0, 3, 1],
            [0, 4, 5],
            [0, 5, 6],
            [0, 6, 4],
        ];
        assert!(!closed(&both));
        assert!(!closed(&[[0, 1, 2], [0, 2, 1]]));
        assert!(!closed(&[]));
    }
}
