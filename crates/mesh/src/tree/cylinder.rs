//! Flat cylinders around triangles, which tell more closely than boxes how near they are at least.
//!
//! From a place far from a surface, many triangles of it are about as near as the nearest. The boxes of those
//! that lie aslant are much thicker than they are, and all whose boxes reach nearer have to be looked at.

use crate::exact::Corners;
use crate::vector::{Vector, cross, dot, minus, plus_scaled};

/// What rounding may take away.
const SLACK: f64 = 1e-6;

/// All places within so far of an axis, and of the plane across it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cylinder {
    middle: [f32; 3],
    /// At most of length 1.
    axis: [f32; 3],
    radius: f32,
    half_height: f32,
}

impl Cylinder {
    /// Around all these triangles, flat where they are.
    pub(super) fn around(triangles: &[Corners]) -> Self {
        let corners = || triangles.iter().flatten();
        let sum = corners().fold([0.0; 3], |sum, c| plus_scaled(sum, 1.0, *c));
        let middle = sum.map(|v| (v / (3 * triangles.len()).max(1) as f64) as f32);
        let facing = triangles.iter().fold([0.0; 3], |sum, [a, b, c]| {
            plus_scaled(sum, 1.0, cross(minus(*b, *a), minus(*c, *a)))
        });
        let length = dot(facing, facing).sqrt();
        // Any axis is right; one of length 0 makes a ball.
        let axis = if length > 0.0 {
            facing.map(|v| (v / length * (1.0 - SLACK)) as f32)
        } else {
            [0.0; 3]
        };
        let mut cylinder = Self {
            middle,
            axis,
            radius: 0.0,
            half_height: 0.0,
        };
        for corner in corners() {
            let [above, beside] = cylinder.seen(*corner).map(|v| (v * (1.0 + SLACK)) as f32);
            cylinder.half_height = cylinder.half_height.max(above);
            cylinder.radius = cylinder.radius.max(beside);
        }
        cylinder
    }

    /// The squared distance (mm2) from a place is at least this.
    ///
    /// With axis a, |x|² = |a·x|² + |x|² - |a·x|²; both parts are squares of norms where a is at most of
    /// length 1, and a difference of two places is at least as large as that of their norms.
    pub(super) fn squared_at_least(&self, place: Vector) -> f64 {
        let [above, beside] = self.seen(place);
        let above = (above - f64::from(self.half_height)).max(0.0);
        let beside = (beside - f64::from(self.radius)).max(0.0);
        (above * above + beside * beside) * (1.0 - SLACK)
    }

    /// How far a place is from the middle along the axis, and across it.
    fn seen(&self, place: Vector) -> [f64; 2] {
        let there = minus(place, self.middle.map(f64::from));
        let above = dot(there, self.axis.map(f64::from));
        let beside = (dot(there, there) - above * above).max(0.0);
        [above.abs(), beside.sqrt()]
    }
}
