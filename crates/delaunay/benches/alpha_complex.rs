//! Alpha complexes and whole triangulations of lattice shells and of random points.

use bonemesh_delaunay::{Points, alpha_complex, tetrahedralize};
use bonemesh_task::Task;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// The skin of an ellipsoid on a lattice of slices three times as thick as its pixels are wide:
/// a bone's edge map in small.
fn shell() -> Vec<[i32; 3]> {
    let mut points = Vec::new();
    for z in 0..60i32 {
        for y in 0..180i32 {
            for x in 0..180i32 {
                let [dx, dy, dz] = [x - 90, y - 90, 3 * (z - 30)];
                let r2 = dx * dx + dy * dy + dz * dz;
                if (85 * 85..87 * 87).contains(&r2) || (70 * 70..71 * 71).contains(&r2) {
                    points.push([x, y, z]);
                }
            }
        }
    }
    points
}

/// Points of a unit cube without any pattern (a splitmix64 sequence).
fn random(count: usize) -> Vec<[f64; 3]> {
    let mut state = 0u64;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count).map(|_| [next(), next(), next()]).collect()
}

fn bench(c: &mut Criterion) {
    let task = Task::default();
    let (lattice, free) = (shell(), random(50_000));
    let gram = [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 1.8]];
    let coordinates = &lattice[..];
    let shell = Points::Lattice { coordinates, gram };
    let cells = alpha_complex(shell, 3.0, &task).expect("a shell has cells");
    let mut group = c.benchmark_group("delaunay");
    group.sample_size(10);
    group.bench_function("alpha complex of a lattice shell", |b| {
        b.iter(|| alpha_complex(black_box(shell), 3.0, &task));
    });
    group.bench_function("whole lattice shell", |b| {
        b.iter(|| tetrahedralize(black_box(shell), &task));
    });
    group.bench_function("boundary of the shell's alpha complex", |b| {
        b.iter(|| {
            black_box(&cells)
                .boundary(&Task::default())
                .expect("nobody cancels")
        });
    });
    group.bench_function("50,000 random points", |b| {
        b.iter(|| tetrahedralize(black_box(Points::Free(&free)), &task));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
