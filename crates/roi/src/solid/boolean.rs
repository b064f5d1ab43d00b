//! What two bodies have in common.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::{Cancelled, Task};
use manifold_rust::cancel::CancelToken;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{BooleanEngine, Error, MeshGL64, OpType};

use crate::RoiError;
use crate::vector::Vector;

/// Shorter edges at the cut are collapsed: in a file's 32-bit coordinates they would make triangles meet.
const TOLERANCE_MM: f64 = 1e-4;
/// How often the cancel switch is looked at.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// A closed surface, and for each of its triangles the one it lies on.
pub(super) struct Body {
    pub(super) vertices_mm: Vec<Vector>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Body {
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

/// The common part of two bodies, and the source of each of its triangles.
///
/// What is closed but touches itself goes by exact rational numbers, which take longer.
///
/// # Errors
/// [`RoiError::Open`] for a first body that is not closed, [`RoiError::Cut`], or the work was cancelled.
pub(super) fn common(
    first: &Body,
    second: &Body,
    task: &Task,
) -> Result<(Body, Vec<Source>), RoiError> {
    let id = Manifold::reserve_ids(2);
    let import = |body: &Body, id: u32| {
        let mesh = exported(body, id);
        let strict = Manifold::from_mesh_gl64(&mesh);
        match strict.status() {
            Error::NotManifold => (Manifold::from_mesh_gl64_robust(&mesh), false),
            _ => (strict, true),
        }
    };
    let ((a, is_manifold), (b, _)) = rayon::join(|| import(first, id), || import(second, id + 1));
    task.check()?;
    // Lids that overlap in their plane are far from the cut, so they are no reason for the slow way.
    let engine = if is_manifold {
        BooleanEngine::Exact
    } else {
        BooleanEngine::Robust
    };
    for (body, is_first) in [(&a, true), (&b, false)] {
        match body.status() {
            Error::NoError => {}
            Error::NotClosed if is_first => return Err(RoiError::Open),
            other => return Err(RoiError::Cut(other.to_str())),
        }
    }
    let cut = until_cancelled(task, |token| {
        a.boolean_with_engine_and_token(&b, OpType::Intersect, engine, Some(token))
    })?;
    match cut.status() {
        Error::NoError => Ok(imported(&cut, id)),
        Error::Cancelled => Err(Cancelled.into()),
        other => Err(RoiError::Cut(other.to_str())),
    }
}

/// Does the work and watches the cancel switch meanwhile.
fn until_cancelled<R>(task: &Task, work: impl FnOnce(&CancelToken) -> R) -> Result<R, Cancelled> {
    let token = &CancelToken::new();
    let (done, is_done) = channel::<()>();
    let result = std::thread::scope(|scope| {
        scope.spawn(move || {
            while is_done.recv_timeout(LOOK_EVERY) == Err(RecvTimeoutError::Timeout) {
                if task.check().is_err() {
                    token.cancel();
                }
            }
        });
        let result = work(token);
        drop(done);
        result
    });
    task.check()?;
    Ok(result)
}

fn exported(body: &Body, id: u32) -> MeshGL64 {
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
        tolerance: TOLERANCE_MM,
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
