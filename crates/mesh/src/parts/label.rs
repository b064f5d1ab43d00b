//! Which triangle belongs to which part, and what each part is like.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use crate::TriangleMesh;
use crate::topology::Sets;
use crate::vector::{Vector, cross, dot, minus, plus_scaled};

/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 16;

/// The part of each triangle, parts numbered as they first come up.
pub(super) struct Labels {
    pub(super) of_triangles: Vec<u32>,
    pub(super) count: usize,
    /// By vertex, whether several parts meet there; empty if none do anywhere.
    is_shared: Vec<bool>,
}

/// What is known of a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Enclosed, below 0 if the part faces inward.
    pub(super) volume_mm3: f64,
    pub(super) triangles: usize,
    pub(super) is_closed: bool,
    /// Its vertex with the highest x, of those that are no other part's; else the middle of its first triangle.
    /// A ray from there along x tells what the part lies in.
    pub(super) tip: Vector,
    /// The innermost closed part that it lies in.
    pub(super) parent: Option<u32>,
    pub(super) is_cavity: bool,
}

impl Labels {
    pub(super) fn of(mesh: &TriangleMesh, task: &Task) -> Result<Self, Cancelled> {
        let mut sets = Sets::default();
        sets.reset(mesh.vertices_mm().len());
        for triangles in mesh.triangles().chunks(STRIDE) {
            for &[a, b, c] in triangles {
                sets.join(a, b);
                sets.join(b, c);
            }
            task.advance(triangles.len())?;
        }
        let of_sets = mesh.triangles().iter().map(|t| sets.lowest(t[0]));
        Ok(Self::numbered(of_sets, mesh.vertices_mm().len()))
    }

    /// Parts that share vertices with one another.
    ///
    /// `of_triangles` are any numbers below `limit`, equal within a part.
    pub(super) fn touching(
        mesh: &TriangleMesh,
        of_triangles: impl Iterator<Item = u32>,
        limit: usize,
    ) -> Self {
        let mut labels = Self::numbered(of_triangles, limit);
        let mut of_vertices = vec![u32::MAX; mesh.vertices_mm().len()];
        labels.is_shared = vec![false; mesh.vertices_mm().len()];
        for (triangle, label) in mesh.triangles().iter().zip(&labels.of_triangles) {
            for vertex in triangle.map(|vertex| vertex as usize) {
                let known = std::mem::replace(&mut of_vertices[vertex], *label);
                labels.is_shared[vertex] |= known != u32::MAX && known != *label;
            }
        }
        labels
    }

    fn numbered(of_triangles: impl Iterator<Item = u32>, limit: usize) -> Self {
        let mut numbers = vec![u32::MAX; limit];
        let mut count = 0;
        let label = |set: u32| {
            let number = &mut numbers[set as usize];
            if *number == u32::MAX {
                *number = count;
                count += 1;
            }
            *number
        };
        Self {
            of_triangles: of_triangles.map(label).collect(),
            count: count as usize,
            is_shared: Vec::new(),
        }
    }

    /// Volume, size and tip of each part; parents are not known yet.
    pub(super) fn parts(&self, mesh: &TriangleMesh, task: &Task) -> Result<Vec<Part>, Cancelled> {
        let Some(&origin) = mesh.vertices_mm().first() else {
            return Ok(Vec::new());
        };
        let chunks = mesh.triangles().par_chunks(STRIDE);
        let measures: Vec<Vec<(u32, Measure)>> = chunks
            .zip(self.of_triangles.par_chunks(STRIDE))
            .map(|(triangles, labels)| {
                task.check()?;
                Ok(measures(mesh, origin, triangles, labels, &self.is_shared))
            })
            .collect::<Result<_, Cancelled>>()?;
        let mut parts = vec![Measure::default(); self.count];
        // In the order of the chunks, which no number of threads changes.
        for (label, measure) in measures.iter().flatten() {
            parts[*label as usize].add(measure);
        }
        Ok(parts.iter().map(|part| part.part(origin)).collect())
    }
}

/// What is added up over the triangles of a part.
#[derive(Clone, Copy)]
struct Measure {
    /// Six times the volume between the triangles and the origin.
    volume6: f64,
    /// Twice the triangles' area along their normals; nothing for a closed part.
    area2: Vector,
    low: Vector,
    high: Vector,
    tip: Vector,
    /// The middle of the first triangle.
    middle: Option<Vector>,
    triangles: usize,
    rim: u64,
}

fn middle([a, b, c]: [Vector; 3]) -> Vector {
    [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0)
}

/// The one with the higher x, of equals the first.
fn further(a: Vector, b: Vector) -> Vector {
    if b[0] > a[0] { b } else { a }
}

impl Default for Measure {
    fn default() -> Self {
        Self {
            volume6: 0.0,
            area2: [0.0; 3],
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
            tip: [f64::NEG_INFINITY; 3],
            middle: None,
            triangles: 0,
            rim: 0,
        }
    }
}

/// The measures of the parts in some triangles, in the order in which the parts' runs come up.
fn measures(
    mesh: &TriangleMesh,
    origin: Vector,
    triangles: &[[u32; 3]],
    labels: &[u32],
    is_shared: &[bool],
) -> Vec<(u32, Measure)> {
    let mut found: Vec<(u32, Measure)> = Vec::new();
    for (triangle, &label) in triangles.iter().zip(labels) {
        // Triangles come in the order of the slices: one part's follow one another.
        if found.last().is_none_or(|(last, _)| *last != label) {
            found.push((label, Measure::default()));
        }
        if let Some((_, measure)) = found.last_mut() {
            let corners = mesh.corners_mm(*triangle);
            measure.see(corners, origin);
            measure.middle.get_or_insert_with(|| middle(corners));
            let is_own = |vertex: u32| is_shared.get(vertex as usize).is_none_or(|shared| !shared);
            for (_, corner) in triangle.iter().zip(corners).filter(|(v, _)| is_own(**v)) {
                measure.tip = further(measure.tip, corner);
            }
            measure.rim = measure.rim.wrapping_add(rim(*triangle));
        }
    }
    found
}

impl Measure {
    fn see(&mut self, corners: [Vector; 3], origin: Vector) {
        for corner in corners {
            self.reach(corner, corner);
        }
        let [a, b, c] = corners.map(|corner| minus(corner, origin));
        self.volume6 += dot(a, cross(b, c));
        self.area2 = plus_scaled(self.area2, 1.0, cross(minus(b, a), minus(c, a)));
        self.triangles += 1;
    }

    fn add(&mut self, other: &Self) {
        self.reach(other.low, other.high);
        self.tip = further(self.tip, other.tip);
        self.middle = self.middle.or(other.middle);
        self.volume6 += other.volume6;
        self.area2 = plus_scaled(self.area2, 1.0, other.area2);
        self.triangles += other.triangles;
        self.rim = self.rim.wrapping_add(other.rim);
    }

    fn reach(&mut self, low: Vector, high: Vector) {
        self.low = [0, 1, 2].map(|axis| self.low[axis].min(low[axis]));
        self.high = [0, 1, 2].map(|axis| self.high[axis].max(high[axis]));
    }

    fn part(&self, origin: Vector) -> Part {
        let middle = [0, 1, 2].map(|axis| f64::midpoint(self.low[axis], self.high[axis]));
        Part {
            volume_mm3: (self.volume6 - dot(self.area2, minus(middle, origin))) / 6.0,
            triangles: self.triangles,
            is_closed: self.rim == 0,
            tip: match self.middle {
                Some(middle) if self.tip[0] == f64::NEG_INFINITY => middle,
                _ => self.tip,
            },
            parent: None,
            is_cavity: false,
        }
    }
}

/// The triangles of each part.
pub(super) struct ByPart {
    starts: Vec<usize>,
    triangles: Vec<u32>,
}

impl ByPart {
    pub(super) fn of(&self, part: usize) -> &[u32] {
        &self.triangles[self.starts[part]..self.starts[part + 1]]
    }
}

impl Labels {
    /// Triangles in their order, part by part.
    pub(super) fn triangles_of_parts(&self) -> ByPart {
        let mut starts = vec![0; self.count + 1];
        for &label in &self.of_triangles {
            starts[label as usize + 1] += 1;
        }
        for part in 0..self.count {
            starts[part + 1] += starts[part];
        }
        let mut next = starts.clone();
        let mut triangles = vec![0; self.of_triangles.len()];
        for (number, &label) in (0..).zip(&self.of_triangles) {
            triangles[next[label as usize]] = number;
            next[label as usize] += 1;
        }
        ByPart { starts, triangles }
    }
}

/// A number for a triangle's three edges that cancels where another triangle runs along an edge the
/// other way: over a part without rims all add up to 0, and over one with rims, but for a chance of
/// one in 2^64, to something else.
fn rim([a, b, c]: [u32; 3]) -> u64 {
    let edges = [[a, b], [b, c], [c, a]].map(|[from, to]| {
        let scattered = scatter(u64::from(from.min(to)) << 32 | u64::from(from.max(to)));
        match from.cmp(&to) {
            std::cmp::Ordering::Less => scattered,
            std::cmp::Ordering::Equal => 0,
            std::cmp::Ordering::Greater => scattered.wrapping_neg(),
        }
    });
    edges.into_iter().fold(0, u64::wrapping_add)
}

/// A number that has nothing to do with its neighbours (Steele, Lea and Flood, *Fast splittable
/// pseudorandom number generators*, 2014).
fn scatter(number: u64) -> u64 {
    let mixed = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ mixed >> 31
}
