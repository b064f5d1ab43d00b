//! Edges of one triangle, followed to loops.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::TriangleMesh;
use crate::topology::{Incidence, Sets};
use crate::vector::{Vector, dot, minus, unit};

/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// An edge of one triangle, running as a triangle in the hole would: against that triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rim {
    pub(super) from: u32,
    pub(super) to: u32,
    /// The third corner of the triangle.
    pub(super) tip: u32,
}

/// Edges one after another; if it is closed, each vertex comes once.
pub(super) type Loop = Vec<Rim>;

/// All edges of one triangle.
pub(super) struct Rims {
    /// Closed ones.
    pub(super) loops: Vec<Loop>,
    /// The others, each piece with all that it is joined to.
    pub(super) open: Vec<Loop>,
}

impl Rims {
    pub(super) fn of(mesh: &TriangleMesh, task: &Task) -> Result<Self, Cancelled> {
        let mut all = edges_of_one(mesh, task)?;
        all.sort_unstable_by_key(|rim| (rim.from, rim.to));
        let mut walk = Walk::new(mesh, &all);
        // Where more edges leave than arrive no loop can begin; what is left after these is all loops.
        let surplus = walk.surplus();
        for first in surplus.into_iter().chain(0..all.len()) {
            task.check()?;
            if !walk.is_used[first] {
                walk.follow(first);
            }
        }
        let open = joined(&walk.open);
        let loops = walk.loops;
        Ok(Self { loops, open })
    }
}

/// Edges of exactly one triangle, in the order of the vertices at which that triangle leaves them.
fn edges_of_one(mesh: &TriangleMesh, task: &Task) -> Result<Vec<Rim>, Cancelled> {
    let incidence = Incidence::of(mesh);
    let vertices = incidence.vertices();
    let chunks = (0..vertices.div_ceil(STRIDE)).into_par_iter().map(|chunk| {
        let range = chunk * STRIDE..vertices.min((chunk + 1) * STRIDE);
        let mut rims = Vec::new();
        let mut ends = Vec::new();
        task.advance(range.len())?;
        for vertex in range {
            ends.clear();
            for &[next, previous] in incidence.at(vertex) {
                ends.extend([(next, true, previous), (previous, false, next)]);
            }
            ends.sort_unstable();
            for edge in ends.chunk_by(|a, b| a.0 == b.0) {
                if let &[(next, true, tip)] = edge {
                    rims.push(Rim {
                        from: next,
                        to: vertex as u32,
                        tip,
                    });
                }
            }
        }
        Ok(rims)
    });
    Ok(chunks.collect::<Result<Vec<_>, _>>()?.concat())
}

/// Edges on their way to loops.
struct Walk<'a> {
    mesh: &'a TriangleMesh,
    /// Sorted by where they begin.
    all: &'a [Rim],
    is_used: Vec<bool>,
    loops: Vec<Loop>,
    open: Vec<Rim>,
}

impl<'a> Walk<'a> {
    fn new(mesh: &'a TriangleMesh, all: &'a [Rim]) -> Self {
        Self {
            mesh,
            all,
            is_used: vec![false; all.len()],
            loops: Vec::new(),
            open: Vec::new(),
        }
    }

    /// Edges that begin where more leave than arrive, as many as are too many.
    fn surplus(&self) -> Vec<usize> {
        let mut arriving: FxHashMap<u32, usize> = FxHashMap::default();
        for rim in self.all {
            *arriving.entry(rim.to).or_default() += 1;
        }
        let surplus = |number: &usize| {
            let from = self.all[*number].from;
            match arriving.get_mut(&from) {
                Some(0) | None => true,
                Some(count) => {
                    *count -= 1;
                    false
                }
            }
        };
        (0..self.all.len()).filter(surplus).collect()
    }

    /// Follows edges from one on; whenever a vertex comes again, what lies between is a loop.
    fn follow(&mut self, first: usize) {
        let mut path: Loop = Vec::new();
        let mut places: FxHashMap<u32, usize> = FxHashMap::default();
        let mut next = Some(first);
        while let Some(number) = next {
            let rim = self.all[number];
            self.is_used[number] = true;
            places.insert(rim.from, path.len());
            path.push(rim);
            if let Some(&place) = places.get(&rim.to) {
                let closed = path.split_off(place);
                for rim in &closed {
                    places.remove(&rim.from);
                }
                self.loops.push(closed);
                if path.is_empty() {
                    return;
                }
            }
            next = self.onward(rim);
        }
        self.open.extend(path);
    }

    /// The unused edge after `rim`; of several the one at the smallest angle, that is of the
    /// narrowest gap.
    fn onward(&self, rim: Rim) -> Option<usize> {
        let first = self.all.partition_point(|other| other.from < rim.to);
        let count = self.all[first..].partition_point(|other| other.from == rim.to);
        let free = (first..first + count).filter(|number| !self.is_used[*number]);
        let at = |vertex: u32| self.mesh.vertices_mm()[vertex as usize];
        let away = |vertex: u32| unit(minus(at(vertex), at(rim.to))).unwrap_or_default();
        let back: Vector = away(rim.from);
        let nearness = |number: usize| dot(back, away(self.all[number].to));
        // The first of equals.
        free.rev()
            .max_by(|a, b| nearness(*a).total_cmp(&nearness(*b)))
    }
}

/// Edges in pieces that share no vertex.
fn joined(rims: &[Rim]) -> Vec<Loop> {
    let mut numbers: FxHashMap<u32, u32> = FxHashMap::default();
    let mut number_of = |vertex: u32| {
        let next = numbers.len() as u32;
        *numbers.entry(vertex).or_insert(next)
    };
    let ends: Vec<[u32; 2]> = rims
        .iter()
        .map(|rim| [number_of(rim.from), number_of(rim.to)])
        .collect();
    let mut sets = Sets::new(numbers.len());
    for [from, to] in &ends {
        sets.join(*from, *to);
    }
    let mut places: FxHashMap<u32, usize> = FxHashMap::default();
    let mut pieces: Vec<Loop> = Vec::new();
    for (rim, [from, _]) in rims.iter().zip(ends) {
        let place = *places.entry(sets.lowest(from)).or_insert_with(|| {
            pieces.push(Vec::new());
            pieces.len() - 1
        });
        pieces[place].push(*rim);
    }
    pieces
}
