//! The published text written out literally, without any search structure, against the fast steps.

#![allow(
    clippy::float_cmp,
    reason = "levels and lattice coordinates are equal to the bit"
)]

use bonemesh_mesh::TriangleMesh;
use bonemesh_task::Task;
use proptest::prelude::*;

use super::{Behind, Levels, find_behind_on};
use crate::selection::Selection;
use crate::{RoiError, ThicknessMm};

type Point = [f64; 3];

/// Why the text finds no direction.
#[derive(Debug, PartialEq)]
enum NoDirection {
    NoSecondPoint,
    ZeroProduct,
}

/// Distinct z of some points, ascending.
fn distinct_z(points: &[Point]) -> Vec<f64> {
    let mut z: Vec<f64> = points.iter().map(|p| p[2]).collect();
    z.sort_by(f64::total_cmp);
    z.dedup();
    z
}

/// The point of the largest coordinate, the first of equals.
fn largest(points: &[Point], axis: usize) -> Option<Point> {
    let mut best: Option<Point> = None;
    for &p in points {
        if best.is_none_or(|b| p[axis] > b[axis]) {
            best = Some(p);
        }
    }
    best
}

/// Step 1.
fn normal_of(f: &[Point], s: &[Point]) -> Result<Point, NoDirection> {
    let mut c = [0.0; 3];
    for axis in 0..3 {
        let offsets: f64 = s.iter().map(|p| p[axis] - s[0][axis]).sum();
        c[axis] = s[0][axis] + offsets / s.len() as f64;
    }
    let levels = distinct_z(s);
    let mut level = levels[0];
    for &z in &levels {
        if (z - c[2]).abs() < (level - c[2]).abs() {
            level = z;
        }
    }
    let on_level: Vec<Point> = s.iter().copied().filter(|p| p[2] == level).collect();
    let p = largest(&on_level, 1).unwrap();
    let axis = if levels.len() == 1 { 0 } else { 2 };
    let others: Vec<Point> = s
        .iter()
        .copied()
        .filter(|q| q[0] != p[0] || q[1] != p[1])
        .collect();
    let q = largest(&others, axis).ok_or(NoDirection::NoSecondPoint)?;
    let a = [p[0] - c[0], p[1] - c[1], p[2] - c[2]];
    let b = [q[0] - c[0], q[1] - c[1], q[2] - c[2]];
    let mut n = [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ];
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    let lengths = ((a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
        * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]))
        .sqrt();
    if length <= 1e-5 * lengths {
        return Err(NoDirection::ZeroProduct);
    }
    let mut along_c = 0.0;
    for axis in 0..3 {
        let centroid: f64 = f.iter().map(|v| v[axis]).sum::<f64>() / f.len() as f64;
        along_c += n[axis] * (c[axis] - centroid);
    }
    for component in &mut n {
        *component /= if along_c > 0.0 { -length } else { length };
    }
    Ok(n)
}

fn manhattan(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).abs() + (a[2] - b[2]).abs()
}

/// The first part of step 3: `(inner level, outer level)`.
fn level_pairs(f: &[Point], s: &[Point], zmax: f64) -> Vec<(f64, f64)> {
    let all = distinct_z(f);
    let own = distinct_z(s);
    if own.len() == 1 {
        let (low, high) = (own[0].min(zmax), own[0].max(zmax));
        return all
            .iter()
            .filter(|z| **z >= low && **z <= high)
            .map(|z| (*z, own[0]))
            .collect();
    }
    let not_above: Vec<f64> = own.iter().copied().filter(|z| *z <= zmax).collect();
    let highest = not_above.last().copied().unwrap_or(own[0]);
    let start = all.iter().position(|z| *z == highest).unwrap();
    let mut pairs = Vec::new();
    for m in 0..own.len() {
        if m <= start {
            pairs.push((all[start - m], own[own.len() - 1 - m]));
        }
    }
    pairs
}

/// Step 4 for one surround point.
fn is_covered(point: Point, outer: &[Point], n: Point, t: f64, step: f64) -> bool {
    let [x, y, z] = n.map(f64::abs);
    let (axis, group): (usize, Vec<Point>) = if x >= y && x >= z {
        (1, outer.to_vec())
    } else if y >= z {
        (0, outer.to_vec())
    } else {
        (
            1,
            outer.iter().copied().filter(|o| o[0] == point[0]).collect(),
        )
    };
    let projected = |o: Point| o[axis] + t * n[axis];
    let value = point[axis];
    match group[..] {
        [] => false,
        [only] => (value - projected(only)).abs() <= step,
        _ => group.iter().enumerate().any(|(own, &o)| {
            let mut others: Vec<(f64, usize)> = (0..group.len())
                .filter(|other| *other != own)
                .map(|other| {
                    let (dx, dy) = (group[other][0] - o[0], group[other][1] - o[1]);
                    (dx * dx + dy * dy, other)
                })
                .collect();
            others.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            others.iter().take(2).any(|(_, other)| {
                let (u, v) = (projected(o), projected(group[*other]));
                u.min(v) <= value && value <= u.max(v)
            })
        }),
    }
}

/// All four steps.
fn literally(f: &[Point], selected: &[u32], t: f64) -> Result<Behind, NoDirection> {
    let s: Vec<Point> = selected.iter().map(|&v| f[v as usize]).collect();
    let n = normal_of(f, &s)?;
    let own = distinct_z(&s);
    let zmax = own[own.len() - 1] + t * n[2];
    let pairs = level_pairs(f, &s, zmax);
    let mut steps: Vec<f64> = distinct_z(f).windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let step = if steps.is_empty() {
        0.0
    } else {
        steps[(steps.len() - 1) / 2]
    };
    let mut kept = Vec::new();
    for (v, &point) in f.iter().enumerate() {
        if selected.contains(&(v as u32)) || point[2] > zmax {
            continue;
        }
        let in_surround = s.iter().any(|&s| {
            let projected = [s[0] + t * n[0], s[1] + t * n[1], s[2] + t * n[2]];
            let inward = if own.len() == 1 {
                point[2] != s[2]
            } else {
                manhattan(point, projected) < manhattan(point, s)
            };
            manhattan(point, s) <= t && inward
        });
        let pair = pairs.iter().find(|(inner, _)| *inner == point[2]);
        if let (true, Some((_, outer_z))) = (in_surround, pair) {
            let outer: Vec<Point> = s.iter().copied().filter(|s| s[2] == *outer_z).collect();
            if is_covered(point, &outer, n, t, step) {
                kept.push(v as u32);
            }
        }
    }
    Ok(Behind { kept, normal: n })
}

/// The fast steps.
fn fast(f: &[Point], selected: &[u32], t: f64) -> Result<Behind, RoiError> {
    let mesh = TriangleMesh::new(f.to_vec(), vec![]).unwrap();
    let selection = Selection::new(selected, f.len())?;
    let levels = Levels::of(f.iter().map(|p| p[2]));
    find_behind_on(
        &mesh,
        &levels,
        &selection,
        ThicknessMm::new(t)?,
        &Task::default(),
    )
}

/// Both, which must agree; what they found.
fn agreed(f: &[Point], selected: &[u32], t: f64) -> Option<Behind> {
    let mut distinct = selected.to_vec();
    distinct.sort_unstable();
    distinct.dedup();
    match (literally(f, &distinct, t), fast(f, selected, t)) {
        (Ok(expected), Ok(found)) => {
            assert_eq!(found, expected);
            Some(found)
        }
        (Err(NoDirection::NoSecondPoint), Err(RoiError::NoSecondPoint { .. }))
        | (Err(NoDirection::ZeroProduct), Err(RoiError::NoNormal { .. })) => None,
        (expected, found) => panic!("{expected:?} but {found:?}"),
    }
}

/// A block of lattice points with pixels of `pixel` and slices of `slice` mm, far from the origin.
fn block(size: [u32; 3], pixel: f64, slice: f64) -> Vec<Point> {
    let mut points = Vec::new();
    for k in 0..size[2] {
        for j in 0..size[1] {
            for i in 0..size[0] {
                let [i, j, k] = [i, j, k].map(f64::from);
                points.push([i * pixel - 40.0, j * pixel - 100.0, k * slice + 700.0]);
            }
        }
    }
    points
}

/// The vertices on the outermost layer of a block across `axis`, at its high or low end.
fn face(points: &[Point], axis: usize, high: bool) -> Vec<u32> {
    let sign = if high { 1.0 } else { -1.0 };
    let end = points
        .iter()
        .map(|p| sign * p[axis])
        .fold(f64::MIN, f64::max);
    (0..)
        .zip(points)
        .filter(|(_, p)| sign * p[axis] == end)
        .map(|(v, _)| v)
        .collect()
}

#[test]
fn each_side_of_a_block_has_the_bone_behind_it() {
    let points = block([9, 9, 9], 0.5, 0.5);
    // Sideways: of the four layers within the thickness, the two nearer to the projection.
    for axis in [0, 1] {
        for high in [false, true] {
            let behind = agreed(&points, &face(&points, axis, high), 2.0).unwrap();
            let expected = if high { -1.0 } else { 1.0 };
            assert!((behind.normal[axis] - expected).abs() < 1e-12);
            assert_eq!(behind.kept.len(), 2 * 81, "{axis} {high}");
        }
    }
    // On one level a rectangle has no normal: the corners of largest y and x are opposite.
    let whole = face(&points, 2, false);
    assert_eq!(agreed(&points, &whole, 2.0), None);
    // From below, the slices up to the projection; from above, only what is not above it. The
    // selection lacks one corner, so the column of that corner is covered one point less far.
    let cut = |high| {
        let mut selected = face(&points, 2, high);
        selected.retain(|&v| points[v as usize][..2] != [-40.0, -96.0]);
        selected
    };
    let from_below = agreed(&points, &cut(false), 2.0).unwrap();
    assert_eq!(from_below.kept.len(), 4 * 80);
    let from_above = agreed(&points, &cut(true), 2.0).unwrap();
    assert_eq!(from_above.kept.len(), 80);
}

#[test]
fn a_slanted_patch_of_several_levels_has_points_behind_it() {
    // A staircase on top of the block: mostly upward, on six levels.
    let points = block([12, 8, 12], 0.5, 0.5);
    let selected: Vec<u32> = (0..)
        .zip(&points)
        .filter(|(_, p)| {
            let [i, _, k] = [p[0] + 40.0, 0.0, p[2] - 700.0].map(|c| (c / 0.5).round() as i32);
            k == 11 - i / 2
        })
        .map(|(v, _)| v)
        .collect();
    let behind = agreed(&points, &selected, 1.5).unwrap();
    let [x, y, z] = behind.normal.map(f64::abs);
    assert!(z > x && z > y, "{:?}", behind.normal);
    assert!(!behind.kept.is_empty());
}

#[test]
fn the_kept_points_do_not_depend_on_threads_or_the_order_of_the_selection() {
    let points = block([30, 20, 15], 0.4492, 1.5);
    let mut selected = face(&points, 1, true);
    let expected = agreed(&points, &selected, 5.0).unwrap();
    selected.reverse();
    selected.push(selected[3]);
    for threads in [1, 2, 5] {
        let pool = bonemesh_task::pool(std::num::NonZeroUsize::new(threads)).unwrap();
        let found = pool.install(|| fast(&points, &selected, 5.0)).unwrap();
        assert_eq!(found, expected);
    }
}

#[test]
fn a_tiny_and_a_huge_thickness_are_only_that() {
    let points = block([6, 5, 4], 0.4492, 1.5);
    let selected = face(&points, 0, false);
    assert!(agreed(&points, &selected, 1e-300).unwrap().kept.is_empty());
    agreed(&points, &selected, 1e9).unwrap();
    agreed(&points, &selected, f64::MAX).unwrap();
}

/// Coordinates of points as they come: lattices of any step, rounded as in files, or jittered in the
/// slice; some missing.
fn arb_points() -> impl Strategy<Value = Vec<Point>> {
    let size = [2_u32..8, 2_u32..8, 1_u32..7];
    let steps = prop::sample::select(vec![(1.0, 1.0), (0.5, 1.0), (0.4492, 5.015), (0.352, 2.5)]);
    let kind = prop::sample::select(vec!["exact", "file", "jitter"]);
    (size, steps, kind).prop_flat_map(|(size, (pixel, slice), kind)| {
        let whole = block(size, pixel, slice);
        let noise = prop::collection::vec(-0.4..0.4_f64, 2 * whole.len());
        let missing = prop::collection::vec(prop::bool::weighted(0.25), whole.len());
        (Just(whole), noise, missing).prop_map(move |(whole, noise, missing)| {
            let kept = whole.iter().zip(noise.chunks(2)).zip(missing);
            kept.filter(|(_, missing)| !missing)
                .map(|((&[x, y, z], noise), _)| match kind {
                    "exact" => [x, y, z],
                    "file" => [x, y, z].map(|c| f64::from(c as f32)),
                    _ => [x + pixel * noise[0], y + pixel * noise[1], z],
                })
                .collect()
        })
    })
}

/// How a selection is made: at random, or from the points farthest along a direction.
#[derive(Clone, Debug)]
enum Pick {
    Random(Vec<bool>),
    Farthest { direction: Point, part: f64 },
}

impl Pick {
    fn of(&self, points: &[Point]) -> Vec<u32> {
        match self {
            Self::Random(flags) => (0..)
                .zip(points)
                .zip(flags.iter().cycle())
                .filter(|(_, picked)| **picked)
                .map(|((v, _), _)| v)
                .collect(),
            Self::Farthest { direction, part } => {
                let along = |p: &Point| p.iter().zip(direction).map(|(c, d)| c * d).sum::<f64>();
                let mut order: Vec<u32> = (0..points.len() as u32).collect();
                order.sort_by(|a, b| {
                    along(&points[*b as usize]).total_cmp(&along(&points[*a as usize]))
                });
                order.truncate((part * points.len() as f64).ceil() as usize);
                order
            }
        }
    }
}

fn arb_pick() -> impl Strategy<Value = Pick> {
    let direction = prop::sample::select(vec![
        [1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [0.3, 0.1, 1.0],
        [0.2, 0.1, -0.9],
        [1.0, 1.0, 0.0],
        [-1.0, 0.4, 0.3],
    ]);
    prop_oneof![
        prop::collection::vec(prop::bool::weighted(0.2), 1..60).prop_map(Pick::Random),
        (direction, 0.02..0.4).prop_map(|(direction, part)| Pick::Farthest { direction, part }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn the_fast_steps_keep_what_the_text_keeps(
        points in arb_points(),
        pick in arb_pick(),
        thickness in prop_oneof![prop::sample::select(vec![0.5, 1.0, 2.5, 5.015]), 0.1..12.0],
    ) {
        let selected = pick.of(&points);
        prop_assume!(selected.len() > 1);
        agreed(&points, &selected, thickness);
    }
}
