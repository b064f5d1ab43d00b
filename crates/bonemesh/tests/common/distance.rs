//! Distances from points to a mesh: the closest point on its triangles.

use std::collections::HashMap;

use bonemesh::TriangleMesh;

type Point = [f64; 3];

pub(crate) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

fn along(a: Point, direction: Point, t: f64) -> Point {
    std::array::from_fn(|c| a[c] + t * direction[c])
}

pub(crate) fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The triangles of a mesh in cubic cells.
pub(crate) struct Triangles {
    corners: Vec<[Point; 3]>,
    cells: HashMap<[i32; 3], Vec<u32>>,
    side: f64,
}

impl Triangles {
    /// Cells of `side` mm: a few triangles wide is quickest.
    pub(crate) fn new(mesh: &TriangleMesh, side: f64) -> Self {
        let corners: Vec<[Point; 3]> = mesh
            .triangles()
            .iter()
            .map(|t| mesh.corners_mm(*t))
            .collect();
        let mut cells: HashMap<[i32; 3], Vec<u32>> = HashMap::new();
        for (number, triangle) in corners.iter().enumerate() {
            let bound = |c: usize, least: fn(f64, f64) -> f64| {
                let value = least(least(triangle[0][c], triangle[1][c]), triangle[2][c]);
                (value / side).floor() as i32
            };
            let [low, high] = [f64::min, f64::max].map(|f| [0, 1, 2].map(|c| bound(c, f)));
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        cells.entry([x, y, z]).or_default().push(number as u32);
                    }
                }
            }
        }
        Self {
            corners,
            cells,
            side,
        }
    }

    /// Distance (mm) to the closest point on a triangle, positive on the triangle's outer side.
    pub(crate) fn signed_distance_mm(&self, p: Point) -> f64 {
        let home = p.map(|v| (v / self.side).floor() as i32);
        let mut best = (f64::INFINITY, 0.0);
        for ring in 0..200_i32 {
            // Whatever lies in a ring is at least this far away.
            if best.0 <= f64::from(ring - 1).max(0.0) * self.side {
                break;
            }
            self.look(p, home, ring, &mut best);
        }
        best.0.copysign(best.1)
    }

    fn look(&self, p: Point, home: [i32; 3], ring: i32, best: &mut (f64, f64)) {
        for x in -ring..=ring {
            for y in -ring..=ring {
                let is_side = x.abs() == ring || y.abs() == ring;
                let step = if is_side { 1 } else { (2 * ring).max(1) };
                for z in (-ring..=ring).step_by(step as usize) {
                    let cell = [home[0] + x, home[1] + y, home[2] + z];
                    for &number in self.cells.get(&cell).into_iter().flatten() {
                        let [a, b, c] = self.corners[number as usize];
                        let away = sub(p, closest(p, a, b, c));
                        // Of equally near triangles the one that faces the point most tells the
                        // side; its normal need not be a unit vector for that.
                        let normal = cross(sub(b, a), sub(c, a));
                        let facing = dot(away, normal) / length(normal).max(1e-300);
                        let distance = length(away);
                        let nearer = distance < best.0 - 1e-9;
                        let tells_more = distance < best.0 + 1e-9 && facing.abs() > best.1.abs();
                        if nearer || tells_more {
                            *best = (distance, facing);
                        }
                    }
                }
            }
        }
    }
}

/// The closest point of triangle `abc`, by the region of its plane that `p` lies over (Ericson,
/// *Real-Time Collision Detection*, 2005).
fn closest(p: Point, a: Point, b: Point, c: Point) -> Point {
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = sub(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return along(a, ab, d1 / (d1 - d3));
    }
    let cp = sub(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return along(a, ac, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return along(b, sub(c, b), t);
    }
    let scale = 1.0 / (va + vb + vc);
    along(along(a, ab, vb * scale), ac, vc * scale)
}

/// Mean of the sizes and mean with sign.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Means {
    pub(crate) unsigned: f64,
    pub(crate) signed: f64,
    /// 95 % are smaller in size.
    pub(crate) p95: f64,
}

/// Weighted means of signed distances.
pub(crate) fn means(distances: impl IntoIterator<Item = (f64, f64)>) -> Means {
    let mut all: Vec<(f64, f64)> = distances.into_iter().collect();
    all.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let total: f64 = all.iter().map(|(_, weight)| weight).sum();
    let mut means = Means::default();
    let mut seen = 0.0;
    for (distance, weight) in all {
        means.unsigned += distance.abs() * weight / total;
        means.signed += distance * weight / total;
        seen += weight;
        if seen <= 0.95 * total {
            means.p95 = distance.abs();
        }
    }
    means
}

/// The middle of every `stride`-th triangle, with its area as its weight.
pub(crate) fn sampled(mesh: &TriangleMesh, stride: usize) -> Vec<(Point, f64)> {
    let triangles = mesh.triangles().iter().step_by(stride);
    triangles
        .map(|t| {
            let [a, b, c] = mesh.corners_mm(*t);
            let middle = std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0);
            (middle, length(cross(sub(b, a), sub(c, a))) / 2.0)
        })
        .collect()
}

/// The shift (mm) that explains signed distances best: least squares of `d - n . shift` over the
/// bone's outward normals `n`.
pub(crate) fn shift(distances: impl IntoIterator<Item = (f64, Point)>) -> Point {
    let mut rows = [[0.0; 3]; 3];
    let mut sides = [0.0; 3];
    for (d, n) in distances {
        for r in 0..3 {
            sides[r] += d * n[r];
            for c in 0..3 {
                rows[r][c] += n[r] * n[c];
            }
        }
    }
    // Cramer's rule; the matrix is symmetric, so its rows are its columns.
    let [a, b, c] = rows;
    let whole = dot(a, cross(b, c));
    [
        dot(sides, cross(b, c)) / whole,
        dot(a, cross(sides, c)) / whole,
        dot(a, cross(b, sides)) / whole,
    ]
}
