//! What after-care did to a mesh, in numbers.

use bonemesh_mesh::{FacedOutward, HoleLeft, HoleReason, HolesFilled, Kept, TriangleMesh};
use serde::Serialize;

/// What [`care_for`](super::care_for) did.
#[derive(Clone, Debug, PartialEq, Default, Serialize)]
pub struct AfterCareReport {
    /// Triangles without area that were taken out.
    pub removed_degenerate: usize,
    /// Triangles taken out because others have the same corners.
    pub removed_doubled: usize,
    /// Triangles turned over; `None` if none were to be.
    pub turned_triangles: Option<usize>,
    /// Holes filled; `None` if none were to be.
    pub filled_holes: Option<usize>,
    /// Holes that are still there after filling.
    pub left_holes: Option<usize>,
    /// The largest of them, at most [`MOST_NAMED`].
    pub largest_left_holes: Vec<LeftHole>,
    /// Islands taken away.
    pub removed_islands: usize,
    /// Their volume, cavities counted in.
    pub removed_islands_mm3: f64,
    /// Cavities filled, and those that went with their islands.
    pub removed_cavities: usize,
    /// Their volume.
    pub removed_cavities_mm3: f64,
    /// The furthest that smoothing moved a vertex; `None` without smoothing.
    pub largest_move_mm: Option<f64>,
    /// Vertices that smoothing left in place, because the surface would have passed through itself.
    pub put_back_vertices: Option<usize>,
    /// Triangles that decimation took away; `None` without decimation.
    pub removed_triangles: Option<usize>,
    /// The number of triangles that was asked for, if there are more.
    pub missed_triangles: Option<usize>,
    /// Vertices that decimation left alone with their triangles, because the surface would have
    /// passed through itself or left the error bound.
    pub held_vertices: Option<usize>,
    /// The furthest that a vertex which decimation was given is from the surface it left; `None` without
    /// decimation.
    pub largest_distance_mm: Option<f64>,
    /// By how much smoothing and decimation changed the volume; `None` without them or of an open mesh.
    pub volume_change_percent: Option<f64>,
    /// Seconds that it took.
    pub seconds: f64,
}

/// Holes that a report names one by one.
pub const MOST_NAMED: usize = 20;

/// A hole that is still there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftHole {
    /// How many edges its rim has.
    pub edges: usize,
    /// The longest side of its box along the axes.
    pub extent_mm: f64,
    /// The middle of that box.
    pub place_mm: [f64; 3],
    /// Why it is still there, in a few words.
    pub reason: &'static str,
}

impl From<&HoleLeft> for LeftHole {
    fn from(left: &HoleLeft) -> Self {
        Self {
            edges: left.edges,
            extent_mm: left.extent_mm,
            place_mm: left.place_mm,
            reason: match left.reason {
                HoleReason::TooLarge => "larger than asked for",
                HoleReason::NoLoop => {
                    "its rim is no closed loop: triangles are turned over or the edge is non-manifold"
                }
                HoleReason::Blocked => "the surface is in the way",
                _ => "it cannot be filled",
            },
        }
    }
}

impl AfterCareReport {
    /// Notes how many triangles were turned over, the larger number of two passes, and gives the mesh.
    pub(super) fn turned(&mut self, faced: FacedOutward) -> TriangleMesh {
        self.turned_triangles = self.turned_triangles.max(Some(faced.turned));
        faced.mesh
    }

    /// Notes which holes are filled and gives the mesh without them.
    pub(super) fn with_lids(&mut self, filled: HolesFilled) -> TriangleMesh {
        self.filled_holes = Some(filled.filled);
        self.left_holes = Some(filled.left.len());
        self.largest_left_holes = filled
            .left
            .iter()
            .take(MOST_NAMED)
            .map(LeftHole::from)
            .collect();
        filled.mesh
    }

    /// Notes what is gone and gives what is left.
    pub(super) fn without(&mut self, kept: Kept) -> TriangleMesh {
        for part in &kept.removed {
            if part.is_cavity {
                self.removed_cavities += 1;
                self.removed_cavities_mm3 += part.volume_mm3;
            } else {
                self.removed_islands += 1;
                self.removed_islands_mm3 += part.volume_mm3;
            }
        }
        kept.mesh
    }
}
