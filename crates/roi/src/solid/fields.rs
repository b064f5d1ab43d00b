//! The cutter's two values on the nodes of a lattice: how far a place is inside of its sides, and how far
//! between its lid and its bottom.
//!
//! They are two bodies, of which the cutter is the common part: in a single one its edges would be cut off
//! between nodes.
//!
//! What takes time is to find the nearest place of the patch, so not all nodes are looked at. First those at
//! the corners of coarse cells; then, half as far apart and at last all, those of the cells that a border may
//! pass through, judging by how large the values at the cell's corners are and how much they differ.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::lattice::{COARSE, Lattice};
use bonemesh_mesh::vector::Vector;

/// How fast values change with place, at least and at most: below a curled patch the nearest place moves
/// faster than the place that it is nearest to.
const SLOPES: [f32; 2] = [1.0, 3.0];
/// Nodes done between two looks at the cancel switch.
const STRIDE: usize = 1 << 8;

/// How far (mm) a place is inside of the sides, and between lid and bottom; below 0 outside.
pub(super) type Inside = [f64; 2];

/// The values of all nodes, in the order of the lattice: exact around borders, elsewhere right in sign where
/// both count.
#[derive(Debug)]
pub(super) struct Fields {
    pub(super) sides: Vec<f32>,
    pub(super) between: Vec<f32>,
}

impl Fields {
    /// All outside.
    pub(super) fn outside(nodes: usize) -> Self {
        Self {
            sides: vec![-1.0; nodes],
            between: vec![-1.0; nodes],
        }
    }

    pub(super) fn set(&mut self, node: usize, [sides, between]: Inside) {
        self.sides[node] = sides as f32;
        self.between[node] = between as f32;
    }

    /// `inside`: what a place is; `None` where all places nearer to it than the diagonal of a coarse cell are
    /// outside.
    pub(super) fn of(
        lattice: &Lattice,
        inside: impl Fn(Vector) -> Option<Inside> + Sync,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let nodes = lattice.nodes();
        let mut sampled = Sampled {
            lattice,
            fields: Self::outside(nodes),
            known: vec![Known::Nothing; nodes],
        };
        let mut side = COARSE;
        let mut cells: Vec<[usize; 3]> = lattice.coarse_cells().collect();
        sampled.look(&cells, [side, side], &inside, task)?;
        while side > 1 {
            cells.retain(|cell| sampled.may_have_border(*cell, side));
            let half = side / 2;
            sampled.look(&cells, [side, half], &inside, task)?;
            let halves = cells.iter().flat_map(|cell| corners(*cell, half));
            cells = halves.collect();
            side = half;
        }
        Ok(sampled.fields)
    }
}

/// The places of a cell's corners, that many nodes apart.
fn corners([i, j, k]: [usize; 3], side: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..8).map(move |c| {
        [
            i + (c & 1) * side,
            j + (c >> 1 & 1) * side,
            k + (c >> 2) * side,
        ]
    })
}

/// What is known of a node.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Known {
    Nothing,
    Values,
    /// It and all around it are outside.
    Beyond,
}

/// Fields of which some nodes are known.
struct Sampled<'a> {
    lattice: &'a Lattice,
    fields: Fields,
    known: Vec<Known>,
}

impl Sampled<'_> {
    /// Looks at the nodes of the cells that are not known yet, those `apart` from one another.
    fn look(
        &mut self,
        cells: &[[usize; 3]],
        [side, apart]: [usize; 2],
        inside: &(impl Fn(Vector) -> Option<Inside> + Sync),
        task: &Task,
    ) -> Result<(), Cancelled> {
        let across = side / apart + 1;
        let mut nodes = Vec::new();
        for [i, j, k] in cells {
            for n in 0..across.pow(3) {
                let step = [n % across, n / across % across, n / across / across];
                let node = [
                    i + step[0] * apart,
                    j + step[1] * apart,
                    k + step[2] * apart,
                ];
                let known = &mut self.known[self.lattice.number(node)];
                if *known == Known::Nothing {
                    *known = Known::Values;
                    nodes.push(node);
                }
            }
        }
        task.begin("cutter", nodes.len());
        let look = |nodes: &[[usize; 3]]| {
            let found = nodes.iter().map(|node| inside(self.lattice.place(*node)));
            let found: Vec<Option<Inside>> = found.collect();
            task.advance(nodes.len())?;
            Ok(found)
        };
        let found = nodes.par_chunks(STRIDE).map(look);
        let found = found.collect::<Result<Vec<_>, Cancelled>>()?;
        for (node, found) in nodes.into_iter().zip(found.into_iter().flatten()) {
            let number = self.lattice.number(node);
            match found {
                Some(inside) => self.fields.set(number, inside),
                None => self.known[number] = Known::Beyond,
            }
        }
        Ok(())
    }

    /// Whether one of the borders may pass through a cell; where none does, sets what is not known in it.
    fn may_have_border(&mut self, cell: [usize; 3], side: usize) -> bool {
        let corners = corners(cell, side).map(|node| self.lattice.number(node));
        let corners: Vec<usize> = corners.collect();
        if corners
            .iter()
            .any(|node| self.known[*node] == Known::Beyond)
        {
            return false;
        }
        let side_mm = side as f32 * self.lattice.step_mm as f32;
        let signs = [&self.fields.sides, &self.fields.between].map(|values| {
            let at = corners.iter().map(|node| values[*node]);
            let least = at.clone().fold(f32::INFINITY, f32::min);
            let largest = at.fold(f32::NEG_INFINITY, f32::max);
            let [flattest, steepest] = SLOPES;
            let slope = ((largest - least) / side_mm).clamp(flattest, steepest);
            // No place of the cell is farther from all corners.
            let farthest_mm = side_mm * 3.0_f32.sqrt() / 2.0;
            let (is_in, is_out) = (least > slope * farthest_mm, -largest > slope * farthest_mm);
            i32::from(is_in) - i32::from(is_out)
        });
        match signs {
            [1, 1] => {
                self.fill(cell, side);
                false
            }
            [a, b] => a.min(b) >= 0,
        }
    }

    /// What is not known in a cell is inside.
    fn fill(&mut self, [i, j, k]: [usize; 3], side: usize) {
        for k in k..=k + side {
            for j in j..=j + side {
                for i in i..=i + side {
                    let node = self.lattice.number([i, j, k]);
                    if self.known[node] == Known::Nothing {
                        self.fields.set(node, [1.0; 2]);
                    }
                }
            }
        }
    }
}
