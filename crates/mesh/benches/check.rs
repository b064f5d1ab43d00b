//! Looking at a closed mesh of a million triangles.

#[path = "../tests/shapes/mod.rs"]
mod shapes;

use bonemesh_mesh::{TriangleTree, check_topology, find_intersections, wall_thickness};
use bonemesh_task::Task;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn bench(c: &mut Criterion) {
    let task = Task::default();
    let mesh = shapes::torus(1000, 500);
    let tree = TriangleTree::new(&mesh, &task).expect("nothing cancels it");
    let mut group = c.benchmark_group("check");
    group.sample_size(10);
    group.bench_function("topology", |b| {
        b.iter(|| check_topology(black_box(&mesh), &task));
    });
    group.bench_function("tree", |b| {
        b.iter(|| {
            TriangleTree::new(black_box(&mesh), &task).map(|tree| tree.mesh().triangles().len())
        });
    });
    group.bench_function("intersections", |b| {
        b.iter(|| find_intersections(black_box(&tree), 100, &task));
    });
    group.bench_function("wall thickness", |b| {
        b.iter(|| wall_thickness(black_box(&tree), &task));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
