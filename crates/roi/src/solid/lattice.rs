//! Where the cutter's values are taken.

use bonemesh_volume::Affine;

use super::space::Space;
use bonemesh_mesh::vector::{Vector, cross, dot, plus_scaled, unit_or_zero};

/// Largest and smallest step between nodes (mm).
const STEPS_MM: [f64; 2] = [1.2, 0.06];
/// At least so many steps in the thickness, and in the patch's width.
const IN_THICKNESS: f64 = 4.0;
const IN_WIDTH: f64 = 12.0;
/// At most so many steps in the patch's width.
const MOST_IN_WIDTH: f64 = 250.0;
/// Most nodes of a lattice.
const MOST_NODES: f64 = 2e7;
/// Steps along the side of a coarse cell; a power of two.
pub(super) const COARSE: usize = 4;

/// Steps from a box to the first node: as unlike one another as can be, so that what lies along the axes
/// does not pass through nodes.
const BEFORE: [f64; 3] = [0.381_966_011, 0.245_122_334, 0.180_827_487];

/// Three directions of length 1 at right angles, right-handed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame(pub(super) [Vector; 3]);

impl Frame {
    /// The patient's own.
    pub(super) const PATIENT: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    /// One whose third direction is this.
    pub(crate) fn along(third: Vector) -> Self {
        let least = (0..3).min_by(|a, b| third[*a].abs().total_cmp(&third[*b].abs()));
        let mut beside = [0.0; 3];
        beside[least.unwrap_or(0)] = 1.0;
        let first = unit_or_zero(cross(beside, third));
        Self([first, cross(third, first), third])
    }

    /// A place's coordinates in it.
    pub(crate) fn of(&self, place: Vector) -> Vector {
        self.0.map(|axis| dot(axis, place))
    }

    /// The place of coordinates in it.
    pub(super) fn place(&self, [x, y, z]: Vector) -> Vector {
        let [first, second, third] = self.0;
        plus_scaled(plus_scaled(first.map(|v| x * v), y, second), z, third)
    }
}

/// Nodes at equal steps along the directions of a frame, in whole coarse cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    pub(super) frame: Frame,
    /// The first node's coordinates in the frame.
    pub(super) first: Vector,
    pub(super) step_mm: f64,
    pub(super) shape: [usize; 3],
}

/// How far apart nodes are for a patch and a thickness.
pub(super) fn step_mm(area_mm2: f64, thickness_mm: f64) -> f64 {
    let [largest, least] = STEPS_MM;
    let step = (thickness_mm / IN_THICKNESS).min(area_mm2.sqrt() / IN_WIDTH);
    step.clamp(least, largest)
        .max(area_mm2.sqrt() / MOST_IN_WIDTH)
}

/// The step with which a lattice of that size has not too many nodes.
pub(super) fn affordable_mm(space: &Space, step_mm: f64) -> f64 {
    let size = [0, 1, 2].map(|axis| space.high[axis] - space.low[axis]);
    step_mm.max((size.iter().product::<f64>() / MOST_NODES).cbrt())
}

impl Lattice {
    /// Fills `space`, a box in the frame.
    pub(super) fn around(frame: Frame, space: Space, step_mm: f64) -> Self {
        let nodes = |axis: usize| {
            let size = space.high[axis] - space.low[axis];
            let steps = (size / step_mm).ceil() as usize + 2;
            steps.next_multiple_of(COARSE) + 1
        };
        Self {
            frame,
            first: [0, 1, 2].map(|axis| space.low[axis] - BEFORE[axis] * step_mm),
            step_mm,
            shape: [0, 1, 2].map(nodes),
        }
    }

    /// How many nodes there are.
    pub(super) fn nodes(&self) -> usize {
        self.shape.iter().product()
    }

    /// A node's number, along the first axis first.
    pub(super) fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.shape[1] + j) * self.shape[0] + i
    }

    /// The first node of each coarse cell.
    pub(super) fn coarse_cells(&self) -> impl Iterator<Item = [usize; 3]> {
        let [columns, rows, slices] = self.shape.map(|nodes| (nodes - 1) / COARSE);
        let cell = move |c: usize| [c % columns, c / columns % rows, c / columns / rows];
        (0..columns * rows * slices).map(move |c| cell(c).map(|place| place * COARSE))
    }

    pub(super) fn place(&self, node: [usize; 3]) -> Vector {
        let at = [0, 1, 2].map(|axis| self.first[axis] + self.step_mm * node[axis] as f64);
        self.frame.place(at)
    }

    /// From nodes to millimetres.
    pub(super) fn affine(&self) -> Affine {
        let [first, second, third] = self.frame.0.map(|axis| axis.map(|v| self.step_mm * v));
        Affine::from_axes(first, second, third, self.frame.place(self.first))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_along_a_direction_is_right_handed_and_gives_places_back() {
        for third in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.6, -0.48, 0.64]] {
            let frame = Frame::along(third);
            let [a, b, c] = frame.0;
            assert!((dot(cross(a, b), c) - 1.0).abs() < 1e-12);
            let place = [3.0, -7.0, 11.0];
            let back = frame.place(frame.of(place));
            assert!((0..3).all(|i| (back[i] - place[i]).abs() < 1e-12));
            assert!((frame.of(third)[2] - 1.0).abs() < 1e-12);
        }
    }
}
