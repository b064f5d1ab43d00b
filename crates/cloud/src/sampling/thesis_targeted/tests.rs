use super::*;
use crate::{Lattice, Sampling, sample};
use bonemesh_volume::Affine;
use proptest::prelude::*;

fn cloud(coordinates: Vec<[i32; 3]>) -> PointCloud {
    PointCloud::from_lattice(Lattice {
        coordinates,
        frame_from_lattice: Affine::from_axes(
            [0.4, 0.0, 0.0],
            [0.0, 0.4, 0.0],
            [0.0, 0.0, 2.5],
            [-31.7, 12.3, 4.1],
        ),
    })
    .unwrap()
}

fn keep_sorted(cloud: &PointCloud, ranges: SimilarityRanges) -> Vec<u32> {
    sample(cloud, &Sampling::ThesisTargeted(ranges), &Task::default()).unwrap()
}

proptest! {
    #[test]
    fn a_cell_is_sampled_as_its_points_alone_would_be(
        coordinates in prop::collection::btree_set(
            (0..3_i32, 0..25_i32, 0..25_i32).prop_map(|(k, j, i)| [k, j, i]), 1..300),
        grid_px in 1..30_u32,
    ) {
        let coordinates: Vec<[i32; 3]> = coordinates.into_iter().map(|[k, j, i]| [i, j, k]).collect();
        let whole = cloud(coordinates.clone());
        let ranges = SimilarityRanges::new(grid_px, [0.0, 0.4, 0.6, 0.8], [10.0, 25.0, 50.0, 75.0]);
        let ranges = ranges.unwrap();
        let low = [0, 1].map(|axis| coordinates.iter().map(|c| c[axis]).min().unwrap());
        let cell = |c: &[i32; 3]| {
            let at = |axis: usize| (c[axis] - low[axis]) / grid_px as i32;
            [c[2], at(1), at(0)]
        };
        let mut expected = Vec::new();
        let mut seen: Vec<[i32; 3]> = coordinates.iter().map(cell).collect();
        seen.sort_unstable();
        seen.dedup();
        for own in seen {
            let members: Vec<u32> = (0..whole.len() as u32)
                .filter(|i| cell(&coordinates[*i as usize]) == own)
                .collect();
            let alone = whole.subset(&members);
            let task = Task::default();
            let normals = normals(alone.points_mm(), NEIGHBOURS, &task).unwrap();
            let similarity = mean_similarity(&normals, &task).unwrap();
            let percent = match similarity {
                s if s < 0.4 => 75.0,
                s if s < 0.6 => 50.0,
                s if s < 0.8 => 25.0,
                _ => 10.0,
            };
            let percent = Percent::new(percent).unwrap();
            let kept = sample(&alone, &Sampling::ThesisUniform { percent }, &task).unwrap();
            expected.extend(kept.into_iter().map(|i| members[i as usize]));
        }
        expected.sort_unstable();
        prop_assert_eq!(keep_sorted(&whole, ranges), expected);
        let counts = count_ranges(&whole, &ranges, &Task::default()).unwrap();
        prop_assert!(counts.iter().sum::<usize>() <= whole.len());
    }
}

#[test]
fn the_lowest_similarity_has_the_last_percentage() {
    let ranges = SimilarityRanges::default();
    for (similarity, range) in [
        (0.0, 0),
        (0.39, 0),
        (0.4, 1),
        (0.6, 2),
        (0.79, 2),
        (0.8, 3),
        (1.0, 3),
    ] {
        assert_eq!(ranges.range(similarity), range, "{similarity}");
    }
}

#[test]
fn points_on_the_upper_bound_and_single_points_are_not_lost() {
    // Eleven columns in cells of ten: the last point has a cell of its own.
    let row = cloud((0..11).map(|i| [i, 0, 7]).collect());
    let all = SimilarityRanges::new(10, [0.0, 0.4, 0.6, 0.8], [100.0; 4]).unwrap();
    assert_eq!(keep_sorted(&row, all).len(), 11);
    let counts = count_ranges(&row, &all, &Task::default()).unwrap();
    assert_eq!(counts.iter().sum::<usize>(), 2);
}

#[test]
fn a_cell_of_up_to_thirty_points_has_one_normal_whatever_its_shape() {
    let corner = (0..10).map(|i| [i, 0, 0]).chain((1..10).map(|j| [0, j, 0]));
    let counts = count_ranges(
        &cloud(corner.collect()),
        &SimilarityRanges::default(),
        &Task::default(),
    );
    assert_eq!(counts.unwrap(), [0, 0, 0, 1]);
}

#[test]
fn unusable_ranges_are_refused_with_the_remedy() {
    let usual = [0.0, 0.4, 0.6, 0.8];
    let percentages = [10.0, 25.0, 50.0, 75.0];
    for (grid_px, cutoffs, percentages, word) in [
        (0, usual, percentages, "pixel"),
        (10, [0.1, 0.4, 0.6, 0.8], percentages, "rising"),
        (10, [0.0, 0.4, 0.4, 0.8], percentages, "rising"),
        (10, [0.0, 0.4, 0.6, 1.1], percentages, "rising"),
        (10, [0.0, f64::NAN, 0.6, 0.8], percentages, "rising"),
        (10, usual, [10.0, 25.0, 50.0, 0.0], "percentage"),
        (10, usual, [10.0, 25.0, 50.0, 101.0], "percentage"),
    ] {
        let error = SimilarityRanges::new(grid_px, cutoffs, percentages).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
    }
    let free = PointCloud::from_points(vec![[0.1, 0.7, 0.3], [1.0, 2.5, 3.0]]).unwrap();
    let error = sample(
        &free,
        &Sampling::ThesisTargeted(SimilarityRanges::default()),
        &Task::default(),
    );
    assert!(error.unwrap_err().to_string().contains("spacing"));
}
