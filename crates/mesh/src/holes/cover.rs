//! The triangles over one hole.

use bonemesh_task::{Cancelled, Task};
use rustc_hash::FxHashSet;

use super::around::{meeting_pairs, meets_surface};
use super::divide::divide;
use super::rims::Rim;
use super::triangulate::{Allowed, Polygon, triangulate};
use crate::exact::{Corners, has_area};
use crate::tree::TriangleTree;
use crate::vector::{Vector, cross, dot, minus, unit};

/// Rims with more corners are cut.
const MOST_CORNERS: usize = 160;
/// How often triangles that meet others are forbidden and the rest is tried.
const MOST_TRIES: usize = 24;

/// Two vertices, the lower first.
pub(super) type Edge = [u32; 2];

pub(super) fn edge(u: u32, v: u32) -> Edge {
    [u.min(v), u.max(v)]
}

/// Triangles that close the rim, make no edge non-manifold and meet nothing; `None` if there are none.
pub(super) fn cover(
    tree: &TriangleTree<'_>,
    rim: &[Rim],
    edges: &FxHashSet<Edge>,
    task: &Task,
) -> Result<Option<Vec<[u32; 3]>>, Cancelled> {
    let at = |vertex: u32| tree.mesh().vertices_mm()[vertex as usize];
    let places: Vec<Vector> = rim.iter().map(|rim| at(rim.from)).collect();
    let is_free = |i: usize, j: usize| !edges.contains(&edge(rim[i].from, rim[j].from));
    let Some(pieces) = divide(&places, MOST_CORNERS, is_free, task)? else {
        return Ok(None);
    };
    let pieces: Vec<Piece> = pieces
        .iter()
        .map(|numbers| Piece::of(tree, rim, numbers))
        .collect();
    let mut rules = Rules {
        tree,
        edges,
        forbidden: FxHashSet::default(),
        chords: FxHashSet::default(),
        looks_at_surface: false,
    };
    for _ in 0..MOST_TRIES {
        let Some(triangles) = rules.triangles(&pieces, task)? else {
            return Ok(None);
        };
        if rules.is_sound(&triangles) {
            return Ok(Some(triangles));
        }
    }
    Ok(None)
}

/// A part of a rim.
struct Piece {
    vertices: Vec<u32>,
    corners: Vec<Vector>,
    beyond: Vec<Option<Vector>>,
}

impl Piece {
    fn of(tree: &TriangleTree<'_>, rim: &[Rim], numbers: &[usize]) -> Self {
        let at = |vertex: u32| tree.mesh().vertices_mm()[vertex as usize];
        let vertices: Vec<u32> = numbers.iter().map(|&number| rim[number].from).collect();
        let next = |place: usize| vertices[(place + 1) % vertices.len()];
        let beyond = numbers.iter().enumerate().map(|(place, &number)| {
            let Rim { from, to, tip } = rim[number];
            let [a, b, c] = [to, from, tip].map(at);
            // Where the piece ends there is a chord and not the rim.
            let is_rim = next(place) == to;
            is_rim
                .then(|| unit(cross(minus(b, a), minus(c, a))))
                .flatten()
        });
        Self {
            beyond: beyond.collect(),
            corners: vertices.iter().map(|&vertex| at(vertex)).collect(),
            vertices,
        }
    }
}

/// What the triangles over a hole must keep to.
struct Rules<'a> {
    tree: &'a TriangleTree<'a>,
    /// Edges that are there.
    edges: &'a FxHashSet<Edge>,
    /// Triangles that were found to be in the way.
    forbidden: FxHashSet<[u32; 3]>,
    /// Chords that other pieces of the same rim have.
    chords: FxHashSet<Edge>,
    /// Whether each triangle is held against the surface before it is taken: what is seldom needed
    /// takes long.
    looks_at_surface: bool,
}

impl Rules<'_> {
    /// The best triangles by what is known now.
    fn triangles(
        &mut self,
        pieces: &[Piece],
        task: &Task,
    ) -> Result<Option<Vec<[u32; 3]>>, Cancelled> {
        let mut all = Vec::new();
        self.chords.clear();
        for piece in pieces {
            let polygon = Polygon {
                corners: &piece.corners,
                beyond: &piece.beyond,
            };
            let of_piece = OfPiece { rules: self, piece };
            let Some(triangles) = triangulate(&polygon, &of_piece, task)? else {
                return Ok(None);
            };
            let named = triangles
                .into_iter()
                .map(|t| t.map(|corner| piece.vertices[corner]));
            all.extend(named);
            if pieces.len() > 1 {
                let edges = all.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
                self.chords.extend(edges.map(|[u, v]| edge(u, v)));
            }
        }
        Ok(Some(all))
    }

    /// Whether triangles meet nothing; if not, forbids what is in the way.
    fn is_sound(&mut self, triangles: &[[u32; 3]]) -> bool {
        let before = self.forbidden.len();
        let corners: Vec<Corners> = triangles
            .iter()
            .map(|&triangle| self.tree.mesh().corners_mm(triangle))
            .collect();
        if !self.looks_at_surface {
            let tree = self.tree;
            let meeting = |corners: &&Corners| meets_surface(tree, corners);
            self.looks_at_surface = corners.iter().find(meeting).is_some();
            if self.looks_at_surface {
                return false;
            }
        }
        for pair in meeting_pairs(&corners) {
            let [a, b] = pair.map(|number| doubled_area_squared(&corners[number]));
            let larger = if b > a { pair[1] } else { pair[0] };
            self.forbidden.insert(sorted(triangles[larger]));
        }
        self.forbidden.len() == before
    }
}

/// The rules for the corners of one piece.
struct OfPiece<'a, 'b> {
    rules: &'a Rules<'b>,
    piece: &'a Piece,
}

impl Allowed for OfPiece<'_, '_> {
    fn chord(&self, from: usize, to: usize) -> bool {
        let chord = edge(self.piece.vertices[from], self.piece.vertices[to]);
        !self.rules.edges.contains(&chord) && !self.rules.chords.contains(&chord)
    }

    fn triangle(&self, corners: [usize; 3]) -> bool {
        let places = corners.map(|corner| self.piece.corners[corner]);
        let vertices = sorted(corners.map(|corner| self.piece.vertices[corner]));
        has_area(&places)
            && !self.rules.forbidden.contains(&vertices)
            && !(self.rules.looks_at_surface && meets_surface(self.rules.tree, &places))
    }
}

fn doubled_area_squared([a, b, c]: &Corners) -> f64 {
    let normal = cross(minus(*b, *a), minus(*c, *a));
    dot(normal, normal)
}

fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}
