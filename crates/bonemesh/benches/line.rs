//! The steps that need files, and the whole line, on the phantom head at half its resolution.

use bonemesh::{Phantom, Settings, Source, Task, render_volume, scan_phantom, write_phantom};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn bench(c: &mut Criterion) {
    let task = Task::default();
    let settings = Phantom::Head.settings().coarser(2.0);
    let volume = scan_phantom(Phantom::Head, &settings, &task).expect("the settings are sound");
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let head = folder.path().join("head");
    let series = write_phantom(Phantom::Head, &head, &settings, &task)
        .expect("the folder is new")
        .series;

    let mut group = c.benchmark_group("phantom head");
    group.sample_size(10);
    group.bench_function("find the series", |b| {
        b.iter(|| Source::open(black_box(&series), false, &task));
    });
    let source = Source::open(&series, false, &task).expect("the series was just written");
    group.bench_function("read the volume", |b| {
        b.iter(|| black_box(&source).read(None, &task));
    });
    group.bench_function("volume to surface", |b| {
        b.iter(|| render_volume(black_box(&volume), &Settings::default(), &task));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
