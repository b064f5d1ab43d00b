//! Balls around solids: a quick lower bound of every distance.

use super::Shape;
use crate::vector::{Vec3, add, length, scale, sub};

/// A ball; its radius is infinite around what has no end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(super) centre: Vec3,
    pub(super) radius: f64,
}

impl Ball {
    /// No distance of what is in the ball is below this.
    pub(super) fn least(&self, p: Vec3) -> f64 {
        length(sub(p, self.centre)) - self.radius
    }

    fn grown(self, by: f64) -> Self {
        let radius = self.radius + by;
        Self { radius, ..self }
    }

    /// The ball around both ends of a line, their own radii included.
    fn around_line(a: Vec3, b: Vec3, radius: f64) -> Self {
        Self {
            centre: midpoint(a, b),
            radius: length(sub(a, b)) / 2.0 + radius,
        }
    }

    /// A ball around balls.
    fn around(balls: impl Iterator<Item = Self> + Clone) -> Self {
        // Balls without end have no middle.
        if balls.clone().any(|b| !b.radius.is_finite()) {
            return Self::EVERYWHERE;
        }
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for ball in balls.clone() {
            for i in 0..3 {
                low[i] = low[i].min(ball.centre[i] - ball.radius);
                high[i] = high[i].max(ball.centre[i] + ball.radius);
            }
        }
        let centre = midpoint(low, high);
        let radius = balls
            .map(|b| length(sub(b.centre, centre)) + b.radius)
            .fold(0.0, f64::max);
        Self { centre, radius }
    }

    const EVERYWHERE: Self = Self {
        centre: [0.0; 3],
        radius: f64::INFINITY,
    };
}

fn midpoint(a: Vec3, b: Vec3) -> Vec3 {
    scale(add(a, b), 0.5)
}

impl Shape {
    /// Centre and radius of a ball around the solid.
    pub(crate) fn around(&self) -> (Vec3, f64) {
        let ball = self.ball();
        (ball.centre, ball.radius)
    }

    /// A ball around the solid.
    pub(super) fn ball(&self) -> Ball {
        match self {
            Self::Ball { centre, radius } => Ball {
                centre: *centre,
                radius: *radius,
            },
            Self::Ellipsoid { centre, radii } => Ball {
                centre: *centre,
                radius: radii[0].max(radii[1]).max(radii[2]),
            },
            Self::RoundCone { a, b, ra, rb } => Ball::around_line(*a, *b, ra.max(*rb)),
            Self::Cuboid { centre, half, .. } => Ball {
                centre: *centre,
                radius: length(*half),
            },
            Self::Cylinder { a, b, radius } => Ball::around_line(*a, *b, *radius),
            Self::Tube { a, b, outer, .. } => Ball::around_line(*a, *b, *outer),
            Self::BallShell { outer, .. } => Ball {
                centre: [0.0; 3],
                radius: *outer,
            },
            Self::HoledBox { half, .. } => Ball {
                centre: [0.0; 3],
                radius: length(*half),
            },
            Self::Plate { corners, radius } => {
                let corner = |centre: Vec3| Ball {
                    centre,
                    radius: *radius,
                };
                Ball::around(corners.iter().map(|c| corner(*c)))
            }
            Self::HalfSpace { .. } => Ball::EVERYWHERE,
            // A blend bulges by a quarter of its width at most.
            Self::Union { parts, blend } => {
                Ball::around(parts.iter().map(|b| b.ball)).grown(blend / 4.0)
            }
            Self::Intersect { parts, .. } => parts
                .iter()
                .map(|s| s.ball())
                .min_by(|a, b| a.radius.total_cmp(&b.radius))
                .unwrap_or(Ball::EVERYWHERE),
            Self::Cut { from, .. } => from.ball(),
            Self::Grow { part, by } => part.ball().grown(*by),
            Self::BothSides { part } => {
                let ball = part.ball();
                let [x, y, z] = ball.centre;
                let other = Ball {
                    centre: [-x, y, z],
                    ..ball
                };
                Ball::around([ball, other].into_iter())
            }
        }
    }
}
