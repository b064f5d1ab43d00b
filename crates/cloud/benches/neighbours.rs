//! Mean distance to 100 neighbours, on a lattice and of free points, and the extraction of points.

use bonemesh_cloud::{Frame, PointCloud, extract_points, mean_neighbour_distance};
use bonemesh_segment::EdgeMap;
use bonemesh_task::Task;
use bonemesh_volume::{Affine, Geometry};
use criterion::{Criterion, criterion_group, criterion_main};
use ndarray::Array3;
use std::hint::black_box;

/// Two skins of an ellipsoid, one pixel thick, in slices twice as thick as pixels are wide.
fn skins() -> EdgeMap {
    let is_edge = |(k, j, i): (usize, usize, usize)| {
        let square = |at: usize, middle: f64, half: f64| ((at as f64 - middle) / half).powi(2);
        let distance = |half: f64| {
            let sum = square(i, 128.0, half) + square(j, 128.0, half) + square(k, 40.0, half / 3.0);
            (sum.sqrt() - 1.0) * half
        };
        distance(120.0).abs() < 0.5 || distance(108.0).abs() < 0.5
    };
    let shape = [80, 256, 256];
    let affine = Affine::from_axes([0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
    EdgeMap {
        edges: Array3::from_shape_fn(shape, is_edge),
        geometry: Geometry::new(shape, affine).expect("the grid is sound"),
    }
}

fn bench(c: &mut Criterion) {
    let task = Task::default();
    let edges = skins();
    let lattice = extract_points(&edges, Frame::Patient, &task).expect("nobody cancels");
    let free = PointCloud::from_points(lattice.points_mm().to_vec()).expect("points are finite");
    let mut group = c.benchmark_group("cloud");
    group.sample_size(10);
    group.bench_function("points of two skins", |b| {
        b.iter(|| extract_points(black_box(&edges), Frame::Patient, &task));
    });
    for (name, cloud) in [("lattice", &lattice), ("free points", &free)] {
        group.bench_function(format!("100 neighbours, {name}"), |b| {
            b.iter(|| mean_neighbour_distance(black_box(cloud), 100, true, &task));
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
