//! Step 1: one direction into the bone.

use bonemesh_mesh::TriangleMesh;

use super::Levels;
use crate::RoiError;
use crate::selection::Selection;
use bonemesh_mesh::vector::{cross, dot, minus};

/// Directions closer than this angle (radians) are one: 32-bit files do not keep a short patch's
/// directions better than that.
const PARALLEL: f64 = 1e-5;

/// The unit normal of the selected vertices, towards the centroid of the mesh.
///
/// 1. c is their mean; a leads from it to the point of largest y on the level nearest to it.
/// 2. b leads from it to the point of largest z, or of largest x if there is one level, among those
///    that differ from the first point in x or in y.
/// 3. n = a x b, turned to point against c as seen from the centroid.
pub(super) fn of_selection(
    mesh: &TriangleMesh,
    selection: &Selection,
    levels: &Levels,
) -> Result<[f64; 3], RoiError> {
    let selected = selection.indices().len();
    let points: Vec<[f64; 3]> = selection
        .indices()
        .iter()
        .map(|&vertex| mesh.vertices_mm()[vertex as usize])
        .collect();
    let centre = mean(&points);
    let nearest = first_by(levels.z_mm().iter().copied(), |z| -(z - centre[2]).abs());
    let on_nearest = points.iter().copied().filter(|p| Some(p[2]) == nearest);
    let first = first_by(on_nearest, |p| p[1]).ok_or(RoiError::NoSelection)?;
    let axis = if levels.z_mm().len() == 1 { 0 } else { 2 };
    let others = points.iter().copied().filter(|p| p[..2] != first[..2]);
    let second = first_by(others, |p| p[axis]).ok_or(RoiError::NoSecondPoint { selected })?;
    let (a, b) = (minus(first, centre), minus(second, centre));
    let normal = cross(a, b);
    let length = dot(normal, normal).sqrt();
    let largest = (dot(a, a) * dot(b, b)).sqrt();
    if length <= PARALLEL * largest {
        return Err(RoiError::NoNormal { selected });
    }
    let centroid = mesh.centroid_mm().unwrap_or_default();
    let outward = dot(normal, minus(centre, centroid)) > 0.0;
    Ok(normal.map(|component| (if outward { -component } else { component }) / length))
}

/// The mean of at least one point, by differences from the first one: a coordinate that all share
/// is the mean's to the bit, so a flat patch has an exactly perpendicular normal.
fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    let origin = points.first().copied().unwrap_or_default();
    let sum = points.iter().fold([0.0; 3], |sum: [f64; 3], &point| {
        let offset = minus(point, origin);
        [0, 1, 2].map(|axis| sum[axis] + offset[axis])
    });
    [0, 1, 2].map(|axis| origin[axis] + sum[axis] / points.len().max(1) as f64)
}

/// The first item of the largest value.
fn first_by<T: Copy>(items: impl Iterator<Item = T>, value: impl Fn(T) -> f64) -> Option<T> {
    items.reduce(|best, item| {
        if value(item) > value(best) {
            item
        } else {
            best
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The normal of the points numbered `selected`.
    fn normal(points: &[[f64; 3]], selected: &[u32]) -> Result<[f64; 3], RoiError> {
        let mesh = TriangleMesh::new(points.to_vec(), vec![]).unwrap();
        let selection = Selection::new(selected, points.len()).unwrap();
        let z = selected.iter().map(|&v| points[v as usize][2]);
        of_selection(&mesh, &selection, &Levels::of(z))
    }

    #[test]
    fn a_flat_patch_has_its_perpendicular_towards_the_centroid() {
        for (axis, side) in [
            (0, 1.0),
            (0, -1.0),
            (1, 1.0),
            (1, -1.0),
            (2, 1.0),
            (2, -1.0),
        ] {
            let mut points: Vec<[f64; 3]> = (0..12)
                .map(|i| (f64::from(i % 4), f64::from(i / 4)))
                .map(|(i, j)| (i * (0.3 + 0.1 * j), 0.7 * j))
                .map(|(u, v)| {
                    let mut point = [u, v, v];
                    point[(axis + 1) % 3] = u;
                    point[(axis + 2) % 3] = v;
                    point[axis] = 0.1 + side;
                    point
                })
                .collect();
            points.extend([[0.1; 3]; 40]);
            let selected: Vec<u32> = (0..12).collect();
            let mut expected = [0.0; 3];
            expected[axis] = -side;
            let found = normal(&points, &selected).unwrap();
            let error = minus(found, expected);
            assert!(dot(error, error) < 1e-20, "{axis} {side}: {found:?}");
        }
    }

    #[test]
    fn points_in_a_line_have_no_normal() {
        let line: Vec<[f64; 3]> = (0..5)
            .map(|i| [0.1, 0.3, 0.7].map(|c| c * f64::from(i)))
            .collect();
        assert!(matches!(
            normal(&line, &[0, 1, 2, 3, 4]),
            Err(RoiError::NoNormal { .. })
        ));
        let upright: Vec<[f64; 3]> = (0..5).map(|i| [1.0, 2.0, f64::from(i)]).collect();
        let error = normal(&upright, &[0, 1, 2, 3, 4]).unwrap_err();
        assert!(matches!(error, RoiError::NoSecondPoint { selected: 5 }));
    }
}
