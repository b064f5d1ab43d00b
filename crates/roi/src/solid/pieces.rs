//! Triangles in pieces that hang together, and which of the pieces lie behind others.

use bonemesh_mesh::{Sets, TriangleMesh, TriangleTree};
use bonemesh_task::Task;

use super::crop::Neighbourhood;
use crate::RoiError;
use bonemesh_mesh::vector::{Vector, dot, plus_scaled, unit_or_zero};

/// A piece with less than this part of the largest one's area is a crumb.
const CRUMB: f64 = 0.03;
/// Triangles of a piece that are looked at to tell whether it lies behind.
const SAMPLES: usize = 32;
/// How far (mm) before a triangle a look towards the eye begins, so that it does not see the triangle itself.
const BEFORE_MM: f64 = 1e-3;

/// Triangles in pieces that share vertices.
pub(super) struct Pieces<'a> {
    near: &'a Neighbourhood,
    /// The triangles of each piece, ascending.
    pub(super) triangles: Vec<Vec<u32>>,
    pub(super) areas_mm2: Vec<f64>,
}

impl<'a> Pieces<'a> {
    /// The pieces of some of the triangles, in the order of their first ones.
    pub(super) fn of(near: &'a Neighbourhood, is_in: &[bool]) -> Self {
        let members: Vec<u32> = (0..)
            .zip(is_in)
            .filter(|(_, is_in)| **is_in)
            .map(|(triangle, _)| triangle)
            .collect();
        let mut sets = Sets::new(near.vertices_mm.len());
        for member in &members {
            let [a, b, c] = near.triangles[*member as usize];
            sets.join(a, b);
            sets.join(b, c);
        }
        let mut numbers = vec![u32::MAX; near.vertices_mm.len()];
        let mut triangles: Vec<Vec<u32>> = Vec::new();
        for member in members {
            let root = sets.lowest(near.triangles[member as usize][0]);
            let number = &mut numbers[root as usize];
            if *number == u32::MAX {
                *number = triangles.len() as u32;
                triangles.push(Vec::new());
            }
            triangles[*number as usize].push(member);
        }
        let area = |piece: &Vec<u32>| piece.iter().map(|t| near.area_mm2(*t)).sum();
        let areas_mm2 = triangles.iter().map(area).collect();
        Self {
            near,
            triangles,
            areas_mm2,
        }
    }

    /// Which pieces are large and not behind others. `view`: where the selection was looked at along.
    pub(super) fn meant(&self, view: Option<Vector>, task: &Task) -> Result<Vec<bool>, RoiError> {
        let largest_mm2 = self.areas_mm2.iter().copied().fold(0.0, f64::max);
        let is_large = |area: &f64| *area >= CRUMB * largest_mm2;
        let mut is_meant: Vec<bool> = self.areas_mm2.iter().map(is_large).collect();
        let large: Vec<usize> = (0..is_meant.len()).filter(|p| is_meant[*p]).collect();
        if large.len() < 2 {
            return Ok(is_meant);
        }
        let own = large.iter().flat_map(|piece| &self.triangles[*piece]);
        let (own, _) = self.near.part(own.copied());
        let mesh = TriangleMesh::new(own.vertices_mm, own.triangles)?;
        let tree = TriangleTree::new(&mesh, task)?;
        let towards_eye = match view {
            Some(view) => view.map(|v| -v),
            None => self.front(&large, &tree),
        };
        for piece in large {
            is_meant[piece] = !self.is_hidden(piece, &tree, towards_eye);
        }
        // Whatever the eye, something was meant.
        if !is_meant.contains(&true) {
            is_meant = self.areas_mm2.iter().map(is_large).collect();
        }
        Ok(is_meant)
    }

    /// Which way the largest piece faces that nothing lies before.
    fn front(&self, large: &[usize], tree: &TriangleTree<'_>) -> Vector {
        let rank = |piece: usize| {
            let is_free = !self.is_hidden(piece, tree, self.outward(piece));
            (is_free, self.areas_mm2[piece])
        };
        let order = |a: &(bool, f64), b: &(bool, f64)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
        let ranked = large.iter().rev().map(|piece| (rank(*piece), *piece));
        // The first of equal ones.
        let first = ranked.max_by(|(a, _), (b, _)| order(a, b));
        first.map_or([0.0; 3], |(_, piece)| self.outward(piece))
    }

    fn outward(&self, piece: usize) -> Vector {
        let facings = self.triangles[piece].iter().map(|t| self.facing(*t));
        unit_or_zero(facings.fold([0.0; 3], |sum, n| plus_scaled(sum, 1.0, n)))
    }

    fn facing(&self, triangle: u32) -> Vector {
        self.near.facing(self.near.triangles[triangle as usize])
    }

    /// Whether most of a piece lies behind another, or faces away.
    fn is_hidden(&self, piece: usize, tree: &TriangleTree<'_>, towards_eye: Vector) -> bool {
        let own = &self.triangles[piece];
        let samples = own.iter().step_by(own.len().div_ceil(SAMPLES));
        let is_hidden = |triangle: &&u32| {
            let before = plus_scaled(self.near.middle(**triangle), BEFORE_MM, towards_eye);
            dot(self.facing(**triangle), towards_eye) < 0.0
                || tree.first_hit(before, towards_eye, f64::INFINITY).is_some()
        };
        let hidden = samples.clone().filter(is_hidden).count();
        2 * hidden > samples.count()
    }
}
