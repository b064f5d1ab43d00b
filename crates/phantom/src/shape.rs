//! Solids built from elementary ones, and their quick evaluation in a small ball of space.

use std::sync::Arc;

use crate::primitives::{
    cuboid, cylinder, ellipsoid, holed_box, round_cone, smooth_least, smooth_min, triangle, tube,
};
use crate::vector::{Vec3, dot, length, sub};

/// A solid as a tree; every node's distance is 1-Lipschitz, so that its value at the centre of
/// a ball bounds it in the whole ball.
///
/// Elementary solids are exact. `Union` is exact outside, `Intersect` and `Cut` inside; blends
/// are exact where only one part is near. Everywhere else the size is a lower bound of the true
/// distance; sign and surface are always right.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Ball {
        centre: Vec3,
        radius: f64,
    },
    Ellipsoid {
        centre: Vec3,
        radii: Vec3,
    },
    RoundCone {
        a: Vec3,
        b: Vec3,
        ra: f64,
        rb: f64,
    },
    /// Box in a frame of its own: `axes` are unit vectors.
    Cuboid {
        centre: Vec3,
        axes: [Vec3; 3],
        half: Vec3,
        round: f64,
    },
    Cylinder {
        a: Vec3,
        b: Vec3,
        radius: f64,
    },
    Tube {
        a: Vec3,
        b: Vec3,
        inner: f64,
        outer: f64,
    },
    /// Between two spheres about the origin.
    BallShell {
        inner: f64,
        outer: f64,
    },
    /// Box about the origin with a square hole along z.
    HoledBox {
        half: Vec3,
        hole: f64,
    },
    Plate {
        corners: [Vec3; 3],
        radius: f64,
    },
    /// The side of a plane that `normal` (unit) points away from.
    HalfSpace {
        normal: Vec3,
        offset: f64,
    },
    /// Parts joined; where two surfaces come within `blend` mm their edge is rounded.
    Union {
        parts: Vec<Arc<Shape>>,
        blend: f64,
    },
    Intersect {
        parts: Vec<Arc<Shape>>,
        blend: f64,
    },
    Cut {
        from: Arc<Shape>,
        tool: Arc<Shape>,
        blend: f64,
    },
    /// Surface moved outwards.
    Grow {
        part: Arc<Shape>,
        by: f64,
    },
    /// The part with `x > 0` on both sides of the plane `x = 0`.
    BothSides {
        part: Arc<Shape>,
    },
}

impl Shape {
    /// Signed distance in mm, negative inside.
    pub(crate) fn distance(&self, p: Vec3) -> f64 {
        match self {
            Self::Ball { centre, radius } => length(sub(p, *centre)) - radius,
            Self::Ellipsoid { centre, radii } => ellipsoid(sub(p, *centre), *radii),
            Self::RoundCone { a, b, ra, rb } => round_cone(p, *a, *b, *ra, *rb),
            Self::Cuboid {
                centre,
                axes,
                half,
                round,
            } => {
                let q = sub(p, *centre);
                cuboid(axes.map(|a| dot(a, q)), *half, *round)
            }
            Self::Cylinder { a, b, radius } => cylinder(p, *a, *b, *radius),
            Self::Tube { a, b, inner, outer } => tube(p, *a, *b, *inner, *outer),
            Self::BallShell { inner, outer } => {
                (length(p) - f64::midpoint(*inner, *outer)).abs() - (outer - inner) / 2.0
            }
            Self::HoledBox { half, hole } => holed_box(p, *half, *hole),
            Self::Plate { corners, radius } => triangle(p, *corners) - radius,
            Self::HalfSpace { normal, offset } => dot(*normal, p) - offset,
            Self::Union { parts, blend } => {
                smooth_least(parts.iter().map(|s| s.distance(p)), *blend)
            }
            Self::Intersect { parts, blend } => {
                -smooth_least(parts.iter().map(|s| -s.distance(p)), *blend)
            }
            Self::Cut { from, tool, blend } => {
                -smooth_min(-from.distance(p), tool.distance(p), *blend)
            }
            Self::Grow { part, by } => part.distance(p) - by,
            Self::BothSides { part } => part.distance([p[0].abs(), p[1], p[2]]),
        }
    }

    /// A tree that gives the same distances within `radius` of `centre` with the parts left out
    /// that cannot matter there, and the distance at `centre`.
    pub(crate) fn near(self: &Arc<Self>, centre: Vec3, radius: f64) -> (Arc<Self>, f64) {
        match &**self {
            Self::Union { parts, blend } => {
                let rebuild = |parts, blend| Self::Union { parts, blend };
                Self::keep_close(parts, *blend, centre, radius, 1.0, rebuild)
            }
            Self::Intersect { parts, blend } => {
                let rebuild = |parts, blend| Self::Intersect { parts, blend };
                Self::keep_close(parts, *blend, centre, radius, -1.0, rebuild)
            }
            Self::Cut { from, tool, blend } => {
                let (from, df) = from.near(centre, radius);
                let (tool, dt) = tool.near(centre, radius);
                if -dt < df - 2.0 * radius - blend {
                    return (from, df);
                }
                let d = -smooth_min(-df, dt, *blend);
                let blend = *blend;
                (Arc::new(Self::Cut { from, tool, blend }), d)
            }
            Self::Grow { part, by } => {
                let (part, d) = part.near(centre, radius);
                (Arc::new(Self::Grow { part, by: *by }), d - by)
            }
            Self::BothSides { part } => {
                let folded = [centre[0].abs(), centre[1], centre[2]];
                let (part, d) = part.near(folded, radius);
                (Arc::new(Self::BothSides { part }), d)
            }
            elementary => (Arc::clone(self), elementary.distance(centre)),
        }
    }

    /// [`Shape::near`] of a union (`sign` 1) or an intersection (`sign` -1).
    fn keep_close(
        parts: &[Arc<Self>],
        blend: f64,
        centre: Vec3,
        radius: f64,
        sign: f64,
        rebuild: impl Fn(Vec<Arc<Self>>, f64) -> Self,
    ) -> (Arc<Self>, f64) {
        let closer: Vec<_> = parts.iter().map(|s| s.near(centre, radius)).collect();
        let least = closer
            .iter()
            .map(|(_, d)| sign * d)
            .fold(f64::INFINITY, f64::min);
        let d = smooth_least(closer.iter().map(|(_, d)| sign * d), blend);
        // A part this far from the nearest one neither wins nor blends anywhere in the ball.
        let limit = least + 2.0 * radius + blend;
        let mut kept: Vec<Arc<Self>> = closer
            .into_iter()
            .filter(|(_, d)| sign * d <= limit)
            .map(|(s, _)| s)
            .collect();
        let pruned = if kept.len() == 1 {
            kept.swap_remove(0)
        } else {
            Arc::new(rebuild(kept, blend))
        };
        (pruned, sign * d)
    }
}

/// Short names for building trees.
pub(crate) mod build {
    use super::{Arc, Shape, Vec3};
    use crate::vector::unit;

    pub(crate) type Solid = Arc<Shape>;

    pub(crate) fn ball(centre: Vec3, radius: f64) -> Solid {
        Arc::new(Shape::Ball { centre, radius })
    }
    pub(crate) fn ellipsoid(centre: Vec3, radii: Vec3) -> Solid {
        Arc::new(Shape::Ellipsoid { centre, radii })
    }
    pub(crate) fn cone(a: Vec3, ra: f64, b: Vec3, rb: f64) -> Solid {
        Arc::new(Shape::RoundCone { a, b, ra, rb })
    }
    /// A smooth line through `points`, `pieces` straight ones from each to the next (Catmull and
    /// Rom 1974; the ends run out straight).
    pub(crate) fn curve<const N: usize>(points: &[[f64; N]], pieces: usize) -> Vec<[f64; N]> {
        let last = points.len() - 1;
        let at = |i: usize, k: usize| points[(i + k).saturating_sub(1).min(last)];
        let mut line = Vec::with_capacity(last * pieces + 1);
        for i in 0..last {
            let [a, b, c, d] = [at(i, 0), at(i, 1), at(i, 2), at(i, 3)];
            for step in 0..pieces {
                let t = step as f64 / pieces as f64;
                line.push(std::array::from_fn(|n| {
                    let square = 2.0 * a[n] - 5.0 * b[n] + 4.0 * c[n] - d[n];
                    let cube = 3.0 * (b[n] - c[n]) + d[n] - a[n];
                    b[n] + 0.5 * t * (c[n] - a[n] + t * (square + t * cube))
                }));
            }
        }
        line.push(points[last]);
        line
    }
    /// A smooth rod through points `[x, y, z, radius]`.
    pub(crate) fn cord(points: &[[f64; 4]]) -> Solid {
        let line = curve(points, 4);
        let links = line
            .windows(2)
            .map(|w| {
                let [a, b] = [w[0], w[1]];
                cone([a[0], a[1], a[2]], a[3], [b[0], b[1], b[2]], b[3])
            })
            .collect();
        union(links)
    }
    /// Round cones in a row through `(point, radius)`.
    pub(crate) fn chain(points: &[(Vec3, f64)], blend: f64) -> Solid {
        let links = points
            .windows(2)
            .map(|w| cone(w[0].0, w[0].1, w[1].0, w[1].1))
            .collect();
        blended(blend, links)
    }
    pub(crate) fn block(centre: Vec3, half: Vec3, round: f64) -> Solid {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        turned_block(centre, axes, half, round)
    }
    pub(crate) fn turned_block(centre: Vec3, axes: [Vec3; 3], half: Vec3, round: f64) -> Solid {
        Arc::new(Shape::Cuboid {
            centre,
            axes,
            half,
            round,
        })
    }
    pub(crate) fn rod(a: Vec3, b: Vec3, radius: f64) -> Solid {
        Arc::new(Shape::Cylinder { a, b, radius })
    }
    pub(crate) fn plate(corners: [Vec3; 3], radius: f64) -> Solid {
        Arc::new(Shape::Plate { corners, radius })
    }
    /// A smooth band between two lines with the same number of points.
    pub(crate) fn band(one: &[Vec3], other: &[Vec3], radius: f64) -> Solid {
        let (one, other) = (curve(one, 3), curve(other, 3));
        let plates = one
            .windows(2)
            .zip(other.windows(2))
            .flat_map(|(u, l)| {
                [
                    plate([u[0], u[1], l[0]], radius),
                    plate([u[1], l[1], l[0]], radius),
                ]
            })
            .collect();
        union(plates)
    }
    /// Everything on the side of the plane through `point` that `normal` points away from.
    pub(crate) fn below(point: Vec3, normal: Vec3) -> Solid {
        let normal = unit(normal);
        let offset = crate::vector::dot(normal, point);
        Arc::new(Shape::HalfSpace { normal, offset })
    }
    pub(crate) fn union(parts: Vec<Solid>) -> Solid {
        blended(0.0, parts)
    }
    pub(crate) fn blended(blend: f64, parts: Vec<Solid>) -> Solid {
        Arc::new(Shape::Union { parts, blend })
    }
    pub(crate) fn common(blend: f64, parts: Vec<Solid>) -> Solid {
        Arc::new(Shape::Intersect { parts, blend })
    }
    pub(crate) fn cut(from: Solid, tool: Solid, blend: f64) -> Solid {
        Arc::new(Shape::Cut { from, tool, blend })
    }
    pub(crate) fn grow(part: &Solid, by: f64) -> Solid {
        let part = Arc::clone(part);
        Arc::new(Shape::Grow { part, by })
    }
    pub(crate) fn both_sides(part: Solid) -> Solid {
        Arc::new(Shape::BothSides { part })
    }
}

#[cfg(test)]
mod tests {
    use super::build::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_tree_pruned_to_a_ball_gives_the_same_distances_in_it(
            centre in proptest::array::uniform3(-30.0..30.0f64),
            offset in proptest::array::uniform3(-1.0..1.0f64),
            radius in 0.5..10.0f64,
        ) {
            let parts = (0..12)
                .map(|i| ball([f64::from(i) * 5.0 - 28.0, f64::from(i % 3) * 9.0, f64::from(i % 4)], 4.0))
                .collect();
            let tree = cut(
                blended(3.0, vec![both_sides(blended(4.0, parts)), block([0.0; 3], [20.0, 3.0, 9.0], 1.0)]),
                grow(&ellipsoid([3.0, 2.0, 1.0], [9.0, 4.0, 5.0]), 1.0),
                2.0,
            );
            let (pruned, d) = tree.near(centre, radius);
            prop_assert!((d - tree.distance(centre)).abs() < 1e-9);
            let s = radius / 3f64.sqrt();
            let p = std::array::from_fn(|i| centre[i] + s * offset[i]);
            prop_assert!((pruned.distance(p) - tree.distance(p)).abs() < 1e-9);
        }
    }
}
