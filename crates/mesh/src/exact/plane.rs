//! Questions within one plane, answered in its shadow along an axis.

use robust::{Coord, orient2d};

use super::{Corners, Point, is_two_sided};

/// A direction along an axis in which a triangle throws a shadow that has an area.
///
/// Seen along it, no two points of the triangle's plane fall together.
#[derive(Clone, Copy)]
pub(super) struct Shadow {
    axes: [usize; 2],
}

impl Shadow {
    /// The first axis along which the triangle's shadow has an area; `None` if it has none itself.
    pub(super) fn of([a, b, c]: &Corners) -> Option<Self> {
        let all = [[0, 1], [1, 2], [2, 0]].map(|axes| Self { axes });
        all.into_iter().find(|shadow| shadow.turn(a, b, c) != 0.0)
    }

    /// Above 0 if `a`, `b`, `c` turn left, below 0 if they turn right, 0 on one line.
    pub(super) fn turn(self, a: &Point, b: &Point, c: &Point) -> f64 {
        let [a, b, c] = [a, b, c].map(|point| Coord {
            x: point[self.axes[0]],
            y: point[self.axes[1]],
        });
        orient2d(a, b, c)
    }

    /// Whether a point of its plane lies in the triangle, border included.
    pub(super) fn holds(self, [a, b, c]: &Corners, point: &Point) -> bool {
        !is_two_sided([
            self.turn(a, b, point),
            self.turn(b, c, point),
            self.turn(c, a, point),
        ])
    }

    /// Whether two segments of one plane share a point.
    pub(super) fn cross(self, [p, q]: [&Point; 2], [r, s]: [&Point; 2]) -> bool {
        let (to_r, to_s) = (self.turn(p, q, r), self.turn(p, q, s));
        let (to_p, to_q) = (self.turn(r, s, p), self.turn(r, s, q));
        if to_r == 0.0 && to_s == 0.0 {
            // On one line, where what counts is whether their extents meet.
            return self.axes.iter().all(|&axis| {
                p[axis].min(q[axis]) <= r[axis].max(s[axis])
                    && r[axis].min(s[axis]) <= p[axis].max(q[axis])
            });
        }
        !(to_r > 0.0 && to_s > 0.0
            || to_r < 0.0 && to_s < 0.0
            || to_p > 0.0 && to_q > 0.0
            || to_p < 0.0 && to_q < 0.0)
    }
}

/// Whether three points are the corners of a triangle, not all on one line.
pub(crate) fn has_area(corners: &Corners) -> bool {
    Shadow::of(corners).is_some()
}
