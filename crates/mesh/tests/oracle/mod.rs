//! What two triangles of whole coordinates share, in whole numbers: every corner of the shared
//! (convex) set as a fraction. It knows no projections and no signs of four points.

type Vector = [i128; 3];

/// A point `[x, y, z] / w`.
#[derive(Clone, Copy)]
struct Fraction {
    n: Vector,
    w: i128,
}

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: Vector, b: Vector) -> i128 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

impl Fraction {
    fn whole(n: Vector) -> Self {
        Self { n, w: 1 }
    }

    /// `w` times the vector from `a` to this point; `w` is positive.
    fn from(&self, a: Vector) -> Vector {
        [0, 1, 2].map(|axis| self.n[axis] - self.w * a[axis])
    }

    fn is_in(&self, [a, b, c]: [Vector; 3]) -> bool {
        let normal = cross(minus(b, a), minus(c, a));
        dot(normal, self.from(a)) == 0
            && [[a, b], [b, c], [c, a]]
                .iter()
                .all(|[p, q]| dot(normal, cross(minus(*q, *p), self.from(*p))) >= 0)
    }

    fn is_on(&self, [p, q]: [Vector; 2]) -> bool {
        let (along, here) = (minus(q, p), self.from(p));
        cross(along, here) == [0; 3]
            && dot(along, here) >= 0
            && dot(along, here) <= self.w * dot(along, along)
    }
}

/// The point of the segment `p`, `q` where the linear function with values `u` and `v` there is 0.
fn between(p: Vector, q: Vector, u: i128, v: i128) -> Fraction {
    let (w, sign) = ((u - v).abs(), (u - v).signum());
    let n = [0, 1, 2].map(|axis| sign * (u * q[axis] - v * p[axis]));
    Fraction { n, w }
}

/// Points of which the convex hull is what the triangles share (and some more of it).
fn shared(a: [Vector; 3], b: [Vector; 3]) -> Vec<Fraction> {
    let mut points = Vec::new();
    for (from, to) in [(a, b), (b, a)] {
        let normal = cross(minus(to[1], to[0]), minus(to[2], to[0]));
        for (p, q) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (from[i], from[j])) {
            points.push(Fraction::whole(p));
            let height = |point| dot(normal, minus(point, to[0]));
            if height(p) != height(q) {
                points.push(between(p, q, height(p), height(q)));
            }
            for (r, s) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (to[i], to[j])) {
                // The plane through the edge `r`, `s` at right angles to the triangle.
                let upright = cross(normal, minus(s, r));
                let beside = |point| dot(upright, minus(point, r));
                if beside(p) != beside(q) {
                    points.push(between(p, q, beside(p), beside(q)));
                }
            }
        }
    }
    points.retain(|point| point.is_in(a) && point.is_in(b));
    // Crossings beyond the ends of an edge are in neither triangle or in both anyway.
    points
}

/// Whether three points are on one line.
pub(crate) fn is_flat([a, b, c]: [[i32; 3]; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(|p| p.map(i128::from));
    cross(minus(b, a), minus(c, a)) == [0; 3]
}

/// Whether the triangles share more than a corner or an edge of both.
pub(crate) fn meet(a: [[i32; 3]; 3], b: [[i32; 3]; 3]) -> bool {
    let [a, b] = [a, b].map(|t| t.map(|p| p.map(i128::from)));
    let common: Vec<Vector> = a.into_iter().filter(|p| b.contains(p)).collect();
    let shared = shared(a, b);
    match common[..] {
        [] => !shared.is_empty(),
        [p] => shared.iter().any(|point| point.from(p) != [0; 3]),
        [p, q] => shared.iter().any(|point| !point.is_on([p, q])),
        _ => true,
    }
}
