//! Writing a mesh to a file.

use bonemesh_mesh::{TriangleMesh, write_mesh};
use bonemesh_task::Task;
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// A wavy sheet of half a million triangles.
fn sheet() -> TriangleMesh {
    const SIDE: u32 = 500;
    let place = |at: u32| {
        let (x, y) = (f64::from(at % SIDE), f64::from(at / SIDE));
        [x, y, 20.0 * (x * 0.05).sin() * (y * 0.03).cos()]
    };
    let corners = |at: u32| {
        let (right, below) = (at + 1, at + SIDE);
        [[at, right, below], [right, below + 1, below]]
    };
    let inner = (0..SIDE * (SIDE - 1)).filter(|at| at % SIDE + 1 < SIDE);
    let vertices = (0..SIDE * SIDE).map(place).collect();
    TriangleMesh::new(vertices, inner.flat_map(corners).collect()).expect("the sheet is sound")
}

fn bench(c: &mut Criterion) {
    let task = Task::default();
    let mesh = sheet();
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let mut group = c.benchmark_group("write");
    group.sample_size(10);
    for format in ["stl", "ply"] {
        let path = folder.path().join(format!("sheet.{format}"));
        group.bench_function(format, |b| {
            b.iter(|| write_mesh(&path, black_box(&mesh), &task));
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
