//! Thresholds, local thresholds and components of a head of 37 million voxels.

use std::hint::black_box;
use std::num::NonZeroU16;

use bonemesh_phantom::{Phantom, scan};
use bonemesh_segment::{
    Connectivity, HuThreshold, LocalThreshold, connected_components, largest_component,
    local_threshold, suggest_thresholds, threshold,
};
use bonemesh_task::Task;
use bonemesh_volume::Histogram;
use criterion::{Criterion, criterion_group, criterion_main};

fn bench(c: &mut Criterion) {
    let task = Task::default();
    let settings = Phantom::Head.settings().coarser(0.74);
    let volume = scan(Phantom::Head, &settings, &task).expect("the phantom is sound");
    let bone = HuThreshold::new(350.0).expect("350 is a number");
    let mask = threshold(&volume, bone, &task).expect("a head has bone");
    // Noise around soft tissue's own value: the hardest mask there is.
    let soft = HuThreshold::new(40.0).expect("40 is a number");
    let noise = threshold(&volume, soft, &task).expect("a head has soft tissue");
    let histogram = Histogram::of(&volume, NonZeroU16::MIN, &task).expect("nobody cancels");
    let mut group = c.benchmark_group("thresholds");
    group.sample_size(10);
    group.bench_function("histogram", |b| {
        b.iter(|| Histogram::of(black_box(&volume), NonZeroU16::MIN, &task));
    });
    group.bench_function("suggestions", |b| {
        b.iter(|| suggest_thresholds(black_box(&volume), &histogram, &task));
    });
    group.bench_function("local threshold", |b| {
        b.iter(|| local_threshold(black_box(&volume), LocalThreshold::around(bone), &task));
    });
    group.bench_function("largest component of bone", |b| {
        b.iter(|| largest_component(black_box(&mask), Connectivity::Corners, &task));
    });
    group.bench_function("components of noise", |b| {
        b.iter(|| connected_components(black_box(&noise), Connectivity::Faces, &task));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
