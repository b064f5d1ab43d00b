//! Slices that are missing, unevenly spaced, tilted or crooked: the surface is where the bone is.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

mod common;

use std::f64::consts::PI;
use std::path::Path;
use std::sync::LazyLock;

use bonemesh::{Method, Phantom, Settings, Task, Volume, Voxels, render_volume};
use bonemesh_dicom::{find_series, read_series};
use bonemesh_phantom::{Body, SeriesLabels, write_dicom_series};
use bonemesh_volume::{Affine, Geometry};
use common::{Fit, fit, fit_of_middles, halfway};
use dicom_core::{DataElement, PrimitiveValue, VR};
use dicom_dictionary_std::tags;
use ndarray::Array3;

type Point = [f64; 3];

/// Field of view and height of the stack: the shell, 72 mm wide, lies inside.
const FIELD_MM: f64 = 84.0;

/// The published method, and those for use, whose threshold far from halfway must not matter.
const METHODS: [Method; 3] = [Method::Alpha, Method::Isosurface, Method::Labelled];

/// Where a slice is, and where its file says it is.
#[derive(Clone, Copy)]
struct Place {
    /// Middle of the slice.
    middle: Point,
    /// Directions of columns and rows.
    axes: [Point; 2],
    /// Directions as written.
    written: [Point; 2],
}

/// A series to be written.
#[derive(Clone)]
struct Stack {
    pixel_mm: [f64; 2],
    /// Thickness of a slice.
    slice_mm: f64,
    places: Vec<Place>,
}

impl Stack {
    /// Axial slices at these heights, tilted by `degrees` about the columns' direction.
    fn at(heights: impl IntoIterator<Item = f64>, degrees: f64) -> Self {
        let (s, c) = degrees.to_radians().sin_cos();
        let axes = [[1.0, 0.0, 0.0], [0.0, c, s]];
        let place = |z| Place {
            middle: [0.0, 0.0, z],
            axes,
            written: axes,
        };
        Self {
            pixel_mm: [1.0; 2],
            slice_mm: 1.5,
            places: heights.into_iter().map(place).collect(),
        }
    }

    fn regular(step_mm: f64, degrees: f64) -> Self {
        Self {
            slice_mm: step_mm,
            ..Self::at(heights(step_mm), degrees)
        }
    }

    fn without(mut self, missing: &[usize]) -> Self {
        let mut number = 0;
        self.places.retain(|_| {
            number += 1;
            !missing.contains(&(number - 1))
        });
        self
    }

    fn moved(mut self, by: impl Fn(usize) -> Point) -> Self {
        for (k, place) in self.places.iter_mut().enumerate() {
            place.middle = std::array::from_fn(|c| place.middle[c] + by(k)[c]);
        }
        self
    }

    fn shape(&self) -> [usize; 3] {
        let [columns, rows] = self.pixel_mm.map(|p| (FIELD_MM / p).round() as usize);
        [self.places.len(), rows, columns]
    }

    /// The middle of a pixel.
    fn pixel(&self, k: usize, row: f64, column: f64) -> Point {
        let [_, rows, columns] = self.shape();
        let Place { middle, axes, .. } = self.places[k];
        let u = (column - (columns as f64 - 1.0) / 2.0) * self.pixel_mm[0];
        let v = (row - (rows as f64 - 1.0) / 2.0) * self.pixel_mm[1];
        std::array::from_fn(|c| middle[c] + u * axes[0][c] + v * axes[1][c])
    }

    /// Hounsfield units with partial volume: bone 1240 HU in soft tissue of 40 HU.
    fn hu(&self, body: &dyn Body, k: usize, row: usize, column: usize) -> i16 {
        const LAYERS: [f64; 3] = [-1.0 / 3.0, 0.0, 1.0 / 3.0];
        let p = self.pixel(k, row as f64, column as f64);
        let side = self.pixel_mm[0].max(self.pixel_mm[1]);
        let covered: f64 = LAYERS
            .iter()
            .map(|layer| {
                let at = [p[0], p[1], p[2] + layer * self.slice_mm];
                (0.5 - body.signed_distance_mm(at) / side).clamp(0.0, 1.0) / 3.0
            })
            .sum();
        (40.0 + 1200.0 * covered).round() as i16
    }

    fn write(&self, body: &dyn Body, folder: &Path) {
        let hu = Array3::from_shape_fn(self.shape(), |(k, j, i)| self.hu(body, k, j, i));
        // A straight stack first; each file then gets its own place.
        let grid = Affine::from_axes(
            [self.pixel_mm[0], 0.0, 0.0],
            [0.0, self.pixel_mm[1], 0.0],
            [0.0, 0.0, self.slice_mm],
            [0.0; 3],
        );
        let geometry = Geometry::new(self.shape(), grid).unwrap();
        let volume = Volume::new(Voxels::I16(hu), geometry).unwrap();
        let labels = SeriesLabels::default();
        let files = write_dicom_series(&volume, folder, &labels, &Task::default()).unwrap();
        for (k, path) in files.iter().enumerate() {
            let mut file = dicom_object::open_file(path).unwrap();
            let corner = self.pixel(k, 0.0, 0.0);
            let orientation = self.places[k].written.as_flattened();
            for (tag, numbers) in [
                (tags::IMAGE_POSITION_PATIENT, &corner[..]),
                (tags::IMAGE_ORIENTATION_PATIENT, orientation),
            ] {
                let texts: Vec<String> = numbers.iter().map(|v| format!("{v:.9}")).collect();
                let value = PrimitiveValue::from(texts.join("\\"));
                file.put(DataElement::new(tag, VR::DS, value));
            }
            file.remove_element(tags::SLICE_LOCATION);
            file.write_to_file(path).unwrap();
        }
    }

    /// Written, read, rendered by each of [`METHODS`], and compared with the body where `counts`
    /// says so.
    fn measured(&self, name: &str, counts: impl Fn(Point) -> bool) -> ([Fit; 3], Vec<String>) {
        let body = Phantom::SphereShell.body().unwrap();
        let folder = tempfile::tempdir().unwrap();
        self.write(body.as_ref(), folder.path());
        let task = Task::default();
        let found = find_series(folder.path(), &task).unwrap();
        assert_eq!(found.series.len(), 1, "{name}");
        let (volume, warnings) = read_series(&found.series[0], &task).unwrap();
        let fits = METHODS.map(|method| {
            let mesh = render_volume(&volume, &settings(method), &task)
                .unwrap()
                .mesh;
            let fit = if method == Method::Alpha {
                fit(&mesh, body.as_ref(), &counts)
            } else {
                fit_of_middles(&mesh, body.as_ref(), &counts)
            };
            println!(
                "{name:32} {:10}: mean {:.3}, 95 % {:.3}, signed {:+.3}, shift {:.3} mm; {}",
                method.name(),
                fit.distance_mm.unsigned,
                fit.distance_mm.p95,
                fit.distance_mm.signed,
                fit.shift_mm,
                warnings.join("; "),
            );
            fit
        });
        (fits, warnings)
    }
}

fn settings(method: Method) -> Settings {
    if method == Method::Alpha {
        // More than the gap between the shell's points, less than its radius.
        Settings {
            alpha_mm: Some(4.0),
            ..halfway()
        }
    } else {
        Settings {
            method,
            ..Settings::default()
        }
    }
}

/// Heights of a regular stack about the middle of the shell.
fn heights(step_mm: f64) -> Vec<f64> {
    let count = (FIELD_MM / step_mm).round();
    (0..count as usize)
        .map(|k| (k as f64 - (count - 1.0) / 2.0) * step_mm)
        .collect()
}

/// Numbers from -1 to 1 that follow no pattern.
fn scattered(k: usize) -> f64 {
    ((k * 389 % 997) as f64 / 498.0) - 1.0
}

/// The even, upright stack that the others are compared with. The published method's own error:
/// vertices are centres of pixels, a fifth of a pixel outside the bone in the mean.
static REGULAR: LazyLock<[Fit; 3]> =
    LazyLock::new(|| Stack::regular(1.5, 0.0).measured("regular", everywhere).0);

fn everywhere(_: Point) -> bool {
    true
}

/// How much further from the bone a surface may lie than that of the regular stack: mean and 95th
/// percentile. The methods for use are measured between slices too, and where slices are made up
/// it shows.
fn allowed(method: Method, are_slices_made_up: bool) -> [f64; 2] {
    match (method, are_slices_made_up) {
        (Method::Alpha, _) => [0.035, 0.06],
        (_, false) => [0.01, 0.03],
        (_, true) => [0.05, 0.12],
    }
}

/// The surface is as near to the bone as that of the regular stack, and not moved; a word of
/// what is said of the stack, or nothing if nothing is to be said.
fn assert_in_place(name: &str, stack: &Stack, said: Option<&str>) {
    let (fits, warnings) = stack.measured(name, everywhere);
    let are_slices_made_up = warnings
        .iter()
        .any(|w| w.contains("missing") || w.contains("resampled"));
    for ((fit, regular), method) in fits.iter().zip(REGULAR.iter()).zip(METHODS) {
        let name = format!("{name}, {}", method.name());
        let more = |of: fn(&Fit) -> f64| of(fit) - of(regular);
        let [mean, p95] = allowed(method, are_slices_made_up);
        assert!(more(|f| f.distance_mm.unsigned) < mean, "{name}: {fit:?}");
        assert!(more(|f| f.distance_mm.p95) < p95, "{name}: {fit:?}");
        assert!(fit.shift_mm < 0.05, "{name}: {fit:?}");
    }
    match said {
        Some(word) => assert!(
            warnings.len() == 1 && warnings[0].contains(word),
            "{name}: {warnings:?}"
        ),
        None => assert!(warnings.is_empty(), "{name}: {warnings:?}"),
    }
}

#[test]
fn missing_slices_leave_the_surface_in_place() {
    let stack = Stack::regular(1.5, 0.0);
    let missing = Some("2 slices are missing");
    assert_in_place("2 missing", &stack.clone().without(&[20, 21]), missing);
    assert_in_place("2 near the pole", &stack.without(&[6, 7]), missing);
}

#[test]
fn a_filled_gap_adds_less_than_its_steps_are_high() {
    let gap = |p: Point| (-13.0..-7.0).contains(&p[2]);
    let stack = Stack::regular(1.5, 0.0);
    let (whole, _) = stack.measured("the gap's place, filled", gap);
    let (filled, _) = stack.without(&[20, 21]).measured("the gap", gap);
    // Between binary slices linear interpolation is a step halfway, here 4.5 / 2 mm high; the
    // bone's side leans by a third there.
    for (filled, whole) in filled.iter().zip(&whole) {
        assert!(filled.distance_mm.unsigned < whole.distance_mm.unsigned + 0.1);
    }
}

#[test]
fn uneven_spacing_leaves_the_surface_in_place() {
    for part in [0.1, 0.3] {
        let jittered = heights(1.5).into_iter().enumerate();
        let jittered = jittered.map(|(k, z)| z + part * 1.5 * scattered(k));
        let name = format!("off by {part} of a step");
        assert_in_place(&name, &Stack::at(jittered, 0.0), Some("resampled"));
    }
}

/// Thin slices far apart have stairs between them in every method; they must not become worse
/// because the rest of the stack is denser.
#[test]
fn a_stack_that_changes_its_step_is_no_worse_than_its_coarser_part() {
    let every_other = |from: usize| {
        let heights = heights(1.5).into_iter().enumerate();
        let kept = heights.filter(move |(k, _)| *k < from || k % 2 == 0);
        Stack::at(kept.map(|(_, z)| z), 0.0)
    };
    let coarse = |p: Point| p[2] > 0.0;
    let (of_the_coarse, _) = every_other(0).measured("3 mm", coarse);
    let stack = every_other(28);
    let (fits, warnings) = stack.measured("1.5 mm, then 3 mm", coarse);
    assert!(
        warnings.len() == 1 && warnings[0].contains("resampled"),
        "{warnings:?}"
    );
    for (fit, of_the_coarse) in fits.iter().zip(&of_the_coarse) {
        let more = fit.distance_mm.unsigned - of_the_coarse.distance_mm.unsigned;
        assert!(more < 0.035, "{fit:?} {of_the_coarse:?}");
    }
    let (fits, _) = stack.measured("1.5 mm, then 3 mm", |p| p[2] < -3.0);
    for (fit, regular) in fits.iter().zip(REGULAR.iter()) {
        let more = fit.distance_mm.unsigned - regular.distance_mm.unsigned;
        assert!(more < 0.01, "{fit:?}");
    }
}

#[test]
fn a_tilted_gantry_leaves_the_surface_in_place() {
    for degrees in [15.0, -25.0] {
        let stack = Stack::regular(1.5, degrees);
        assert_in_place(&format!("tilted by {degrees}"), &stack, None);
        let gaps = stack.without(&[20, 21, 33]);
        let name = format!("tilted by {degrees}, 3 missing");
        assert_in_place(&name, &gaps, Some("3 slices are missing"));
    }
}

#[test]
fn pixels_that_are_not_square_leave_the_surface_in_place() {
    for pixel_mm in [[0.4, 0.7], [0.7, 0.4]] {
        let stack = Stack {
            pixel_mm,
            ..Stack::regular(1.5, 0.0)
        };
        // Finer pixels, a nearer surface.
        let (fits, _) = stack.measured(&format!("{pixel_mm:?} mm"), everywhere);
        for fit in fits {
            assert!(
                fit.distance_mm.unsigned < 0.2 && fit.shift_mm < 0.01,
                "{fit:?}"
            );
        }
        let means = fits.map(|fit| fit.distance_mm.unsigned);
        assert!(means[1..].iter().all(|mean| *mean < 0.02), "{means:?}");
    }
}

#[test]
fn crooked_stacks_leave_the_surface_in_place() {
    let part = |k: usize| k as f64 / 55.0;
    let stack = || Stack::regular(1.5, 0.0);
    let sloping = stack().moved(|k| [4.0 * part(k), 0.0, 0.0]);
    assert_in_place("a table that drifts straight", &sloping, None);
    let sideways = Some("shifted sideways");
    let bent = stack().moved(|k| [3.0 * (PI * part(k)).sin(), 0.0, 0.0]);
    assert_in_place("a table that sways", &bent, sideways);
    let wild = stack().moved(|k| [3.0 * scattered(k), 2.0 * scattered(k + 7), 0.0]);
    assert_in_place("every slice somewhere else", &wild, sideways);
    for odd in [0, 30, 55] {
        let one = stack().moved(|k| [if k == odd { 3.0 } else { 0.0 }, 0.0, 0.0]);
        assert_in_place(&format!("slice {odd} off by 3 mm"), &one, sideways);
    }
    let missing = Stack::regular(1.5, 15.0).moved(|k| [3.0 * (PI * part(k)).sin(), 0.0, 0.0]);
    let missing = missing.without(&[20, 21, 33]);
    let (fits, warnings) = missing.measured("swaying, tilted, 3 missing", everywhere);
    assert!(
        fits.iter().all(|fit| fit.shift_mm < 0.05) && warnings.len() == 2,
        "{fits:?} {warnings:?}"
    );
}

#[test]
fn a_stack_centred_anew_halfway_keeps_its_bone_in_place() {
    for shift in [12.0, -12.0] {
        let anew = |k: usize| [if k < 28 { 0.0 } else { shift }, 0.0, 0.0];
        let stack = Stack::regular(1.5, 0.0).moved(anew);
        // One edge of the image was not scanned in all slices.
        let scanned = |p: Point| p[0].abs() < 25.0;
        let (fits, warnings) = stack.measured("centred anew", scanned);
        for ((fit, regular), method) in fits.iter().zip(REGULAR.iter()).zip(METHODS) {
            let more = fit.distance_mm.unsigned - regular.distance_mm.unsigned;
            assert!(more < allowed(method, false)[0], "{fit:?}");
        }
        assert!(
            warnings.len() == 1 && warnings[0].contains("up to 12.00 mm of their edge"),
            "{warnings:?}"
        );
    }
}

#[test]
fn rounding_in_the_tags_moves_nothing() {
    for noise in [5e-5, 4e-4] {
        let mut stack = Stack::regular(1.5, 20.0);
        for (k, place) in stack.places.iter_mut().enumerate() {
            let written = place.written.as_flattened_mut().iter_mut();
            for (n, v) in written.enumerate() {
                *v += noise * scattered(7 * k + n);
            }
        }
        assert_in_place(&format!("directions off by {noise}"), &stack, None);
    }
}
