//! The least principal direction of a symmetric matrix.

/// Rotations over all three pairs of axes; a handful brings rounding level.
const SWEEPS: usize = 12;

/// Unit eigenvector of the smallest eigenvalue of a symmetric matrix, by Jacobi's rotations.
///
/// Of equal eigenvalues the later axis wins, so a matrix of nothing gives z.
pub(super) fn least_direction(mut m: [[f64; 3]; 3]) -> [f64; 3] {
    // Columns are the directions found so far.
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let size = m
        .as_flattened()
        .iter()
        .fold(0.0, |s: f64, x| s.max(x.abs()));
    for _ in 0..SWEEPS {
        let off = m[0][1].abs() + m[0][2].abs() + m[1][2].abs();
        if off <= size * f64::EPSILON {
            break;
        }
        for [p, q] in [[0, 1], [0, 2], [1, 2]] {
            rotate(&mut m, &mut v, p, q);
        }
    }
    let least = (0..3).fold(0, |l, k| if m[k][k] <= m[l][l] { k } else { l });
    let direction = v.map(|row| row[least]);
    let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
    direction.map(|x| x / length)
}

/// Turns axes `p` and `q` so that their off-diagonal entry vanishes.
fn rotate(m: &mut [[f64; 3]; 3], v: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if m[p][q] == 0.0 {
        return;
    }
    let ratio = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
    let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    for row in m.iter_mut().chain(v.iter_mut()) {
        (row[p], row[q]) = (
            cosine * row[p] - sine * row[q],
            sine * row[p] + cosine * row[q],
        );
    }
    let turned = |k: usize| {
        (
            cosine * m[p][k] - sine * m[q][k],
            sine * m[p][k] + cosine * m[q][k],
        )
    };
    let rows = [turned(0), turned(1), turned(2)];
    m[p] = rows.map(|r| r.0);
    m[q] = rows.map(|r| r.1);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn nothing_and_equal_directions_give_the_last_axis() {
        assert!(least_direction([[0.0; 3]; 3])[2] > 0.999_999);
        let ball = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
        assert!(least_direction(ball)[2] > 0.999_999);
    }

    proptest! {
        #[test]
        fn no_direction_has_a_smaller_form(
            steps in prop::collection::vec(prop::array::uniform3(-5.0..5.0f64), 3..12),
            others in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 20),
        ) {
            let mut m = [[0.0; 3]; 3];
            for s in &steps {
                for (i, row) in m.iter_mut().enumerate() {
                    (0..3).for_each(|k| row[k] += s[i] * s[k]);
                }
            }
            let form = |d: [f64; 3]| -> f64 {
                let length = d.iter().map(|x| x * x).sum::<f64>();
                steps.iter().map(|s| (0..3).map(|k| s[k] * d[k]).sum::<f64>().powi(2)).sum::<f64>() / length
            };
            let least = form(least_direction(m));
            for other in others {
                prop_assert!(least <= form(other) * (1.0 + 1e-9) + 1e-9);
            }
        }
    }
}
