//! Which cells of a slab's triangulation belong to the alpha complex.
//!
//! A cell is kept where its circumradius is at most alpha, by the slab that holds its
//! circumcentre. Its sphere in doubles decides where that is beyond doubt; whole numbers decide
//! the rest, so that every slab that sees a cell decides alike, and cospherical cells stay
//! together.

use bonemesh_task::{Cancelled, Task};

use crate::predicates::{Kernel, Site};
use crate::slabs::Slabs;
use crate::triangulation::{Cell, Triangulation};

/// Cells judged between two looks at the cancel switch: some ten milliseconds at worst.
const CELLS_PER_CHECK: usize = 1 << 12;

/// A slab's triangulation and which of its cells the slab keeps.
pub(crate) struct Kept<'t, 'k, K: Kernel> {
    triangulation: &'t Triangulation<'k, K>,
    is_kept: Vec<bool>,
}

impl<'t, 'k, K: Kernel> Kept<'t, 'k, K> {
    /// Decides for every cell that `slab` found.
    pub(crate) fn new(
        triangulation: &'t Triangulation<'k, K>,
        alpha: f64,
        slabs: &Slabs,
        slab: usize,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let judge = Judge {
            triangulation,
            alpha,
            alpha_squared: alpha * alpha,
            slabs,
            slab,
        };
        let mut is_kept = Vec::with_capacity(triangulation.cells.len());
        for cells in triangulation.cells.chunks(CELLS_PER_CHECK) {
            task.check()?;
            is_kept.extend(cells.iter().map(|cell| judge.keeps(cell)));
        }
        Ok(Self {
            triangulation,
            is_kept,
        })
    }

    fn cells(&self) -> impl Iterator<Item = &'t Cell> {
        let cells = self.triangulation.cells.iter().zip(&self.is_kept);
        cells.filter(|(_, kept)| **kept).map(|(cell, _)| cell)
    }

    /// How many cells are kept.
    pub(crate) fn count(&self) -> usize {
        self.cells().count()
    }

    /// The kept cells' ranks, see [`canonical`].
    pub(crate) fn ranks(&self) -> Vec<[u32; 4]> {
        let t = self.triangulation;
        self.cells().map(|c| canonical(t.cell_sites(c)).0).collect()
    }

    /// Facets, outward and as ranks, of kept cells with none of this slab's kept cells beyond.
    ///
    /// Beyond may be a cell that another slab keeps: that slab has the same facet from the other
    /// side, since this one's cell is not its own, and the two cancel. A facet with a kept cell
    /// on one side only comes once.
    pub(crate) fn facets(&self) -> Vec<[u32; 3]> {
        let t = self.triangulation;
        let mut facets = Vec::new();
        for cell in self.cells() {
            for (across, facet) in cell.neighbours.iter().zip(outward(cell.vertices)) {
                if !self.is_kept[(across >> 2) as usize] {
                    facets.push(facet.map(|v| t.vertices[v as usize].site.rank));
                }
            }
        }
        facets
    }
}

/// What it takes to decide about a cell.
struct Judge<'a, 'k, K: Kernel> {
    triangulation: &'a Triangulation<'k, K>,
    alpha: f64,
    alpha_squared: f64,
    slabs: &'a Slabs,
    slab: usize,
}

impl<K: Kernel> Judge<'_, '_, K> {
    fn keeps(&self, cell: &Cell) -> bool {
        if !cell.is_finite() {
            return false;
        }
        let (sphere, precision) = (&cell.sphere, &self.triangulation.precision);
        let slack = self.alpha_squared * precision.tolerance;
        if sphere.radius_squared > self.alpha_squared + slack {
            return false;
        }
        if sphere.radius_squared < self.alpha_squared - slack {
            let reach = self.alpha * precision.tolerance + 4.0 * precision.place;
            if let Some(owner) = self.slabs.only_owner(sphere.centre, reach) {
                return owner == self.slab;
            }
        }
        self.keeps_exactly(cell)
    }

    /// Whoever asks gets the same answer: nothing is rounded but the centre, from one order of
    /// the sites.
    fn keeps_exactly(&self, cell: &Cell) -> bool {
        let kernel = self.triangulation.kernel;
        let (_, sites) = canonical(self.triangulation.cell_sites(cell));
        let sphere = kernel.exact_sphere(sites.each_ref().map(|s| &s.at));
        if !sphere.radius_is_at_most(self.alpha) {
            return false;
        }
        let corner = kernel.place_mm(&sites[0].at);
        let to_centre = kernel.vector_mm(sphere.centre());
        let centre = [0, 1, 2].map(|k| corner[k] + to_centre[k]);
        self.slabs.owner(centre) == self.slab
    }
}

/// The facets of a positive cell, outward, each opposite the vertex of its place.
#[inline]
pub(crate) fn outward([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 4] {
    [[b, c, d], [a, d, c], [a, b, d], [a, c, b]]
}

/// A positively oriented cell as ranks: ascending, the last two swapped if orientation asks for
/// it; and its sites, ascending.
pub(crate) fn canonical<S: Copy>(mut cell: [Site<S>; 4]) -> ([u32; 4], [Site<S>; 4]) {
    let mut even = true;
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        if cell[i].rank > cell[j].rank {
            cell.swap(i, j);
            even = !even;
        }
    }
    let mut ranks = cell.map(|s| s.rank);
    if !even {
        ranks.swap(2, 3);
    }
    (ranks, cell)
}
