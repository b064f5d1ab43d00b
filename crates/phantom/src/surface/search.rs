//! The nearest point of a solid's surface, whatever its field says of distances.
//!
//! The field never claims more than the true distance, so that it empties space: no surface is
//! in a cube whose middle says more than half the cube's diagonal. A first point comes from
//! walking down the field and along the surface; cubes around the asked point, the nearest
//! first, are then split and thrown away until all that are left lie further than the best
//! point found.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::foot::{gradient, walk_to_surface};
use crate::shape::Shape;
use crate::shape::build::Solid;
use crate::vector::{Vec3, add, dot, length, scale, sub, unit};

/// Nothing nearer by more than this is missed (mm), nor by more than this part of the distance.
const SLACK: f64 = 0.003;
/// Steps along the surface.
const SLIDES: usize = 24;
/// Half the diagonal of a cube of side 2.
const DIAGONAL: f64 = 1.732_050_807_568_877_2;

/// The nearest point of the surface of `solid`, and its distance, negative inside.
pub(super) fn nearest(solid: &Solid, p: Vec3) -> (Vec3, f64) {
    let claimed = solid.distance(p);
    let sign = if claimed < 0.0 { -1.0 } else { 1.0 };
    let mut search = Search {
        p,
        inside: claimed < 0.0,
        best: f64::INFINITY,
        point: p,
    };
    if let Some(point) = walk_to_surface(solid, p) {
        search.best = length(sub(point, p));
        search.point = point;
        // Only what is within reach of the walk can be nearer.
        let (local, _) = solid.near(p, (1.01 * search.best + 1e-3) * DIAGONAL);
        search.slide(&local);
        if search.best - claimed.abs() > slack(search.best) {
            search.look(&local, search.best);
        }
    } else {
        let mut reach = 2.0 * claimed.abs() + 0.1;
        while search.best.is_infinite() && reach < 1e4 {
            let (local, _) = solid.near(p, reach * DIAGONAL);
            search.look(&local, reach);
            reach *= 2.0;
        }
    }
    (search.point, sign * search.best)
}

fn slack(distance: f64) -> f64 {
    SLACK * distance.max(1.0)
}

struct Search {
    p: Vec3,
    inside: bool,
    best: f64,
    point: Vec3,
}

/// A cube that may hold surface.
struct Cube {
    middle: Vec3,
    half: f64,
    /// Nothing in it is nearer to the asked point.
    least: f64,
}

impl Search {
    /// Takes `q`, which lies on the surface, if it is nearer.
    fn offer(&mut self, q: Vec3) -> bool {
        let away = length(sub(q, self.p));
        let nearer = away < self.best;
        if nearer {
            (self.best, self.point) = (away, q);
        }
        nearer
    }

    /// Slides the best point along the surface as long as it gets nearer.
    fn slide(&mut self, solid: &Shape) {
        let mut part = 1.0;
        for _ in 0..SLIDES {
            let normal = unit(gradient(solid, self.point));
            let away = sub(self.p, self.point);
            let along = sub(away, scale(normal, dot(away, normal)));
            if length(along) < 1e-6 || part < 1e-2 {
                break;
            }
            let next = add(self.point, scale(along, part));
            if !walk_to_surface(solid, next).is_some_and(|q| self.offer(q)) {
                part *= 0.5;
            }
        }
    }

    /// Looks through the cube of half side `reach` about the asked point.
    fn look(&mut self, solid: &Shape, reach: f64) {
        let mut open = BinaryHeap::from([Cube {
            middle: self.p,
            half: reach,
            least: 0.0,
        }]);
        while let Some(cube) = open.pop() {
            if cube.least >= self.best - slack(self.best) {
                break;
            }
            let half = cube.half / 2.0;
            for corner in 0..8 {
                let side = |axis: usize| if corner >> axis & 1 == 0 { -half } else { half };
                let middle = add(cube.middle, [side(0), side(1), side(2)]);
                let least = self.least(middle, half);
                if least < self.best - slack(self.best)
                    && self.may_hold_surface(solid, middle, half)
                {
                    open.push(Cube {
                        middle,
                        half,
                        least,
                    });
                }
            }
        }
    }

    /// Distance to a cube.
    fn least(&self, middle: Vec3, half: f64) -> f64 {
        let off: Vec3 = std::array::from_fn(|i| ((self.p[i] - middle[i]).abs() - half).max(0.0));
        length(off)
    }

    /// Whether the cube has to be split; what is learnt of the surface on the way is kept.
    fn may_hold_surface(&mut self, solid: &Shape, middle: Vec3, half: f64) -> bool {
        let d = solid.distance(middle);
        let radius = DIAGONAL * half;
        if d.abs() > radius {
            // Far inside the other material: the surface lies on the way there.
            if (d < 0.0) != self.inside && length(sub(middle, self.p)) < self.best + radius {
                self.cross(solid, middle);
            }
            return false;
        }
        if (d < 0.0) != self.inside && length(sub(middle, self.p)) < self.best {
            self.cross(solid, middle);
        }
        if half < SLACK / 8.0 {
            self.offer(middle);
            return false;
        }
        true
    }

    /// Finds where the way to `other`, which lies on the surface's other side, crosses it.
    fn cross(&mut self, solid: &Shape, other: Vec3) {
        let (mut here, mut there) = (self.p, other);
        while length(sub(there, here)) > 1e-7 * (1.0 + length(here)) {
            let middle = scale(add(here, there), 0.5);
            if (solid.distance(middle) < 0.0) == self.inside {
                here = middle;
            } else {
                there = middle;
            }
        }
        if self.offer(there) {
            self.slide(solid);
        }
    }
}

impl Ord for Cube {
    fn cmp(&self, other: &Self) -> Ordering {
        // The heap gives the largest first.
        other.least.total_cmp(&self.least)
    }
}

impl PartialOrd for Cube {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Cube {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cube {}
