//! The z-levels of points that come from slices.

/// One part in so many of a mesh's vertices may lie on levels with fewer than three vertices, which
/// no contour has; more, and the mesh is not made of slices.
const STRAYS: usize = 10;

/// Distinct z, ascending. Equal means equal to the bit (with 0.0 and -0.0 the same): all vertices of
/// a slice get their z by the same operation, and rounding to a file's floats keeps that.
#[derive(Debug)]
pub(super) struct Levels {
    z_mm: Vec<f64>,
    points: usize,
    strays: usize,
}

impl Levels {
    /// The levels of points with these z.
    pub(super) fn of(z_mm: impl Iterator<Item = f64>) -> Self {
        let mut all: Vec<f64> = z_mm.map(|z| z + 0.0).collect();
        all.sort_unstable_by(f64::total_cmp);
        let mut levels = Self {
            z_mm: Vec::new(),
            points: all.len(),
            strays: 0,
        };
        for level in all.chunk_by(|a, b| a.total_cmp(b).is_eq()) {
            levels.z_mm.push(level[0]);
            if level.len() < 3 {
                levels.strays += level.len();
            }
        }
        levels
    }

    /// Each level's z, ascending.
    pub(super) fn z_mm(&self) -> &[f64] {
        &self.z_mm
    }

    /// The highest level's z.
    pub(super) fn top(&self) -> f64 {
        *self
            .z_mm
            .last()
            .expect("a selection has a level; anything else is a bug")
    }

    /// Whether the points come from slices rather than from anywhere.
    pub(super) fn are_slices(&self) -> bool {
        self.strays * STRAYS <= self.points
    }

    /// Median distance of successive levels, the lower one of two; 0 with one level.
    pub(super) fn step_mm(&self) -> f64 {
        let mut steps: Vec<f64> = self.z_mm.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_unstable_by(f64::total_cmp);
        steps
            .get(steps.len().saturating_sub(1) / 2)
            .copied()
            .unwrap_or(0.0)
    }

    /// The place of a z that is one of the levels.
    pub(super) fn place_of(&self, z: f64) -> Option<usize> {
        let z = z + 0.0;
        self.z_mm.binary_search_by(|level| level.total_cmp(&z)).ok()
    }
}

/// Whether two points lie on one level.
#[expect(
    clippy::float_cmp,
    reason = "levels are equal to the bit, see `Levels`"
)]
pub(super) fn is_same_level(a: [f64; 3], b: [f64; 3]) -> bool {
    a[2] == b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(z: &[f64]) -> Levels {
        Levels::of(z.iter().copied())
    }

    #[test]
    fn levels_are_distinct_and_ascending() {
        let levels = levels(&[2.5, 0.0, -1.0, 2.5, -0.0]);
        assert_eq!(levels.z_mm().len(), 3);
        assert_eq!(levels.place_of(-1.0), Some(0));
        assert_eq!(levels.place_of(-0.0), Some(1));
        assert_eq!(levels.place_of(2.5), Some(2));
        assert_eq!(levels.place_of(1.0), None);
    }

    #[test]
    fn the_step_is_the_median_distance() {
        assert!((levels(&[0.0, 1.0, 2.0, 5.0]).step_mm() - 1.0).abs() < 1e-15);
        assert!((levels(&[0.0, 1.0, 3.0]).step_mm() - 1.0).abs() < 1e-15);
        assert!(levels(&[7.0, 7.0]).step_mm().abs() < 1e-15);
    }

    #[test]
    fn points_anywhere_are_no_slices() {
        let anywhere: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.37).collect();
        assert!(!levels(&anywhere).are_slices());
        let mut slices: Vec<f64> = (0..100).map(|i| f64::from(i / 10)).collect();
        assert!(levels(&slices).are_slices());
        slices.extend(&anywhere[..50]);
        assert!(!levels(&slices).are_slices());
    }
}
