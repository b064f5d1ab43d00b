//! Short names for building trees.

use std::sync::Arc;

use super::{Bounded, Shape};
use crate::vector::{Vec3, dot, unit};

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
    let offset = dot(normal, point);
    Arc::new(Shape::HalfSpace { normal, offset })
}
pub(crate) fn union(parts: Vec<Solid>) -> Solid {
    blended(0.0, parts)
}
pub(crate) fn blended(blend: f64, parts: Vec<Solid>) -> Solid {
    let parts = parts
        .into_iter()
        .map(|part| Bounded {
            ball: part.ball(),
            part,
        })
        .collect();
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
