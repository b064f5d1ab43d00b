//! Lines in the plane of a slice, which have no sign.
//!
//! The normal of a contour, found among points of one plane, has one too few dimensions to be told from
//! that of the plane by principal components in space. In the plane it is at right angles to the line
//! that fits the points best, and two lines differ by an angle of at most a right one.

/// Direction of twice the angle of the line that fits `places` best (their larger principal axis), of
/// length 1: lines that are equal but for their sign have the same. 0 where no line is better than another.
pub(super) fn double_angle(places: impl Iterator<Item = [f64; 2]> + Clone) -> [f64; 2] {
    let (mut sum, mut count) = ([0.0; 2], 0.0);
    for [x, y] in places.clone() {
        sum = [sum[0] + x, sum[1] + y];
        count += 1.0;
    }
    let mean = sum.map(|s| s / count);
    let (mut difference, mut mixed) = (0.0, 0.0);
    for [x, y] in places {
        let [x, y] = [x - mean[0], y - mean[1]];
        difference += (x - y) * (x + y);
        mixed += 2.0 * x * y;
    }
    let length = difference.hypot(mixed);
    if length > 0.0 {
        [difference / length, mixed / length]
    } else {
        [0.0; 2]
    }
}

/// Square of the sine of the angle between two lines.
pub(super) fn squared_sine(a: [f64; 2], b: [f64; 2]) -> f64 {
    (0.5 * (1.0 - (a[0] * b[0] + a[1] * b[1]))).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_no_sign() {
        let at = |angle: f64, t: f64| [5.0 + t * angle.cos(), -3.0 + t * angle.sin()];
        for degrees in [0.0_f64, 30.0, 90.0, 135.0] {
            let angle = degrees.to_radians();
            let there = double_angle((0..9).map(|t| at(angle, f64::from(t))));
            let back = double_angle((0..9).map(|t| at(angle, -f64::from(t))));
            assert!(squared_sine(there, back) < 1e-12);
            assert!((there[0] - (2.0 * angle).cos()).abs() < 1e-12);
            let across = double_angle((0..9).map(|t| at(angle + 0.5, f64::from(t))));
            assert!((squared_sine(there, across) - 0.5_f64.sin().powi(2)).abs() < 1e-12);
        }
    }

    #[test]
    fn points_without_a_line_have_none() {
        let is_none = |[x, y]: [f64; 2]| x == 0.0 && y == 0.0;
        assert!(is_none(double_angle([[1.0, 2.0]; 4].into_iter())));
        let square = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        assert!(is_none(double_angle(square.into_iter())));
    }
}
