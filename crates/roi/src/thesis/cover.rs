//! Step 4: what the selection covers, seen along the normal.

use rustc_hash::FxHashMap;

use super::Patch;
use bonemesh_mesh::vector::minus;

/// Which places behind one level of the selection are covered by it.
#[derive(Debug)]
pub(super) struct Cover {
    /// The coordinate that is compared.
    axis: usize,
    /// By the bits of x when x must be equal, under 0 otherwise.
    groups: FxHashMap<u64, Span>,
    needs_equal_x: bool,
}

impl Cover {
    /// The cover of the selected points of one level, projected along the normal.
    ///
    /// The largest component of the normal tells the coordinate to compare: y for x, x for y, and
    /// for z it is y within groups of equal x.
    pub(super) fn of_points(patch: &Patch<'_>, points: &[[f64; 3]], step_mm: f64) -> Self {
        let [x, y, z] = patch.normal.map(f64::abs);
        let needs_equal_x = z > x && z > y;
        let axis = usize::from(x >= y || needs_equal_x);
        let mut members = FxHashMap::<u64, Vec<[f64; 2]>>::default();
        for &[x, y, _] in points {
            members
                .entry(key(needs_equal_x, x))
                .or_default()
                .push([x, y]);
        }
        let span = |points: Vec<[f64; 2]>| Span::of(&points, axis, patch.shift[axis], step_mm);
        Self {
            axis,
            groups: members
                .into_iter()
                .map(|(key, points)| (key, span(points)))
                .collect(),
            needs_equal_x,
        }
    }

    /// Whether a point of the inner level is covered.
    pub(super) fn contains(&self, point: [f64; 3]) -> bool {
        let group = self.groups.get(&key(self.needs_equal_x, point[0]));
        group.is_some_and(|span| span.contains(point[self.axis]))
    }
}

/// The group of a point with this x.
fn key(needs_equal_x: bool, x: f64) -> u64 {
    // Adding 0.0 turns -0.0 into 0.0, which it equals.
    if needs_equal_x {
        (x + 0.0).to_bits()
    } else {
        0
    }
}

/// Covered values of the compared coordinate.
#[derive(Debug)]
enum Span {
    /// Within `reach_mm` of a single projected point.
    Around { centre_mm: f64, reach_mm: f64 },
    /// In one of these closed intervals, which are disjoint and ascending.
    Between(Vec<[f64; 2]>),
}

impl Span {
    /// The span of a level's (x, y) points: from each, projected, to its two nearest neighbours.
    fn of(points: &[[f64; 2]], axis: usize, shift_mm: f64, step_mm: f64) -> Self {
        let projected: Vec<f64> = points.iter().map(|point| point[axis] + shift_mm).collect();
        if let [centre_mm] = projected[..] {
            return Self::Around {
                centre_mm,
                reach_mm: step_mm,
            };
        }
        let mut intervals: Vec<[f64; 2]> = two_nearest(points)
            .iter()
            .zip(&projected)
            .flat_map(|(nearest, &own)| {
                let others = nearest.iter().flatten().map(|&other| projected[other]);
                others.map(move |other| [own.min(other), own.max(other)])
            })
            .collect();
        intervals.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        intervals.dedup_by(|next, last| {
            let touches = next[0] <= last[1];
            if touches {
                last[1] = last[1].max(next[1]);
            }
            touches
        });
        Self::Between(intervals)
    }

    /// Whether it covers this value.
    fn contains(&self, value: f64) -> bool {
        match self {
            Self::Around {
                centre_mm,
                reach_mm,
            } => (value - centre_mm).abs() <= *reach_mm,
            Self::Between(intervals) => {
                let after = intervals.partition_point(|interval| interval[0] <= value);
                after > 0 && value <= intervals[after - 1][1]
            }
        }
    }
}

/// The two nearest others of each point, of equally near ones the first; fewer if there are fewer.
///
/// The points are sorted along the axis on which they spread most. From each, the search goes both
/// ways until the distance along that axis alone exceeds the second nearest.
fn two_nearest(points: &[[f64; 2]]) -> Vec<[Option<usize>; 2]> {
    let spread = |axis: usize| {
        let values = points.iter().map(|p| p[axis]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    let axis = usize::from(spread(1) > spread(0));
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_unstable_by(|&a, &b| points[a][axis].total_cmp(&points[b][axis]));
    let mut nearest = vec![[None; 2]; points.len()];
    for (place, &own) in order.iter().enumerate() {
        let mut best = Best::default();
        let (before, after) = (order[..place].iter().rev(), order[place + 1..].iter());
        best.search(points, own, axis, before);
        best.search(points, own, axis, after);
        nearest[own] = best.indices();
    }
    nearest
}

/// The two nearest so far as (squared distance, index).
struct Best([(f64, usize); 2]);

impl Default for Best {
    fn default() -> Self {
        Self([(f64::INFINITY, usize::MAX); 2])
    }
}

impl Best {
    /// Looks at points in the order of their distance along `axis`, as far as it matters.
    fn search<'a>(
        &mut self,
        points: &[[f64; 2]],
        own: usize,
        axis: usize,
        others: impl Iterator<Item = &'a usize>,
    ) {
        let [x, y] = points[own];
        for &other in others {
            let [dx, dy, _] = minus([points[other][0], points[other][1], 0.0], [x, y, 0.0]);
            let along = if axis == 0 { dx } else { dy };
            // At equal distance a lower index may still win.
            if along * along > self.0[1].0 {
                break;
            }
            let entry = (dx * dx + dy * dy, other);
            if entry < self.0[1] {
                self.0[1] = entry;
                self.0
                    .sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            }
        }
    }

    /// The indices found.
    fn indices(&self) -> [Option<usize>; 2] {
        self.0
            .map(|(distance, index)| distance.is_finite().then_some(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_point_covers_one_step_around_it() {
        let span = Span::of(&[[3.0, 5.0]], 1, 1.0, 0.5);
        let covered = [5.4, 5.5, 6.0, 6.5, 6.6].map(|y| span.contains(y));
        assert_eq!(covered, [false, true, true, true, false]);
    }

    #[test]
    fn two_points_cover_what_is_between_them() {
        let span = Span::of(&[[3.0, 5.0], [9.0, 2.0]], 0, -1.0, 0.5);
        let covered = [1.9, 2.0, 5.0, 8.0, 8.1].map(|x| span.contains(x));
        assert_eq!(covered, [false, true, true, true, false]);
    }

    #[test]
    fn a_gap_between_clusters_is_not_covered() {
        let points = [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [9.0, 0.0],
            [10.0, 0.0],
            [11.0, 0.0],
        ];
        let span = Span::of(&points, 0, 0.0, 0.5);
        assert!(span.contains(1.5) && span.contains(9.5));
        assert!(!span.contains(5.0));
    }
}
