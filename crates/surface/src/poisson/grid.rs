//! A cube of nodes around the points.

/// Nodes of a cube, `nodes` along each side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    pub(super) nodes: usize,
    pub(super) cell_mm: f64,
    pub(super) origin_mm: [f64; 3],
}

/// A place in a grid: the lower corner of its cell and the way through it, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) cell: [u32; 3],
    pub(super) part: [f32; 3],
}

impl Grid {
    /// A cube of 2^depth cells a side, `scale` times as large as the points; `None` where these
    /// have no extent that can be divided.
    pub(super) fn around(points_mm: &[[f64; 3]], depth: u32, scale: f64) -> Option<Self> {
        let first = *points_mm.first()?;
        let (mut low, mut high) = (first, first);
        for p in points_mm {
            low = [0, 1, 2].map(|k| low[k].min(p[k]));
            high = [0, 1, 2].map(|k| high[k].max(p[k]));
        }
        let side_mm = scale * (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        let cells = 1usize << depth;
        let cell_mm = side_mm / cells as f64;
        let origin_mm = [0, 1, 2].map(|k| f64::midpoint(low[k], high[k]) - side_mm / 2.0);
        // Neighbouring nodes have to differ in numbers of this size.
        let size = origin_mm.iter().fold(side_mm, |s, v| s.max(v.abs()));
        let can_divide = cell_mm.is_finite() && cell_mm > size * 1e-12 && cell_mm > 1e-100;
        (can_divide && size < 1e100).then_some(Self {
            nodes: cells + 1,
            cell_mm,
            origin_mm,
        })
    }

    /// The grid of cells `2^steps` as large.
    pub(super) fn coarser(&self, steps: u32) -> Self {
        Self {
            nodes: ((self.nodes - 1) >> steps) + 1,
            cell_mm: self.cell_mm * f64::from(1u32 << steps),
            ..*self
        }
    }

    /// The cell of a place in mm.
    pub(super) fn place(&self, at_mm: [f64; 3]) -> Place {
        let last = (self.nodes - 2) as f64;
        let at = [0, 1, 2].map(|k| (at_mm[k] - self.origin_mm[k]) / self.cell_mm);
        let cell = at.map(|v| v.floor().clamp(0.0, last));
        Place {
            cell: cell.map(|v| v as u32),
            part: [0, 1, 2].map(|k| (at[k] - cell[k]).clamp(0.0, 1.0) as f32),
        }
    }
}

impl Place {
    /// The four nodes of one side of the cell, as places in their plane of nodes, and their
    /// weights; `upper` chooses the side along z.
    #[inline]
    pub(super) fn corners(&self, nodes: usize, upper: bool) -> [(usize, f32); 4] {
        let [x, y, z] = self.part;
        let side = if upper { z } else { 1.0 - z };
        let first = self.cell[1] as usize * nodes + self.cell[0] as usize;
        [
            (first, (1.0 - x) * (1.0 - y) * side),
            (first + 1, x * (1.0 - y) * side),
            (first + nodes, (1.0 - x) * y * side),
            (first + nodes + 1, x * y * side),
        ]
    }

    /// A function between its nodes.
    #[inline]
    pub(super) fn value(&self, nodes: usize, function: &[f32]) -> f32 {
        let mut value = 0.0;
        for upper in [false, true] {
            let plane = &function[(self.cell[2] as usize + usize::from(upper)) * nodes * nodes..];
            for (node, weight) in self.corners(nodes, upper) {
                value += weight * plane[node];
            }
        }
        value
    }
}
