//! Triangles whose three different corners lie in a line.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::topology::is_without_area;
use crate::vector::{Vector, dot, minus};

/// Triangles done between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;
/// Rounds after which what is left stays: each mends all needles whose neighbours are none.
const MOST_ROUNDS: usize = 64;

/// A triangle along its longest edge.
struct Needle {
    triangle: u32,
    /// The ends of the longest edge, the lower number first.
    edge: [u32; 2],
    /// The corner between them.
    middle: u32,
}

/// Takes needles out and divides their neighbours across the longest edge; gives how many are gone.
pub(super) fn divide_neighbours(
    vertices_mm: &[Vector],
    triangles: &mut Vec<[u32; 3]>,
    task: &Task,
) -> Result<usize, Cancelled> {
    let mut needles = needles(vertices_mm, triangles, task)?;
    let given = needles.len();
    for _ in 0..MOST_ROUNDS {
        if needles.is_empty() || !Round::new(triangles, &needles).mend(triangles, &needles) {
            break;
        }
        needles = self::needles(vertices_mm, triangles, task)?;
    }
    // What rounding leaves of a divided neighbour may be one more.
    Ok(given.saturating_sub(needles.len()))
}

fn needles(
    vertices_mm: &[Vector],
    triangles: &[[u32; 3]],
    task: &Task,
) -> Result<Vec<Needle>, Cancelled> {
    let chunks = triangles.par_chunks(STRIDE).enumerate();
    let found = chunks.map(|(chunk, triangles)| {
        task.check()?;
        let numbered = ((chunk * STRIDE) as u32..).zip(triangles);
        let needle = |(number, &triangle): (u32, &[u32; 3])| {
            let corners = triangle.map(|v| vertices_mm[v as usize]);
            is_without_area(corners).then(|| needle(number, triangle, corners))
        };
        Ok(numbered.filter_map(needle).collect())
    });
    Ok(found
        .collect::<Result<Vec<Vec<Needle>>, Cancelled>>()?
        .into_iter()
        .flatten()
        .collect())
}

fn needle(number: u32, [a, b, c]: [u32; 3], [p, q, r]: [Vector; 3]) -> Needle {
    let squared = |from: Vector, to: Vector| dot(minus(to, from), minus(to, from));
    let edges = [
        (squared(p, q), [a, b], c),
        (squared(q, r), [b, c], a),
        (squared(r, p), [c, a], b),
    ];
    let [first, second, third] = edges;
    let longer = if second.0 > first.0 { second } else { first };
    let (_, [from, to], middle) = if third.0 > longer.0 { third } else { longer };
    Needle {
        triangle: number,
        edge: [from.min(to), from.max(to)],
        middle,
    }
}

/// What is known around needles while they are mended one after another.
struct Round {
    /// The triangles at the longest edge of a needle.
    at_edges: FxHashMap<[u32; 2], Vec<u32>>,
    /// All edges with the middle corner of a needle.
    at_middles: FxHashSet<[u32; 2]>,
    /// The longest edge of each needle.
    longest: FxHashMap<u32, [u32; 2]>,
    /// Triangles that are not what they were at the beginning.
    touched: FxHashSet<u32>,
    gone: FxHashSet<u32>,
}

impl Round {
    fn new(triangles: &[[u32; 3]], needles: &[Needle]) -> Self {
        let middles: FxHashSet<u32> = needles.iter().map(|needle| needle.middle).collect();
        let mut at_edges: FxHashMap<[u32; 2], Vec<u32>> = FxHashMap::default();
        at_edges.extend(needles.iter().map(|needle| (needle.edge, Vec::new())));
        let mut at_middles = FxHashSet::default();
        for (number, triangle) in (0..).zip(triangles) {
            for edge in edges(*triangle) {
                if let Some(at_edge) = at_edges.get_mut(&edge) {
                    at_edge.push(number);
                }
                if edge.iter().any(|v| middles.contains(v)) {
                    at_middles.insert(edge);
                }
            }
        }
        Self {
            at_edges,
            at_middles,
            longest: needles.iter().map(|n| (n.triangle, n.edge)).collect(),
            touched: FxHashSet::default(),
            gone: FxHashSet::default(),
        }
    }

    /// Mends what can be mended at once; gives whether that is anything.
    fn mend(mut self, triangles: &mut Vec<[u32; 3]>, needles: &[Needle]) -> bool {
        for needle in needles {
            if !self.touched.contains(&needle.triangle) {
                self.mend_one(triangles, needle);
            }
        }
        let mut number = 0..;
        triangles.retain(|_| {
            !number
                .next()
                .is_some_and(|number| self.gone.contains(&number))
        });
        !self.touched.is_empty()
    }

    fn mend_one(&mut self, triangles: &mut [[u32; 3]], needle: &Needle) {
        let at_edge = self.at_edges.get(&needle.edge);
        let others = at_edge.into_iter().flatten().copied();
        let others: Vec<u32> = others.filter(|other| *other != needle.triangle).collect();
        match others[..] {
            // The surface ends here: its rim now runs through the middle corner.
            [] => self.drop(needle.triangle),
            [other] if !self.touched.contains(&other) => self.divide(triangles, needle, other),
            _ => {}
        }
    }

    fn drop(&mut self, triangle: u32) {
        self.touched.insert(triangle);
        self.gone.insert(triangle);
    }

    fn divide(&mut self, triangles: &mut [[u32; 3]], needle: &Needle, other: u32) {
        let [a, b, c] = triangles[other as usize];
        let is_edge = |from: u32, to: u32| [from.min(to), from.max(to)] == needle.edge;
        let (from, to, tip) = match () {
            () if is_edge(a, b) => (a, b, c),
            () if is_edge(b, c) => (b, c, a),
            () => (c, a, b),
        };
        let middle = needle.middle;
        if tip == middle {
            // One lies on the other.
            self.drop(needle.triangle);
            let [a, b, c] = triangles[needle.triangle as usize];
            if [[a, b], [b, c], [c, a]].contains(&[to, from]) {
                self.drop(other);
            }
            return;
        }
        let is_others_longest = |longest: &[u32; 2]| *longest == needle.edge;
        let is_ready = self.longest.get(&other).is_none_or(is_others_longest);
        // An edge that is there already would get triangles too many.
        if is_ready && self.at_middles.insert([middle.min(tip), middle.max(tip)]) {
            triangles[other as usize] = [from, middle, tip];
            triangles[needle.triangle as usize] = [middle, to, tip];
            self.touched.extend([other, needle.triangle]);
        }
    }
}

fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)])
}
