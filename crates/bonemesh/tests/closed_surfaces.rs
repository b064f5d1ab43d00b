//! The methods for use on whatever volume comes: a surface that can be printed, the same for any
//! number of threads, or one line that says what is wrong.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::num::NonZeroUsize;

use bonemesh::{
    Error, Method, Phantom, Rendered, Settings, Task, Volume, Voxels, render_volume, scan_phantom,
    write_mesh,
};
use bonemesh_volume::{Affine, Geometry};
use ndarray::Array3;

const METHODS: [Method; 2] = [Method::Isosurface, Method::Labelled];

fn rendered(volume: &Volume, method: Method) -> Result<Rendered, Error> {
    let settings = Settings {
        method,
        ..Settings::default()
    };
    render_volume(volume, &settings, &Task::default())
}

/// Voxels of 1 x 1 x 2 mm by column, row and slice of a shape that counts these.
fn volume([columns, rows, slices]: [usize; 3], hu: impl Fn([usize; 3]) -> f32) -> Volume {
    let hu = Array3::from_shape_fn((slices, rows, columns), |(k, j, i)| hu([i, j, k]));
    of_voxels(Voxels::I16(hu.mapv(|hu| hu as i16)))
}

fn of_voxels(voxels: Voxels) -> Volume {
    let shape = match &voxels {
        Voxels::I16(hu) => hu.dim(),
        Voxels::F32(hu) => hu.dim(),
    };
    let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0], [9.0; 3]);
    let geometry = Geometry::new([shape.0, shape.1, shape.2], affine).unwrap();
    Volume::new(voxels, geometry).unwrap()
}

/// A blurred ball in the middle of a shape, its radius 5 mm.
fn ball([columns, rows, slices]: [usize; 3]) -> impl Fn([usize; 3]) -> f32 {
    let from_middle = |at: usize, count: usize| at as f32 - count as f32 / 2.0;
    move |[i, j, k]| {
        let [x, y] = [from_middle(i, columns), from_middle(j, rows)];
        let z = 2.0 * from_middle(k, slices);
        let away = (x * x + y * y + z * z).sqrt();
        (640.0 - 300.0 * (away - 5.0)).clamp(40.0, 1240.0)
    }
}

fn assert_printable(name: &str, volume: &Volume) {
    for method in METHODS {
        let mesh = rendered(volume, method).unwrap().mesh;
        let report = bonemesh::check(&mesh, None, &Task::default()).unwrap();
        assert!(report.printable, "{name}, {}: {report:?}", method.name());
        assert!(report.topology.volume_mm3 > 0.0, "{name}");
    }
}

/// Flat, narrow and small ones among them.
const SHAPES: [[usize; 3]; 12] = [
    [2, 2, 2],
    [3, 3, 3],
    [1, 20, 20],
    [20, 1, 20],
    [20, 20, 1],
    [1, 1, 20],
    [1, 20, 1],
    [20, 1, 1],
    [2, 20, 20],
    [20, 20, 2],
    [64, 64, 2],
    [64, 64, 12],
];

#[test]
fn volumes_of_any_shape_give_printable_surfaces() {
    for shape in SHAPES {
        let half = |[i, j, k]: [usize; 3]| if i + j + k > 1 { 1000.0 } else { 40.0 };
        assert_printable(&format!("half of {shape:?}"), &volume(shape, half));
        if shape.iter().product::<usize>() > 50 || shape.contains(&20) {
            assert_printable(&format!("ball in {shape:?}"), &volume(shape, ball(shape)));
        }
    }
}

/// What both methods say, which must be the same words.
fn refusal(volume: &Volume) -> String {
    let [isosurface, labelled] = METHODS.map(|m| rendered(volume, m).unwrap_err().to_string());
    assert_eq!(isosurface, labelled);
    isosurface
}

#[test]
fn constant_volumes_are_refused_with_their_range() {
    for shape in [[1, 1, 1]].into_iter().chain(SHAPES) {
        let all_bone = refusal(&volume(shape, |_| 1000.0));
        assert!(
            all_bone.contains("everything") && all_bone.contains("1000"),
            "{all_bone}"
        );
        for hu in [40.0, 350.0, -1000.0] {
            let nothing = refusal(&volume(shape, |_| hu));
            assert!(
                nothing.contains("nothing") && nothing.contains(&hu.to_string()),
                "{nothing}"
            );
        }
    }
}

#[test]
fn values_beyond_all_measure_break_nothing() {
    let shape = [20, 20, 10];
    let hu = ball(shape);
    for value in [1e5, 1e10, 1e30, f32::MAX, f32::INFINITY, f32::NAN] {
        for value in [value, -value] {
            let voxel = |(k, j, i): (usize, usize, usize)| {
                let is_odd = i == 2 || [i, j, k] == [10, 10, 5];
                if is_odd { value } else { hu([i, j, k]) }
            };
            let voxels = Array3::from_shape_fn((10, 20, 20), voxel);
            assert_printable(&format!("{value} HU"), &of_voxels(Voxels::F32(voxels)));
            let all = Array3::from_elem((10, 20, 20), value);
            let said = refusal(&of_voxels(Voxels::F32(all)));
            let word = if value > 0.0 { "everything" } else { "nothing" };
            assert!(said.contains(word), "{said}");
        }
    }
}

fn written(volume: &Volume, method: Method, threads: usize) -> Vec<u8> {
    let settings = Settings {
        method,
        threads: NonZeroUsize::new(threads),
        ..Settings::default()
    };
    let mesh = render_volume(volume, &settings, &Task::default())
        .unwrap()
        .mesh;
    let folder = tempfile::tempdir().unwrap();
    let stl = folder.path().join("bone.stl");
    write_mesh(&stl, &mesh, &Task::default()).unwrap();
    fs::read(stl).unwrap()
}

/// A phantom in slices of 5 mm.
fn in_thick_slices(phantom: Phantom) -> Volume {
    let scan = phantom.settings().with_voxels(1.5, 5.0);
    scan_phantom(phantom, &scan, &Task::default()).unwrap()
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let volume = in_thick_slices(Phantom::Head);
    for method in METHODS {
        let one = written(&volume, method, 1);
        for threads in [2, 5] {
            let is_same = written(&volume, method, threads) == one;
            assert!(is_same, "{}, {threads} threads", method.name());
        }
    }
}

#[test]
fn slices_of_five_mm_give_printable_surfaces() {
    for phantom in [
        Phantom::Head,
        Phantom::Femur,
        Phantom::SphereShell,
        Phantom::Tube,
    ] {
        assert_printable(phantom.name(), &in_thick_slices(phantom));
    }
}
