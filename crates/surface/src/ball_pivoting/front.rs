//! Triangles so far, and their borders.

use std::collections::BTreeMap;

/// The mesh as its directed edges: each belongs to one triangle at most, so that an edge has at
/// most two, which run along it in opposite directions.
pub(super) struct Front {
    triangles: Vec<[u32; 3]>,
    /// The edges that leave each vertex: where to, and the third corner of their triangle.
    leaving: Vec<Vec<[u32; 2]>>,
    /// How many borders each vertex has.
    borders: Vec<u32>,
}

impl Front {
    pub(super) fn new(vertices: usize) -> Self {
        Self {
            triangles: Vec::new(),
            leaving: vec![Vec::new(); vertices],
            borders: vec![0; vertices],
        }
    }

    fn find(&self, [a, b]: [u32; 2]) -> Option<u32> {
        let leaving = self.leaving[a as usize].iter();
        leaving.copied().find(|e| e[0] == b).map(|e| e[1])
    }

    /// The third corner of the triangle of a directed edge that has one.
    pub(super) fn opposite(&self, edge: [u32; 2]) -> u32 {
        self.find(edge)
            .expect("edges that roll belong to a triangle: anything else is a bug")
    }

    /// Whether an edge has a triangle on this side only.
    pub(super) fn is_border(&self, [a, b]: [u32; 2]) -> bool {
        self.find([b, a]).is_none()
    }

    /// Whether a vertex has a triangle.
    pub(super) fn is_used(&self, v: u32) -> bool {
        !self.leaving[v as usize].is_empty()
    }

    /// Whether a vertex can have more triangles.
    pub(super) fn is_open(&self, v: u32) -> bool {
        !self.is_used(v) || self.borders[v as usize] > 0
    }

    /// Whether a triangle keeps every edge at two triangles that agree, and is not there yet.
    pub(super) fn takes(&self, [a, b, c]: [u32; 3]) -> bool {
        [[a, b, c], [b, c, a], [c, a, b]]
            .into_iter()
            .all(|[a, b, c]| self.find([a, b]).is_none() && self.find([b, a]) != Some(c))
    }

    pub(super) fn add(&mut self, [a, b, c]: [u32; 3]) {
        self.triangles.push([a, b, c]);
        for [a, b, c] in [[a, b, c], [b, c, a], [c, a, b]] {
            let closes = !self.is_border([a, b]);
            self.leaving[a as usize].push([b, c]);
            for v in [a, b] {
                let borders = &mut self.borders[v as usize];
                *borders = if closes { *borders - 1 } else { *borders + 1 };
            }
        }
    }

    /// The borders and the third corners of their triangles, in the order of vertices.
    pub(super) fn borders(&self) -> Vec<([u32; 2], u32)> {
        let edges = self.leaving.iter().zip(0u32..).flat_map(|(leaving, a)| {
            let sorted: BTreeMap<u32, u32> = leaving.iter().map(|e| (e[0], e[1])).collect();
            sorted.into_iter().map(move |(b, c)| ([a, b], c))
        });
        edges.filter(|(edge, _)| self.is_border(*edge)).collect()
    }

    pub(super) fn into_triangles(self) -> Vec<[u32; 3]> {
        self.triangles
    }
}
