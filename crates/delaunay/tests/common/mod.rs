//! An oracle that shares nothing with the crate: plain i128 determinants, all points at once.

// Each test file is a crate of its own and uses a part of this.
#![allow(dead_code)]

use bonemesh_delaunay::{DelaunayError, Points, Tetrahedra, tetrahedralize};
use bonemesh_task::Task;
use proptest::prelude::*;

/// Exact lattice geometry with an integer Gram matrix.
pub(crate) struct Oracle<'a> {
    pub(crate) points: &'a [[i32; 3]],
    pub(crate) gram: [[i64; 3]; 3],
}

/// The metric of a 1 x 1 x 1 lattice.
pub(crate) const CUBIC: [[i64; 3]; 3] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

impl Oracle<'_> {
    fn at(&self, v: u32) -> [i128; 3] {
        self.points[v as usize].map(i128::from)
    }

    pub(crate) fn gram_f64(&self) -> [[f64; 3]; 3] {
        self.gram.map(|row| row.map(|g| g as f64))
    }

    pub(crate) fn lattice(&self) -> Points<'_> {
        Points::Lattice {
            coordinates: self.points,
            gram: self.gram_f64(),
        }
    }

    /// Six times the signed volume.
    pub(crate) fn orientation(&self, cell: [u32; 4]) -> i128 {
        let [a, b, c, d] = cell.map(|v| self.at(v));
        det3([sub(b, a), sub(c, a), sub(d, a)])
    }

    /// Six times the signed volume between a triangle and the origin.
    pub(crate) fn cone(&self, triangle: [u32; 3]) -> i128 {
        det3(triangle.map(|v| self.at(v)))
    }

    /// Positive inside the circumsphere of a positive cell, 0 on it, negative outside.
    pub(crate) fn in_sphere(&self, cell: [u32; 4], query: u32) -> i128 {
        let q = self.at(query);
        let rows = cell.map(|v| {
            let p = sub(self.at(v), q);
            [p[0], p[1], p[2], self.squared(p)]
        });
        // Expansion of the 4 x 4 determinant by its last column.
        (0..4)
            .map(|i| {
                let others: Vec<[i128; 3]> = (0..4)
                    .filter(|&j| j != i)
                    .map(|j| [rows[j][0], rows[j][1], rows[j][2]])
                    .collect();
                let minor = det3([others[0], others[1], others[2]]);
                let sign = if i % 2 == 0 { 1 } else { -1 };
                sign * rows[i][3] * minor
            })
            .sum()
    }

    /// The squared circumradius as a fraction: `N^T adj(G) N / (4 D^2 det G)`, with `D` and `N`
    /// the determinant and the sum of squared lengths times cross products of three edges.
    pub(crate) fn radius_squared(&self, cell: [u32; 4]) -> (i128, i128) {
        let [a, b, c, d] = cell.map(|v| self.at(v));
        let [u, v, w] = [sub(b, a), sub(c, a), sub(d, a)];
        let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
        let [lu, lv, lw] = [u, v, w].map(|e| self.squared(e));
        let normal = [0, 1, 2].map(|k| lu * vw[k] + lv * wu[k] + lw * uv[k]);
        let rows = self.gram.map(|row| row.map(i128::from));
        let adjugate = [
            cross(rows[1], rows[2]),
            cross(rows[2], rows[0]),
            cross(rows[0], rows[1]),
        ];
        let centre = adjugate.map(|row| dot(row, normal));
        let volume = det3([u, v, w]);
        (dot(normal, centre), 4 * volume * volume * det3(rows))
    }

    fn squared(&self, p: [i128; 3]) -> i128 {
        (0..3)
            .flat_map(|i| (0..3).map(move |j| (i, j)))
            .map(|(i, j)| i128::from(self.gram[i][j]) * p[i] * p[j])
            .sum()
    }

    /// The promise: positive cells, empty spheres, and together exactly the convex hull.
    pub(crate) fn assert_delaunay(&self, cells: &Tetrahedra) {
        assert!(!cells.cells.is_empty());
        for &cell in &cells.cells {
            assert!(self.orientation(cell) > 0, "cell {cell:?} is not positive");
            for query in 0..self.points.len() as u32 {
                let side = self.in_sphere(cell, query);
                assert!(side <= 0, "point {query} is inside the sphere of {cell:?}");
            }
        }
        let boundary = cells.boundary(&Task::default()).expect("nobody cancels");
        self.assert_convex(&boundary);
        // Cells that overlapped would have more volume than their outer boundary encloses.
        let within: i128 = cells.cells.iter().map(|&c| self.orientation(c)).sum();
        let enclosed: i128 = boundary.iter().map(|&t| self.cone(t)).sum();
        assert_eq!(within, enclosed, "six times the volume");
        assert_eq!(euler_characteristic(&cells.cells), 1, "a ball");
    }

    /// A closed surface that has every point behind or on each of its triangles.
    fn assert_convex(&self, boundary: &[[u32; 3]]) {
        for &[a, b, c] in boundary {
            for p in 0..self.points.len() as u32 {
                assert!(
                    self.orientation([a, b, c, p]) <= 0,
                    "{p} is outside the hull"
                );
            }
        }
        let mut edges: Vec<[u32; 2]> = boundary
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .collect();
        edges.sort_unstable();
        let mut twins: Vec<[u32; 2]> = edges.iter().map(|&[a, b]| [b, a]).collect();
        twins.sort_unstable();
        assert_eq!(edges, twins, "the hull is closed and oriented");
    }

    pub(crate) fn tetrahedra(&self) -> Result<Tetrahedra, DelaunayError> {
        tetrahedralize(self.lattice(), &Task::default())
    }
}

/// Pixels of 1 x 1, slices of 3.
pub(crate) const SLICES: [[i64; 3]; 3] = [[1, 0, 0], [0, 1, 0], [0, 0, 9]];

/// Lattice points as free ones.
pub(crate) fn as_f64(points: &[[i32; 3]]) -> Vec<[f64; 3]> {
    points.iter().map(|p| p.map(f64::from)).collect()
}

fn sub(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn det3([u, v, w]: [[i128; 3]; 3]) -> i128 {
    u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

/// Vertices - edges + triangles - tetrahedra.
pub(crate) fn euler_characteristic(cells: &[[u32; 4]]) -> i64 {
    let mut faces: [Vec<Vec<u32>>; 4] = Default::default();
    for cell in cells {
        for subset in 1u32..16 {
            let mut face: Vec<u32> = (0..4)
                .filter(|k| subset >> k & 1 == 1)
                .map(|k| cell[k as usize])
                .collect();
            face.sort_unstable();
            faces[face.len() - 1].push(face);
        }
    }
    let count = faces.map(|mut f| {
        f.sort_unstable();
        f.dedup();
        f.len() as i64
    });
    count[0] - count[1] + count[2] - count[3]
}

/// Cells by the coordinates of their vertices, so that numbering does not matter.
pub(crate) fn named<T: Copy>(cells: &Tetrahedra, points: &[T]) -> Vec<[T; 4]> {
    let cells = cells.cells.iter();
    cells.map(|c| c.map(|v| points[v as usize])).collect()
}

/// Point sets of every kind that goes wrong: blocks, shells, planes with a point off them,
/// cospherical sets, few points, duplicates.
pub(crate) fn nasty() -> impl Strategy<Value = Vec<[i32; 3]>> {
    let wide = prop::array::uniform3(-300..300i32);
    let narrow = prop::array::uniform3(0..4i32);
    let flat = [0..6i32, 0..6i32, 0..2i32];
    prop_oneof![
        prop::collection::vec(wide, 1..40),
        prop::collection::vec(narrow, 1..60),
        prop::collection::vec(flat, 1..60),
        (1..5i32, 1..5i32, 1..4i32).prop_map(|(x, y, z)| block([x, y, z])),
        (1..5i32).prop_map(|n| [block([n, n, 1]), vec![[1, 1, n], [2, 0, -n]]].concat()),
        Just(cospherical()),
        (prop::collection::vec(prop::array::uniform3(0..5i32), 1..20))
            .prop_map(|p| [p.clone(), p].concat()),
    ]
}

/// All points of a block.
pub(crate) fn block([x, y, z]: [i32; 3]) -> Vec<[i32; 3]> {
    (0..z)
        .flat_map(|k| (0..y).flat_map(move |j| (0..x).map(move |i| [i, j, k])))
        .collect()
}

/// All lattice points at the distance sqrt(26) from the origin: 72 points of one sphere.
pub(crate) fn cospherical() -> Vec<[i32; 3]> {
    let mut points = block([11, 11, 11]);
    for p in &mut points {
        *p = p.map(|v| v - 5);
    }
    points.retain(|p| p.iter().map(|v| v * v).sum::<i32>() == 26);
    points
}
