//! The least principal direction with the sign that the published program got.
//!
//! That program's package finds it without iteration: eigenvalues from the cosines of a third of an
//! angle, eigenvectors as cross products of the rows of the shifted matrix. Its sign has no meaning, but
//! decides what the published similarity is, so it is found the same way here.
//!
//! D. Eberly, *A robust eigensolver for 3x3 symmetric matrices*, Geometric Tools, 2014.

type Vector = [f64; 3];
type Matrix = [Vector; 3];

/// Unit eigenvector of the smallest eigenvalue of a symmetric matrix; z for a matrix of nothing.
pub(super) fn least_direction(matrix: Matrix) -> Vector {
    let largest = matrix.as_flattened().iter().copied().fold(0.0, f64::max);
    if largest <= 0.0 {
        return [0.0, 0.0, 1.0];
    }
    let m = matrix.map(|row| row.map(|value| value / largest));
    let off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
    if off <= 0.0 {
        let [x, y, z] = [m[0][0], m[1][1], m[2][2]];
        return if x < y && x < z {
            [1.0, 0.0, 0.0]
        } else if y < x && y < z {
            [0.0, 1.0, 0.0]
        } else {
            [0.0, 0.0, 1.0]
        };
    }
    let (values, is_upper_single) = eigenvalues(m, off);
    // The eigenvalue that is surely single comes first, the vector of the other extreme last.
    let order = if is_upper_single {
        [2, 1, 0]
    } else {
        [0, 1, 2]
    };
    let least = (1..3).fold(0, |l, k| if values[k] < values[l] { k } else { l });
    let first = of_single_value(m, values[order[0]]);
    if least == order[0] {
        return first;
    }
    let second = across(m, first, values[order[1]]);
    if least == order[1] {
        return second;
    }
    if is_upper_single {
        cross(second, first)
    } else {
        cross(first, second)
    }
}

/// Rising eigenvalues, and whether the upper one is further from the middle one than the lower.
fn eigenvalues(m: Matrix, off: f64) -> (Vector, bool) {
    let mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
    let [a, b, c] = [0, 1, 2].map(|k| m[k][k] - mean);
    let spread = ((a * a + b * b + c * c + 2.0 * off) / 6.0).sqrt();
    let minor_a = b * c - m[1][2] * m[1][2];
    let minor_b = m[0][1] * c - m[1][2] * m[0][2];
    let minor_c = m[0][1] * m[1][2] - b * m[0][2];
    let determinant = a * minor_a - m[0][1] * minor_b + m[0][2] * minor_c;
    let half = (0.5 * determinant / (spread * spread * spread)).clamp(-1.0, 1.0);
    let angle = libm::acos(half) / 3.0;
    let upper = 2.0 * libm::cos(angle);
    let lower = 2.0 * libm::cos(angle + std::f64::consts::TAU / 3.0);
    let roots = [lower, -(lower + upper), upper];
    (roots.map(|root| mean + spread * root), half >= 0.0)
}

/// The longest cross product of two rows of the matrix less its eigenvalue.
fn of_single_value(m: Matrix, value: f64) -> Vector {
    let mut rows = m;
    (0..3).for_each(|k| rows[k][k] -= value);
    let products = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| cross(rows[i], rows[j]));
    let squares = products.map(|p| dot(p, p));
    let longest = (1..3).fold(0, |l, k| if squares[k] > squares[l] { k } else { l });
    let length = squares[longest].sqrt();
    products[longest].map(|x| x / length)
}

/// The eigenvector of a value among the directions across another eigenvector.
fn across(m: Matrix, other: Vector, value: f64) -> Vector {
    let [x, y, z] = other;
    let u = if x.abs() > y.abs() {
        let length = (x * x + z * z).sqrt();
        [-z / length, 0.0, x / length]
    } else {
        let length = (y * y + z * z).sqrt();
        [0.0, z / length, -y / length]
    };
    let v = cross(other, u);
    let form = |a: Vector, b: Vector| dot(a, m.map(|row| dot(row, b)));
    let (uu, uv, vv) = (form(u, u) - value, form(u, v), form(v, v) - value);
    let combined = |of_u: f64, of_v: f64| {
        let length = of_u.hypot(of_v);
        [0, 1, 2].map(|k| (of_u * u[k] - of_v * v[k]) / length)
    };
    // The larger row of the two tells the direction better; of no rows every direction is one.
    if uu.abs() >= vv.abs() {
        if uu.abs().max(uv.abs()) <= 0.0 {
            return u;
        }
        let sign = if uu.abs() >= uv.abs() { uu } else { uv }.signum();
        combined(sign * uv, sign * uu)
    } else {
        let sign = if vv.abs() >= uv.abs() { vv } else { uv }.signum();
        combined(sign * vv, sign * uv)
    }
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_is_an_eigenvector_of_the_smallest_value(
            steps in prop::collection::vec(prop::array::uniform3(-5.0..5.0f64), 4..12),
            others in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 20),
        ) {
            let mut m = [[0.0; 3]; 3];
            for s in &steps {
                for (i, row) in m.iter_mut().enumerate() {
                    (0..3).for_each(|k| row[k] += s[i] * s[k]);
                }
            }
            let form = |d: Vector| dot(d, m.map(|row| dot(row, d))) / dot(d, d);
            let least = least_direction(m);
            prop_assert!((dot(least, least) - 1.0).abs() < 1e-6);
            for other in others {
                prop_assert!(form(least) <= form(other) * (1.0 + 1e-6) + 1e-6 * form([1.0; 3]));
            }
        }
    }

    #[test]
    fn a_plane_has_its_own_normal_with_either_sign() {
        // Products of a slanted row of points in the plane of z.
        for (xx, xy, yy) in [(1.0, 0.5, 2.0), (3.0, -1.0, 0.7), (1.0, 0.0, 2.0)] {
            let m = [[xx, xy, 0.0], [xy, yy, 0.0], [0.0; 3]];
            assert!((least_direction(m)[2].abs() - 1.0).abs() < 1e-9);
        }
        assert!(least_direction([[0.0; 3]; 3])[2] > 0.999_999);
    }
}
