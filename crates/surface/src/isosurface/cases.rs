//! How a surface passes through a cube of eight voxels, for each of the 256 ways in which these
//! can be inside or outside.
//!
//! 1. `Case::turns`: on each face every run of inside corners is cut off by one segment, so that
//!    inside corners that meet only across a face's diagonal stay apart. The rule looks at the
//!    face alone, so the cubes on both sides draw the same segments.
//! 2. `loops`: the segments, all with the inside on one hand, join to closed loops around the
//!    cube: every cut edge is entered once and left once.
//! 3. `triangulate`: each loop is filled with triangles, none of whose inner edges lies in a face.
//!
//! Therefore the whole surface is a closed 2-manifold: a segment belongs to the two cubes of its
//! face, an inner edge to one cube and two of its triangles, and around a vertex, which lies on
//! an edge of four cubes, these have one fan each, joined in a ring. It passes through itself
//! nowhere, wherever on their edges its vertices lie, because each cube's triangles keep to themselves
//! (tested with exact predicates for all cases).
//!
//! After W. E. Lorensen, H. E. Cline, *Marching cubes*, 1987, and C. Montani, R. Scateni,
//! R. Scopigno, *A modified look-up table for implicit disambiguation of marching cubes*, 1994;
//! the table is computed, not copied.

use std::sync::LazyLock;

/// Corner `x + 2 y + 4 z` of the unit cube, each 0 or 1.
type Corner = u8;
/// The edge along axis `a` (0 to 2) at `low` and `high` of the other two axes, in their order:
/// `4 a + low + 2 high`.
pub(super) type Edge = u8;

/// No edge.
const NONE: Edge = Edge::MAX;

/// The triangles of every case over the edges they have corners on, seen from outside
/// counter-clockwise. Case `i` has corner `c` inside where bit `c` of `i` is set.
pub(super) static CASES: LazyLock<[Vec<[Edge; 3]>; 256]> =
    LazyLock::new(|| std::array::from_fn(|inside| triangles(inside as u8)));

/// Corners around each face, counter-clockwise from outside the cube.
const FACES: [[Corner; 4]; 6] = [
    [0, 4, 6, 2],
    [1, 3, 7, 5],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 2, 3, 1],
    [4, 5, 7, 6],
];

fn triangles(inside: u8) -> Vec<[Edge; 3]> {
    let loops = loops(inside);
    let filled = loops.iter().map(|edges| {
        triangulate(edges).expect("a loop can be filled without edges in faces: tested for all")
    });
    filled.collect::<Vec<_>>().concat()
}

/// The closed loops of the surface around the cube, as the edges they cross.
fn loops(inside: u8) -> Vec<Vec<Edge>> {
    let mut next = turns(inside);
    let mut loops = Vec::new();
    for first in 0..12 {
        let mut edges = Vec::new();
        let mut edge = first;
        while next[edge as usize] != NONE {
            edges.push(edge);
            edge = std::mem::replace(&mut next[edge as usize], NONE);
        }
        if !edges.is_empty() {
            loops.push(edges);
        }
    }
    loops
}

/// For each cut edge, the one to which a segment leads from it around a run of inside corners.
fn turns(inside: u8) -> [Edge; 12] {
    let is_inside = |corner: Corner| inside >> corner & 1 == 1;
    let mut next = [NONE; 12];
    for face in FACES {
        for i in 0..4 {
            let before = face[(i + 3) % 4];
            if is_inside(before) || !is_inside(face[i]) {
                continue;
            }
            // Corner `i` begins a run of inside corners; it ends before the next outside one.
            let mut last = i;
            while is_inside(face[(last + 1) % 4]) {
                last += 1;
            }
            let after = edge(face[last % 4], face[(last + 1) % 4]);
            next[edge(before, face[i]) as usize] = after;
        }
    }
    next
}

/// The edge between two neighbouring corners.
fn edge(a: Corner, b: Corner) -> Edge {
    let [x, y, z] = [0, 1, 2].map(|axis| (a & b) >> axis & 1);
    match a ^ b {
        1 => y + 2 * z,
        2 => 4 + x + 2 * z,
        _ => 8 + x + 2 * y,
    }
}

/// The corners at both ends of an edge, the lower first.
pub(super) fn ends(edge: Edge) -> [Corner; 2] {
    let (low, high) = (edge & 1, edge >> 1 & 1);
    let first = match edge >> 2 {
        0 => 2 * low + 4 * high,
        1 => low + 4 * high,
        _ => low + 2 * high,
    };
    [first, first | 1 << (edge >> 2)]
}

/// Whether two edges lie in one face.
fn share_face(a: Edge, b: Edge) -> bool {
    let ([p, q], [r, s]) = (ends(a), ends(b));
    // A bit that all four corners have, or none.
    (p & q & r & s) != 0 || (p | q | r | s) != 7
}

/// Triangles that fill a loop without an inner edge in a face, those with the best worst angle
/// where the cut edges are cut in the middle.
fn triangulate(edges: &[Edge]) -> Option<Vec<[Edge; 3]>> {
    fill(edges).map(|(_, triangles)| triangles)
}

/// [`triangulate`] with the worst shape of its triangles.
fn fill(edges: &[Edge]) -> Option<(f64, Vec<[Edge; 3]>)> {
    let (&[first, .., last], count) = (edges, edges.len()) else {
        return Some((f64::INFINITY, Vec::new()));
    };
    if count == 2 {
        return Some((f64::INFINITY, Vec::new()));
    }
    let mut best: Option<(f64, Vec<[Edge; 3]>)> = None;
    for apex in 1..count - 1 {
        let is_inner = |from: usize, to: usize| to - from > 1;
        let lies_in_face =
            |from: usize, to: usize| is_inner(from, to) && share_face(edges[from], edges[to]);
        if lies_in_face(0, apex) || lies_in_face(apex, count - 1) {
            continue;
        }
        let parts = (fill(&edges[..=apex]), fill(&edges[apex..]));
        let (Some((p, before)), Some((q, after))) = parts else {
            continue;
        };
        let triangle = [first, edges[apex], last];
        let worst = shape(triangle).min(p).min(q);
        if best.as_ref().is_none_or(|(shape, _)| worst > *shape) {
            best = Some((worst, [vec![triangle], before, after].concat()));
        }
    }
    best
}

/// Area over the sum of the squared sides, with the edges cut in the middle.
fn shape(triangle: [Edge; 3]) -> f64 {
    let middle = |edge: Edge| {
        let [a, b] = ends(edge);
        [0, 1, 2].map(|axis| f64::from((a >> axis & 1) + (b >> axis & 1)))
    };
    let [a, b, c] = triangle.map(middle);
    let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| p[k] - q[k]);
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let (u, v, w) = (minus(b, a), minus(c, a), minus(c, b));
    let squared_area = dot(u, u) * dot(v, v) - dot(u, v) * dot(u, v);
    squared_area.sqrt() / (dot(u, u) + dot(v, v) + dot(w, w))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_corner_inside_is_cut_off_facing_away_from_it() {
        let triangles = &CASES[1];
        assert_eq!(triangles.len(), 1);
        // Edges along x, y, z from corner 0, in this order seen from far outside.
        let start = triangles[0].iter().position(|&e| e == 0).unwrap();
        let turned: Vec<Edge> = (0..3).map(|i| triangles[0][(start + i) % 3]).collect();
        assert_eq!(turned, [0, 4, 8]);
    }

    #[test]
    fn every_case_fills_its_loops() {
        for inside in 0..=255u8 {
            let loops = loops(inside);
            let cut = |e: &Edge| {
                let [a, b] = ends(*e);
                (inside >> a & 1) != (inside >> b & 1)
            };
            let mut crossed: Vec<Edge> = loops.concat();
            crossed.sort_unstable();
            let expected: Vec<Edge> = (0..12).filter(cut).collect();
            assert_eq!(crossed, expected, "every cut edge is crossed once");
            let triangles: usize = loops.iter().map(|l| l.len() - 2).sum();
            assert_eq!(CASES[inside as usize].len(), triangles);
        }
    }

    #[test]
    fn an_edge_is_named_by_its_ends() {
        for e in 0..12 {
            let [a, b] = ends(e);
            assert_eq!(edge(a, b), e);
            assert_eq!(edge(b, a), e);
        }
        assert!(share_face(0, 1) && !share_face(0, 3));
    }
}
