//! What the crate promises of every triangulation, checked against plain exact arithmetic.

mod common;

use bonemesh_delaunay::{
    AlphaBoundary, DelaunayError, Points, Tetrahedra, alpha_boundary, alpha_complex, tetrahedralize,
};
use bonemesh_task::{Task, pool};
use common::{CUBIC, Oracle, SLICES, as_f64, block, cospherical, named, nasty};
use proptest::prelude::*;

/// A tilted, uneven metric.
const TILTED: [[i64; 3]; 3] = [[4, 1, 0], [1, 5, -2], [0, -2, 9]];

fn is_flat(error: &DelaunayError) -> bool {
    matches!(
        error,
        DelaunayError::TooFew { .. }
            | DelaunayError::Collinear { .. }
            | DelaunayError::Coplanar { .. }
    )
}

/// A permutation that depends on `seed`.
fn shuffled<T: Copy>(points: &[T], seed: u64) -> Vec<T> {
    let mut keyed: Vec<(u64, T)> = points
        .iter()
        .enumerate()
        .map(|(i, &p)| {
            (
                (i as u64 + 1)
                    .wrapping_mul(seed | 1)
                    .rotate_left(23)
                    .wrapping_mul(seed | 1),
                p,
            )
        })
        .collect();
    keyed.sort_by_key(|(k, _)| *k);
    keyed.into_iter().map(|(_, p)| p).collect()
}

/// The points of a sphere shell of lattice points: what an edge map of a skull looks like.
fn shell(radius: i32, flatness: i32) -> Vec<[i32; 3]> {
    let side = 2 * radius + 1;
    let mut points = block([side, side, side / flatness]);
    points.retain(|p| {
        let [x, y, z] = [p[0] - radius, p[1] - radius, p[2] * flatness - radius];
        let r2 = x * x + y * y + z * z;
        (radius - 1) * (radius - 1) <= r2 && r2 <= radius * radius
    });
    points
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn spheres_are_empty_and_cells_fill_the_hull(
        points in nasty(),
        gram in prop::sample::select(vec![CUBIC, SLICES, TILTED]),
    ) {
        let oracle = Oracle { points: &points, gram };
        match oracle.tetrahedra() {
            Ok(cells) => oracle.assert_delaunay(&cells),
            Err(error) => prop_assert!(is_flat(&error), "{error}"),
        }
    }

    #[test]
    fn shuffling_the_input_renames_vertices_only(points in nasty(), seed in any::<u64>()) {
        let mixed = shuffled(&points, seed);
        let (one, other) = (
            Oracle { points: &points, gram: SLICES }.tetrahedra(),
            Oracle { points: &mixed, gram: SLICES }.tetrahedra(),
        );
        if let (Ok(one), Ok(other)) = (&one, &other) {
            prop_assert_eq!(named(one, &points), named(other, &mixed));
        } else {
            prop_assert!(is_flat(&one.unwrap_err()) && is_flat(&other.unwrap_err()));
        }
    }

    #[test]
    fn free_points_and_their_lattice_give_the_same_cells(points in nasty()) {
        let free = as_f64(&points);
        let task = Task::default();
        let lattice = Oracle { points: &points, gram: CUBIC }.tetrahedra();
        match (lattice, tetrahedralize(Points::Free(&free), &task)) {
            (Ok(lattice), Ok(free)) => prop_assert_eq!(lattice, free),
            (Err(a), Err(b)) => prop_assert_eq!(a, b),
            (a, b) => prop_assert!(false, "{:?} but {:?}", a, b),
        }
    }

    #[test]
    fn in_general_position_the_cells_are_all_those_with_empty_spheres(
        points in prop::collection::vec(prop::array::uniform3(-1000..1000i32), 5..14),
    ) {
        let oracle = Oracle { points: &points, gram: TILTED };
        let n = points.len() as u32;
        let mut expected = Vec::new();
        for a in 0..n { for b in a + 1..n { for c in b + 1..n { for d in c + 1..n {
            let mut cell = [a, b, c, d];
            let volume = oracle.orientation(cell);
            prop_assume!(volume != 0);
            if volume < 0 { cell.swap(0, 1); }
            let others = (0..n).filter(|v| !cell.contains(v));
            let sides: Vec<i128> = others.map(|v| oracle.in_sphere(cell, v)).collect();
            prop_assume!(!sides.contains(&0));
            if sides.iter().all(|&s| s < 0) { expected.push([a, b, c, d]); }
        }}}}
        let mut found = oracle.tetrahedra().unwrap().cells;
        for cell in &mut found { cell.sort_unstable(); }
        found.sort_unstable();
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn a_far_lattice_is_as_exact_as_a_near_one(
        points in prop::collection::vec(prop::array::uniform3(-16_383..16_384i32), 4..40),
        corners in prop::collection::vec(prop::array::uniform3(0..2i32), 8..9),
    ) {
        // Besides random points a set of cospherical ones that is as large as can be.
        let mut points = points;
        points.extend(corners.into_iter().map(|c| c.map(|v| v * 32_766 - 16_383)));
        let oracle = Oracle { points: &points, gram: TILTED };
        oracle.assert_delaunay(&oracle.tetrahedra().unwrap());
    }

    #[test]
    fn alpha_keeps_the_cells_of_small_circumradius(points in nasty(), alpha in 0.5..6.0f64) {
        let free = as_f64(&points);
        let task = Task::default();
        if let Ok(all) = tetrahedralize(Points::Free(&free), &task) {
            let kept = alpha_complex(Points::Free(&free), alpha, &task).unwrap();
            let expected: Vec<[u32; 4]> = all.cells.iter().copied()
                .filter(|&c| circumradius(c.map(|v| free[v as usize])) <= alpha)
                .collect();
            let close = all.cells.iter()
                .any(|&c| (circumradius(c.map(|v| free[v as usize])) - alpha).abs() < 1e-9);
            prop_assume!(!close);
            prop_assert_eq!(kept.cells, expected);
            let open = alpha_complex(Points::Free(&free), f64::INFINITY, &task).unwrap();
            prop_assert_eq!(open, all);
        }
    }

    #[test]
    fn the_boundary_of_any_alpha_complex_is_closed(points in nasty(), alpha in 0.5..6.0f64) {
        let oracle = Oracle { points: &points, gram: SLICES };
        if let Ok(cells) = alpha_complex(oracle.lattice(), alpha, &Task::default()) {
            let boundary = cells.boundary(&Task::default()).unwrap();
            let direct = alpha_boundary(oracle.lattice(), alpha, &Task::default()).unwrap();
            prop_assert_eq!(&direct.triangles, &boundary);
            prop_assert_eq!(direct.tetrahedra, cells.cells.len());
            let volume = cells.volume_mm3(oracle.lattice());
            prop_assert!((direct.volume_mm3(oracle.lattice()) - volume).abs() < 1e-9);
            let mut balance = std::collections::HashMap::new();
            for [a, b, c] in &boundary {
                for (u, v) in [(a, b), (b, c), (c, a)] {
                    *balance.entry((u.min(v), u.max(v))).or_insert(0) += if u < v { 1 } else { -1 };
                }
            }
            prop_assert!(balance.values().all(|&b| b == 0));
        }
    }
}

/// The textbook formula with lengths of edges: the radius from volume and opposite products.
fn circumradius([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    let sub = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let length = |v: [f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    let pairs = [[(a, b), (c, d)], [(a, c), (b, d)], [(a, d), (b, c)]];
    let p = pairs.map(|pair| pair.map(|(p, q)| length(sub(p, q))).iter().product::<f64>());
    let (u, v, w) = (sub(b, a), sub(c, a), sub(d, a));
    let six_volumes = u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
        + u[2] * (v[0] * w[1] - v[1] * w[0]);
    let s: f64 = p.iter().sum::<f64>() / 2.0;
    (s * (s - p[0]) * (s - p[1]) * (s - p[2])).max(0.0).sqrt() / six_volumes.abs()
}

#[test]
fn blocks_shells_and_spheres_are_delaunay() {
    for gram in [CUBIC, SLICES, TILTED] {
        for points in [block([6, 5, 4]), shell(6, 1), shell(8, 3), cospherical()] {
            let oracle = Oracle {
                points: &points,
                gram,
            };
            oracle.assert_delaunay(&oracle.tetrahedra().unwrap());
        }
    }
}

#[test]
fn two_skew_lines_make_a_cell_of_every_pair_of_steps() {
    let n = 60;
    let points: Vec<[i32; 3]> = (0..n)
        .map(|i| [i, 0, 0])
        .chain((0..n).map(|i| [n / 2, i - n / 2, 9]))
        .collect();
    let oracle = Oracle {
        points: &points,
        gram: CUBIC,
    };
    let cells = oracle.tetrahedra().unwrap();
    oracle.assert_delaunay(&cells);
    assert_eq!(cells.cells.len(), ((n - 1) * (n - 1)) as usize);
}

#[test]
fn a_rim_of_hundreds_of_facets_is_closed() {
    // A ring around an axis: a point on the axis that comes after a hundred of the ring has a
    // cavity with a cell for each of them, whatever the order of the others.
    let mut points: Vec<[i32; 3]> = Vec::new();
    for i in 0..400 {
        let angle = f64::from(i) / 400.0 * std::f64::consts::TAU;
        points.push([
            (angle.cos() * 9000.0) as i32,
            (angle.sin() * 9000.0) as i32,
            0,
        ]);
    }
    points.extend([[0, 0, 5000], [0, 0, -5000], [0, 0, 10]]);
    let oracle = Oracle {
        points: &points,
        gram: CUBIC,
    };
    oracle.assert_delaunay(&oracle.tetrahedra().unwrap());
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    // A long tube wall: enough points for several slabs and, without alpha, several pieces.
    let mut points = block([41, 41, 700]);
    points.retain(|p| (225..=400).contains(&((p[0] - 20).pow(2) + (p[1] - 20).pow(2))));
    let gram = [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.3]];
    let lattice = Points::Lattice {
        coordinates: &points,
        gram,
    };
    let workers = |n| pool(std::num::NonZeroUsize::new(n)).unwrap();
    let runs: Vec<(Tetrahedra, AlphaBoundary)> = [1, 2, 3, 8]
        .into_iter()
        .map(|n| {
            workers(n).install(|| {
                let whole = tetrahedralize(lattice, &Task::default()).unwrap();
                let boundary = alpha_boundary(lattice, 1.5, &Task::default()).unwrap();
                (whole, boundary)
            })
        })
        .collect();
    assert!(runs.iter().all(|run| *run == runs[0]));
    let (whole, boundary) = &runs[0];
    let kept = alpha_complex(lattice, 1.5, &Task::default()).unwrap();
    assert!(kept.cells.len() > points.len() && kept.cells.len() < whole.cells.len());
    assert_eq!(boundary.triangles, kept.boundary(&Task::default()).unwrap());
    let mut of_whole = whole.cells.iter();
    let is_of_whole = |cell| of_whole.by_ref().any(|other| other == cell);
    assert!(
        kept.cells.iter().all(is_of_whole),
        "the same cells in the same order"
    );
}

#[test]
fn a_sphere_shell_has_an_outer_and_an_inner_wall() {
    // Alpha above the lattice's cell and below the cavity's radius keeps the shell alone.
    let mut points = block([25, 25, 25]);
    points.retain(|p| (64..=144).contains(&p.iter().map(|v| (v - 12) * (v - 12)).sum::<i32>()));
    let oracle = Oracle {
        points: &points,
        gram: CUBIC,
    };
    let cells = alpha_complex(oracle.lattice(), 2.0, &Task::default()).unwrap();
    let volume = cells.volume_mm3(oracle.lattice());
    let boundary = cells.boundary(&Task::default()).unwrap();
    let mut wall: Vec<usize> = (0..points.len()).collect();
    let mut changed = true;
    while changed {
        changed = false;
        for triangle in &boundary {
            let least = triangle.iter().map(|&v| wall[v as usize]).min().unwrap();
            for &v in triangle {
                changed |= wall[v as usize] != least;
                wall[v as usize] = least;
            }
        }
    }
    let mut walls: Vec<usize> = boundary.iter().map(|t| wall[t[0] as usize]).collect();
    walls.sort_unstable();
    walls.dedup();
    assert_eq!(walls.len(), 2);
    let enclosed: i128 = boundary.iter().map(|&t| oracle.cone(t)).sum();
    assert!((volume - enclosed as f64 / 6.0).abs() < 1e-9);
    let ball = |r: f64| 4.0 / 3.0 * std::f64::consts::PI * r * r * r;
    assert!(volume > ball(11.0) - ball(9.0) && volume < ball(12.0) - ball(8.0));
    let (free, task) = (as_f64(&points), Task::default());
    let again = alpha_complex(Points::Free(&free), 2.0, &task).unwrap();
    assert_eq!(again, cells);
    assert!((again.volume_mm3(Points::Free(&free)) - volume).abs() < 1e-9);
}
