//! From the tetrahedra of a bone-like shell to its surface.

use bonemesh_cloud::{Lattice, PointCloud};
use bonemesh_surface::{alpha_boundary, boundary_surface};
use bonemesh_task::Task;
use bonemesh_volume::Affine;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

const ALPHA_MM: f64 = 3.0;

/// The skin of a ball of 40 mm radius on pixels of 0.5 mm and slices of 1.5 mm.
fn shell() -> PointCloud {
    let mut coordinates = Vec::new();
    for k in -28..=28_i32 {
        for j in -82..=82_i32 {
            for i in -82..=82_i32 {
                let r2 = i * i + j * j + 9 * k * k;
                if (80 * 80..81 * 81).contains(&r2) {
                    coordinates.push([i, j, k]);
                }
            }
        }
    }
    let axes = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 1.5]];
    PointCloud::from_lattice(Lattice {
        coordinates,
        frame_from_lattice: Affine::from_axes(axes[0], axes[1], axes[2], [0.0; 3]),
    })
    .expect("coordinates are finite")
}

fn bench(c: &mut Criterion) {
    let task = Task::default();
    let cloud = shell();
    let boundary = alpha_boundary(&cloud, ALPHA_MM, &task).expect("a shell has cells");
    c.bench_function("surface of a lattice shell", |b| {
        b.iter(|| boundary_surface(black_box(&cloud), boundary.clone(), &task));
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
