//! Planes, and meshes mirrored in them.

use crate::vector::{Vector, cross, dot, minus, plus_scaled, unit};
use crate::{MeshError, TriangleMesh};

/// The places p with normal · p = offset, in the frame of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    normal: Vector,
    offset_mm: f64,
}

impl Plane {
    /// The places p with `normal` · p = `offset`; the normal may have any length, which scales the
    /// offset, too.
    ///
    /// # Errors
    /// [`MeshError::NoPlane`] for a normal that is 0, or for no numbers.
    pub fn new(normal: [f64; 3], offset: f64) -> Result<Self, MeshError> {
        let length = dot(normal, normal).sqrt();
        match unit(normal) {
            Some(direction) if offset.is_finite() => Ok(Self {
                normal: direction,
                offset_mm: offset / length,
            }),
            _ => Err(MeshError::NoPlane),
        }
    }

    /// The plane through three places (mm).
    ///
    /// # Errors
    /// [`MeshError::NoPlane`] for places in a line.
    pub fn through([a, b, c]: [[f64; 3]; 3]) -> Result<Self, MeshError> {
        let across = cross(minus(b, a), minus(c, a));
        let longest = dot(minus(b, a), minus(b, a)).max(dot(minus(c, a), minus(c, a)));
        // A sliver of rounding errors is a line.
        if dot(across, across).sqrt() <= 1e-9 * longest {
            return Err(MeshError::NoPlane);
        }
        Self::new(across, dot(across, a))
    }

    /// Its normal, of length 1.
    pub fn normal(&self) -> [f64; 3] {
        self.normal
    }

    /// How far (mm) from the origin it lies, along its normal.
    pub fn offset_mm(&self) -> f64 {
        self.offset_mm
    }

    /// How far (mm) above it a place lies.
    pub fn above_mm(&self, place_mm: [f64; 3]) -> f64 {
        dot(self.normal, place_mm) - self.offset_mm
    }

    /// The place as far on its other side.
    pub fn mirrored(&self, place_mm: [f64; 3]) -> [f64; 3] {
        plus_scaled(place_mm, -2.0 * self.above_mm(place_mm), self.normal)
    }

    /// The direction as a mirror shows it.
    pub fn mirrored_direction(&self, direction: [f64; 3]) -> [f64; 3] {
        plus_scaled(direction, -2.0 * dot(self.normal, direction), self.normal)
    }
}

impl TriangleMesh {
    /// The mesh on the other side of a plane, with the same numbers for vertices and triangles; what was
    /// outside stays so.
    #[must_use]
    pub fn mirrored(&self, plane: &Plane) -> Self {
        let (mut vertices_mm, mut triangles) = self.clone().into_parts();
        for vertex in &mut vertices_mm {
            *vertex = plane.mirrored(*vertex);
        }
        for triangle in &mut triangles {
            triangle.swap(1, 2);
        }
        Self::from_sound_parts(vertices_mm, triangles)
    }
}

#[cfg(test)]
mod tests {
    use bonemesh_task::Task;

    use super::*;
    use crate::check_topology;

    #[test]
    fn the_length_of_a_normal_scales_the_offset() {
        let plane = Plane::new([0.0, 0.0, 4.0], 20.0).unwrap();
        assert_eq!(plane, Plane::new([0.0, 0.0, 1.0], 5.0).unwrap());
        let place = plane.mirrored([1.0, 2.0, 7.0]);
        let direction = plane.mirrored_direction([1.0, 2.0, 7.0]);
        for (found, expected) in [(place, [1.0, 2.0, 3.0]), (direction, [1.0, 2.0, -7.0])] {
            assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-12));
        }
    }

    #[test]
    fn three_places_make_the_plane_they_lie_in() {
        let places = [[1.0, 0.0, 3.0], [4.0, 2.0, 3.0], [0.0, 5.0, 4.0]];
        let plane = Plane::through(places).unwrap();
        assert!(places.iter().all(|p| plane.above_mm(*p).abs() < 1e-12));
    }

    #[test]
    fn what_makes_no_plane_is_refused() {
        assert!(Plane::new([0.0; 3], 1.0).is_err());
        assert!(Plane::new([1.0, f64::NAN, 0.0], 1.0).is_err());
        assert!(Plane::new([1.0, 0.0, 0.0], f64::INFINITY).is_err());
        let line = [[0.1, 0.2, 0.3], [0.2, 0.4, 0.6], [0.7, 1.4, 2.1]];
        assert!(Plane::through(line).is_err());
    }

    #[test]
    fn a_mirrored_body_keeps_its_volume_and_its_outside() {
        let corners = vec![[0.0; 3], [3.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 5.0]];
        let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let body = TriangleMesh::new(corners, faces).unwrap();
        let plane = Plane::new([1.0, 2.0, -0.5], 7.0).unwrap();
        let mirrored = body.mirrored(&plane);
        let task = Task::default();
        let volume = |mesh| check_topology(mesh, &task).unwrap().volume_mm3;
        assert!((volume(&mirrored) - 5.0).abs() < 1e-12);
        let back = mirrored.mirrored(&plane);
        assert_eq!(back.triangles(), body.triangles());
        let pairs = back.vertices_mm().iter().zip(body.vertices_mm());
        assert!(
            pairs
                .flat_map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).abs()))
                .all(|d| d < 1e-12)
        );
    }
}
