//! What may be done with each vertex.

use bonemesh_task::{Cancelled, Task};

use super::faults::Faults;
use crate::stars::{MOST, Stars};

/// A limit that was too wide is this part of it in the next round.
const NARROWER: f64 = 0.25;
/// Times that a limit is narrowed before the vertex keeps all its triangles.
const MOST_NARROWED: i32 = 2;

/// What may be done with a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hold {
    /// It may move and go.
    Free,
    /// It stays in its place, but neighbours may collapse onto it.
    Place,
    /// It stays with all triangles at it.
    Star,
}

/// The bounds of all vertices of the given mesh.
pub(super) struct Bounds {
    pub(super) holds: Vec<Hold>,
    /// How far (mm2, squared) the surface may come away from each vertex; infinite without an error
    /// bound.
    pub(super) limits: Vec<f64>,
    pub(super) error_mm: Option<f64>,
    /// Vertices that keep all their triangles because of faults.
    pub(super) held: usize,
}

impl Bounds {
    /// Only vertices with one closed fan of triangles are free.
    pub(super) fn new(
        stars: &Stars,
        error_mm: Option<f64>,
        task: &Task,
    ) -> Result<Self, Cancelled> {
        let is_closed = stars.closed_fans(task)?;
        let mut star = Vec::new();
        let hold = |(vertex, is_closed): (u32, bool)| {
            if is_closed {
                return Hold::Free;
            }
            stars.at(vertex, &mut star);
            if star.len() > MOST {
                Hold::Star
            } else {
                Hold::Place
            }
        };
        let limit = error_mm.map_or(f64::INFINITY, |error_mm| error_mm * error_mm);
        Ok(Self {
            limits: vec![limit; is_closed.len()],
            holds: (0..).zip(is_closed).map(hold).collect(),
            error_mm,
            held: 0,
        })
    }

    /// Narrows the bounds of what the faults' vertices stand for; says where.
    ///
    /// What is too far gets another try or two with a narrower limit. Triangles that meet may do so
    /// again whatever the limit.
    pub(super) fn narrowed(&mut self, faults: &Faults, standing: &[u32]) -> Vec<bool> {
        let marked = |vertices: &[u32]| {
            let mut is_marked = vec![false; standing.len()];
            for vertex in vertices {
                is_marked[*vertex as usize] = true;
            }
            is_marked
        };
        let (is_meeting, is_far) = (marked(&faults.meeting), marked(&faults.far));
        let widest = self.error_mm.unwrap_or(f64::INFINITY).powi(2);
        let narrowest = 0.9 * widest * NARROWER.powi(MOST_NARROWED);
        let mut is_narrowed = vec![false; standing.len()];
        for (vertex, stands) in standing.iter().map(|v| *v as usize).enumerate() {
            let is_faulty = is_meeting[stands] || is_far[stands];
            if !is_faulty || self.holds[vertex] == Hold::Star {
                continue;
            }
            is_narrowed[vertex] = true;
            self.limits[vertex] *= NARROWER;
            if is_meeting[stands] || self.limits[vertex] < narrowest {
                self.holds[vertex] = Hold::Star;
                self.held += 1;
            }
        }
        is_narrowed
    }
}
