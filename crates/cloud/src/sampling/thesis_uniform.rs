//! The published pseudo-uniform sampling, to the letter.
//!
//! In each slice: the first remaining point and its nearest remaining neighbours, ten with
//! itself, are taken away, and of these some are kept, evenly by rank of distance.

use bonemesh_task::{Cancelled, Task};
use rayon::prelude::*;

use super::Percent;
use super::remaining::Remaining;
use super::slices::Slices;
use crate::PointCloud;

/// Points that are taken away together.
const GROUP: usize = 10;

/// The indices to keep, slice by slice.
pub(super) fn keep(
    cloud: &PointCloud,
    percent: Percent,
    task: &Task,
) -> Result<Vec<u32>, Cancelled> {
    let slices = Slices::of(cloud);
    let kept: Vec<Vec<u32>> = slices
        .par_iter()
        .map(|members| {
            let kept = keep_of_slice(&slices.places(members), slices.metric(), percent, task)?;
            task.advance(members.len())?;
            Ok(kept.into_iter().map(|i| members[i as usize]).collect())
        })
        .collect::<Result<_, Cancelled>>()?;
    Ok(kept.concat())
}

/// The numbers to keep of the points of one slice, or of a part of it.
pub(super) fn keep_of_slice(
    places: &[[f64; 3]],
    metric: [f64; 3],
    percent: Percent,
    task: &Task,
) -> Result<Vec<u32>, Cancelled> {
    let mut remaining = Remaining::new(places, metric);
    let mut kept = Vec::new();
    let mut group = Vec::with_capacity(GROUP);
    while let Some(first) = remaining.first() {
        task.check()?;
        group.clear();
        group.extend(remaining.nearest(first, GROUP).iter().map(|n| n.1));
        kept.extend(kept_ranks(group.len(), percent).map(|rank| group[rank]));
        for point in &group {
            remaining.remove(*point);
        }
    }
    Ok(kept)
}

/// Which of `group` points, ranked by distance from 0, are kept.
fn kept_ranks(group: usize, percent: Percent) -> impl Iterator<Item = usize> {
    let count = (percent.fraction() * group as f64) as usize;
    let last = group as f64 - 1.0;
    (0..count).map(move |i| {
        let position = if i + 1 == count && count > 1 {
            last
        } else {
            i as f64 * (last / (count as f64 - 1.0).max(1.0))
        };
        // Ranks count from 1 in the source; halves go to the even one.
        (position + 1.0).round_ties_even() as usize - 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lattice, Sampling, sample};
    use bonemesh_volume::Affine;
    use proptest::prelude::*;

    /// The definition, quadratic: distances to all remaining points, sorted.
    fn by_definition(cloud: &PointCloud, percent: f64) -> Vec<u32> {
        let lattice = cloud.lattice().unwrap();
        let gram = lattice.frame_from_lattice.gram();
        let mut kept = Vec::new();
        let mut heights: Vec<i32> = lattice.coordinates.iter().map(|c| c[2]).collect();
        heights.sort_unstable();
        heights.dedup();
        for height in heights {
            let mut left: Vec<u32> = (0..cloud.len() as u32)
                .filter(|i| lattice.coordinates[*i as usize][2] == height)
                .collect();
            while let Some(first) = left.first().copied() {
                let at = lattice.coordinates[first as usize];
                let mut all: Vec<(f64, u32)> = left
                    .iter()
                    .map(|i| {
                        let c = lattice.coordinates[*i as usize];
                        let [di, dj] = [0, 1].map(|a| f64::from(c[a] - at[a]));
                        (di * di * gram[0][0] + dj * dj * gram[1][1], *i)
                    })
                    .collect();
                all.sort_by(|a, b| a.partial_cmp(b).unwrap());
                all.truncate(10);
                let n = all.len();
                let count = (percent / 100.0 * n as f64) as usize;
                for i in 0..count {
                    let step = if count > 1 {
                        (n - 1) as f64 / (count - 1) as f64
                    } else {
                        0.0
                    };
                    let rank = (1.0 + i as f64 * step).round_ties_even() as usize;
                    kept.push(all[rank - 1].1);
                }
                left.retain(|i| all.iter().all(|(_, taken)| taken != i));
            }
        }
        kept.sort_unstable();
        kept
    }

    fn keep_sorted(cloud: &PointCloud, percent: f64) -> Vec<u32> {
        let percent = Percent::new(percent).unwrap();
        sample(
            cloud,
            &Sampling::ThesisUniform { percent },
            &Task::default(),
        )
        .unwrap()
    }

    fn cloud(coordinates: Vec<[i32; 3]>, spacing: [f64; 3]) -> PointCloud {
        let frame_from_lattice = Affine::from_axes(
            [spacing[0], 0.0, 0.0],
            [0.0, spacing[1], 0.0],
            [0.0, 0.0, spacing[2]],
            [-31.7, 12.3, 4.1],
        );
        PointCloud::from_lattice(Lattice {
            coordinates,
            frame_from_lattice,
        })
        .unwrap()
    }

    proptest! {
        #[test]
        fn the_quick_search_keeps_what_the_definition_keeps(
            coordinates in prop::collection::btree_set(
                (0..3_i32, 0..25_i32, 0..25_i32).prop_map(|(k, j, i)| [k, j, i]), 0..400),
            percent in prop::sample::select(vec![5.0, 10.0, 25.0, 30.0, 55.5, 70.0, 99.0, 100.0]),
            spacing in prop::sample::select(vec![[0.4, 0.4, 1.0], [0.3, 0.7, 2.5]]),
        ) {
            let coordinates = coordinates.into_iter().map(|[k, j, i]| [i, j, k]).collect();
            let cloud = cloud(coordinates, spacing);
            prop_assert_eq!(keep_sorted(&cloud, percent), by_definition(&cloud, percent));
        }
    }

    #[test]
    fn ranks_are_spread_as_published() {
        let ranks =
            |n, percent| -> Vec<usize> { kept_ranks(n, Percent::new(percent).unwrap()).collect() };
        assert_eq!(ranks(10, 10.0), [0]);
        assert_eq!(ranks(10, 25.0), [0, 9]);
        // 1, 5.5 and 10, of which 5.5 goes to 6.
        assert_eq!(ranks(10, 30.0), [0, 5, 9]);
        assert_eq!(ranks(10, 100.0), (0..10).collect::<Vec<_>>());
        assert_eq!(ranks(10, 9.0), [0; 0]);
        assert_eq!(ranks(3, 50.0), [0]);
    }

    #[test]
    fn percentages_act_in_steps_of_ten() {
        let row = (0..1000).map(|i| [i, 0, 0]).collect();
        let cloud = cloud(row, [1.0, 1.0, 1.0]);
        assert_eq!(keep_sorted(&cloud, 25.0).len(), 200);
        assert_eq!(keep_sorted(&cloud, 9.0).len(), 0);
        assert_eq!(keep_sorted(&cloud, 100.0).len(), 1000);
    }
}
