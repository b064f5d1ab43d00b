//! The mesh itself.

use bonemesh_task::{Cancelled, Task};

use crate::MeshError;
use crate::merge::VertexMerger;

/// Vertices done between two looks at the cancel switch.
const STRIDE: usize = 1 << 14;

/// A triangle corner that [`TriangleMesh::compacted`] has not met yet.
const UNSEEN: u32 = u32::MAX;

/// Triangles over shared vertices in mm; counter-clockwise seen from outside.
///
/// Every index names a vertex and every coordinate is finite. Nothing else is promised:
/// [`crate::check_topology`] tells whether the mesh is closed.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct TriangleMesh {
    vertices_mm: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// Joins vertices (mm) and triangles (indices of vertices, from 0).
    ///
    /// # Errors
    /// [`MeshError::Index`], [`MeshError::NotFinite`] or [`MeshError::TooManyVertices`].
    pub fn new(vertices_mm: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if vertices_mm.len() >= UNSEEN as usize {
            return Err(MeshError::TooManyVertices(vertices_mm.len()));
        }
        for (vertex, coordinates) in vertices_mm.iter().enumerate() {
            if let Some(&value) = coordinates.iter().find(|value| !value.is_finite()) {
                return Err(MeshError::NotFinite { vertex, value });
            }
        }
        let vertices = vertices_mm.len();
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices) {
                return Err(MeshError::Index {
                    triangle,
                    vertex,
                    vertices,
                });
            }
        }
        Ok(Self {
            vertices_mm,
            triangles,
        })
    }

    /// Joins what is known to be sound.
    pub(crate) fn from_sound_parts(vertices_mm: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            vertices_mm,
            triangles,
        }
    }

    /// Vertices in mm.
    pub fn vertices_mm(&self) -> &[[f64; 3]] {
        &self.vertices_mm
    }

    /// Vertex indices of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The vertices (mm) and triangles, without a copy.
    pub fn into_parts(self) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        (self.vertices_mm, self.triangles)
    }

    /// Several meshes as one, their vertices and triangles one after another; nothing is made one.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn together<'a>(meshes: impl IntoIterator<Item = &'a Self>) -> Result<Self, MeshError> {
        let mut whole = Self::default();
        for mesh in meshes {
            let first = whole.vertices_mm.len();
            let vertices = first + mesh.vertices_mm.len();
            let (Ok(first), Ok(_)) = (u32::try_from(first), u32::try_from(vertices)) else {
                return Err(MeshError::TooManyVertices(vertices));
            };
            whole.vertices_mm.extend(&mesh.vertices_mm);
            let triangles = mesh.triangles.iter();
            whole
                .triangles
                .extend(triangles.map(|t| t.map(|v| first + v)));
        }
        Ok(whole)
    }

    /// The three corners (mm) of a triangle of this mesh.
    #[inline]
    pub fn corners_mm(&self, triangle: [u32; 3]) -> [[f64; 3]; 3] {
        triangle.map(|vertex| self.vertices_mm[vertex as usize])
    }

    /// Lowest and highest coordinates (mm) of all vertices; `None` without vertices.
    pub fn bounds_mm(&self) -> Option<[[f64; 3]; 2]> {
        let first = *self.vertices_mm.first()?;
        Some(self.vertices_mm.iter().fold([first, first], |bounds, v| {
            let [low, high] = bounds;
            [
                std::array::from_fn(|axis| low[axis].min(v[axis])),
                std::array::from_fn(|axis| high[axis].max(v[axis])),
            ]
        }))
    }

    /// Mean (mm) of all vertices, used or not; `None` without vertices.
    pub fn centroid_mm(&self) -> Option<[f64; 3]> {
        let sum = self.vertices_mm.iter().fold([0.0; 3], |sum: [f64; 3], v| {
            [0, 1, 2].map(|axis| sum[axis] + v[axis])
        });
        (!self.vertices_mm.is_empty()).then(|| sum.map(|s| s / self.vertices_mm.len() as f64))
    }

    /// The same surface with vertices of exactly equal coordinates made one.
    ///
    /// The first of equal vertices keeps its place in the order and later ones become it, so the
    /// numbers do not depend on anything but the order of the vertices. 0.0 and -0.0 are equal.
    /// Triangles keep their number and order, also those whose corners have become one.
    ///
    /// # Errors
    /// [`Cancelled`]
    pub fn merged(&self, task: &Task) -> Result<Self, Cancelled> {
        Ok(self.merged_with_numbers(task)?.0)
    }

    /// [`Self::merged`], and for each vertex of this mesh its number in that one.
    ///
    /// # Errors
    /// [`Cancelled`]
    pub fn merged_with_numbers(&self, task: &Task) -> Result<(Self, Vec<u32>), Cancelled> {
        let mut merger = VertexMerger::default();
        let mut numbers = Vec::with_capacity(self.vertices_mm.len());
        for vertices_mm in self.vertices_mm.chunks(STRIDE) {
            task.check()?;
            numbers.extend(vertices_mm.iter().map(|&v| merger.index_of(v)));
        }
        let merged = Self {
            vertices_mm: merger.into_vertices(),
            triangles: self
                .triangles
                .iter()
                .map(|t| t.map(|v| numbers[v as usize]))
                .collect(),
        };
        Ok((merged, numbers))
    }

    /// The same surface as its file gives it back: coordinates rounded to 32-bit floats, vertices
    /// that are then equal made one.
    ///
    /// # Errors
    /// [`MeshError::NotFinite`] for a coordinate that is too large for a 32-bit float,
    /// [`MeshError::Cancelled`].
    pub fn as_written(&self, task: &Task) -> Result<Self, MeshError> {
        let rounded = |v: &[f64; 3]| v.map(|value| f64::from(value as f32));
        let vertices_mm = self.vertices_mm.iter().map(rounded).collect();
        Ok(Self::new(vertices_mm, self.triangles.clone())?.merged(task)?)
    }

    /// The same triangles without the vertices that none of them uses; the order stays.
    #[must_use]
    pub fn compacted(&self) -> Self {
        let mut index = vec![UNSEEN; self.vertices_mm.len()];
        for &vertex in self.triangles.iter().flatten() {
            index[vertex as usize] = 0;
        }
        let mut vertices_mm = Vec::new();
        for (vertex, index) in index.iter_mut().enumerate() {
            if *index != UNSEEN {
                *index = vertices_mm.len() as u32;
                vertices_mm.push(self.vertices_mm[vertex]);
            }
        }
        Self {
            vertices_mm,
            triangles: self
                .triangles
                .iter()
                .map(|t| t.map(|v| index[v as usize]))
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_past_the_vertices_is_refused() {
        let error = TriangleMesh::new(vec![[0.0; 3]; 3], vec![[0, 1, 2], [0, 1, 3]]).unwrap_err();
        assert!(matches!(
            error,
            MeshError::Index {
                triangle: 1,
                vertex: 3,
                vertices: 3
            }
        ));
    }

    #[test]
    fn a_coordinate_that_is_no_number_is_refused() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let error = TriangleMesh::new(vec![[0.0; 3], [0.0, value, 0.0]], vec![]).unwrap_err();
            assert!(matches!(error, MeshError::NotFinite { vertex: 1, .. }));
        }
    }

    #[test]
    fn merging_gives_the_first_of_equal_vertices_the_next_number() {
        let (a, b, c) = ([0.0, 1.0, 2.0], [3.0, 1.0, 2.0], [-0.0, 1.0, 2.0]);
        let mesh = TriangleMesh::new(vec![b, a, c, b, [9.0; 3]], vec![[0, 1, 4], [3, 2, 1]])
            .unwrap()
            .merged(&Task::default())
            .unwrap();
        assert_eq!(mesh.vertices_mm(), [b, a, [9.0; 3]]);
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 1, 1]]);
    }

    #[test]
    fn what_single_precision_cannot_tell_apart_is_one_vertex_when_written() {
        let near = [200.0, 1e-50, 0.1];
        let same = [200.000_000_1, 0.0, f64::from(0.1_f32)];
        let mesh = TriangleMesh::new(vec![near, [1.0; 3], same], vec![[0, 1, 2]]).unwrap();
        let written = mesh.as_written(&Task::default()).unwrap();
        assert_eq!(
            written.vertices_mm(),
            [[200.0, 0.0, f64::from(0.1_f32)], [1.0; 3]]
        );
        assert_eq!(written.triangles(), [[0, 1, 0]]);
        let far = TriangleMesh::new(vec![[0.0, 1e39, 0.0]], vec![]).unwrap();
        assert!(matches!(
            far.as_written(&Task::default()),
            Err(MeshError::NotFinite { vertex: 0, .. })
        ));
    }

    #[test]
    fn compacting_drops_unused_vertices_and_keeps_the_order() {
        let vertices: Vec<[f64; 3]> = (0..6).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let mesh = TriangleMesh::new(vertices, vec![[5, 1, 3]])
            .unwrap()
            .compacted();
        assert_eq!(
            mesh.vertices_mm(),
            [[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [5.0, 0.0, 0.0]]
        );
        assert_eq!(mesh.triangles(), [[2, 0, 1]]);
    }

    #[test]
    fn bounds_and_centroid_are_those_of_the_vertices() {
        let mesh = TriangleMesh::new(vec![[1.0, -2.0, 3.0], [3.0, 4.0, 3.0]], vec![]).unwrap();
        assert_eq!(mesh.bounds_mm(), Some([[1.0, -2.0, 3.0], [3.0, 4.0, 3.0]]));
        assert_eq!(mesh.centroid_mm(), Some([2.0, 1.0, 3.0]));
        assert_eq!(TriangleMesh::default().bounds_mm(), None);
        assert_eq!(TriangleMesh::default().centroid_mm(), None);
    }
}
