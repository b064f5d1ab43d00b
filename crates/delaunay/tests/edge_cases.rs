//! Inputs at the edge of what is possible, and beyond it.

mod common;

use bonemesh_delaunay::{DelaunayError, Points, Tetrahedra, alpha_complex, tetrahedralize};
use bonemesh_task::{Cancel, Task};
use common::{CUBIC, Oracle, SLICES, as_f64, block};

#[test]
fn rounded_direction_cosines_are_right_angles() {
    let points = block([5, 5, 3]);
    let upright = Oracle {
        points: &points,
        gram: SLICES,
    };
    let mut gram = upright.gram_f64();
    gram[0][1] = 1e-16;
    gram[1][0] = 1e-16;
    gram[1][1] += f64::EPSILON;
    let noisy = Points::Lattice {
        coordinates: &points,
        gram,
    };
    let cells = tetrahedralize(noisy, &Task::default()).unwrap();
    assert_eq!(cells, upright.tetrahedra().unwrap());
}

#[test]
fn equal_points_count_once_as_the_first_of_them() {
    let mut points = block([3, 3, 3]);
    let cells = Oracle {
        points: &points,
        gram: CUBIC,
    }
    .tetrahedra()
    .unwrap();
    points.extend(block([3, 3, 3]));
    let doubled = Oracle {
        points: &points,
        gram: CUBIC,
    }
    .tetrahedra()
    .unwrap();
    assert_eq!(cells, doubled);
    let free = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-0.0, 0.0, 1.0],
        [0.0, -0.0, 0.0],
    ];
    let cells = tetrahedralize(Points::Free(&free), &Task::default()).unwrap();
    assert_eq!(cells.cells, [[0, 1, 2, 3]]);
}

#[test]
fn points_without_volume_are_named_for_what_they_are() {
    let fails = |points: &[[i32; 3]]| {
        Oracle {
            points,
            gram: CUBIC,
        }
        .tetrahedra()
        .unwrap_err()
    };
    assert_eq!(
        fails(&[]),
        DelaunayError::TooFew {
            points: 0,
            distinct: 0
        }
    );
    assert_eq!(
        fails(&[[1, 2, 3]; 9]),
        DelaunayError::TooFew {
            points: 9,
            distinct: 1
        }
    );
    let line: Vec<[i32; 3]> = (0..9).map(|i| [i, 2 * i, -i]).collect();
    assert_eq!(fails(&line), DelaunayError::Collinear { distinct: 9 });
    assert_eq!(
        fails(&block([3, 3, 1])),
        DelaunayError::Coplanar { distinct: 9 }
    );
    let tilted: Vec<[f64; 3]> = (0..9)
        .map(|i| [f64::from(i % 3), f64::from(i / 3), f64::from(i % 3)])
        .collect();
    let error = alpha_complex(Points::Free(&tilted), 1.0, &Task::default()).unwrap_err();
    assert_eq!(error, DelaunayError::Coplanar { distinct: 9 });
}

#[test]
fn unusable_numbers_are_refused() {
    let task = Task::default();
    for bad in [f64::NAN, f64::INFINITY, 1e56, 1e-46] {
        let mut free = as_f64(&block([2, 2, 2]));
        free[3][1] = bad;
        let error = tetrahedralize(Points::Free(&free), &task).unwrap_err();
        assert!(
            matches!(error, DelaunayError::Coordinate { point: 3, .. }),
            "{error}"
        );
    }
    let points = block([2, 2, 2]);
    for alpha in [0.0, -1.0, f64::NAN] {
        let lattice = Oracle {
            points: &points,
            gram: CUBIC,
        };
        let error = alpha_complex(lattice.lattice(), alpha, &task).unwrap_err();
        assert!(matches!(error, DelaunayError::Alpha(_)));
    }
    for gram in [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, f64::NAN]],
        [[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    ] {
        let lattice = Points::Lattice {
            coordinates: &points,
            gram,
        };
        let error = tetrahedralize(lattice, &task).unwrap_err();
        assert!(matches!(error, DelaunayError::Gram { .. }), "{error}");
    }
    let far = [[0, 0, 0], [i32::MAX, 0, 0], [i32::MIN, 1, 0], [0, 0, 1]];
    let error = Oracle {
        points: &far,
        gram: CUBIC,
    }
    .tetrahedra()
    .unwrap_err();
    assert!(
        matches!(
            error,
            DelaunayError::Span {
                axis: 0,
                span: 4_294_967_295,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn a_cancelled_task_stops_the_work() {
    let cancel = Cancel::default();
    let task = Task::new(cancel.clone());
    cancel.cancel();
    let points = block([20, 20, 20]);
    let oracle = Oracle {
        points: &points,
        gram: CUBIC,
    };
    for result in [
        tetrahedralize(oracle.lattice(), &task),
        alpha_complex(oracle.lattice(), 2.0, &task),
    ] {
        assert!(matches!(result, Err(DelaunayError::Cancelled(_))));
    }
}

#[test]
fn the_boundary_is_outward_and_takes_any_indices() {
    let cell = Tetrahedra {
        cells: vec![[0, 1, 2, 3]],
    };
    assert_eq!(
        cell.boundary(&Task::default()).unwrap(),
        [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    );
    let sparse = Tetrahedra {
        cells: vec![[7, u32::MAX - 1, 1 << 31, u32::MAX]],
    };
    assert_eq!(sparse.boundary(&Task::default()).unwrap().len(), 4);
    assert_eq!(
        sparse.boundary(&Task::default()).unwrap()[3],
        [1 << 31, u32::MAX, u32::MAX - 1]
    );
    assert!(
        Tetrahedra::default()
            .boundary(&Task::default())
            .unwrap()
            .is_empty()
    );
}

#[test]
fn the_circumradius_may_equal_alpha() {
    let cube = block([2, 2, 2]);
    let oracle = Oracle {
        points: &cube,
        gram: CUBIC,
    };
    // The square root of 3/4 lies between two doubles: no rounding may blur that.
    let above = 0.75f64.sqrt().next_up();
    let whole = alpha_complex(oracle.lattice(), above, &Task::default()).unwrap();
    assert_eq!(whole, oracle.tetrahedra().unwrap());
    assert!((whole.volume_mm3(oracle.lattice()) - 1.0).abs() < 1e-15);
    let below = 0.75f64.sqrt();
    let none = alpha_complex(oracle.lattice(), below, &Task::default()).unwrap();
    assert!(none.cells.is_empty() && none.boundary(&Task::default()).unwrap().is_empty());
}

#[test]
fn a_circumradius_of_exactly_alpha_is_kept_with_all_its_cospherical_cells() {
    // Boxes of 2 x 2 x 1 mm have a circumradius of 1.5 mm; five or six cells each share it.
    let points = block([9, 8, 7]);
    let gram = [[4, 0, 0], [0, 4, 0], [0, 0, 1]];
    let oracle = Oracle {
        points: &points,
        gram,
    };
    let whole = oracle.tetrahedra().unwrap();
    let free: Vec<[f64; 3]> = points
        .iter()
        .map(|&[x, y, z]| [2.0 * f64::from(x), 2.0 * f64::from(y), f64::from(z)])
        .collect();
    for cloud in [oracle.lattice(), Points::Free(&free)] {
        let kept = alpha_complex(cloud, 1.5, &Task::default()).unwrap();
        assert_eq!(kept, whole);
        let none = alpha_complex(cloud, 1.5f64.next_down(), &Task::default()).unwrap();
        assert!(none.cells.is_empty());
    }
}
