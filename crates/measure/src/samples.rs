//! Places spread evenly over a surface.

use bonemesh_mesh::TriangleMesh;

use bonemesh_mesh::vector::{cross, length, minus};

/// Steps of the sequence that spreads places over triangles: the plastic number's powers, after M. Roberts, *The
/// unreasonable effectiveness of quasirandom sequences*, 2018.
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// The area (mm2) of each triangle.
pub(crate) fn areas_mm2(mesh: &TriangleMesh) -> Vec<f64> {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = mesh.corners_mm(*t);
        0.5 * length(cross(minus(b, a), minus(c, a)))
    };
    mesh.triangles().iter().map(area).collect()
}

/// `count` places, as many a square millimetre everywhere, by a sequence that is always the same.
pub(crate) fn places_mm(mesh: &TriangleMesh, areas_mm2: &[f64], count: usize) -> Vec<[f64; 3]> {
    let total: f64 = areas_mm2.iter().sum();
    if total <= 0.0 {
        return Vec::new();
    }
    let step = total / count as f64;
    let mut places = Vec::with_capacity(count);
    let mut upto = 0.0;
    for (triangle, area) in mesh.triangles().iter().zip(areas_mm2) {
        upto += area;
        // Each place stands for one step of area, in the middle of which it lies.
        while places.len() < count && (places.len() as f64 + 0.5) * step < upto {
            places.push(within(mesh.corners_mm(*triangle), places.len() as f64));
        }
    }
    places
}

/// The place in a triangle that belongs to a number.
fn within(corners: [[f64; 3]; 3], number: f64) -> [f64; 3] {
    let [mut u, mut v] = STEPS.map(|step| (0.5 + number * step).fract());
    // The far half of the parallelogram is folded over.
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    let [a, b, c] = corners;
    [0, 1, 2].map(|axis| a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_lie_evenly_by_area() {
        // A small triangle and one of eight times its area.
        let vertices = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-2.0, 0.0], [0.0, -8.0]];
        let vertices = vertices.map(|[x, y]| [x, y, 5.0]).to_vec();
        let mesh = TriangleMesh::new(vertices, vec![[0, 1, 2], [0, 3, 4]]).unwrap();
        let areas = areas_mm2(&mesh);
        let places = places_mm(&mesh, &areas, 1700);
        assert_eq!(places.len(), 1700);
        let in_small = places.iter().filter(|p| p[0] > 0.0 && p[1] > 0.0).count();
        assert!((95..=105).contains(&in_small), "{in_small}");
        // Their mean is the centre of the area.
        let mean = [0, 1, 2].map(|axis| places.iter().map(|p| p[axis]).sum::<f64>() / 1700.0);
        let centre = |axis: usize| {
            let of = |t: usize| {
                let corners = mesh.corners_mm(mesh.triangles()[t]);
                areas[t] * corners.iter().map(|c| c[axis]).sum::<f64>() / 3.0
            };
            (of(0) + of(1)) / (areas[0] + areas[1])
        };
        assert!(
            (0..3).all(|axis| (mean[axis] - centre(axis)).abs() < 0.02),
            "{mean:?}"
        );
    }

    #[test]
    fn a_surface_without_area_has_no_places() {
        let flat = TriangleMesh::new(vec![[1.0; 3]; 3], vec![[0, 1, 2]]).unwrap();
        assert!(places_mm(&flat, &areas_mm2(&flat), 10).is_empty());
    }
}
