//! Insertion of one point (Bowyer 1981, Watson 1981).
//!
//! 1. [`Triangulation::locate`] finds one cell in conflict.
//! 2. [`Triangulation::open`] collects all of them: they are connected. Their rim is a closed
//!    triangulated sphere, and the point sees all of it from inside.
//! 3. [`Triangulation::close`] joins the point to every facet of the rim.

use prefetch_index::prefetch_index;

use crate::predicates::{Kernel, Site};
use crate::star::Edges;
use crate::triangulation::Triangulation;

/// Squared radius of a cell in conflict, which is about to go.
const DOOMED: f64 = -1.0;

/// A facet of the rim: its cell-to-be and what lies beyond.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RimFacet {
    /// The conflicting cell's vertices, with the one opposite the facet replaced by the point.
    pub(crate) vertices: [u32; 4],
    /// Which one that is.
    pub(crate) facet: u32,
    /// The facet seen from outside.
    pub(crate) across: u32,
    /// Numbers on the rim of the three vertices beside the point, see [`Edges`].
    pub(crate) numbers: [u32; 3],
}

/// What one insertion needs, kept for the next one.
#[derive(Default)]
pub(crate) struct Cavity {
    /// Cells in conflict, each with the facet through which it was entered (`4 cell + facet`);
    /// the queue of the search as well.
    pub(crate) entries: Vec<u32>,
    pub(crate) rim: Vec<RimFacet>,
    /// The new cell of each facet of the rim.
    pub(crate) slots: Vec<u32>,
    pub(crate) edges: Edges,
}

/// The point that is inserted.
struct Newcomer<'a, K: Kernel> {
    vertex: u32,
    site: &'a Site<K::Scalar>,
    place_mm: [f64; 3],
}

/// What is seen out of a cell in conflict through one of its facets.
#[derive(Clone, Copy)]
struct Glance {
    /// The facet, and the same from beyond.
    facet: u32,
    across: u32,
    /// Whether the cell beyond is known to be in conflict.
    is_doomed: bool,
    /// Where its sphere has the point, see [`crate::sphere::Precision::side`].
    side: f64,
}

impl<K: Kernel> Triangulation<'_, K> {
    /// Inserts `vertex`, which equals none before it; the number of new cells.
    pub(crate) fn insert(&mut self, vertex: u32, cavity: &mut Cavity) -> usize {
        let site = self.vertices[vertex as usize].site;
        let start = self.locate(&site);
        let newcomer = Newcomer {
            vertex,
            site: &site,
            place_mm: self.kernel.place_mm(&site.at),
        };
        self.open(start, &newcomer, cavity);
        self.close(&site, newcomer.place_mm, cavity);
        cavity.rim.len()
    }

    /// Collects the cells in conflict and their rim.
    fn open(&mut self, start: u32, newcomer: &Newcomer<'_, K>, cavity: &mut Cavity) {
        cavity.entries.clear();
        cavity.rim.clear();
        cavity.entries.push(4 * start);
        self.cells[start as usize].sphere.radius_squared = DOOMED;
        // The start counts as entered through its facet 0, which nobody has looked through.
        let glance = self.glance(4 * start, newcomer);
        self.look(glance, newcomer, cavity);
        let mut next = 0;
        while let Some(&entry) = cavity.entries.get(next) {
            next += 1;
            let facet = |turn: u32| (entry & !3) | ((entry + turn) & 3);
            // All three at once, so that the memory of one is waited for with the others'.
            let (a, b, c) = (
                self.glance(facet(1), newcomer),
                self.glance(facet(2), newcomer),
                self.glance(facet(3), newcomer),
            );
            self.look(a, newcomer, cavity);
            self.look(b, newcomer, cavity);
            self.look(c, newcomer, cavity);
        }
    }

    #[inline]
    fn glance(&self, facet: u32, newcomer: &Newcomer<'_, K>) -> Glance {
        let across = self.cells[(facet >> 2) as usize].neighbours[(facet & 3) as usize];
        let sphere = &self.cells[(across >> 2) as usize].sphere;
        Glance {
            facet,
            across,
            is_doomed: sphere.radius_squared < 0.0,
            side: self.precision.side(sphere, newcomer.place_mm),
        }
    }

    /// Acts on a glance out of a cell in conflict: the cell beyond is in conflict as well, or the
    /// facet is on the rim.
    #[expect(clippy::inline_always, reason = "called 60 times for each point")]
    #[inline(always)]
    fn look(&mut self, glance: Glance, newcomer: &Newcomer<'_, K>, cavity: &mut Cavity) {
        if glance.is_doomed {
            return;
        }
        let beyond = glance.across >> 2;
        if glance.side < 0.0 || (glance.side == 0.0 && self.conflicts(beyond, newcomer.site)) {
            self.cells[beyond as usize].sphere.radius_squared = DOOMED;
            cavity.entries.push(glance.across);
            // By the time the queue gets there, its neighbours have come from memory.
            for across in self.cells[beyond as usize].neighbours {
                prefetch_index(&self.cells, (across >> 2) as usize);
            }
            return;
        }
        let facet = glance.facet & 3;
        let [a, b, c, d] = self.cells[(glance.facet >> 2) as usize].vertices;
        // Chosen one by one: to change one of four in memory and copy the four would wait for
        // the change.
        let vertex = |k: u32, old: u32| if k == facet { newcomer.vertex } else { old };
        cavity.rim.push(RimFacet {
            vertices: [vertex(0, a), vertex(1, b), vertex(2, c), vertex(3, d)],
            facet,
            across: glance.across,
            numbers: [0; 3],
        });
    }

    /// Whether a cell loses its place when `query` comes, exactly.
    ///
    /// An infinite cell does when the query lies strictly outside its hull facet. A query in the
    /// facet's plane takes part in the triangulation of that plane, where lifted points of the
    /// plane alone decide; the finite cell behind the facet meets the plane in just that circle,
    /// ties and all, so the query's conflict with it is the infinite cell's, too.
    #[inline(never)]
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
        let corners = cell.vertices.map(|v| &self.vertices[v as usize].site);
        self.kernel.in_conflict(corners, query)
    }
}
