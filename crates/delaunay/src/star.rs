//! The new point's star: a cell for every facet of the rim, joined along the rim's edges.

use crate::insert::{Cavity, RimFacet};
use crate::predicates::{Kernel, Site};
use crate::sphere::{Arm, LANES, Sphere, arm};
use crate::triangulation::{Cell, GHOST, Triangulation, UNUSED, Vertex};

/// Vertices on the rim up to which edges are matched in a table: 98 of 100 rims.
const TABLE_SIDE: usize = 32;
/// An empty place in the table.
const EMPTY: u32 = u32::MAX;

/// Finds, for a facet of a new cell, the other new cell with the same edge of the rim.
#[derive(Default)]
pub(crate) struct Edges {
    /// Which insertion this is.
    round: u32,
    /// From the new point to each vertex of the rim, by number.
    arms: Vec<Arm>,
    /// Square over numbers, all [`EMPTY`] between insertions.
    table: Vec<u32>,
    /// The edges of a rim too large for the table: vertices, facet.
    list: Vec<([u32; 2], u32)>,
}

impl Edges {
    fn begin(&mut self) {
        self.table.resize(TABLE_SIDE * TABLE_SIDE, EMPTY);
        self.arms.clear();
        self.round += 1;
    }
}

/// The vertices beside `facet`'s own, in an order that makes positive cells with it in front.
const BESIDE: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

impl<K: Kernel> Triangulation<'_, K> {
    /// Replaces the cells in conflict by one for each facet of the rim.
    pub(crate) fn close(
        &mut self,
        site: &Site<K::Scalar>,
        place_mm: [f64; 3],
        cavity: &mut Cavity,
    ) {
        cavity.edges.begin();
        cavity.slots.clear();
        // The rim is a sphere: v - e + f = 2 with 2 e = 3 f.
        let small = cavity.rim.len() / 2 + 2 <= TABLE_SIDE;
        let mut old = cavity.entries.iter().map(|entry| entry >> 2);
        for rim in &mut cavity.rim {
            let slot = match old.next() {
                Some(slot) => slot,
                None => self.fresh_slot(),
            };
            cavity.slots.push(slot);
            self.place_cell(slot, rim);
            let beside = BESIDE[(rim.facet & 3) as usize];
            for (number, k) in rim.numbers.iter_mut().zip(beside) {
                let vertex = rim.vertices[k];
                *number = self.number(vertex, site, &mut cavity.edges);
            }
            self.link(slot, rim, small, &mut cavity.edges);
        }
        self.recent = *cavity
            .slots
            .last()
            .expect("a rim has facets, none is a bug");
        for slot in old {
            self.cells[slot as usize].vertices = [UNUSED; 4];
            self.unused.push(slot);
        }
        if !small {
            self.link_list(&mut cavity.edges.list);
        }
        self.place_spheres(place_mm, cavity);
    }

    fn fresh_slot(&mut self) -> u32 {
        self.unused.pop().unwrap_or_else(|| {
            self.cells.push(Cell {
                vertices: [UNUSED; 4],
                neighbours: [0; 4],
                sphere: Sphere::UNKNOWN,
            });
            self.cells.len() as u32 - 1
        })
    }

    /// The vertex's number on the rim; its arm is found at its first appearance.
    #[inline]
    fn number(&mut self, vertex: u32, from: &Site<K::Scalar>, edges: &mut Edges) -> u32 {
        let Vertex { site, on_rim } = &mut self.vertices[vertex as usize];
        if on_rim.0 != edges.round {
            *on_rim = (edges.round, edges.arms.len() as u32);
            // The ghost has no arm, and so no sphere.
            edges.arms.push(if vertex == GHOST {
                [f64::NAN; 4]
            } else {
                arm(self.kernel.difference_mm(&site.at, &from.at))
            });
        }
        on_rim.1
    }

    #[inline]
    fn place_cell(&mut self, slot: u32, rim: &RimFacet) {
        let cell = &mut self.cells[slot as usize];
        cell.vertices = rim.vertices;
        cell.neighbours[(rim.facet & 3) as usize] = rim.across;
        let beyond = &mut self.cells[(rim.across >> 2) as usize];
        beyond.neighbours[(rim.across & 3) as usize] = 4 * slot + rim.facet;
    }

    /// Joins the three inner facets of a new cell to those that are already there.
    #[inline]
    fn link(&mut self, slot: u32, rim: &RimFacet, small: bool, edges: &mut Edges) {
        let [a, b, c] = rim.numbers;
        let beside = BESIDE[(rim.facet & 3) as usize];
        for (k, u, v) in [(0, b, c), (1, c, a), (2, a, b)] {
            let this = 4 * slot + beside[k] as u32;
            let (low, high) = (u.min(v), u.max(v));
            if !small {
                edges.list.push(([low, high], this));
                continue;
            }
            let place = &mut edges.table[low as usize * TABLE_SIDE + high as usize];
            // Each edge of the rim comes exactly twice, which leaves the table empty. The first
            // time the facet is joined to nothing: no branch, since which time it is cannot be
            // foreseen.
            let mate = *place;
            let is_first = mate == EMPTY;
            *place = if is_first { this } else { EMPTY };
            let other = if is_first { this } else { mate };
            self.cells[(other >> 2) as usize].neighbours[(other & 3) as usize] = this;
            self.cells[(this >> 2) as usize].neighbours[(this & 3) as usize] = mate;
        }
    }

    /// The same for a rim of any size: equal edges become neighbours by sorting.
    fn link_list(&mut self, list: &mut Vec<([u32; 2], u32)>) {
        list.sort_unstable();
        for pair in list.chunks_exact(2) {
            self.join(pair[0].1, pair[1].1);
        }
        list.clear();
    }

    #[inline]
    fn join(&mut self, a: u32, b: u32) {
        self.cells[(a >> 2) as usize].neighbours[(a & 3) as usize] = b;
        self.cells[(b >> 2) as usize].neighbours[(b & 3) as usize] = a;
    }

    fn place_spheres(&mut self, place_mm: [f64; 3], cavity: &Cavity) {
        let arms = &cavity.edges.arms;
        let facets = cavity.rim.chunks(LANES);
        for (facets, slots) in facets.zip(cavity.slots.chunks(LANES)) {
            let facets_arms = std::array::from_fn(|lane| {
                // Lanes past the end repeat the last facet.
                let [a, b, c] = facets[lane.min(facets.len() - 1)].numbers;
                [&arms[a as usize], &arms[b as usize], &arms[c as usize]]
            });
            let spheres = self.precision.spheres(place_mm, &facets_arms);
            for (lane, &slot) in slots.iter().enumerate() {
                self.cells[slot as usize].sphere = spheres.get(lane);
            }
        }
    }
}
