//! Triangle meshes: topology, STL and PLY.

/// A mesh that cannot be used, and the remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex}, but there are {vertices}")]
    Index {
        /// Number of the triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
}

/// Triangles over shared vertices in mm; counter-clockwise seen from outside.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct TriangleMesh {
    vertices_mm: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// Joins vertices and triangles.
    ///
    /// # Errors
    /// see MeshError
    pub fn new(vertices_mm: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        Ok(Self {
            vertices_mm,
            triangles,
        })
    }

    /// Vertices in mm.
    pub fn vertices_mm(&self) -> &[[f64; 3]] {
        &self.vertices_mm
    }

    /// Vertex indices of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }
}
