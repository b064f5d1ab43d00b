//! What is said of a result: plain values with units in their names, ready for JSON.

use bonemesh_mesh::{Island, Topology, TriangleMesh, check_topology};
use bonemesh_task::Task;
use serde::Serialize;

use crate::after_care::AfterCareReport;
use crate::memory::peak_mib;
use crate::metal::MetalReport;
use crate::options::OptionsReport;
use crate::{Error, Settings, VERSION};

/// Wall-clock seconds of each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Files to volume.
    pub read: f64,
    /// Metal, threshold and Canny.
    pub edges: f64,
    /// Edge pixels to points, sampling included.
    pub cloud: f64,
    /// Mean distance to the neighbours, which gives alpha.
    pub neighbours: f64,
    /// Delaunay tetrahedra, filtered by alpha.
    pub tetrahedra: f64,
    /// Their boundary as a mesh, and its check.
    pub surface: f64,
    /// Mesh to file.
    pub write: f64,
    /// All of them.
    pub total: f64,
}

/// Islands that a mesh is made without.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LeftOutIslands {
    /// How many.
    pub islands: usize,
    /// Their volume, cavities in them counted in.
    pub volume_mm3: f64,
}

impl LeftOutIslands {
    /// Those that go; `None` if none does.
    pub(crate) fn of(islands: &[Island<'_>], are_taken: &[bool]) -> Option<Self> {
        let taken = islands.iter().zip(are_taken).filter(|(_, taken)| **taken);
        let volumes = taken.map(|(island, _)| island.volume_mm3.abs());
        let (islands, volume_mm3) = volumes.fold((0, 0.0), |(n, sum), mm3| (n + 1, sum + mm3));
        (islands > 0).then_some(Self {
            islands,
            volume_mm3,
        })
    }
}

/// What a closed surface is made without.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LeftOut {
    pub(crate) table: Option<LeftOutIslands>,
    pub(crate) specks: Option<LeftOutIslands>,
}

/// What is said of a rendered mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RenderReport {
    /// Version of this program.
    pub version: &'static str,
    /// Name of the surface method.
    pub method: &'static str,
    /// Bone is strictly above this; `None` for a mesh made of a cloud.
    pub threshold_hu: Option<f64>,
    /// How the threshold was found, or which preset it is; `None` for any other number.
    pub threshold_reason: Option<String>,
    /// How far the threshold may lie elsewhere around a voxel; `None` if it is the same everywhere.
    pub local_leeway_hu: Option<f64>,
    /// Canny's smoothing, pixels.
    pub sigma: f64,
    /// `SeriesInstanceUID`, where the volume came from files.
    pub series_uid: Option<String>,
    /// Distance between columns, rows, slices in mm.
    pub spacing_mm: Option<[f64; 3]>,
    /// Points that were meshed; `None` where a method meshes voxels.
    pub points: Option<usize>,
    /// Largest circumradius kept, by the method with alpha.
    pub alpha_mm: Option<f64>,
    /// Alpha over the mean distance to 100 neighbours, where it was matched to the bone's volume.
    pub alpha_coefficient: Option<f64>,
    /// Volume of all voxels of the bone, where alpha was matched to it.
    pub bone_volume_mm3: Option<f64>,
    /// Radii of the balls, by ball pivoting.
    pub radii_mm: Option<Vec<f64>>,
    /// Tetrahedra kept, by the methods that make them.
    pub tetrahedra: Option<usize>,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Closed: every edge has as many triangles running along it one way as the other.
    pub watertight: bool,
    /// No edge has more than two triangles, no vertex more than one fan of them.
    pub manifold: bool,
    /// Parts of the mesh that do not touch.
    pub components: usize,
    /// Those of them that face inward: the walls of cavities. 0 unless watertight.
    pub cavities: usize,
    /// Volume of air that labelled tetrahedra filled where the bone only touched itself.
    pub filled_mm3: Option<f64>,
    /// Volume inside the mesh; with alpha it goes through the centres of the edge pixels.
    pub volume_mm3: f64,
    /// Islands that look like the scanner's table or headrest; `None` if there are none.
    pub left_out_table: Option<LeftOutIslands>,
    /// Islands too small for a bone; `None` if there are none.
    pub left_out_specks: Option<LeftOutIslands>,
    /// Metal in the volume; `None` if there is none.
    pub metal: Option<MetalReport>,
    /// What was done to the finished mesh; `None` if nothing was asked for.
    pub after_care: Option<AfterCareReport>,
    /// Every option, so that the mesh can be made again.
    pub options: OptionsReport,
    /// Seconds of each step.
    pub seconds: Seconds,
    /// Peak memory of this process in MiB, where the system tells.
    pub peak_mib: Option<f64>,
    /// What the reader had to say of the series, and of metal in it.
    pub warnings: Vec<String>,
}

impl RenderReport {
    pub(crate) fn new(settings: &Settings, check: &CheckReport, seconds: Seconds) -> Self {
        Self {
            version: VERSION,
            method: settings.method.name(),
            threshold_hu: None,
            threshold_reason: None,
            local_leeway_hu: settings.local_leeway_hu,
            sigma: settings.canny.sigma(),
            series_uid: None,
            spacing_mm: None,
            points: None,
            alpha_mm: None,
            alpha_coefficient: None,
            bone_volume_mm3: None,
            radii_mm: None,
            tetrahedra: None,
            vertices: check.vertices,
            triangles: check.triangles,
            watertight: check.watertight,
            manifold: check.manifold,
            components: check.components,
            cavities: check.cavities,
            filled_mm3: None,
            volume_mm3: check.volume_mm3,
            left_out_table: None,
            left_out_specks: None,
            metal: None,
            after_care: None,
            options: OptionsReport::of(settings),
            seconds,
            peak_mib: peak_mib(),
            warnings: Vec::new(),
        }
    }

    /// Adds the time that writing the file took.
    pub fn written(&mut self, seconds: f64) {
        self.seconds.write = seconds;
        self.seconds.total += seconds;
        self.peak_mib = peak_mib();
    }
}

/// The topology of a mesh in plain words and numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckReport {
    /// Vertices.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Closed: every edge has as many triangles running along it one way as the other.
    pub watertight: bool,
    /// No edge has more than two triangles, no vertex more than one fan of them.
    pub manifold: bool,
    /// Neighbouring triangles agree on which side is out.
    pub consistent_winding: bool,
    /// Edges with one triangle.
    pub boundary_edges: usize,
    /// Edges with three or more triangles.
    pub non_manifold_edges: usize,
    /// Vertices with more than one fan of triangles.
    pub non_manifold_vertices: usize,
    /// Triangles without area.
    pub degenerate_triangles: usize,
    /// Parts that do not touch.
    pub components: usize,
    /// Those of them that face inward: the walls of cavities. 0 unless watertight.
    pub cavities: usize,
    /// Volume inside, positive when the winding is outward.
    pub volume_mm3: f64,
    /// Area.
    pub area_mm2: f64,
    /// Smallest and largest corner of the bounding box; `None` for an empty mesh.
    pub bounds_mm: Option<[[f64; 3]; 2]>,
}

impl From<Topology> for CheckReport {
    fn from(t: Topology) -> Self {
        Self {
            vertices: t.vertices,
            triangles: t.triangles,
            watertight: t.watertight,
            manifold: t.manifold,
            consistent_winding: t.inconsistent_edges == 0,
            boundary_edges: t.boundary_edges,
            non_manifold_edges: t.non_manifold_edges,
            non_manifold_vertices: t.non_manifold_vertices,
            degenerate_triangles: t.degenerate_triangles,
            components: t.components,
            cavities: t.cavities,
            volume_mm3: t.volume_mm3,
            area_mm2: t.area_mm2,
            bounds_mm: t.bounds_mm,
        }
    }
}

/// Looks at the topology of `mesh`; cheap enough for every mesh that is made.
///
/// # Errors
/// [`Error::Mesh`] of a cancelled task.
pub fn check(mesh: &TriangleMesh, task: &Task) -> Result<CheckReport, Error> {
    Ok(check_topology(mesh, task)?.into())
}
