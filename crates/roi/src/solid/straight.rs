//! What lies straight behind the patch, along one direction.
//!
//! The patch is a relief over the plane across the direction: where several parts of it lie behind one
//! another, the first counts. Parts that face the other way play no part.

use bonemesh_task::Task;
use rayon::prelude::*;

use super::fields::Fields;
use super::lattice::Lattice;
use super::sheet::Sheet;
use crate::RoiError;
use bonemesh_mesh::vector::{Vector, cross, minus};

/// Below this cosine a triangle is seen edge on.
const EDGE_ON: f64 = 1e-3;

/// What is inside, straight behind a sheet along the lattice's third direction.
pub(super) struct Straight<'a> {
    pub(super) sheet: &'a Sheet,
    /// Where it begins (mm), below 0 before the patch.
    pub(super) top_mm: f64,
}

/// What of the sheet is seen on a line along the direction.
#[derive(Clone, Copy)]
struct Seen {
    /// In steps from the first slice of nodes.
    height: f64,
    inside_mm: f64,
    bottom_mm: f64,
}

impl Straight<'_> {
    pub(super) fn fields(&self, lattice: &Lattice, task: &Task) -> Result<Fields, RoiError> {
        let slice = lattice.shape[0] * lattice.shape[1];
        let relief = self.relief(lattice);
        task.begin("cutter", lattice.shape[2]);
        let mut fields = Fields::outside(lattice.nodes());
        fields
            .sides
            .par_chunks_mut(slice)
            .zip(fields.between.par_chunks_mut(slice))
            .enumerate()
            .try_for_each(|(k, (sides, between))| {
                let nodes = sides.iter_mut().zip(between).zip(&relief);
                for ((side, between), seen) in nodes {
                    if let Some(seen) = seen {
                        let depth = (k as f64 - seen.height) * lattice.step_mm;
                        *side = seen.inside_mm as f32;
                        *between = (depth - self.top_mm).min(seen.bottom_mm - depth) as f32;
                    }
                }
                task.advance(1)
            })?;
        Ok(fields)
    }

    /// What is seen on each line of nodes.
    fn relief(&self, lattice: &Lattice) -> Vec<Option<Seen>> {
        let [columns, rows, _] = lattice.shape;
        let mut relief: Vec<Option<Seen>> = vec![None; columns * rows];
        let at = |v: u32| {
            let place = lattice.frame.of(self.sheet.mesh.vertices_mm()[v as usize]);
            [0, 1, 2].map(|axis| (place[axis] - lattice.first[axis]) / lattice.step_mm)
        };
        for triangle in self.sheet.mesh.triangles() {
            let corners = triangle.map(at);
            let [a, b, c] = corners;
            let facing = cross(minus(b, a), minus(c, a));
            // What faces along the direction is the far side.
            if facing[2] > -EDGE_ON * (facing[0].abs() + facing[1].abs()) {
                continue;
            }
            let mean = |weights: Vector, values: &[f64]| -> f64 {
                let values = triangle.iter().map(|v| values[*v as usize]);
                weights.iter().zip(values).map(|(w, v)| w * v).sum()
            };
            for (i, j, weights) in covered(corners, [columns, rows]) {
                let seen = Seen {
                    height: (0..3)
                        .map(|corner| weights[corner] * corners[corner][2])
                        .sum(),
                    inside_mm: mean(weights, &self.sheet.inside_mm),
                    bottom_mm: mean(weights, &self.sheet.bottom_mm),
                };
                let before = &mut relief[j * columns + i];
                if before.is_none_or(|before| seen.is_rather_than(&before)) {
                    *before = Some(seen);
                }
            }
        }
        relief
    }
}

impl Seen {
    /// Whether it counts where both are on one line: the patch before what is beside it, the nearer
    /// part of the patch before the other.
    fn is_rather_than(&self, other: &Self) -> bool {
        match (self.inside_mm > 0.0, other.inside_mm > 0.0) {
            (true, true) => self.height < other.height,
            (true, false) => true,
            (false, true) => false,
            (false, false) => self.inside_mm > other.inside_mm,
        }
    }
}

/// The nodes of the plane that a triangle covers, each with the weights of its corners.
pub(crate) fn covered(
    [a, b, c]: [Vector; 3],
    shape: [usize; 2],
) -> impl Iterator<Item = (usize, usize, Vector)> {
    /// So that a node on a common edge is not missed by both triangles.
    const SLACK: f64 = 1e-9;
    let range = |axis: usize| {
        let low = a[axis].min(b[axis]).min(c[axis]).ceil().max(0.0) as usize;
        let high = a[axis].max(b[axis]).max(c[axis]).floor();
        let end = if high < 0.0 { 0 } else { high as usize + 1 };
        low..end.min(shape[axis])
    };
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let part = move |from: Vector, to: Vector, x: f64, y: f64| {
        ((to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0])) / area
    };
    let columns = range(0);
    range(1).flat_map(move |j| {
        columns.clone().filter_map(move |i| {
            let [x, y] = [i, j].map(|node| node as f64);
            let weights = [part(b, c, x, y), part(c, a, x, y), part(a, b, x, y)];
            let is_inside = weights.iter().all(|weight| *weight >= -SLACK);
            is_inside.then_some((i, j, weights))
        })
    })
}
