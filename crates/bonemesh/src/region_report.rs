//! What is said of a region of interest.

use bonemesh_mesh::TriangleMesh;
use bonemesh_roi::{Region, Solid};
use serde::Serialize;

use crate::VERSION;
use crate::mirror::PlaneReport;
use crate::region::RegionRequest;
use crate::report::CheckReport;

/// What is said of a region of interest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RegionReport {
    /// Version of this program.
    pub version: &'static str,
    /// Name of the method.
    pub method: &'static str,
    /// Thickness asked for.
    pub thickness_mm: f64,
    /// Of the thesis's method.
    #[serde(flatten)]
    pub thesis: Option<ThesisReport>,
    /// Of a solid.
    #[serde(flatten)]
    pub solid: Option<SolidReport>,
    /// Vertices of the region.
    pub vertices: usize,
    /// Triangles of the region.
    pub triangles: usize,
    /// Closed: every edge has as many triangles running along it one way as the other.
    pub watertight: bool,
    /// No edge has more than two triangles, no vertex more than one fan of them.
    pub manifold: bool,
    /// Parts of the mesh that do not touch.
    pub components: usize,
    /// Volume inside the region.
    pub volume_mm3: f64,
    /// Seconds that it took.
    pub seconds: f64,
}

impl RegionReport {
    pub(crate) fn new(
        request: &RegionRequest,
        thesis: Option<ThesisReport>,
        mut solid: Option<SolidReport>,
        check: &CheckReport,
        seconds: f64,
    ) -> Self {
        if let Some(solid) = &mut solid {
            solid.direction = request.direction.to_string();
        }
        Self {
            version: VERSION,
            method: request.method.name(),
            thickness_mm: request.thickness.mm(),
            volume_mm3: thesis
                .as_ref()
                .map_or(check.volume_mm3, |t| t.tetrahedra_mm3),
            thesis,
            solid,
            vertices: check.vertices,
            triangles: check.triangles,
            watertight: check.watertight,
            manifold: check.manifold,
            components: check.components,
            seconds,
        }
    }

    /// Distinct selected vertices.
    pub fn selected(&self) -> usize {
        let thesis = self.thesis.as_ref().map(|t| t.selected);
        thesis
            .or(self.solid.as_ref().map(|s| s.selected))
            .unwrap_or(0)
    }
}

/// What the thesis's method found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThesisReport {
    /// Distinct selected vertices.
    pub selected: usize,
    /// Points found behind the selection.
    pub kept_points: usize,
    /// Largest circumradius kept.
    pub alpha_mm: f64,
    /// Unit normal along which the selection was projected.
    pub normal: [f64; 3],
    /// Volume of the tetrahedra.
    #[serde(skip)]
    tetrahedra_mm3: f64,
}

impl ThesisReport {
    pub(crate) fn new(region: &Region) -> Self {
        Self {
            selected: region.selected,
            kept_points: region.kept_points,
            alpha_mm: region.alpha_mm,
            normal: region.normal,
            tetrahedra_mm3: region.volume_mm3,
        }
    }
}

/// What a solid was cut from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SolidReport {
    /// Distinct selected vertices; of a mirrored selection those of its counterpart.
    pub selected: usize,
    /// Which way it was cut.
    pub direction: String,
    /// Mean direction from the selection into the bone, of length 1.
    pub inward: [f64; 3],
    /// Area of the selected patch.
    pub patch_mm2: f64,
    /// Pieces of the selection that were left out: crumbs, and those hidden behind others.
    pub dropped_pieces: usize,
    /// Gaps in the selection that were closed.
    pub closed_gaps: usize,
    /// Triangles of the mesh without area, or given twice, that were taken out first.
    pub removed_triangles: usize,
    /// Triangles of the mesh that were turned over first, to face as their neighbours do.
    pub turned_triangles: usize,
    /// Holes of the mesh that were filled first.
    pub filled_holes: usize,
    /// How near a plate comes to the bone (mm), if nearer than its clearance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap_mm: Option<f64>,
    /// The plane between the sides, if the other side's counterpart was taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mirror: Option<PlaneReport>,
}

/// What was done to the mesh before a solid was cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Mended {
    pub(crate) removed_triangles: usize,
    pub(crate) turned_triangles: usize,
    pub(crate) filled_holes: usize,
}

impl Mended {
    /// What was done where the same mesh was mended for several sides.
    pub(crate) fn most(self, other: Self) -> Self {
        Self {
            removed_triangles: self.removed_triangles.max(other.removed_triangles),
            turned_triangles: self.turned_triangles.max(other.turned_triangles),
            filled_holes: self.filled_holes.max(other.filled_holes),
        }
    }
}

impl SolidReport {
    /// The solid's mesh, and what is said of it.
    pub(crate) fn of(
        solid: Solid,
        mended: Mended,
        mirror: Option<PlaneReport>,
    ) -> (TriangleMesh, Self) {
        let report = Self {
            selected: solid.selected,
            direction: String::new(),
            inward: solid.inward,
            patch_mm2: solid.patch_mm2,
            dropped_pieces: solid.dropped,
            closed_gaps: solid.closed,
            removed_triangles: mended.removed_triangles,
            turned_triangles: mended.turned_triangles,
            filled_holes: mended.filled_holes,
            gap_mm: solid.gap_mm,
            mirror,
        };
        (solid.mesh, report)
    }
}
