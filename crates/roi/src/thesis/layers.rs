//! Step 3: inner levels and the outer ones they correspond to.

use super::{Levels, Patch};

/// Which of the selection's levels each inner level corresponds to.
#[derive(Debug)]
pub(super) struct Layers {
    /// `(z of the inner level, place of the outer level)`, ascending.
    pairs: Vec<(f64, usize)>,
}

impl Layers {
    /// The place of the outer level for an inner z, if it is one.
    pub(super) fn outer_of(&self, z: f64) -> Option<usize> {
        let z = z + 0.0;
        let found = self.pairs.binary_search_by(|pair| pair.0.total_cmp(&z));
        found.ok().map(|place| self.pairs[place].1)
    }
}

/// Pairs the inner levels among `levels` (all of the mesh) with those of the patch.
///
/// With one level selected: every level between it and its projection, both included. Otherwise as
/// many successive levels as are selected, downward from the highest selected one that is not above
/// the projection's top (from the lowest if all are), the m-th with the m-th.
pub(super) fn pairs(patch: &Patch<'_>, levels: &Levels) -> Layers {
    let own = patch.levels.z_mm();
    let top = patch.projected_top();
    if patch.is_one_level() {
        let (low, high) = (own[0].min(top), own[0].max(top));
        let between = levels.z_mm().iter().filter(|z| (low..=high).contains(*z));
        return Layers {
            pairs: between.map(|&z| (z, 0)).collect(),
        };
    }
    let highest = own.iter().rfind(|z| **z <= top).unwrap_or(&own[0]);
    let place = levels
        .place_of(*highest)
        .expect("a selected level is not one of the mesh, which is a bug");
    // From the top down; `zip` ends where the mesh or the selection does.
    let inner = levels.z_mm()[..=place].iter().copied().rev();
    let mut pairs: Vec<(f64, usize)> = inner.zip((0..own.len()).rev()).collect();
    pairs.reverse();
    Layers { pairs }
}
