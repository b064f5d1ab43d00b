//! What a surface is like at a point: where it faces, whether it turns there, how thick the wall is.

use crate::body::{Body, Layers};
use crate::shape::Shape;
use crate::shape::build::Solid;
use crate::vector::{Vec3, add, cross, dot, length, scale, sub, unit};

/// Step of differences (mm).
const STEP: f64 = 1e-5;
/// Walks end here (mm).
const ON_SURFACE: f64 = 1e-8;
const WALK_STEPS: usize = 40;
/// Cosine of the turn that makes a crease, 25 degrees.
const TURN: f64 = 0.906;
/// Walks around a point.
const DIRECTIONS: u8 = 8;
/// Walls and gaps are followed so far (mm).
const LONGEST: f64 = 20.0;

/// Between air and fat.
const AIR_LIKE_HU: f64 = -500.0;

/// Direction in which the field grows, and how fast.
pub(super) fn gradient(solid: &Shape, p: Vec3) -> Vec3 {
    std::array::from_fn(|i| {
        let (mut above, mut below) = (p, p);
        above[i] += STEP;
        below[i] -= STEP;
        (solid.distance(above) - solid.distance(below)) / (2.0 * STEP)
    })
}

/// Follows the field to the surface; `None` where it leads nowhere, as at the middle of a wall.
pub(super) fn walk_to_surface(solid: &Shape, p: Vec3) -> Option<Vec3> {
    let mut q = p;
    for _ in 0..WALK_STEPS {
        let d = solid.distance(q);
        if d.abs() < ON_SURFACE {
            return Some(q);
        }
        let slope = gradient(solid, q);
        // A field that hardly grows would send the walk far away.
        let steep = dot(slope, slope);
        if steep < 1e-3 {
            return None;
        }
        q = sub(q, scale(slope, d / steep));
    }
    None
}

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    point: Vec3,
    pub(super) normal: Vec3,
}

impl Foot {
    /// The surface at `point`, the nearest to `from`, which is `distance` away.
    ///
    /// The way to `from` is square to the surface, also at an edge, where the field's direction
    /// is one face's by chance; on the surface itself only the field is left.
    pub(super) fn at(solid: &Shape, point: Vec3, from: Vec3, distance: f64) -> Self {
        let normal = if distance.abs() > 0.01 {
            scale(sub(from, point), 1.0 / distance)
        } else {
            gradient(solid, point)
        };
        let steep = length(normal);
        let normal = if steep > 1e-9 {
            scale(normal, 1.0 / steep)
        } else {
            [0.0, 0.0, 1.0]
        };
        Self { point, normal }
    }

    /// A point outside.
    pub(super) fn beside(&self, by: f64) -> Vec3 {
        add(self.point, scale(self.normal, by))
    }

    /// Whether the surface turns within `reach`.
    pub(super) fn is_at_crease(&self, solid: &Solid, reach: f64) -> bool {
        let (local, _) = solid.near(self.point, 2.0 * reach);
        let (u, v) = across(self.normal);
        (0..DIRECTIONS).any(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / f64::from(DIRECTIONS);
            let way = add(scale(u, angle.cos()), scale(v, angle.sin()));
            [0.5, 1.0].iter().any(|part| {
                let beside = add(self.point, scale(way, part * reach));
                let turned = |q: Vec3| {
                    length(sub(q, beside)) > reach
                        || dot(unit(gradient(&local, q)), self.normal) < TURN
                };
                // A walk that does not arrive, or far off, left the face.
                walk_to_surface(&local, beside).is_none_or(turned)
            })
        })
    }
}

/// Two directions square to `normal` and to one another.
pub(super) fn across(normal: Vec3) -> (Vec3, Vec3) {
    let least = (0..3)
        .min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))
        .unwrap_or_default();
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let u = unit(cross(normal, axis));
    (u, cross(normal, u))
}

/// Bone below a point of the surface.
pub(super) fn wall(solid: &Shape, point: Vec3, normal: Vec3) -> f64 {
    until(solid, point, scale(normal, -1.0), |d| d < 0.0)
}

/// Way to the next bone.
pub(super) fn gap(solid: &Shape, point: Vec3, normal: Vec3) -> f64 {
    until(solid, point, normal, |d| d >= 0.0)
}

/// Way to the first place below [`AIR_LIKE_HU`].
pub(super) fn way_to_air(layers: &Layers, point: Vec3, normal: Vec3) -> f64 {
    let mut s = 1e-3;
    while s < LONGEST {
        let p = add(point, scale(normal, s));
        if layers.hu(p) < AIR_LIKE_HU {
            return s;
        }
        let surfaces = layers.tissues.iter().map(|t| t.shape.distance(p).abs());
        s += surfaces.fold(LONGEST, f64::min).max(1e-2);
    }
    LONGEST
}

/// How far `on` holds along a ray, from just off the surface.
fn until(solid: &Shape, point: Vec3, way: Vec3, on: impl Fn(f64) -> bool) -> f64 {
    let mut s = 1e-3;
    while s < LONGEST {
        let d = solid.distance(add(point, scale(way, s)));
        if !on(d) {
            return s;
        }
        s += d.abs().max(1e-3);
    }
    LONGEST
}
