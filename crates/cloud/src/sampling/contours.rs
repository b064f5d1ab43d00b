//! The points of a slice in the order of a walk along its contours.

use super::remaining::Remaining;
use bonemesh_task::{Cancelled, Task};

/// A point of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// Number of the point in its slice.
    pub(super) point: u32,
    /// Length of contour (mm) that the point stands for; `None` for a point on its own.
    pub(super) arc_mm: Option<f64>,
}

/// Steps longer than this many usual ones end a contour of free points.
const LONGEST_STEP: f64 = 4.0;

/// Neighbours on the lattice: sides before corners, so that a walk does not cut corners.
const NEIGHBOURS: [[i32; 2]; 8] = [
    [1, 0],
    [0, 1],
    [-1, 0],
    [0, -1],
    [1, 1],
    [-1, 1],
    [-1, -1],
    [1, -1],
];

/// Walks 8-connected lattice points; `metric` is the squared length of a step along each axis.
///
/// Walks begin at the loose ends, then wherever points are left. Points are different.
pub(super) fn walk_lattice(pixels: &[[i32; 2]], metric: [f64; 3]) -> Vec<Step> {
    let mut sorted: Vec<u32> = (0..pixels.len() as u32).collect();
    let key = |pixel: [i32; 2]| (pixel[1], pixel[0]);
    sorted.sort_by_key(|i| key(pixels[*i as usize]));
    let neighbour = |point: u32, [di, dj]: [i32; 2]| {
        let [i, j] = pixels[point as usize];
        let wanted = key([i.checked_add(di)?, j.checked_add(dj)?]);
        let at = sorted.binary_search_by_key(&wanted, |other| key(pixels[*other as usize]));
        at.ok().map(|at| sorted[at])
    };
    let is_loose = |point: u32| {
        NEIGHBOURS
            .iter()
            .filter(|offset| neighbour(point, **offset).is_some())
            .count()
            == 1
    };
    let ends: Vec<u32> = sorted.iter().copied().filter(|p| is_loose(*p)).collect();
    let mut is_taken = vec![false; pixels.len()];
    let mut steps = Vec::with_capacity(pixels.len());
    let mut walk = Vec::new();
    for start in ends.iter().chain(&sorted) {
        let mut next = Some(*start).filter(|p| !is_taken[*p as usize]);
        walk.clear();
        while let Some(point) = next {
            is_taken[point as usize] = true;
            walk.push(point);
            next = NEIGHBOURS
                .iter()
                .filter_map(|offset| neighbour(point, *offset))
                .find(|p| !is_taken[*p as usize]);
        }
        let place = |point: u32| pixels[point as usize].map(f64::from);
        push_walk(&mut steps, &walk, |a, b| {
            let (a, b) = (place(a), place(b));
            ((a[0] - b[0]).powi(2) * metric[0] + (a[1] - b[1]).powi(2) * metric[1]).sqrt()
        });
    }
    steps
}

/// Walks free points from nearest to nearest.
pub(super) fn walk_nearest(
    places: &[[f64; 3]],
    metric: [f64; 3],
    task: &Task,
) -> Result<Vec<Step>, Cancelled> {
    let mut remaining = Remaining::new(places, metric);
    let mut usual: Vec<f64> = (0..places.len() as u32)
        .filter_map(|i| remaining.nearest(i, 2).get(1).map(|n| n.0.sqrt()))
        .collect();
    let middle = usual.len() / 2;
    let longest = if usual.is_empty() {
        0.0
    } else {
        LONGEST_STEP * *usual.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let squared = longest * longest;
    let mut steps = Vec::with_capacity(places.len());
    let mut walk = Vec::new();
    while let Some(start) = remaining.first() {
        walk.clear();
        let mut next = Some(start);
        while let Some(point) = next {
            task.check()?;
            remaining.remove(point);
            walk.push(point);
            let nearest = remaining.nearest(point, 1).first();
            next = nearest.filter(|n| n.0 <= squared).map(|n| n.1);
        }
        push_walk(&mut steps, &walk, |a, b| {
            let (a, b) = (places[a as usize], places[b as usize]);
            let squares = (0..3).map(|i| (a[i] - b[i]).powi(2) * metric[i]);
            squares.sum::<f64>().sqrt()
        });
    }
    Ok(steps)
}

/// Appends a walk; each point stands for half the way to the points before and after, an end for
/// the whole way to its only one.
fn push_walk(steps: &mut Vec<Step>, walk: &[u32], length: impl Fn(u32, u32) -> f64) {
    for (at, point) in walk.iter().enumerate() {
        let before = at.checked_sub(1).map(|b| length(walk[b], *point));
        let after = walk.get(at + 1).map(|a| length(*point, *a));
        let arc_mm = match (before, after) {
            (Some(before), Some(after)) => Some(f64::midpoint(before, after)),
            (one, other) => one.or(other),
        };
        steps.push(Step {
            point: *point,
            arc_mm,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(steps: &[Step]) -> Vec<u32> {
        steps.iter().map(|s| s.point).collect()
    }

    #[test]
    fn a_walk_begins_at_a_loose_end_and_keeps_to_the_line() {
        // Given out of order: a row of five with a step down at its end.
        let pixels = [[2, 0], [0, 0], [4, 0], [1, 0], [3, 0], [5, 1]];
        let steps = walk_lattice(&pixels, [1.0, 1.0, 0.0]);
        assert_eq!(points(&steps), [1, 3, 0, 4, 2, 5]);
        assert_eq!(steps[1].arc_mm, Some(1.0));
        assert_eq!(steps[5].arc_mm, Some(2.0_f64.sqrt()));
    }

    #[test]
    fn a_closed_contour_is_one_walk_in_both_ways_of_walking() {
        let pixels: Vec<[i32; 2]> = (0..10)
            .flat_map(|j| (0..12).map(move |i| [i, j]))
            .filter(|[i, j]| [0, 11].contains(i) || [0, 9].contains(j))
            .collect();
        let places: Vec<[f64; 3]> = pixels
            .iter()
            .map(|[i, j]| [f64::from(*i), f64::from(*j), 0.0])
            .collect();
        let lattice = walk_lattice(&pixels, [1.0, 1.0, 0.0]);
        let free = walk_nearest(&places, [1.0; 3], &Task::default()).unwrap();
        for steps in [lattice, free] {
            let mut sorted = points(&steps);
            for pair in sorted.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|p| pixels[p as usize]);
                assert_eq!((a[0] - b[0]).abs() + (a[1] - b[1]).abs(), 1);
            }
            sorted.sort_unstable();
            assert_eq!(sorted, (0..40).collect::<Vec<u32>>());
        }
    }

    #[test]
    fn a_point_on_its_own_has_no_length() {
        let steps = walk_lattice(&[[0, 0], [5, 5], [6, 6]], [1.0, 4.0, 0.0]);
        assert_eq!(steps.iter().filter(|s| s.arc_mm.is_none()).count(), 1);
        let far = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [99.0, 0.0, 0.0]];
        let steps = walk_nearest(&far, [1.0; 3], &Task::default()).unwrap();
        assert_eq!(steps[3].arc_mm, None);
    }

    #[test]
    fn extreme_coordinates_are_walked_too() {
        let pixels = [
            [i32::MIN, i32::MAX],
            [i32::MAX, i32::MIN],
            [i32::MAX, i32::MAX],
        ];
        assert_eq!(walk_lattice(&pixels, [1.0, 1.0, 0.0]).len(), 3);
    }
}
