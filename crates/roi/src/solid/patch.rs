//! Which part of the surface was meant.
//!
//! 1. [`Pieces`]: triangles with three selected corners, in pieces that share vertices. Where a direction is
//!    given, only those that face it.
//! 2. `without_crumbs`: pieces that a rough lasso leaves beside the large ones are dropped, and so are those
//!    behind others, which a lasso that sees through the bone picks up, unless they are asked for. Without a
//!    direction the eye is before the largest piece that nothing lies before.
//! 3. [`drop_flaps`]: what the selection takes of the surface around a rim is left out.
//! 4. `close_gaps`: small holes in what is left are closed.

use bonemesh_mesh::{Sets, TriangleMesh, TriangleTree};
use bonemesh_task::Task;

use super::crop::Neighbourhood;
use super::flaps::drop_flaps;
use crate::RoiError;
use crate::vector::{Vector, cross, dot, length, minus, plus_scaled, unit};

/// A piece with less than this part of the largest one's area is a crumb.
const CRUMB: f64 = 0.03;
/// A hole with less than this part of the patch's area is a gap, and so is one of less than so many mm2.
const GAP: f64 = 0.02;
const GAP_MM2: f64 = 2.0;
/// Triangles of a piece that are looked at to tell whether it lies behind.
const SAMPLES: usize = 32;
/// How far (mm) before a triangle a look towards the eye begins, so that it does not see the triangle itself.
const BEFORE_MM: f64 = 1e-3;

/// The selected part of a neighbourhood's surface.
pub(super) struct Patch {
    /// For each triangle whether it belongs to the patch.
    pub(super) has_triangle: Vec<bool>,
    pub(super) area_mm2: f64,
    /// Pieces that were dropped: crumbs, and those behind.
    pub(super) dropped: usize,
    /// Gaps that were closed.
    pub(super) closed: usize,
}

impl Patch {
    /// `is_selected`: by the neighbourhood's vertices. `view`: where the selection was looked at along.
    ///
    /// # Errors
    /// [`RoiError::NoFace`] where no triangle is selected, or none that can be seen.
    pub(super) fn of(
        near: &Neighbourhood,
        is_selected: &[bool],
        view: Option<Vector>,
        with_hidden: bool,
        task: &Task,
    ) -> Result<Self, RoiError> {
        let areas_mm2: Vec<f64> = near.triangles.iter().map(|t| near.area_mm2(*t)).collect();
        let view = view.filter(|_| !with_hidden);
        let is_chosen = |t: usize| {
            let triangle = near.triangles[t];
            triangle.iter().all(|v| is_selected[*v as usize])
                && view.is_none_or(|view| dot(near.facing(triangle), view) < 0.0)
        };
        let pieces = Pieces::of(near, &areas_mm2, is_chosen);
        if pieces.areas_mm2.is_empty() {
            return Err(RoiError::NoFace {
                selected: is_selected.iter().filter(|s| **s).count(),
            });
        }
        task.check()?;
        let is_kept = if with_hidden {
            vec![true; pieces.areas_mm2.len()]
        } else {
            pieces.without_crumbs(near, view, task)?
        };
        let is_of = |piece: &Option<u32>| piece.is_some_and(|piece| is_kept[piece as usize]);
        let mut has_triangle: Vec<bool> = pieces.of_triangles.iter().map(is_of).collect();
        drop_flaps(near, &mut has_triangle);
        let closed = close_gaps(near, &areas_mm2, &mut has_triangle);
        Ok(Self {
            area_mm2: area_mm2(&areas_mm2, &has_triangle),
            has_triangle,
            dropped: is_kept.iter().filter(|kept| !**kept).count(),
            closed,
        })
    }
}

impl Patch {
    /// The mean of the directions into the body, of length 1.
    pub(super) fn inward(&self, near: &Neighbourhood) -> Vector {
        let triangles = near.triangles.iter().zip(&self.has_triangle);
        let own = triangles.filter(|(_, has)| **has).map(|(t, _)| *t);
        unit(own.fold([0.0; 3], |sum, t| plus_scaled(sum, -1.0, near.facing(t))))
    }
}

/// The area of some of the triangles.
fn area_mm2(areas_mm2: &[f64], has_triangle: &[bool]) -> f64 {
    let areas = areas_mm2.iter().zip(has_triangle);
    areas.filter(|(_, has)| **has).map(|(area, _)| area).sum()
}

/// Adds the triangles of small holes to a patch; gives how many holes these were.
fn close_gaps(near: &Neighbourhood, areas_mm2: &[f64], has_triangle: &mut [bool]) -> usize {
    let most_mm2 = GAP_MM2.max(GAP * area_mm2(areas_mm2, has_triangle));
    let others = Pieces::of(near, areas_mm2, |t| !has_triangle[t]);
    let mut is_of_patch = vec![false; near.vertices_mm.len()];
    for (triangle, _) in near.triangles.iter().zip(&*has_triangle).filter(|t| *t.1) {
        for vertex in triangle {
            is_of_patch[*vertex as usize] = true;
        }
    }
    // What is as small but touches no patch is a crumb of bone beside it.
    let mut is_gap = vec![false; others.areas_mm2.len()];
    for (triangle, piece) in near.triangles.iter().zip(&others.of_triangles) {
        if let Some(piece) = piece
            && triangle.iter().any(|v| is_of_patch[*v as usize])
        {
            is_gap[*piece as usize] = others.areas_mm2[*piece as usize] < most_mm2;
        }
    }
    for (has, piece) in has_triangle.iter_mut().zip(&others.of_triangles) {
        *has |= piece.is_some_and(|piece| is_gap[piece as usize]);
    }
    is_gap.iter().filter(|gap| **gap).count()
}

impl Neighbourhood {
    /// Twice the area of a triangle in the direction that it faces.
    pub(crate) fn facing(&self, triangle: [u32; 3]) -> Vector {
        let [a, b, c] = triangle.map(|v| self.vertices_mm[v as usize]);
        cross(minus(b, a), minus(c, a))
    }

    fn area_mm2(&self, triangle: [u32; 3]) -> f64 {
        0.5 * length(self.facing(triangle))
    }
}

/// Triangles in pieces that share vertices.
struct Pieces {
    /// The piece of each triangle that is in one.
    of_triangles: Vec<Option<u32>>,
    areas_mm2: Vec<f64>,
}

impl Pieces {
    fn of(near: &Neighbourhood, areas_mm2: &[f64], is_in: impl Fn(usize) -> bool) -> Self {
        let mut sets = Sets::new(near.vertices_mm.len());
        for (_, &[a, b, c]) in near.triangles.iter().enumerate().filter(|(t, _)| is_in(*t)) {
            sets.join(a, b);
            sets.join(b, c);
        }
        let mut numbers = vec![None; near.vertices_mm.len()];
        let mut areas = Vec::new();
        let piece = |(triangle, corners): (usize, &[u32; 3])| {
            let root = sets.lowest(corners[0]);
            is_in(triangle).then(|| {
                let number = *numbers[root as usize].get_or_insert_with(|| {
                    areas.push(0.0);
                    areas.len() as u32 - 1
                });
                areas[number as usize] += areas_mm2[triangle];
                number
            })
        };
        let of_triangles = near.triangles.iter().enumerate().map(piece).collect();
        Self {
            of_triangles,
            areas_mm2: areas,
        }
    }

    /// Which pieces are large and not behind others. `view`: where the selection was looked at along.
    fn without_crumbs(
        &self,
        near: &Neighbourhood,
        view: Option<Vector>,
        task: &Task,
    ) -> Result<Vec<bool>, RoiError> {
        let largest_mm2 = self.areas_mm2.iter().copied().fold(0.0, f64::max);
        let is_large = |area: &f64| *area >= CRUMB * largest_mm2;
        let mut is_kept: Vec<bool> = self.areas_mm2.iter().map(is_large).collect();
        let large: Vec<u32> = (0..)
            .zip(&is_kept)
            .filter(|(_, kept)| **kept)
            .map(|(piece, _)| piece)
            .collect();
        if large.len() < 2 {
            return Ok(is_kept);
        }
        let triangles = near.triangles.iter().zip(&self.of_triangles);
        let own = triangles.filter(|(_, piece)| piece.is_some_and(|p| is_kept[p as usize]));
        let own = own.map(|(t, _)| *t).collect();
        let mesh = TriangleMesh::new(near.vertices_mm.clone(), own)?;
        let tree = TriangleTree::new(&mesh, task)?;
        let towards_eye = match view {
            Some(view) => view.map(|v| -v),
            None => self.front(&large, near, &tree),
        };
        for piece in large {
            is_kept[piece as usize] = !self.is_hidden(piece, near, &tree, towards_eye);
        }
        // Whatever the eye, something was meant.
        if !is_kept.contains(&true) {
            is_kept = self.areas_mm2.iter().map(is_large).collect();
        }
        Ok(is_kept)
    }

    /// Which way the largest piece faces that nothing lies before.
    fn front(&self, large: &[u32], near: &Neighbourhood, tree: &TriangleTree<'_>) -> Vector {
        let rank = |piece: &&u32| {
            let is_free = !self.is_hidden(**piece, near, tree, self.outward(**piece, near));
            (is_free, self.areas_mm2[**piece as usize])
        };
        let order = |a: &(bool, f64), b: &(bool, f64)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
        let ranked = large.iter().rev().map(|piece| (rank(&piece), piece));
        // The first of equal ones.
        let first = ranked.max_by(|(a, _), (b, _)| order(a, b));
        first.map_or([0.0; 3], |(_, piece)| self.outward(*piece, near))
    }

    fn of_piece<'a>(&'a self, piece: u32, near: &'a Neighbourhood) -> Vec<[u32; 3]> {
        let triangles = near.triangles.iter().zip(&self.of_triangles);
        let own = triangles.filter(|(_, of)| **of == Some(piece));
        own.map(|(t, _)| *t).collect()
    }

    fn outward(&self, piece: u32, near: &Neighbourhood) -> Vector {
        let facing = |t: &[u32; 3]| near.facing(*t);
        let own = self.of_piece(piece, near);
        let sum = own
            .iter()
            .map(facing)
            .fold([0.0; 3], |sum, n| plus_scaled(sum, 1.0, n));
        unit(sum)
    }

    /// Whether most of a piece lies behind another, or faces away.
    fn is_hidden(
        &self,
        piece: u32,
        near: &Neighbourhood,
        tree: &TriangleTree<'_>,
        towards_eye: Vector,
    ) -> bool {
        let own = self.of_piece(piece, near);
        let samples = own.iter().step_by(own.len().div_ceil(SAMPLES));
        let is_hidden = |triangle: &&[u32; 3]| {
            let [a, b, c] = triangle.map(|v| near.vertices_mm[v as usize]);
            let middle = [0, 1, 2].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0);
            let before = plus_scaled(middle, BEFORE_MM, towards_eye);
            dot(near.facing(**triangle), towards_eye) < 0.0
                || tree.first_hit(before, towards_eye, f64::INFINITY).is_some()
        };
        let hidden = samples.clone().filter(is_hidden).count();
        2 * hidden > samples.count()
    }
}
