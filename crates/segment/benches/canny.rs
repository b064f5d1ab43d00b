//! Canny's edges of the slices of a head, and of one grey image.

use bonemesh_phantom::{Phantom, scan};
use bonemesh_segment::{CannySettings, HuThreshold, Mask, canny, detect_edges, threshold};
use bonemesh_task::Task;
use criterion::{Criterion, criterion_group, criterion_main};
use ndarray::Axis;
use std::hint::black_box;

/// The bone of the demonstration head.
fn head(task: &Task) -> Mask {
    let phantom = Phantom::Head;
    let volume = scan(phantom, &phantom.settings(), task).expect("the phantom is sound");
    let bone = HuThreshold::new(350.0).expect("350 is a number");
    threshold(&volume, bone, task).expect("a head has bone")
}

fn bench(c: &mut Criterion) {
    let task = Task::default();
    let mask = head(&task);
    let settings = CannySettings::default();
    let middle = mask.voxels.len_of(Axis(0)) / 2;
    let grey = mask.voxels.index_axis(Axis(0), middle);
    let grey = grey.mapv(|bone| f64::from(u8::from(bone)));
    let mut group = c.benchmark_group("canny");
    group.sample_size(10);
    group.bench_function("every slice of a head", |b| {
        b.iter(|| detect_edges(black_box(&mask), settings, &task));
    });
    group.bench_function("one grey image", |b| {
        b.iter(|| canny(black_box(grey.view()), settings));
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
