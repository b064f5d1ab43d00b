//! The cells around one vertex.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::six_volumes;
use crate::labelled::points::Grid;

/// The cells around a vertex, and which of them share a facet there.
pub(super) struct Ball<'a> {
    cells: &'a [u32],
    /// Places in `cells` of the three neighbours; [`BEYOND`] where the hull ends the ball.
    neighbours: Vec<[usize; 3]>,
    volumes: Vec<i64>,
}

/// Beyond the hull of all points.
const BEYOND: usize = usize::MAX;

impl<'a> Ball<'a> {
    pub(super) fn new(vertex: u32, around: &'a [u32], cells: &[[u32; 4]], grid: &Grid) -> Self {
        // A facet at the vertex is known by its other two corners.
        let mut facets = Vec::with_capacity(3 * around.len());
        for (place, &c) in around.iter().enumerate() {
            let mut others = cells[c as usize].into_iter().filter(|&v| v != vertex);
            let mut rim = [0; 3].map(|_: u32| others.next().unwrap_or(vertex));
            rim.sort_unstable();
            let [p, q, r] = rim;
            for (side, facet) in [[p, q], [p, r], [q, r]].into_iter().enumerate() {
                facets.push((facet, place, side));
            }
        }
        facets.sort_unstable();
        let mut neighbours = vec![[BEYOND; 3]; around.len()];
        for pair in facets.windows(2) {
            let [(a, place, side), (b, other, other_side)] = [pair[0], pair[1]];
            if a == b {
                neighbours[place][side] = other;
                neighbours[other][other_side] = place;
            }
        }
        let volume = |&c: &u32| six_volumes(cells[c as usize], grid);
        Self {
            cells: around,
            neighbours,
            volumes: around.iter().map(volume).collect(),
        }
    }

    /// Fills air until bone and air each hang together; the cells that became bone.
    pub(super) fn fill(&self, is_bone: &mut [bool]) -> Vec<u32> {
        let mut bone: Vec<bool> = self.cells.iter().map(|&c| is_bone[c as usize]).collect();
        let mut filled = Vec::new();
        loop {
            let wanted = self.apart(&bone);
            if wanted.is_empty() {
                break;
            }
            for place in wanted {
                bone[place] = true;
                filled.push(self.cells[place]);
                is_bone[self.cells[place] as usize] = true;
            }
        }
        filled
    }

    /// What is to be filled next: air apart from the rest, or else the way to bone apart.
    fn apart(&self, bone: &[bool]) -> Vec<usize> {
        let (parts, count) = self.parts(bone);
        let of = |is_bone: bool| {
            let mut of: Vec<usize> = (0..bone.len())
                .filter(|&i| bone[i] == is_bone)
                .map(|i| parts[i])
                .collect();
            of.sort_unstable();
            of.dedup();
            of
        };
        let air = of(false);
        if air.len() > 1 {
            // The greatest part of air remains, and what reaches beyond the hull.
            let mut sizes = vec![0i64; count];
            for i in 0..bone.len() {
                let is_open = self.neighbours[i].contains(&BEYOND);
                sizes[parts[i]] += if is_open {
                    i64::MAX >> 20
                } else {
                    self.volumes[i]
                };
            }
            let kept = air
                .iter()
                .copied()
                .max_by_key(|&part| (sizes[part], Reverse(part)));
            let is_filled = |&i: &usize| !bone[i] && Some(parts[i]) != kept;
            return (0..bone.len()).filter(is_filled).collect();
        }
        match of(true)[..] {
            [first, _, ..] => self.way(bone, &parts, first),
            _ => Vec::new(),
        }
    }

    /// Numbers the parts of bone and of air that hang together.
    fn parts(&self, bone: &[bool]) -> (Vec<usize>, usize) {
        let mut parts = vec![BEYOND; bone.len()];
        let mut count = 0;
        let mut stack = Vec::new();
        for start in 0..bone.len() {
            if parts[start] != BEYOND {
                continue;
            }
            parts[start] = count;
            stack.push(start);
            while let Some(i) = stack.pop() {
                for n in self.neighbours[i] {
                    if n != BEYOND && parts[n] == BEYOND && bone[n] == bone[i] {
                        parts[n] = count;
                        stack.push(n);
                    }
                }
            }
            count += 1;
        }
        (parts, count)
    }

    /// The air of least volume between one part of bone and another one.
    fn way(&self, bone: &[bool], parts: &[usize], from: usize) -> Vec<usize> {
        let mut least = vec![i64::MAX; bone.len()];
        let mut before = vec![BEYOND; bone.len()];
        let mut heap = BinaryHeap::new();
        for i in 0..bone.len() {
            if parts[i] == from {
                least[i] = 0;
                heap.push(Reverse((0, i)));
            }
        }
        while let Some(Reverse((volume, i))) = heap.pop() {
            if volume > least[i] {
                continue;
            }
            if bone[i] && parts[i] != from {
                let way = std::iter::successors(Some(before[i]), |&j| Some(before[j]));
                return way.take_while(|&j| !bone[j]).collect();
            }
            for n in self.neighbours[i] {
                if n == BEYOND {
                    continue;
                }
                let further = volume + if bone[n] { 0 } else { self.volumes[n] };
                if further < least[n] {
                    least[n] = further;
                    before[n] = i;
                    heap.push(Reverse((further, n)));
                }
            }
        }
        // Around a vertex of the hull the way may be barred by what lies beyond: fill all.
        (0..bone.len()).filter(|&i| !bone[i]).collect()
    }
}
