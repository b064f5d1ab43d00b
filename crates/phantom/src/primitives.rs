//! Signed distances to elementary solids: exact, negative inside, mm.

use crate::vector::{Vec3, add, cross, dot, length, scale, sub};

/// Distance to an ellipsoid about the origin.
///
/// The nearest surface point is `x_i = r_i^2 p_i / (t + r_i^2)` for the largest root `t` of
/// `sum (r_i p_i / (t + r_i^2))^2 = 1`; the sum falls and is convex there, so that Newton's
/// steps from the left of the root never pass it.
pub(crate) fn ellipsoid(p: Vec3, r: Vec3) -> f64 {
    let p = p.map(f64::abs);
    let inside = (0..3).map(|i| (p[i] / r[i]).powi(2)).sum::<f64>() < 1.0;
    let mut t = (0..3)
        .map(|i| r[i] * p[i] - r[i] * r[i])
        .fold(f64::NEG_INFINITY, f64::max);
    for _ in 0..24 {
        let (mut sum, mut slope) = (-1.0, 0.0);
        for i in 0..3 {
            let reach = t + r[i] * r[i];
            if reach > 0.0 && p[i] > 0.0 {
                let term = (r[i] * p[i] / reach).powi(2);
                sum += term;
                slope -= 2.0 * term / reach;
            }
        }
        if sum <= 1e-13 || slope == 0.0 {
            break;
        }
        t -= sum / slope;
    }
    let mut near = [0.0; 3];
    let mut missing = None;
    for i in 0..3 {
        let reach = t + r[i] * r[i];
        if reach > 0.0 {
            near[i] = r[i] * r[i] * p[i] / reach;
        } else {
            missing = Some(i);
        }
    }
    // On the plane through the centre across the shortest axis the nearest point leaves the plane.
    if let Some(i) = missing {
        let rest: f64 = (0..3).map(|j| (near[j] / r[j]).powi(2)).sum();
        near[i] = r[i] * (1.0 - rest).max(0.0).sqrt();
    }
    let distance = length(sub(p, near));
    if inside { -distance } else { distance }
}

/// Distance to the hull of two balls (a capsule where the radii are equal).
pub(crate) fn round_cone(p: Vec3, a: Vec3, b: Vec3, ra: f64, rb: f64) -> f64 {
    let axis = sub(b, a);
    let long = length(axis);
    let fall = ra - rb;
    // One ball inside the other.
    if long <= fall.abs() {
        return if ra > rb {
            length(sub(p, a)) - ra
        } else {
            length(sub(p, b)) - rb
        };
    }
    let along = dot(sub(p, a), axis) / long;
    let off = (dot(sub(p, a), sub(p, a)) - along * along).max(0.0).sqrt();
    // The mantle touches both balls where its normal meets the axis at this sine.
    let (sin, cos) = (fall / long, (1.0 - (fall / long).powi(2)).sqrt());
    let foot = along - off * sin / cos;
    if foot <= 0.0 {
        along.hypot(off) - ra
    } else if foot >= long {
        (along - long).hypot(off) - rb
    } else {
        off * cos + along * sin - ra
    }
}

/// Distance to a box about the origin, its edges rounded by `round`.
pub(crate) fn cuboid(p: Vec3, half: Vec3, round: f64) -> f64 {
    let q: Vec3 = std::array::from_fn(|i| p[i].abs() - half[i] + round);
    let outside = length(q.map(|v| v.max(0.0)));
    outside + q[0].max(q[1]).max(q[2]).min(0.0) - round
}

/// Distance to a cylinder with flat ends at `a` and `b`.
pub(crate) fn cylinder(p: Vec3, a: Vec3, b: Vec3, radius: f64) -> f64 {
    let axis = sub(b, a);
    let long = length(axis);
    let along = dot(sub(p, a), axis) / long;
    let off = (dot(sub(p, a), sub(p, a)) - along * along).max(0.0).sqrt();
    let q = [off - radius, (along - long / 2.0).abs() - long / 2.0];
    q[0].max(0.0).hypot(q[1].max(0.0)) + q[0].max(q[1]).min(0.0)
}

/// Distance to a tube (a cylinder with a bore) with flat ends at `a` and `b`.
pub(crate) fn tube(p: Vec3, a: Vec3, b: Vec3, inner: f64, outer: f64) -> f64 {
    let axis = sub(b, a);
    let long = length(axis);
    let along = dot(sub(p, a), axis) / long;
    let off = (dot(sub(p, a), sub(p, a)) - along * along).max(0.0).sqrt();
    let wall = (off - f64::midpoint(inner, outer)).abs() - (outer - inner) / 2.0;
    let q = [wall, (along - long / 2.0).abs() - long / 2.0];
    q[0].max(0.0).hypot(q[1].max(0.0)) + q[0].max(q[1]).min(0.0)
}

/// Distance to a box about the origin with a square hole of half side `hole` along z.
pub(crate) fn holed_box(p: Vec3, half: Vec3, hole: f64) -> f64 {
    let square = |a: f64, b: f64| {
        let q = [p[0].abs() - a, p[1].abs() - b];
        q[0].max(0.0).hypot(q[1].max(0.0)) + q[0].max(q[1]).min(0.0)
    };
    // In the plane both walls are exact, so is the nearer of them, and so is the prism.
    let wall = square(half[0], half[1]).max(-square(hole, hole));
    let q = [wall, p[2].abs() - half[2]];
    q[0].max(0.0).hypot(q[1].max(0.0)) + q[0].max(q[1]).min(0.0)
}

/// Distance to a flat triangle (never negative); less a radius it is a plate with round rims.
pub(crate) fn triangle(p: Vec3, corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = corners;
    let normal = cross(sub(b, a), sub(c, a));
    let edges = [(a, b), (b, c), (c, a)];
    let over = edges
        .iter()
        .all(|(s, e)| dot(cross(normal, sub(*e, *s)), sub(p, *s)) >= 0.0);
    if over {
        return dot(normal, sub(p, a)).abs() / length(normal);
    }
    edges
        .iter()
        .map(|(s, e)| segment(p, *s, *e))
        .fold(f64::INFINITY, f64::min)
}

fn segment(p: Vec3, a: Vec3, b: Vec3) -> f64 {
    let axis = sub(b, a);
    let t = (dot(sub(p, a), axis) / dot(axis, axis)).clamp(0.0, 1.0);
    length(sub(p, add(a, scale(axis, t))))
}

/// The smaller of two distances, blended where they differ by less than `k`; never steeper
/// than its arguments, at most `k/4` below the smaller.
pub(crate) fn smooth_min(a: f64, b: f64, k: f64) -> f64 {
    if k <= 0.0 {
        return a.min(b);
    }
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k / 4.0
}

/// [`smooth_min`] of the two smallest values: the others have no say, so that leaving out parts
/// far behind the first changes nothing.
pub(crate) fn smooth_least(values: impl Iterator<Item = f64>, k: f64) -> f64 {
    let (first, second) = values.fold((f64::INFINITY, f64::INFINITY), |(first, second), v| {
        if v < first {
            (v, first)
        } else {
            (first, second.min(v))
        }
    });
    // An empty union is infinitely far away.
    if second.is_finite() {
        smooth_min(first, second, k)
    } else {
        first
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Steepness of `f` at `p` by central differences.
    fn steepness(f: impl Fn(Vec3) -> f64, p: Vec3) -> f64 {
        let h = 1e-5;
        let gradient = std::array::from_fn(|i| {
            let (mut a, mut b) = (p, p);
            a[i] += h;
            b[i] -= h;
            (f(a) - f(b)) / (2.0 * h)
        });
        length(gradient)
    }

    fn point() -> impl Strategy<Value = Vec3> {
        proptest::array::uniform3(-40.0..40.0f64)
    }

    proptest! {
        #[test]
        fn an_ellipsoid_with_equal_radii_is_a_ball(p in point(), r in 1.0..30.0f64) {
            prop_assert!((ellipsoid(p, [r; 3]) - (length(p) - r)).abs() < 1e-6);
        }

        #[test]
        fn walking_the_ellipsoid_distance_along_its_gradient_meets_the_surface(p in point()) {
            let r = [12.0, 20.0, 31.0];
            let d = ellipsoid(p, r);
            // Away from the medial surface, where the gradient jumps.
            prop_assume!(d > -5.0);
            let h = 1e-5;
            let gradient: Vec3 = std::array::from_fn(|i| {
                let mut q = p;
                q[i] += h;
                let mut s = p;
                s[i] -= h;
                (ellipsoid(q, r) - ellipsoid(s, r)) / (2.0 * h)
            });
            let foot = sub(p, scale(gradient, d));
            let level: f64 = (0..3).map(|i| (foot[i] / r[i]).powi(2)).sum();
            prop_assert!((level - 1.0).abs() < 1e-4, "{level}");
        }

        #[test]
        fn outside_every_solid_the_distance_grows_as_fast_as_one_walks(p in point()) {
            let (a, b) = ([-5.0, 0.0, 3.0], [9.0, 4.0, -2.0]);
            let solids: [Box<dyn Fn(Vec3) -> f64>; 6] = [
                Box::new(|p| ellipsoid(p, [9.0, 5.0, 3.0])),
                Box::new(move |p| round_cone(p, a, b, 6.0, 2.0)),
                Box::new(|p| cuboid(p, [9.0, 5.0, 3.0], 1.0)),
                Box::new(move |p| cylinder(p, a, b, 4.0)),
                Box::new(move |p| tube(p, a, b, 4.0, 5.0)),
                Box::new(move |p| triangle(p, [a, b, [0.0, 8.0, 8.0]]) - 2.0),
            ];
            for (i, solid) in solids.iter().enumerate() {
                if solid(p) > 6.0 {
                    let s = steepness(solid, p);
                    prop_assert!((s - 1.0).abs() < 1e-3, "solid {i}: {s}");
                }
            }
        }
    }

    #[test]
    fn known_distances() {
        assert!((cuboid([10.0, 0.0, 0.0], [4.0, 5.0, 6.0], 0.0) - 6.0).abs() < 1e-12);
        assert!((cuboid([1.0, 0.0, 0.0], [4.0, 5.0, 6.0], 0.0) + 3.0).abs() < 1e-12);
        assert!((ellipsoid([0.0; 3], [3.0, 4.0, 5.0]) + 3.0).abs() < 1e-9);
        let (a, b) = ([0.0, 0.0, -5.0], [0.0, 0.0, 5.0]);
        assert!((tube([7.0, 0.0, 0.0], a, b, 6.0, 8.0) + 1.0).abs() < 1e-12);
        assert!((tube([0.0; 3], a, b, 6.0, 8.0) - 6.0).abs() < 1e-12);
        assert!((round_cone([0.0, 0.0, 9.0], a, b, 3.0, 2.0) - 2.0).abs() < 1e-12);
    }
}
