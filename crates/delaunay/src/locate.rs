//! The walk from a cell to the one that holds a point.

use crate::predicates::{Kernel, Site};
use crate::triangulation::Triangulation;

impl<K: Kernel> Triangulation<'_, K> {
    /// A cell in conflict with `query`: the finite cell that holds it, or an infinite cell whose
    /// hull facet has it strictly outside.
    ///
    /// A visibility walk: leave through any facet that has the query on its other side. In a
    /// Delaunay triangulation (and any other that is the lower hull of a lift) such a walk never
    /// returns to a cell, so it ends (Edelsbrunner 1990). A query within the closed cell, other
    /// than its vertices, lies strictly inside the circumsphere: no in-sphere test is needed.
    pub(crate) fn locate(&self, query: &Site<K::Scalar>) -> u32 {
        let mut here = self.recent;
        if let Some(g) = self.cells[here as usize].ghost() {
            here = self.cells[here as usize].neighbours[g] >> 2;
        }
        let mut entered = 4;
        'walk: loop {
            let cell = &self.cells[here as usize];
            let corners = self.corners(cell.vertices);
            for f in 0..4 {
                if f == entered {
                    continue;
                }
                let mut replaced = corners;
                replaced[f] = &query.at;
                if self.kernel.orientation(replaced) < 0.0 {
                    let across = cell.neighbours[f];
                    here = across >> 2;
                    if self.cells[here as usize].is_infinite() {
                        return here;
                    }
                    entered = (across & 3) as usize;
                    continue 'walk;
                }
            }
            return here;
        }
    }
}
