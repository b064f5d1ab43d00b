//! The points of a slice in the order of walks along its contours.

mod adjacent;

use bonemesh_task::{Cancelled, Task};

use super::remaining::Remaining;
use super::slices::Slices;
use adjacent::Adjacent;

/// Points in the order in which a contour passes them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Walk {
    /// Numbers of the points.
    pub(super) points: Vec<u32>,
    /// Lengths (mm) of the steps from each point to the next; of a closed walk also from the last to
    /// the first.
    pub(super) steps_mm: Vec<f64>,
}

impl Walk {
    fn of(points: Vec<u32>, is_closed: bool, length_mm: impl Fn(u32, u32) -> f64) -> Self {
        let mut steps_mm: Vec<f64> = points.windows(2).map(|w| length_mm(w[0], w[1])).collect();
        if let (true, [first, .., last]) = (is_closed, &points[..]) {
            steps_mm.push(length_mm(*last, *first));
        }
        Self { points, steps_mm }
    }

    /// Whether the last point is followed by the first.
    pub(super) fn is_closed(&self) -> bool {
        self.steps_mm.len() == self.points.len()
    }

    /// The length (mm) of contour that each point stands for: half the way to the points before and
    /// after, for an end the whole way to its only one; `None` for a point on its own.
    pub(super) fn arcs_mm(&self) -> impl Iterator<Item = Option<f64>> {
        let steps = &self.steps_mm;
        (0..self.points.len()).map(|at| {
            let before = match at.checked_sub(1) {
                None if self.is_closed() => steps.last(),
                None => None,
                Some(before) => steps.get(before),
            };
            match (before, steps.get(at)) {
                (Some(before), Some(after)) => Some(f64::midpoint(*before, *after)),
                (one, other) => one.or(other).copied(),
            }
        })
    }
}

/// Fewer points a walk than this on average are no contours of adjacent pixels.
const LEAST_POINTS: usize = 4;

/// The walks of one slice, along adjacent pixels or, where there are none such, from nearest to nearest;
/// points are numbered as in the cloud.
pub(super) fn walk(
    slices: &Slices<'_>,
    members: &[u32],
    task: &Task,
) -> Result<Vec<Walk>, Cancelled> {
    let metric = slices.metric();
    let of_pixels = slices.pixels(members).map(|p| walk_lattice(&p, metric));
    let are_contours = |walks: &Vec<Walk>| walks.len() * LEAST_POINTS <= members.len();
    let mut walks = match of_pixels.filter(are_contours) {
        Some(walks) => walks,
        None => walk_nearest(&slices.places(members), metric, task)?,
    };
    for point in walks.iter_mut().flat_map(|w| &mut w.points) {
        *point = members[*point as usize];
    }
    Ok(walks)
}

/// Steps longer than this many usual ones end a contour of free points.
const LONGEST_STEP: f64 = 4.0;

/// Walks 8-connected lattice points; `metric` is the squared length of a step along each axis.
///
/// Walks begin at loose ends, then wherever points are left, from where they go both ways. Each step leads
/// to the neighbour with the fewest ways on, but into no dead end: so a contour two pixels wide is passed
/// once, from side to side, and not there and back. The time is linear for points that come by row and
/// column.
fn walk_lattice(pixels: &[[i32; 2]], metric: [f64; 3]) -> Vec<Walk> {
    let adjacent = Adjacent::of(pixels);
    let mut is_taken = vec![false; pixels.len()];
    let mut walks = Vec::new();
    let loose = adjacent
        .sorted()
        .filter(|p| adjacent.of_point(*p).count() == 1);
    for start in loose.chain(adjacent.sorted()) {
        if std::mem::replace(&mut is_taken[start as usize], true) {
            continue;
        }
        let points = both_ways(start, |point| {
            let is_left = |p: &u32| !is_taken[*p as usize];
            let onward = |p: &u32| match adjacent.of_point(*p).filter(is_left).count() {
                0 => usize::MAX,
                count => count,
            };
            let next = adjacent
                .of_point(point)
                .filter(is_left)
                .min_by_key(onward)?;
            is_taken[next as usize] = true;
            Some(next)
        });
        let [first, last] = [points[0], points[points.len() - 1]];
        let is_closed = points.len() > 2 && adjacent.of_point(last).any(|p| p == first);
        walks.push(Walk::of(points, is_closed, |a, b| {
            let [a, b] = [a, b].map(|p| pixels[p as usize].map(f64::from));
            ((a[0] - b[0]).powi(2) * metric[0] + (a[1] - b[1]).powi(2) * metric[1]).sqrt()
        }));
    }
    walks
}

/// Walks free points from nearest to nearest.
fn walk_nearest(
    places: &[[f64; 3]],
    metric: [f64; 3],
    task: &Task,
) -> Result<Vec<Walk>, Cancelled> {
    let mut remaining = Remaining::new(places, metric);
    let longest_mm2 = longest_step_mm(places, &mut remaining, task)?.powi(2);
    let squared_mm2 = |a: u32, b: u32| {
        let (a, b) = (places[a as usize], places[b as usize]);
        (0..3)
            .map(|i| (a[i] - b[i]).powi(2) * metric[i])
            .sum::<f64>()
    };
    let mut walks = Vec::new();
    while let Some(start) = remaining.first() {
        task.check()?;
        remaining.remove(start);
        let mut is_cancelled = false;
        let points = both_ways(start, |point| {
            is_cancelled |= task.check().is_err();
            let nearest = remaining.nearest(point, 1).first();
            let next = nearest.filter(|n| n.0 <= longest_mm2 && !is_cancelled)?.1;
            remaining.remove(next);
            Some(next)
        });
        task.check()?;
        let ends_mm2 = squared_mm2(points[points.len() - 1], points[0]);
        let is_closed = points.len() > 2 && ends_mm2 <= longest_mm2;
        walks.push(Walk::of(points, is_closed, |a, b| squared_mm2(a, b).sqrt()));
    }
    Ok(walks)
}

/// A few times the usual distance to the nearest point.
fn longest_step_mm(
    places: &[[f64; 3]],
    remaining: &mut Remaining<'_>,
    task: &Task,
) -> Result<f64, Cancelled> {
    let mut usual = Vec::with_capacity(places.len());
    for point in 0..places.len() as u32 {
        task.check()?;
        usual.extend(remaining.nearest(point, 2).get(1).map(|n| n.0.sqrt()));
    }
    if usual.is_empty() {
        return Ok(0.0);
    }
    let middle = usual.len() / 2;
    Ok(LONGEST_STEP * *usual.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// From `start` by `next` until there is none, then from `start` again, the other way.
fn both_ways(start: u32, mut next: impl FnMut(u32) -> Option<u32>) -> Vec<u32> {
    let mut follow = |walk: &mut Vec<u32>| {
        let mut at = start;
        while let Some(point) = next(at) {
            walk.push(point);
            at = point;
        }
    };
    let mut onward = vec![start];
    follow(&mut onward);
    let mut back = Vec::new();
    follow(&mut back);
    if back.is_empty() {
        return onward;
    }
    back.reverse();
    back.extend(onward);
    back
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring() -> Vec<[i32; 2]> {
        (0..10)
            .flat_map(|j| (0..12).map(move |i| [i, j]))
            .filter(|[i, j]| [0, 11].contains(i) || [0, 9].contains(j))
            .collect()
    }

    #[test]
    fn a_walk_begins_at_a_loose_end_and_keeps_to_the_line() {
        // Given out of order: a row of five with a step down at its end.
        let pixels = [[2, 0], [0, 0], [4, 0], [1, 0], [3, 0], [5, 1]];
        let walks = walk_lattice(&pixels, [1.0, 1.0, 0.0]);
        assert_eq!(walks.len(), 1);
        assert_eq!(walks[0].points, [1, 3, 0, 4, 2, 5]);
        let arcs: Vec<_> = walks[0].arcs_mm().collect();
        assert_eq!(arcs[1], Some(1.0));
        assert_eq!(arcs[5], Some(2.0_f64.sqrt()));
    }

    #[test]
    fn a_closed_contour_is_one_closed_walk_in_both_ways_of_walking() {
        let pixels = ring();
        let places: Vec<[f64; 3]> = pixels
            .iter()
            .map(|[i, j]| [f64::from(*i), f64::from(*j), 0.0])
            .collect();
        let lattice = walk_lattice(&pixels, [1.0, 1.0, 0.0]);
        let free = walk_nearest(&places, [1.0; 3], &Task::default()).unwrap();
        for walks in [lattice, free] {
            assert_eq!(walks.len(), 1);
            assert!(walks[0].is_closed());
            assert!(walks[0].arcs_mm().all(|arc| arc == Some(1.0)));
            let mut sorted = walks[0].points.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..40).collect::<Vec<u32>>());
        }
    }

    #[test]
    fn a_branch_that_begins_in_its_middle_is_walked_both_ways() {
        // A row, and above its middle a second one that both ends of lead down to it.
        let row = (0..30).map(|i| [i, 5]);
        let arch = [[8, 4], [9, 3]].into_iter().chain((10..20).map(|i| [i, 2]));
        let pixels: Vec<[i32; 2]> = row.chain(arch).chain([[20, 3], [21, 4]]).collect();
        let walks = walk_lattice(&pixels, [1.0, 1.0, 0.0]);
        assert_eq!(walks.len(), 2, "{walks:?}");
    }

    #[test]
    fn a_point_on_its_own_has_no_length() {
        let alone = |walks: &[Walk]| {
            let arcs = walks.iter().flat_map(Walk::arcs_mm);
            arcs.filter(Option::is_none).count()
        };
        let walks = walk_lattice(&[[0, 0], [5, 5], [6, 6]], [1.0, 4.0, 0.0]);
        assert_eq!(alone(&walks), 1);
        let far = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [99.0, 0.0, 0.0]];
        let walks = walk_nearest(&far, [1.0; 3], &Task::default()).unwrap();
        assert_eq!(alone(&walks), 1);
    }

    #[test]
    fn extreme_and_equal_coordinates_are_walked_too() {
        let pixels = [
            [i32::MIN, i32::MAX],
            [i32::MAX, i32::MIN],
            [i32::MAX, i32::MAX],
            [i32::MAX, i32::MAX],
        ];
        let walks = walk_lattice(&pixels, [1.0, 1.0, 0.0]);
        let points = walks.iter().map(|w| w.points.len()).sum::<usize>();
        assert_eq!(points, 4);
    }
}
