//! Which part lies in which, by rays along x.
//!
//! 1. `Tips::of`: the places from which rays start, sorted into cells across x.
//! 2. `turns`: every triangle looks for the rays that pass it.
//! 3. `find_parents`: a ray crosses what encloses its part once more one way than the other.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::label::{Labels, Part};
use crate::TriangleMesh;
use crate::exact::{Passing, passing};
use crate::vector::Vector;

/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;
/// Cells along an axis, at most.
const MOST_CELLS: usize = 512;

/// Finds each part's parent and whether it is a cavity: of the parts around it, the innermost
/// encloses least.
pub(super) fn find_parents(
    mesh: &TriangleMesh,
    labels: &Labels,
    parts: &mut [Part],
    task: &Task,
) -> Result<(), Cancelled> {
    let turns = turns(mesh, labels, &Tips::of(parts), task)?;
    let mut parents = vec![None; parts.len()];
    for passed in turns.chunk_by(|a, b| (a.part, a.around) == (b.part, b.around)) {
        let (part, around) = (passed[0].part as usize, passed[0].around);
        let volume = |part: u32| parts[part as usize].volume_mm3.abs();
        let encloses = passed
            .iter()
            .map(|turn| i64::from(turn.outward))
            .sum::<i64>()
            != 0
            && parts[around as usize].is_closed
            && volume(around) > parts[part].volume_mm3.abs();
        if encloses && parents[part].is_none_or(|known| volume(around) < volume(known)) {
            parents[part] = Some(around);
        }
    }
    let is_outward = |parent: u32| parts[parent as usize].volume_mm3 > 0.0;
    let cavities = parts.iter().zip(&parents).map(|(part, parent)| {
        part.is_closed && part.volume_mm3 < 0.0 && parent.is_some_and(is_outward)
    });
    let cavities: Vec<bool> = cavities.collect();
    for ((part, parent), is_cavity) in parts.iter_mut().zip(parents).zip(cavities) {
        part.parent = parent;
        part.is_cavity = is_cavity;
    }
    Ok(())
}

/// A ray that passes a triangle of another part.
struct Turn {
    /// From whose tip the ray starts.
    part: u32,
    /// Whose triangle it is.
    around: u32,
    /// 1 outward, -1 inward.
    outward: i8,
}

/// All turns, sorted by part and by what is around it.
fn turns(
    mesh: &TriangleMesh,
    labels: &Labels,
    tips: &Tips,
    task: &Task,
) -> Result<Vec<Turn>, Cancelled> {
    task.begin("containment", mesh.triangles().len());
    let chunks = mesh.triangles().par_chunks(STRIDE);
    let turns: Vec<Vec<Turn>> = chunks
        .zip(labels.of_triangles.par_chunks(STRIDE))
        .map(|(triangles, labels)| {
            let mut turns = Vec::new();
            for (&triangle, &around) in triangles.iter().zip(labels) {
                let corners = mesh.corners_mm(triangle);
                tips.beside(&corners, |part, tip| {
                    let outward = match passing(&corners, tip) {
                        Passing::Outward if part != around => 1,
                        Passing::Inward if part != around => -1,
                        _ => return,
                    };
                    turns.push(Turn {
                        part,
                        around,
                        outward,
                    });
                });
            }
            task.advance(triangles.len())?;
            Ok(turns)
        })
        .collect::<Result<_, Cancelled>>()?;
    let mut turns: Vec<Turn> = turns.into_iter().flatten().collect();
    turns.par_sort_unstable_by_key(|turn| (turn.part, turn.around));
    task.check()?;
    Ok(turns)
}

/// The parts' tips by their cell across x.
struct Tips {
    low: [f64; 2],
    /// Cells for each mm.
    scale: [f64; 2],
    cells: usize,
    /// Where each cell's tips start, and the end.
    starts: Vec<u32>,
    sorted: Vec<(u32, Vector)>,
}

impl Tips {
    fn of(parts: &[Part]) -> Self {
        let fold = |f: fn(f64, f64) -> f64, from: f64| {
            [1, 2].map(|axis| parts.iter().map(|p| p.tip[axis]).fold(from, f))
        };
        let (low, high) = (
            fold(f64::min, f64::INFINITY),
            fold(f64::max, f64::NEG_INFINITY),
        );
        let cells = (parts.len() as f64).sqrt() as usize;
        let cells = cells.clamp(1, MOST_CELLS);
        let scale = [0, 1].map(|axis| {
            let extent = high[axis] - low[axis];
            if extent > 0.0 {
                cells as f64 / extent
            } else {
                0.0
            }
        });
        let mut tips = Self {
            low,
            scale,
            cells,
            starts: vec![0; cells * cells + 1],
            sorted: Vec::new(),
        };
        let cell = |tip: &Vector| tips.cell(1, tip[2]) * cells + tips.cell(0, tip[1]);
        let mut sorted: Vec<(usize, u32, Vector)> = (0..)
            .zip(parts)
            .map(|(part, known)| (cell(&known.tip), part, known.tip))
            .collect();
        sorted.sort_by_key(|(cell, part, _)| (*cell, *part));
        for (cell, ..) in &sorted {
            tips.starts[cell + 1] += 1;
        }
        for cell in 0..cells * cells {
            tips.starts[cell + 1] += tips.starts[cell];
        }
        tips.sorted = sorted
            .into_iter()
            .map(|(_, part, tip)| (part, tip))
            .collect();
        tips
    }

    /// The cell of a coordinate along y (0) or z (1), the outermost one of what lies beyond.
    fn cell(&self, axis: usize, at: f64) -> usize {
        // What is below becomes 0.
        let cell = ((at - self.low[axis]) * self.scale[axis]) as usize;
        cell.min(self.cells - 1)
    }

    /// The tips whose rays may pass a triangle.
    fn beside(&self, corners: &[Vector; 3], mut found: impl FnMut(u32, &Vector)) {
        let [low, high] = [f64::min as fn(f64, f64) -> f64, f64::max].map(|f| {
            [0, 1, 2].map(|axis| f(f(corners[0][axis], corners[1][axis]), corners[2][axis]))
        });
        let columns = self.cell(0, low[1])..=self.cell(0, high[1]);
        for row in self.cell(1, low[2])..=self.cell(1, high[2]) {
            let first = self.starts[row * self.cells + columns.start()];
            let end = self.starts[row * self.cells + columns.end() + 1];
            for (part, tip) in &self.sorted[first as usize..end as usize] {
                let is_beside = |axis: usize| tip[axis] < low[axis] || tip[axis] > high[axis];
                if tip[0] <= high[0] && !is_beside(1) && !is_beside(2) {
                    found(*part, tip);
                }
            }
        }
    }
}
