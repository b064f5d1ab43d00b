//! Solids built from elementary ones, and their quick evaluation in a small ball of space.

mod bounds;
pub(crate) mod build;

use std::sync::Arc;

use bounds::Ball;

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
        parts: Vec<Bounded>,
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

/// A part and a ball around it.
#[derive(Clone, Debug)]
pub(crate) struct Bounded {
    part: Arc<Shape>,
    ball: Ball,
}

/// Distance to a union: parts whose ball lies behind the nearest parts are passed over.
fn union_distance(parts: &[Bounded], blend: f64, p: Vec3) -> f64 {
    let nearest = (0..parts.len()).min_by(|a, b| {
        let least = |i: usize| parts[i].ball.least(p);
        least(*a).total_cmp(&least(*b))
    });
    let Some(nearest) = nearest else {
        return f64::INFINITY;
    };
    let (mut first, mut second) = (parts[nearest].part.distance(p), f64::INFINITY);
    for (i, bounded) in parts.iter().enumerate() {
        if i == nearest || bounded.ball.least(p) >= second.min(first + blend) {
            continue;
        }
        let d = bounded.part.distance(p);
        if d < first {
            (first, second) = (d, first);
        } else {
            second = second.min(d);
        }
    }
    smooth_least([first, second].into_iter(), blend)
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
            Self::Union { parts, blend } => union_distance(parts, *blend, p),
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
            Self::Union { parts, blend } => Self::near_union(parts, *blend, centre, radius),
            Self::Intersect { parts, blend } => {
                Self::near_intersection(parts, *blend, centre, radius)
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

    /// A part further from the nearest one than `2 radius + blend` neither wins nor blends
    /// anywhere in the ball.
    fn near_union(parts: &[Bounded], blend: f64, centre: Vec3, radius: f64) -> (Arc<Self>, f64) {
        let reach = 2.0 * radius + blend;
        let mut closer: Vec<(Bounded, f64)> = Vec::new();
        let mut least = f64::INFINITY;
        for bounded in parts {
            if bounded.ball.least(centre) > least + reach {
                continue;
            }
            let (part, d) = bounded.part.near(centre, radius);
            least = least.min(d);
            let ball = bounded.ball;
            closer.push((Bounded { part, ball }, d));
        }
        closer.retain(|(_, d)| *d <= least + reach);
        let d = smooth_least(closer.iter().map(|(_, d)| *d), blend);
        let mut parts: Vec<Bounded> = closer.into_iter().map(|(part, _)| part).collect();
        if parts.len() == 1 {
            return (parts.swap_remove(0).part, d);
        }
        (Arc::new(Self::Union { parts, blend }), d)
    }

    fn near_intersection(
        parts: &[Arc<Self>],
        blend: f64,
        centre: Vec3,
        radius: f64,
    ) -> (Arc<Self>, f64) {
        let mut closer: Vec<_> = parts.iter().map(|s| s.near(centre, radius)).collect();
        let most = closer
            .iter()
            .map(|(_, d)| *d)
            .fold(f64::NEG_INFINITY, f64::max);
        closer.retain(|(_, d)| *d >= most - 2.0 * radius - blend);
        let d = -smooth_least(closer.iter().map(|(_, d)| -d), blend);
        let mut parts: Vec<Arc<Self>> = closer.into_iter().map(|(part, _)| part).collect();
        if parts.len() == 1 {
            return (parts.swap_remove(0), d);
        }
        (Arc::new(Self::Intersect { parts, blend }), d)
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
