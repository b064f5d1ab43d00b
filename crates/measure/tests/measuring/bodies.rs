//! Bodies of known size.

use bonemesh_mesh::TriangleMesh;

/// A box from one corner to the other.
pub(crate) fn cuboid(low: [f64; 3], high: [f64; 3]) -> TriangleMesh {
    let vertices = (0..8_usize).map(|v| {
        [0, 1, 2].map(|axis| {
            if v >> axis & 1 == 0 {
                low[axis]
            } else {
                high[axis]
            }
        })
    });
    // Each side as two triangles, counter-clockwise from outside.
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = sides
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    TriangleMesh::new(vertices.collect(), triangles.collect()).unwrap()
}

/// A ball of `rings` rings of 2 `rings` vertices.
pub(crate) fn ball(middle: [f64; 3], radius: f64, rings: u32) -> TriangleMesh {
    let around = 2 * rings;
    let place = |ring: u32, step: u32| {
        let (down, turn) = (
            std::f64::consts::PI * f64::from(ring) / f64::from(rings),
            std::f64::consts::TAU * f64::from(step) / f64::from(around),
        );
        let unit = [down.sin() * turn.cos(), down.sin() * turn.sin(), down.cos()];
        [0, 1, 2].map(|axis| middle[axis] + radius * unit[axis])
    };
    let mut vertices = vec![place(0, 0)];
    vertices.extend((1..rings).flat_map(|r| (0..around).map(move |s| place(r, s))));
    vertices.push(place(rings, 0));
    let last = vertices.len() as u32 - 1;
    let at = |ring: u32, step: u32| 1 + (ring - 1) * around + step % around;
    let mut triangles = Vec::new();
    for s in 0..around {
        triangles.push([0, at(1, s), at(1, s + 1)]);
        triangles.push([last, at(rings - 1, s + 1), at(rings - 1, s)]);
        for r in 1..rings - 1 {
            triangles.push([at(r, s), at(r + 1, s), at(r + 1, s + 1)]);
            triangles.push([at(r, s), at(r + 1, s + 1), at(r, s + 1)]);
        }
    }
    TriangleMesh::new(vertices, triangles).unwrap()
}

/// The same mesh moved.
pub(crate) fn moved(mesh: &TriangleMesh, by: [f64; 3]) -> TriangleMesh {
    let vertices = mesh
        .vertices_mm()
        .iter()
        .map(|v| [0, 1, 2].map(|axis| v[axis] + by[axis]));
    TriangleMesh::new(vertices.collect(), mesh.triangles().to_vec()).unwrap()
}

/// Two meshes as one.
pub(crate) fn together(a: &TriangleMesh, b: &TriangleMesh) -> TriangleMesh {
    let offset = a.vertices_mm().len() as u32;
    let shifted = b.triangles().iter().map(|t| t.map(|v| v + offset));
    let vertices = [a.vertices_mm(), b.vertices_mm()].concat();
    let triangles = a.triangles().iter().copied().chain(shifted).collect();
    TriangleMesh::new(vertices, triangles).unwrap()
}

/// The same mesh facing the other way.
pub(crate) fn turned(mesh: &TriangleMesh) -> TriangleMesh {
    let triangles = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]);
    TriangleMesh::new(mesh.vertices_mm().to_vec(), triangles.collect()).unwrap()
}
