//! The given vertices that each vertex stands for.

use crate::vector::Vector;

/// Places in rings, one ring a vertex.
pub(super) struct Points {
    places: Vec<Vector>,
    /// The place after each place in its ring.
    next: Vec<u32>,
    /// One place of each vertex's ring.
    first: Vec<u32>,
}

impl Points {
    /// Each vertex stands for itself.
    pub(super) fn new(places: Vec<Vector>) -> Self {
        let first: Vec<u32> = (0..places.len() as u32).collect();
        Self {
            places,
            next: first.clone(),
            first,
        }
    }

    /// The same of some vertices, which are numbered anew.
    pub(super) fn part(&self, vertices: &[u32]) -> Self {
        let mut part = Self::new(Vec::new());
        for &vertex in vertices {
            let first = part.places.len() as u32;
            part.first.push(first);
            part.places.extend(self.at(vertex));
            part.next.extend(first + 1..part.places.len() as u32);
            part.next.push(first);
        }
        part
    }

    /// The places that a vertex stands for.
    pub(super) fn at(&self, vertex: u32) -> impl Iterator<Item = Vector> + '_ {
        let first = self.first[vertex as usize];
        let onward = move |&at: &u32| Some(self.next[at as usize]).filter(|next| *next != first);
        std::iter::successors(Some(first), onward).map(|at| self.places[at as usize])
    }

    /// `kept` stands for what `gone` stood for, too.
    pub(super) fn join(&mut self, kept: u32, gone: u32) {
        let [kept, gone] = [kept, gone].map(|vertex| self.first[vertex as usize] as usize);
        self.next.swap(kept, gone);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_vertices_stand_for_all_their_places_in_a_part_too() {
        let mut points = Points::new((0..5).map(|i| [f64::from(i), 0.0, 0.0]).collect());
        points.join(1, 3);
        points.join(4, 1);
        let sorted = |points: &Points, vertex| {
            let mut all: Vec<f64> = points.at(vertex).map(|place| place[0]).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        assert_eq!(sorted(&points, 4), [1.0, 3.0, 4.0]);
        assert_eq!(sorted(&points, 0), [0.0]);
        let mut part = points.part(&[2, 4]);
        assert_eq!(sorted(&part, 0), [2.0]);
        part.join(0, 1);
        assert_eq!(sorted(&part, 0), [1.0, 2.0, 3.0, 4.0]);
    }
}
