//! Small meshes of known topology.
#![allow(dead_code, reason = "each test file uses its own few")]

use bonemesh_mesh::TriangleMesh;

/// Corners of a box, corner number in binary: bit 0 is x, bit 1 is y, bit 2 is z.
pub(crate) fn box_vertices(low: [f64; 3], high: [f64; 3]) -> Vec<[f64; 3]> {
    (0..8)
        .map(|corner| {
            std::array::from_fn(|axis| {
                if corner >> axis & 1 == 1 {
                    high[axis]
                } else {
                    low[axis]
                }
            })
        })
        .collect()
}

/// The box's twelve triangles, outward, two a side in the order -x +x -y +y -z +z.
pub(crate) const BOX: [[u32; 3]; 12] = [
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
];

pub(crate) fn mesh(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    TriangleMesh::new(vertices, triangles).expect("the shapes are valid meshes")
}

pub(crate) fn box_mesh(low: [f64; 3], high: [f64; 3]) -> TriangleMesh {
    mesh(box_vertices(low, high), BOX.to_vec())
}

/// Two meshes as one, without merging.
pub(crate) fn together(a: &TriangleMesh, b: &TriangleMesh) -> TriangleMesh {
    let offset = a.vertices_mm().len() as u32;
    let shifted = b.triangles().iter().map(|t| t.map(|v| v + offset));
    mesh(
        [a.vertices_mm(), b.vertices_mm()].concat(),
        a.triangles().iter().copied().chain(shifted).collect(),
    )
}

/// A grid of `columns` by `rows` squares bent around the z axis and then a circle: a torus.
pub(crate) fn torus(columns: u32, rows: u32) -> TriangleMesh {
    let angle = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let vertices = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (column, row)))
        .map(|(column, row)| {
            let (u, v) = (angle(column, columns), angle(row, rows));
            let radius = 40.0 + 10.0 * v.cos();
            [radius * u.cos(), radius * u.sin(), 10.0 * v.sin()]
        })
        .collect();
    let at = |column: u32, row: u32| row % rows * columns + column % columns;
    let triangles = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (column, row)))
        .flat_map(|(c, r)| {
            let [a, b] = [at(c, r), at(c + 1, r)];
            let [d, e] = [at(c, r + 1), at(c + 1, r + 1)];
            [[a, b, e], [a, e, d]]
        })
        .collect();
    mesh(vertices, triangles)
}
