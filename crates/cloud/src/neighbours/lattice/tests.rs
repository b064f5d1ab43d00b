//! Sums over lattices, against the definition.

use super::*;
use bonemesh_volume::Affine;
use proptest::prelude::*;

fn lattice(coordinates: Vec<[i32; 3]>, axes: [[f64; 3]; 3]) -> Lattice {
    Lattice {
        coordinates,
        frame_from_lattice: Affine::from_axes(axes[0], axes[1], axes[2], [-7.0, 90.0, 1e3]),
    }
}

fn upright(x: f64, y: f64, z: f64) -> [[f64; 3]; 3] {
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}

/// A box full of points.
fn block(size: [i32; 3]) -> Vec<[i32; 3]> {
    let plane = |z| (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y, z]));
    (0..size[2]).flat_map(plane).collect()
}

/// Sum of the distances from one point to its nearest, by looking at all.
fn by_definition(lattice: &Lattice, point: usize, k: usize) -> f64 {
    let place = |at: [i32; 3]| lattice.frame_from_lattice.apply(at.map(f64::from));
    let centre = place(lattice.coordinates[point]);
    let mut all: Vec<f64> = lattice
        .coordinates
        .iter()
        .map(|at| {
            let other = place(*at);
            let squares = (0..3).map(|i| (other[i] - centre[i]).powi(2));
            squares.sum::<f64>().sqrt()
        })
        .collect();
    all.sort_by(f64::total_cmp);
    all[..k].iter().sum()
}

/// How many points were not lonely, whose sum is that of the definition.
fn checked(lattice: &Lattice, k: usize) -> Option<usize> {
    let k = k.min(lattice.coordinates.len());
    let sums = Packed::new(lattice, k)?.sums(&Task::default()).unwrap();
    let points = 0..lattice.coordinates.len();
    let met: Vec<usize> = points
        .filter(|i| !sums.lonely.contains(&(*i as u32)))
        .collect();
    let expected: f64 = met.iter().map(|i| by_definition(lattice, *i, k)).sum();
    assert!(
        (sums.sum_mm - expected).abs() <= 1e-10 * expected,
        "{} {expected}",
        sums.sum_mm
    );
    assert!(sums.lonely.is_sorted());
    Some(met.len())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    #[test]
    fn sums_are_those_of_the_definition(
        near in prop::collection::btree_set(prop::array::uniform3(0..12_i32), 2..250),
        far in prop::collection::btree_set(prop::array::uniform3(40..90_i32), 0..4),
        from in prop::array::uniform3(-1_000_000..1_000_000_i32),
        k in 2..110_usize,
        spacing in prop::array::uniform3(prop_oneof![Just(0.5), Just(1.0), 0.1..5.0_f64]),
        tilt in prop_oneof![Just(0.0), -2.0..2.0_f64],
    ) {
        let [x, y, z] = spacing;
        let axes = [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, tilt * y, z]];
        let points = near.union(&far).map(|at| [0, 1, 2].map(|i| at[i] + from[i]));
        checked(&lattice(points.collect(), axes), k);
    }
}

#[test]
fn crowds_lines_and_planes_are_met_whole() {
    // Columns far finer than rows need rows of several windows.
    for (axes, size) in [
        (upright(0.5, 0.5, 1.0), [9, 8, 7]),
        (upright(0.5, 0.5, 1.0), [20, 20, 1]),
        (upright(0.5, 0.5, 1.0), [8, 2, 30]),
        (upright(0.02, 1.0, 1.0), [9, 8, 7]),
        (upright(0.02, 1.0, 1.0), [90, 5, 1]),
        (upright(1.0, 1.0, 0.1), [9, 8, 7]),
        (upright(1.0, 1.0, 0.1), [2, 2, 60]),
    ] {
        let all = block(size);
        let points = all.len();
        assert_eq!(checked(&lattice(all, axes), 27), Some(points), "{size:?}");
    }
}

#[test]
fn the_nearest_cut_a_class_where_they_must() {
    // Of the six at distance 1 around the middle of a star, two count.
    let star = vec![
        [0, 0, 0],
        [1, 0, 0],
        [-1, 0, 0],
        [0, 1, 0],
        [0, -1, 0],
        [0, 0, 1],
        [0, 0, -1],
    ];
    let lattice = lattice(star, upright(1.0, 1.0, 1.0));
    let sums = Packed::new(&lattice, 3)
        .unwrap()
        .sums(&Task::default())
        .unwrap();
    let expected = 2.0 + 6.0 * (1.0 + 2.0_f64.sqrt());
    assert!((sums.sum_mm - expected).abs() < 1e-12);
    assert!(sums.lonely.is_empty());
}

#[test]
fn lonely_points_are_named_and_the_rest_is_summed() {
    let mut points = block([8, 8, 8]);
    points.insert(100, [200, 8, 8]);
    points.push([8, 300, 9]);
    let lattice = lattice(points, upright(0.5, 0.5, 1.0));
    let sums = Packed::new(&lattice, 30)
        .unwrap()
        .sums(&Task::default())
        .unwrap();
    assert_eq!(sums.lonely, [100, 513]);
    assert_eq!(checked(&lattice, 30), Some(512));
}

#[test]
fn what_does_not_fit_is_left_to_others() {
    let unit = upright(1.0, 1.0, 1.0);
    let refuses = |points: Vec<[i32; 3]>, axes, k| Packed::new(&lattice(points, axes), k).is_none();
    let mut twice = block([9, 9, 9]);
    twice.push([4, 4, 4]);
    assert!(refuses(twice, unit, 20));
    assert!(refuses(vec![[i32::MIN; 3], [0; 3], [i32::MAX; 3]], unit, 2));
    let scattered = (0..200)
        .map(|i| [i * 31 % 97, i * 17 % 89, i * 7 % 83])
        .collect();
    assert!(refuses(scattered, unit, 100));
    let all = || block([9, 9, 9]);
    assert!(!refuses(all(), unit, 20));
    assert!(refuses(all(), unit, 729 * 4));
    assert!(refuses(
        all(),
        [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        20
    ));
    assert!(refuses(all(), [[0.0; 3]; 3], 20));
    assert!(refuses(all(), upright(1e200, 1e200, 1e200), 20));
    assert!(refuses(all(), upright(1e-200, 1e-200, 1e-200), 20));
    assert!(refuses(all(), upright(1.0, f64::NAN, 1.0), 20));
}
