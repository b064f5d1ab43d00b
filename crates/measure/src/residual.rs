//! The residual volume: what one of two bodies has and the other has not.
//!
//! Union less intersection is |A| + |B| - 2 |A and B|, so one boolean is enough. Faces that coincide do no
//! harm: exact signs with symbolic perturbation decide on which side each is, and it adds no volume either
//! way.

use bonemesh_mesh::{TriangleMesh, check_topology};
use bonemesh_task::Task;
use manifold_rust::cancel::CancelToken;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{BooleanEngine, Error, MeshGL64, OpType};

use crate::MeasureError;

/// Volumes of two bodies and of what they have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualVolume {
    /// Volume of the first.
    pub mesh_mm3: f64,
    /// Volume of the second.
    pub reference_mm3: f64,
    /// Volume that is in both.
    pub common_mm3: f64,
    /// Volume that is in exactly one.
    pub residual_mm3: f64,
}

/// The volume that is in exactly one of two closed bodies: their union less their intersection.
///
/// A mesh that faces inward is turned. One that touches itself is cut by exact rational numbers, which
/// takes longer. Where a mesh passes through itself, what is inside twice counts once in common and twice
/// in its own volume; `check` finds such places.
///
/// # Errors
/// [`MeasureError::NoSurface`], [`MeasureError::Open`], [`MeasureError::Boolean`], or the work was
/// cancelled.
pub fn residual_volume(
    mesh: &TriangleMesh,
    reference: &TriangleMesh,
    task: &Task,
) -> Result<ResidualVolume, MeasureError> {
    let (first, mesh_mm3) = outward(mesh, "mesh", task)?;
    let (second, reference_mm3) = outward(reference, "reference", task)?;
    task.begin("residual volume", 1);
    let common_mm3 = common_mm3(first, second, task)?;
    task.advance(1)?;
    Ok(ResidualVolume {
        mesh_mm3,
        reference_mm3,
        common_mm3,
        residual_mm3: (mesh_mm3 + reference_mm3 - 2.0 * common_mm3).max(0.0),
    })
}

/// A closed body facing outward, and its volume.
fn outward(
    mesh: &TriangleMesh,
    what: &'static str,
    task: &Task,
) -> Result<(MeshGL64, f64), MeasureError> {
    let merged = mesh.merged(task)?;
    let topology = check_topology(&merged, task)?;
    if topology.area_mm2 <= 0.0 {
        return Err(MeasureError::NoSurface(what));
    }
    if !topology.watertight {
        return Err(MeasureError::Open(what));
    }
    let is_outward = topology.volume_mm3 >= 0.0;
    let corners = |t: &[u32; 3]| {
        let [a, b, c] = t.map(u64::from);
        if is_outward { [a, b, c] } else { [a, c, b] }
    };
    let has_three = |t: &&[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    let triangles = merged.triangles().iter().filter(has_three);
    let exported = MeshGL64 {
        num_prop: 3,
        vert_properties: merged.vertices_mm().as_flattened().to_vec(),
        tri_verts: triangles.flat_map(corners).collect(),
        ..MeshGL64::default()
    };
    Ok((exported, topology.volume_mm3.abs()))
}

fn common_mm3(first: MeshGL64, second: MeshGL64, task: &Task) -> Result<f64, MeasureError> {
    let gave_up = MeasureError::Boolean("the surface was not understood");
    let bodies = task.leaving(move || (body(&first), body(&second)))?;
    let (first, second) = bodies.ok_or(gave_up)?;
    let token = CancelToken::new();
    let common = task.stopping(
        || token.cancel(),
        || {
            let engine = BooleanEngine::Auto;
            first.boolean_with_engine_and_token(&second, OpType::Intersect, engine, Some(&token))
        },
    )?;
    match common.status() {
        Error::NoError => Ok(common.volume()),
        other => Err(MeasureError::Boolean(other.to_str())),
    }
}

/// A body that touches itself goes by exact rational numbers.
fn body(mesh: &MeshGL64) -> Manifold {
    let strict = Manifold::from_mesh_gl64(mesh);
    if strict.status() == Error::NotManifold {
        Manifold::from_mesh_gl64_robust(mesh)
    } else {
        strict
    }
}
