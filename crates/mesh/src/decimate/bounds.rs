//! What may be done with each vertex.

use bonemesh_task::{Cancelled, Task};
use rustc_hash::FxHashMap;

use super::faults::Faults;
use crate::stars::{MOST, Stars};

/// How a limit (squared) that was too wide is narrowed.
#[derive(Clone, Copy)]
struct Narrowing {
    /// The part of it that is left in the next round.
    part: f64,
    /// Times that it is narrowed before the vertex keeps all its triangles.
    most: u8,
}

/// Where the surface came further away than the error bound.
const TOO_FAR: Narrowing = Narrowing {
    part: 0.25,
    most: 2,
};
/// Where triangles met without an error bound. A vertex may stand for thousands there, which all
/// would stay: so the way back has more steps, and they are smaller.
const MEETING: Narrowing = Narrowing {
    part: 0.5,
    most: 10,
};
/// Where triangles met in spite of an error bound: few stand for one vertex, and a narrower limit
/// rarely helps them.
const MEETING_IN_BOUND: Narrowing = Narrowing { part: 0.0, most: 0 };

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
    /// How often each limit was narrowed.
    narrowed: Vec<u8>,
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
            narrowed: vec![0; is_closed.len()],
            holds: (0..).zip(is_closed).map(hold).collect(),
            error_mm,
            held: 0,
        })
    }

    /// Narrows the bounds of what the faults' vertices stand for; says where.
    ///
    /// Each gets some tries with a narrower limit before it keeps all its triangles. Without an error
    /// bound the first limit is what was `reached` (mm2, squared) at each vertex of triangles that
    /// meet.
    pub(super) fn narrowed(
        &mut self,
        faults: &Faults,
        standing: &[u32],
        reached: &FxHashMap<u32, f64>,
    ) -> Vec<bool> {
        let marked = |vertices: &[u32]| {
            let mut is_marked = vec![false; standing.len()];
            for vertex in vertices {
                is_marked[*vertex as usize] = true;
            }
            is_marked
        };
        let (is_meeting, is_far) = (marked(&faults.meeting), marked(&faults.far));
        let is_bound = self.error_mm.is_some();
        let meeting = if is_bound { MEETING_IN_BOUND } else { MEETING };
        let mut is_narrowed = vec![false; standing.len()];
        for (vertex, stands) in standing.iter().enumerate() {
            let [meets, is_far] = [&is_meeting, &is_far].map(|is| is[*stands as usize]);
            if !(meets || is_far) || self.holds[vertex] == Hold::Star {
                continue;
            }
            is_narrowed[vertex] = true;
            let Narrowing { part, most } = if meets { meeting } else { TOO_FAR };
            if self.narrowed[vertex] >= most {
                self.holds[vertex] = Hold::Star;
                self.held += 1;
                continue;
            }
            let limit = &mut self.limits[vertex];
            if !is_bound {
                *limit = limit.min(reached[stands]);
            }
            *limit *= part;
            self.narrowed[vertex] += 1;
        }
        is_narrowed
    }
}
