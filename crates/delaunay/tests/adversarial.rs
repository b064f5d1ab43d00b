//! A hundred thousand small sets of the worst kinds, each against plain exact arithmetic.

mod common;

use bonemesh_delaunay::{DelaunayError, Points, alpha_boundary, alpha_complex, tetrahedralize};
use bonemesh_task::Task;
use common::{CUBIC, Oracle, SLICES, as_f64, cospherical};
use proptest::prelude::*;

/// Few points of a small block, of two planes, of one sphere, of rows far apart, with duplicates.
fn small_set() -> impl Strategy<Value = Vec<[i32; 3]>> {
    let block = prop::array::uniform3(0..3i32);
    let planes = [0..4i32, 0..4i32, 0..2i32];
    let sphere = prop::sample::select(cospherical());
    let rows = [0..9i32, 0..2i32].prop_map(|[x, y]| [x, 1000 * y, x * y % 3]);
    let wild = prop::array::uniform3(-16_000..16_000i32);
    prop_oneof![
        3 => prop::collection::vec(block.clone(), 4..13),
        2 => prop::collection::vec(planes, 4..13),
        2 => prop::collection::vec(sphere, 4..11),
        1 => prop::collection::vec(rows, 4..11),
        1 => (prop::collection::vec(block, 4..9), prop::collection::vec(wild, 1..3))
            .prop_map(|(near, far)| [near, far].concat()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100_000))]

    #[test]
    fn every_small_set_is_delaunay_and_its_alpha_complexes_are_bounded(
        points in small_set(),
        gram in prop::sample::select(vec![CUBIC, SLICES, [[4, 1, 0], [1, 5, -2], [0, -2, 9]]]),
        // Sixteenths are doubles, and squares of some are squared radii.
        sixteenths in prop_oneof![8..48i128, Just(24), 16_000..32_000i128],
    ) {
        let task = Task::default();
        let oracle = Oracle { points: &points, gram };
        let cells = match oracle.tetrahedra() {
            Ok(cells) => cells,
            Err(DelaunayError::TooFew { .. }
                | DelaunayError::Collinear { .. }
                | DelaunayError::Coplanar { .. }) => return Ok(()),
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        oracle.assert_delaunay(&cells);
        if gram == CUBIC {
            let free = as_f64(&points);
            prop_assert_eq!(&tetrahedralize(Points::Free(&free), &task).unwrap(), &cells);
        }
        let alpha = sixteenths as f64 / 16.0;
        let kept = alpha_complex(oracle.lattice(), alpha, &task).unwrap();
        // Farther points would overflow the oracle's fractions.
        if points.as_flattened().iter().all(|c| c.abs() <= 1000) {
            let is_small = |cell: &&[u32; 4]| {
                let (squared, unit) = oracle.radius_squared(**cell);
                256 * squared <= sixteenths * sixteenths * unit
            };
            let small: Vec<[u32; 4]> = cells.cells.iter().filter(is_small).copied().collect();
            prop_assert_eq!(&kept.cells, &small);
        }
        let direct = alpha_boundary(oracle.lattice(), alpha, &task).unwrap();
        prop_assert_eq!(direct.triangles, kept.boundary(&task).unwrap());
        prop_assert_eq!(direct.tetrahedra, kept.cells.len());
    }
}
