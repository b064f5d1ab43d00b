//! Insertion of one point (Bowyer 1981, Watson 1981).
//!
//! 1. [`Triangulation::locate`] finds one cell in conflict.
//! 2. [`Triangulation::open`] collects all of them: they are connected. Their rim is a closed
//!    triangulated sphere, and the point sees all of it from inside.
//! 3. [`Triangulation::close`] joins the point to every facet of the rim.

use crate::predicates::{Kernel, Site};
use crate::triangulation::{Cell, Triangulation, UNUSED};

/// Vertices on the rim up to which edges are matched in a table.
const TABLE_SIDE: usize = 64;
/// An empty place in the table.
const EMPTY: u32 = u32::MAX;

/// A facet of the rim: its cell-to-be and what lies beyond.
#[derive(Clone, Copy, Debug)]
struct RimFacet {
    /// The conflicting cell's vertices, with the one opposite the facet replaced by the point.
    vertices: [u32; 4],
    /// Which one that is.
    facet: u32,
    /// The facet seen from outside.
    across: u32,
}

/// What one insertion needs, kept for the next one.
#[derive(Default)]
pub(crate) struct Cavity {
    /// Mark of a cell found outside in this insertion; one more: inside.
    outside: u32,
    /// Cells in conflict; the queue of the search as well.
    cells: Vec<u32>,
    rim: Vec<RimFacet>,
    edges: EdgeTable,
}

/// Finds, for a facet of a new cell, the other new cell with the same edge of the rim.
#[derive(Default)]
struct EdgeTable {
    /// Number of a vertex on the rim; only valid where `rim_vertices` has it back.
    number: Vec<u32>,
    rim_vertices: Vec<u32>,
    /// Square over rim vertices, all [`EMPTY`] between insertions.
    table: Vec<u32>,
    /// The edges of a rim too large for the table: vertices, facet.
    list: Vec<([u32; 2], u32)>,
}

impl EdgeTable {
    #[inline]
    fn number(&mut self, vertex: u32) -> usize {
        let known = self.number[vertex as usize];
        if self.rim_vertices.get(known as usize) == Some(&vertex) {
            return known as usize;
        }
        let next = self.rim_vertices.len();
        self.number[vertex as usize] = next as u32;
        self.rim_vertices.push(vertex);
        next
    }
}

impl<K: Kernel> Triangulation<'_, K> {
    /// Inserts `vertex`, which equals none before it; the number of new cells.
    pub(crate) fn insert(&mut self, vertex: u32, cavity: &mut Cavity) -> usize {
        let query = self.sites[vertex as usize];
        let start = self.locate(&query);
        self.open(start, vertex, &query, cavity);
        self.close(cavity);
        cavity.rim.len()
    }

    /// Collects the cells in conflict with `query` and their rim.
    fn open(&mut self, start: u32, vertex: u32, query: &Site<K::Scalar>, cavity: &mut Cavity) {
        cavity.outside += 2;
        let (outside, inside) = (cavity.outside, cavity.outside + 1);
        cavity.cells.clear();
        cavity.rim.clear();
        cavity.cells.push(start);
        self.marks[start as usize] = inside;
        let mut next = 0;
        while let Some(&at) = cavity.cells.get(next) {
            next += 1;
            let cell = self.cells[at as usize];
            for (f, &across) in cell.neighbours.iter().enumerate() {
                let beyond = across >> 2;
                let mark = self.marks[beyond as usize];
                if mark == inside {
                    continue;
                }
                if mark != outside && self.conflicts(beyond, query) {
                    self.marks[beyond as usize] = inside;
                    cavity.cells.push(beyond);
                    continue;
                }
                self.marks[beyond as usize] = outside;
                let mut vertices = cell.vertices;
                vertices[f] = vertex;
                cavity.rim.push(RimFacet {
                    vertices,
                    facet: f as u32,
                    across,
                });
            }
        }
    }

    /// Whether a cell loses its place when `query` comes.
    ///
    /// An infinite cell does when the query lies strictly outside its hull facet. A query in the
    /// facet's plane takes part in the triangulation of that plane, where lifted points of the
    /// plane alone decide; the finite cell behind the facet meets the plane in just that circle,
    /// ties and all, so the query's conflict with it is the infinite cell's, too.
    #[inline]
    fn conflicts(&self, at: u32, query: &Site<K::Scalar>) -> bool {
        let mut cell = &self.cells[at as usize];
        if let Some(g) = cell.ghost() {
            let mut corners = self.corners(cell.vertices);
            corners[g] = &query.at;
            let side = self.kernel.orientation(corners);
            if side != 0.0 {
                return side > 0.0;
            }
            cell = &self.cells[(cell.neighbours[g] >> 2) as usize];
        }
        let corners = cell.vertices.map(|v| &self.sites[v as usize]);
        self.kernel.in_conflict(corners, query)
    }

    /// Replaces the cells in conflict by one for each facet of the rim.
    fn close(&mut self, cavity: &mut Cavity) {
        let edges = &mut cavity.edges;
        edges.number.resize(self.sites.len(), 0);
        edges.table.resize(TABLE_SIDE * TABLE_SIDE, EMPTY);
        edges.rim_vertices.clear();
        // The rim is a sphere: v - e + f = 2 with 2 e = 3 f.
        let small = cavity.rim.len() / 2 + 2 <= TABLE_SIDE;
        let mut old = cavity.cells.iter();
        for rim in &cavity.rim {
            let slot = old.next().copied().or_else(|| self.unused.pop());
            let slot = slot.unwrap_or(self.cells.len() as u32);
            let facet = rim.facet as usize;
            let mut cell = Cell {
                vertices: rim.vertices,
                neighbours: [EMPTY; 4],
            };
            cell.neighbours[facet] = rim.across;
            if slot as usize == self.cells.len() {
                self.cells.push(cell);
                self.marks.push(0);
            } else {
                self.cells[slot as usize] = cell;
            }
            self.cells[(rim.across >> 2) as usize].neighbours[(rim.across & 3) as usize] =
                4 * slot + rim.facet;
            if small {
                self.link(slot, rim, edges);
            } else {
                for (f, [i, j]) in rim_edges(facet) {
                    let (u, v) = (rim.vertices[i], rim.vertices[j]);
                    edges.list.push(([u.min(v), u.max(v)], 4 * slot + f as u32));
                }
            }
            self.recent = slot;
        }
        if !small {
            self.link_list(&mut edges.list);
        }
        for &slot in old {
            self.cells[slot as usize].vertices = [UNUSED; 4];
            self.unused.push(slot);
        }
    }

    /// Joins the three inner facets of a new cell to those that are already there.
    #[inline]
    fn link(&mut self, slot: u32, rim: &RimFacet, edges: &mut EdgeTable) {
        let facet = rim.facet as usize;
        let mut number = [0; 4];
        for (k, number) in number.iter_mut().enumerate() {
            if k != facet {
                *number = edges.number(rim.vertices[k]);
            }
        }
        for (f, [i, j]) in rim_edges(facet) {
            let (u, v) = (number[i], number[j]);
            let place = &mut edges.table[u.min(v) * TABLE_SIDE + u.max(v)];
            let this = 4 * slot + f as u32;
            if *place == EMPTY {
                *place = this;
            } else {
                // Each edge of the rim comes exactly twice, which leaves the table empty.
                let mate = std::mem::replace(place, EMPTY);
                self.join(this, mate);
            }
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
}

/// The three facets beside `facet` of a cell whose vertex there is new, each with the places of
/// the two vertices that it shares with the rim.
#[inline]
fn rim_edges(facet: usize) -> [(usize, [usize; 2]); 3] {
    let others = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]][facet];
    let [i, j, k] = others;
    [(i, [j, k]), (j, [i, k]), (k, [i, j])]
}
