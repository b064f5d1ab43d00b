//! What two bodies have in common.

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Cancelled, Task};
use manifold_rust::cancel::CancelToken;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{BooleanEngine, Error, MeshGL64, OpType};

use crate::RoiError;
use bonemesh_mesh::vector::{Vector, plus_scaled};

/// Shorter edges at the cut are collapsed: in a file's 32-bit coordinates they would make triangles meet. By
/// try: the larger, the more of the front goes with them.
const TOLERANCES_MM: [f64; 4] = [1e-4, 1e-4, 4e-4, 1.6e-3];

/// A closed surface.
pub(super) struct Body {
    pub(super) vertices_mm: Vec<Vector>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Body {
    /// The same body so far away.
    pub(super) fn moved(&self, by_mm: Vector) -> Self {
        let vertices = self.vertices_mm.iter();
        Self {
            vertices_mm: vertices.map(|v| plus_scaled(*v, 1.0, by_mm)).collect(),
            triangles: self.triangles.clone(),
        }
    }

    pub(super) fn of(mesh: TriangleMesh) -> Self {
        let (vertices_mm, triangles) = mesh.into_parts();
        Self {
            vertices_mm,
            triangles,
        }
    }
}

/// Where a triangle of the common part comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// Lies on this triangle of the first body.
    First(u32),
    /// Lies on the second body.
    Second,
}

/// A body that others are cut out of.
pub(super) struct Stock {
    body: Manifold,
    /// Strictly: every edge with two triangles.
    is_manifold: bool,
    /// What its triangles are known by.
    id: u32,
}

impl Stock {
    /// What is closed but touches itself goes by exact rational numbers, which take longer.
    ///
    /// # Errors
    /// [`RoiError::Open`] for a body that is not closed, [`RoiError::Cut`], or the work was cancelled.
    pub(super) fn of(body: Body, task: &Task) -> Result<Self, RoiError> {
        let id = Manifold::reserve_ids(1);
        let made = task.leaving(move || {
            let mesh = exported(&body, id, TOLERANCES_MM[0]);
            let strict = Manifold::from_mesh_gl64(&mesh);
            let is_manifold = strict.status() != Error::NotManifold;
            let body = if is_manifold {
                strict
            } else {
                Manifold::from_mesh_gl64_robust(&mesh)
            };
            (body, is_manifold)
        })?;
        let (body, is_manifold) = made.ok_or(RoiError::Cut("the surface was not understood"))?;
        match body.status() {
            Error::NoError => Ok(Self {
                body,
                is_manifold,
                id,
            }),
            Error::NotClosed => Err(RoiError::Open),
            other => Err(RoiError::Cut(other.to_str())),
        }
    }

    /// What it has in common with a cutter, and the source of each triangle.
    ///
    /// `attempt`: how often it was tried before.
    ///
    /// # Errors
    /// [`RoiError::Cut`], or the work was cancelled.
    pub(super) fn common(
        &self,
        cutter: &Body,
        attempt: u32,
        task: &Task,
    ) -> Result<(Body, Vec<Source>), RoiError> {
        let tolerance_mm = TOLERANCES_MM[attempt as usize % TOLERANCES_MM.len()];
        let cutter = exported(cutter, Manifold::reserve_ids(1), tolerance_mm);
        let cutter = Manifold::from_mesh_gl64(&cutter);
        if cutter.status() != Error::NoError {
            return Err(RoiError::Cut(cutter.status().to_str()));
        }
        task.check()?;
        // Lids that overlap in their plane are far from the cut, so they are no reason for the slow way.
        let engine = if self.is_manifold {
            BooleanEngine::Exact
        } else {
            BooleanEngine::Robust
        };
        let token = CancelToken::new();
        let cut = task.stopping(
            || token.cancel(),
            || {
                let operation = OpType::Intersect;
                self.body
                    .boolean_with_engine_and_token(&cutter, operation, engine, Some(&token))
            },
        )?;
        match cut.status() {
            Error::NoError => Ok(imported(&cut, self.id)),
            Error::Cancelled => Err(Cancelled.into()),
            other => Err(RoiError::Cut(other.to_str())),
        }
    }
}

fn exported(body: &Body, id: u32, tolerance_mm: f64) -> MeshGL64 {
    MeshGL64 {
        num_prop: 3,
        vert_properties: body.vertices_mm.as_flattened().to_vec(),
        tri_verts: body
            .triangles
            .as_flattened()
            .iter()
            .map(|v| u64::from(*v))
            .collect(),
        run_original_id: vec![id],
        run_index: vec![0, 3 * body.triangles.len() as u64],
        // Each triangle is a face of its own: none may be joined with another.
        face_id: (0..body.triangles.len() as u64).collect(),
        tolerance: tolerance_mm,
        ..MeshGL64::default()
    }
}

fn imported(cut: &Manifold, first_id: u32) -> (Body, Vec<Source>) {
    let mesh = cut.get_mesh_gl64(0);
    let corners = mesh
        .vert_properties
        .chunks_exact(mesh.num_prop.max(3) as usize);
    let triangles = mesh.tri_verts.chunks_exact(3);
    let body = Body {
        vertices_mm: corners.map(|c| [c[0], c[1], c[2]]).collect(),
        triangles: triangles
            .map(|t| [t[0] as u32, t[1] as u32, t[2] as u32])
            .collect(),
    };
    let mut sources = vec![Source::Second; body.triangles.len()];
    let runs = mesh.run_index.windows(2).zip(&mesh.run_original_id);
    for (run, _) in runs.filter(|(_, id)| **id == first_id) {
        let triangles = run[0] as usize / 3..run[1] as usize / 3;
        let faces = &mesh.face_id[triangles.clone()];
        for (source, face) in sources[triangles].iter_mut().zip(faces) {
            *source = Source::First(*face as u32);
        }
    }
    (body, sources)
}
