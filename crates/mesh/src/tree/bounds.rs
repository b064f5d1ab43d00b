//! Boxes along the axes, in single precision, never smaller than what they hold.

/// Lowest and highest coordinates (mm), rounded outward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
}

impl Bounds {
    /// Holds nothing; what is added becomes the whole.
    const NOTHING: Self = Self {
        low: [f32::INFINITY; 3],
        high: [f32::NEG_INFINITY; 3],
    };

    /// The box of some points (mm).
    pub(crate) fn of(points_mm: &[[f64; 3]]) -> Self {
        points_mm.iter().fold(Self::NOTHING, |bounds, point| Self {
            low: [0, 1, 2].map(|axis| bounds.low[axis].min(rounded_down(point[axis]))),
            high: [0, 1, 2].map(|axis| bounds.high[axis].max(-rounded_down(-point[axis]))),
        })
    }

    /// The box of some boxes.
    pub(super) fn around<'a>(parts: impl IntoIterator<Item = &'a Self>) -> Self {
        parts.into_iter().fold(Self::NOTHING, |bounds, part| Self {
            low: [0, 1, 2].map(|axis| bounds.low[axis].min(part.low[axis])),
            high: [0, 1, 2].map(|axis| bounds.high[axis].max(part.high[axis])),
        })
    }

    /// Whether two boxes share a point, if only one of their borders.
    #[inline]
    pub(crate) fn touches(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.high[axis] && other.low[axis] <= self.high[axis])
    }

    /// Twice the middle along an axis.
    pub(super) fn doubled_middle(&self, axis: usize) -> f32 {
        self.low[axis] + self.high[axis]
    }
}

/// The largest single that is not above `value`.
fn rounded_down(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) > value {
        nearest.next_down()
    } else {
        nearest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_never_smaller_than_its_points() {
        for value in [0.1, -0.1, 1e300, -1e300, 1e-300, 16_777_217.0, 0.0] {
            let bounds = Bounds::of(&[[value; 3]]);
            assert!(f64::from(bounds.low[0]) <= value, "{value}");
            assert!(f64::from(bounds.high[2]) >= value, "{value}");
        }
    }
}
