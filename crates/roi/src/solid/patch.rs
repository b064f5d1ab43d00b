//! A patch of the surface and what lies around it.
//!
//! 1. [`Meant::of`]: which part of the surface was meant. Triangles with three selected corners come in
//!    [`Pieces`]; where a direction is given, only those count that face it. Pieces that a rough lasso leaves
//!    beside the large ones are dropped, and so are those behind others, which a lasso that sees through the
//!    bone picks up, unless they are asked for. Without a direction the eye is before the largest piece that
//!    nothing lies before.
//! 2. [`drop_flaps`]: what the selection takes of the surface around a rim is left out.
//! 3. `close_gaps`: small holes in what is left are closed.

use std::collections::BTreeMap;

use bonemesh_mesh::Sets;
use bonemesh_task::Task;
use rayon::prelude::*;
use rustc_hash::FxHashSet;

use super::crop::Neighbourhood;
use super::flaps::drop_flaps;
use super::pieces::Pieces;
use super::space::Space;
use crate::RoiError;
use crate::selection::Selection;
use bonemesh_mesh::vector::{Vector, dot, plus_scaled, unit_or_zero};

/// A hole with less than this part of the patch's area is a gap, and so is one of less than so many mm2.
const GAP: f64 = 0.02;
const GAP_MM2: f64 = 2.0;
/// No hole is a gap that has more than this part.
const LARGEST_GAP: f64 = 0.25;

/// A patch on a part of a mesh.
#[derive(Clone)]
pub(super) struct Patch {
    pub(super) near: Neighbourhood,
    /// By triangle: whether it belongs to the patch.
    pub(super) has_triangle: Vec<bool>,
    /// By vertex.
    pub(super) is_selected: Vec<bool>,
}

impl Patch {
    /// Its triangles' numbers.
    pub(super) fn own(&self) -> impl Iterator<Item = u32> + Clone + '_ {
        let triangles = (0..).zip(&self.has_triangle);
        triangles.filter(|(_, has)| **has).map(|(t, _)| t)
    }

    pub(super) fn area_mm2(&self) -> f64 {
        self.own().map(|t| self.near.area_mm2(t)).sum()
    }

    /// The mean of the directions into the body, of length 1.
    pub(super) fn inward(&self) -> Vector {
        let own = self.own().map(|t| self.near.triangles[t as usize]);
        unit_or_zero(own.fold([0.0; 3], |sum, t| {
            plus_scaled(sum, -1.0, self.near.facing(t))
        }))
    }

    /// Its box; `None` of a patch without triangles.
    pub(super) fn space(&self) -> Option<Space> {
        self.near.space(self.own())
    }

    /// Its triangles as the whole mesh numbers their corners.
    pub(super) fn of_mesh(&self) -> FxHashSet<[u32; 3]> {
        let own = self.own().map(|t| self.near.triangles[t as usize]);
        own.map(|t| t.map(|v| self.near.of_mesh[v as usize]))
            .collect()
    }

    /// What of it and around it touches `space`.
    pub(super) fn restricted(&self, space: &Space) -> Self {
        self.restricted_with(&self.has_triangle, space)
    }

    /// The same of another patch in its place.
    fn restricted_with(&self, has_triangle: &[bool], space: &Space) -> Self {
        let places = &self.near.vertices_mm;
        let touching = |t: &u32| {
            let triangle = self.near.triangles[*t as usize];
            space.touches(triangle.map(|v| places[v as usize]))
        };
        let kept: Vec<u32> = (0..self.near.triangles.len() as u32)
            .into_par_iter()
            .filter(touching)
            .collect();
        let (near, members) = self.near.part(kept.iter().copied());
        Self {
            near,
            has_triangle: kept.iter().map(|t| has_triangle[*t as usize]).collect(),
            is_selected: members
                .iter()
                .map(|v| self.is_selected[*v as usize])
                .collect(),
        }
    }

    /// Its pieces that do not touch, the largest first; those whose boxes are nearer to one another than
    /// twice `reach_mm`, if it is given, as one. Each with what lies around it as far as `beside_mm`.
    pub(super) fn parts(&self, reach_mm: Option<f64>, beside_mm: f64) -> Vec<Self> {
        let pieces = Pieces::of(&self.near, &self.has_triangle);
        let mut order: Vec<usize> = (0..pieces.triangles.len()).collect();
        order.sort_by(|a, b| pieces.areas_mm2[*b].total_cmp(&pieces.areas_mm2[*a]));
        let mut sets = Sets::new(order.len());
        if let Some(reach_mm) = reach_mm {
            let space = |piece: &usize| self.near.space(pieces.triangles[*piece].iter().copied());
            let spaces = order.iter().filter_map(space);
            let spaces: Vec<Space> = spaces.map(|space| space.wider(reach_mm)).collect();
            for (a, space) in (0..).zip(&spaces) {
                for (b, other) in (0..a).zip(&spaces) {
                    if space.meets(other) {
                        sets.join(a, b);
                    }
                }
            }
        }
        let mut parts: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (number, piece) in (0..).zip(order) {
            let part = parts.entry(sets.lowest(number)).or_default();
            part.extend(&pieces.triangles[piece]);
        }
        let part = |triangles: Vec<u32>| {
            let space = self.near.space(triangles.iter().copied())?;
            let mut has_triangle = vec![false; self.has_triangle.len()];
            for triangle in triangles {
                has_triangle[triangle as usize] = true;
            }
            Some(self.restricted_with(&has_triangle, &space.wider(beside_mm)))
        };
        parts.into_values().filter_map(part).collect()
    }
}

/// The part of the surface that was meant by a selection.
pub(super) struct Meant {
    pub(super) patch: Patch,
    /// Pieces that were dropped: crumbs, and those behind.
    pub(super) dropped: usize,
    /// Gaps that were closed.
    pub(super) closed: usize,
}

impl Meant {
    /// `near`: what lies around the selection. `view`: where the selection was looked at along, unless
    /// hidden pieces count, too.
    ///
    /// # Errors
    /// [`RoiError::NoFace`] where no triangle is selected, [`RoiError::FacesAway`] where none can be seen.
    pub(super) fn of(
        near: Neighbourhood,
        selection: &Selection,
        view: Option<Vector>,
        with_hidden: bool,
        beside_mm: f64,
        task: &Task,
    ) -> Result<Self, RoiError> {
        let of_mesh = near.of_mesh.iter();
        let is_selected: Vec<bool> = of_mesh.map(|v| selection.contains(*v)).collect();
        let view = view.filter(|_| !with_hidden);
        let is_chosen = |triangle: &[u32; 3]| {
            triangle.iter().all(|v| is_selected[*v as usize])
                && view.is_none_or(|view| dot(near.facing(*triangle), view) < 0.0)
        };
        let mut has_triangle: Vec<bool> = near.triangles.par_iter().map(is_chosen).collect();
        let pieces = Pieces::of(&near, &has_triangle);
        if pieces.triangles.is_empty() {
            let is_own = |t: &[u32; 3]| t.iter().all(|v| is_selected[*v as usize]);
            return Err(if near.triangles.iter().any(is_own) {
                RoiError::FacesAway
            } else {
                RoiError::NoFace {
                    selected: selection.indices().len(),
                }
            });
        }
        task.check()?;
        let mut dropped = 0;
        if !with_hidden {
            let is_meant = pieces.meant(view, task)?;
            for (piece, _) in pieces.triangles.iter().zip(is_meant).filter(|(_, m)| !m) {
                dropped += 1;
                for triangle in piece {
                    has_triangle[*triangle as usize] = false;
                }
            }
        }
        let patch = Patch {
            near,
            has_triangle,
            is_selected,
        };
        let space = patch.space().ok_or(RoiError::NothingCut)?.wider(beside_mm);
        let mut patch = patch.restricted(&space);
        drop_flaps(&mut patch);
        let closed = close_gaps(&mut patch, &space);
        Ok(Self {
            patch,
            dropped,
            closed,
        })
    }
}

/// Adds the triangles of small holes to a patch; gives how many holes these were. What reaches out of `space`
/// is no hole.
fn close_gaps(patch: &mut Patch, space: &Space) -> usize {
    let area_mm2 = patch.area_mm2();
    let most_mm2 = GAP_MM2.max(GAP * area_mm2).min(LARGEST_GAP * area_mm2);
    let near = &patch.near;
    let mut is_of_patch = vec![false; near.vertices_mm.len()];
    for vertex in patch.own().flat_map(|t| near.triangles[t as usize]) {
        is_of_patch[vertex as usize] = true;
    }
    let is_other: Vec<bool> = patch.has_triangle.iter().map(|has| !has).collect();
    let others = Pieces::of(near, &is_other);
    let of = |piece: &[u32], is: &dyn Fn(usize) -> bool| {
        let corners = piece.iter().flat_map(|t| near.triangles[*t as usize]);
        corners.into_iter().any(|v| is(v as usize))
    };
    let gaps = others
        .triangles
        .iter()
        .zip(&others.areas_mm2)
        .filter(|(piece, area)| {
            // What is as small but touches no patch is a crumb of bone beside it.
            **area < most_mm2
                && of(piece, &|v| is_of_patch[v])
                && !of(piece, &|v| !space.holds(near.vertices_mm[v]))
        });
    let gaps: Vec<&Vec<u32>> = gaps.map(|(piece, _)| piece).collect();
    for triangle in gaps.iter().copied().flatten() {
        patch.has_triangle[*triangle as usize] = true;
    }
    gaps.len()
}
