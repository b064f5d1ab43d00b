//! A CT scanner: X-rays of many energies through a body with metal, noise and starved detectors.
//!
//! Rays are longer than those of the method under test: other angles, other offsets, a finer
//! picture of the body, and a projector of its own. Attenuation is NIST's (J. H. Hubbell,
//! S. M. Seltzer, NISTIR 5632), the spectrum that of a tungsten tube at 120 kV behind aluminium, in
//! steps of 10 keV and smoothed by eye.

#![allow(dead_code, reason = "each test uses its part")]

use std::f64::consts::PI;

use bonemesh_phantom::{Phantom, ScanSettings, scan};
use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};
use ndarray::Array3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// Energies (keV) at which attenuation is known, and the part of the photons about each.
const ENERGIES: [(f64, f64); 5] = [
    (40.0, 0.20),
    (50.0, 0.25),
    (60.0, 0.25),
    (80.0, 0.20),
    (100.0, 0.10),
];
/// Linear attenuation (1/mm) at these energies.
const WATER: [f64; 5] = [0.02683, 0.02269, 0.02059, 0.01837, 0.01707];
const BONE: [f64; 5] = [0.127_8, 0.081_4, 0.060_4, 0.042_8, 0.035_6];
/// Hounsfield units of that bone about as the scanner sees it.
const BONE_HU: f64 = 1950.0;

/// What metal is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Alloy {
    Titanium,
    Steel,
    /// Silver, for amalgam.
    Amalgam,
}

impl Alloy {
    fn attenuation(self) -> [f64; 5] {
        match self {
            Self::Titanium => [0.9976, 0.5466, 0.3452, 0.1826, 0.1226],
            Self::Steel => [2.857, 1.542, 0.9488, 0.4687, 0.2927],
            Self::Amalgam => [18.04, 9.906, 6.048, 2.781, 1.542],
        }
    }
}

/// A ball or rod of metal: from `a` to `b`, `radius_mm` about that line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rod {
    pub(crate) a: [f64; 3],
    pub(crate) b: [f64; 3],
    pub(crate) radius_mm: f64,
    pub(crate) alloy: Alloy,
}

impl Rod {
    /// Distance (mm) of a place to the metal, negative inside.
    pub(crate) fn distance_mm(&self, p: [f64; 3]) -> f64 {
        let minus = |u: [f64; 3], v: [f64; 3]| [0, 1, 2].map(|k| u[k] - v[k]);
        let dot = |u: [f64; 3], v: [f64; 3]| u.iter().zip(v).map(|(x, y)| x * y).sum::<f64>();
        let (way, to) = (minus(self.b, self.a), minus(p, self.a));
        let length = dot(way, way).max(1e-12);
        let along = (dot(to, way) / length).clamp(0.0, 1.0);
        let off = [0, 1, 2].map(|k| to[k] - along * way[k]);
        dot(off, off).sqrt() - self.radius_mm
    }
}

/// How a body is scanned.
pub(crate) struct Scanner {
    /// Grid of the scan.
    pub(crate) settings: ScanSettings,
    /// Soft tissue ends so far from the axis in which the body lies, beyond is air.
    pub(crate) trunk_mm: Option<f64>,
    pub(crate) photons: f64,
    pub(crate) metal: Vec<Rod>,
}

impl Scanner {
    /// The scan, with its metal or without.
    pub(crate) fn scan(&self, phantom: Phantom, with_metal: bool) -> Volume {
        let task = Task::default();
        let coarse = self.settings.ideal();
        let fine = ScanSettings {
            columns: 2 * coarse.columns,
            rows: 2 * coarse.rows,
            pixel_mm: coarse.pixel_mm.map(|p| p / 2.0),
            ..coarse.clone()
        };
        let body = scan(phantom, &fine, &task).unwrap();
        let Voxels::I16(body_hu) = body.voxels() else {
            unreachable!()
        };
        let geometry = coarse.geometry().unwrap();
        let [slices, rows, columns] = geometry.shape();
        let mut hu = Array3::<i16>::zeros([slices, rows, columns]);
        let affine = body.geometry().patient_from_voxel();
        hu.as_slice_mut()
            .unwrap()
            .par_chunks_mut(rows * columns)
            .enumerate()
            .for_each(|(k, out)| {
                let place = |pixel: usize| {
                    affine.apply([
                        (pixel % (2 * columns)) as f64,
                        (pixel / (2 * columns)) as f64,
                        k as f64,
                    ])
                };
                let mut tissue: Vec<f32> = body_hu
                    .index_axis(ndarray::Axis(0), k)
                    .iter()
                    .map(|v| f32::from(*v))
                    .collect();
                if let Some(trunk) = self.trunk_mm {
                    for (pixel, hu) in tissue.iter_mut().enumerate() {
                        let [x, y, _] = place(pixel);
                        if x.hypot(y) > trunk {
                            *hu = -1000.0;
                        }
                    }
                }
                let alloy = self.metal.first().map(|m| m.alloy);
                let part = |pixel: usize| -> f32 {
                    let p = place(pixel);
                    let near = self
                        .metal
                        .iter()
                        .map(|m| m.distance_mm(p))
                        .fold(f64::INFINITY, f64::min);
                    let cell = coarse.pixel_mm[0] / 2.0;
                    (0.5 - near / cell).clamp(0.0, 1.0) as f32
                };
                let metal: Vec<f32> = if with_metal && alloy.is_some() {
                    (0..tissue.len()).map(part).collect()
                } else {
                    vec![0.0; tissue.len()]
                };
                let slice = Slice {
                    rows: 2 * rows,
                    columns: 2 * columns,
                    pixel_mm: coarse.pixel_mm[0] / 2.0,
                };
                let image = slice.image(
                    &tissue,
                    &metal,
                    alloy.unwrap_or(Alloy::Steel),
                    self.photons,
                    k as u64,
                );
                for (hu, value) in out.iter_mut().zip(image) {
                    *hu = value.round().clamp(-1024.0, 3071.0) as i16;
                }
            });
        Volume::new(Voxels::I16(hu), geometry).unwrap()
    }
}

/// A fine picture of a body; its image has half of its rows and columns.
struct Slice {
    rows: usize,
    columns: usize,
    pixel_mm: f64,
}

impl Slice {
    fn image(
        &self,
        tissue_hu: &[f32],
        metal: &[f32],
        alloy: Alloy,
        photons: f64,
        seed: u64,
    ) -> Vec<f64> {
        let materials: Vec<[f32; 3]> = tissue_hu
            .iter()
            .zip(metal)
            .map(|(hu, m)| materials(*hu, *m))
            .collect();
        let pitch = 1.4 * self.pixel_mm;
        let diagonal = (self.rows as f64).hypot(self.columns as f64) * self.pixel_mm;
        let bins = (diagonal / pitch) as usize + 9;
        let angles = (1.3 * self.columns as f64) as usize + 7;
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let table = WaterTable::new();
        let filter = hann(bins, pitch);
        let lines = alloy.attenuation();
        let (rows, columns) = (self.rows / 2, self.columns / 2);
        let mut image = vec![0.0_f64; rows * columns];
        for angle in 0..angles {
            let (sin, cos) = (PI * (angle as f64 + 0.37) / angles as f64).sin_cos();
            let measured: Vec<f64> = (0..bins)
                .map(|bin| {
                    let offset = (bin as f64 - (bins - 1) as f64 / 2.0 + 0.21) * pitch;
                    // A detector is as wide as its pitch.
                    let through: f64 = [-0.25, 0.25]
                        .into_iter()
                        .map(|part| {
                            let [w, b, m] =
                                self.lengths(&materials, [cos, sin], offset + part * pitch);
                            let at =
                                |e: usize| (-(w * WATER[e] + b * BONE[e] + m * lines[e])).exp();
                            (0..5).map(|e| 0.5 * ENERGIES[e].1 * at(e)).sum::<f64>()
                        })
                        .sum();
                    let seen = noisy(photons * through, &mut rng);
                    table.water_mm(-(seen / photons).ln())
                })
                .collect();
            let filtered: Vec<f64> = (0..bins)
                .map(|i| {
                    measured
                        .iter()
                        .enumerate()
                        .map(|(j, v)| v * filter[i.abs_diff(j)])
                        .sum()
                })
                .collect();
            for row in 0..rows {
                let y = (row as f64 - (rows - 1) as f64 / 2.0) * 2.0 * self.pixel_mm;
                for column in 0..columns {
                    let x = (column as f64 - (columns - 1) as f64 / 2.0) * 2.0 * self.pixel_mm;
                    let at = (x * cos + y * sin) / pitch + (bins - 1) as f64 / 2.0 - 0.21;
                    let bin = at as usize;
                    let part = at - bin as f64;
                    image[row * columns + column] +=
                        filtered[bin] * (1.0 - part) + filtered[bin + 1] * part;
                }
            }
        }
        image
            .iter()
            .map(|v| 1000.0 * (v * PI / angles as f64 - 1.0))
            .collect()
    }

    /// Lengths (mm) of a ray in water, bone and metal: at each row or column that it crosses.
    fn lengths(&self, materials: &[[f32; 3]], [cos, sin]: [f64; 2], offset: f64) -> [f64; 3] {
        let (mx, my) = (
            (self.columns - 1) as f64 / 2.0,
            (self.rows - 1) as f64 / 2.0,
        );
        let is_steep = cos.abs() > sin.abs();
        let (main, other) = if is_steep { (cos, sin) } else { (sin, cos) };
        let (lines, pixels) = if is_steep {
            (self.rows, self.columns)
        } else {
            (self.columns, self.rows)
        };
        let (line_middle, pixel_middle) = if is_steep { (my, mx) } else { (mx, my) };
        let mut sums = [0.0_f64; 3];
        for line in 0..lines {
            let along = line as f64 - line_middle;
            let at = (offset / self.pixel_mm - along * other) / main + pixel_middle;
            if at < 0.0 || at >= pixels as f64 - 1.0 {
                continue;
            }
            let pixel = at as usize;
            let part = (at - pixel as f64) as f32;
            let here = if is_steep {
                line * self.columns + pixel
            } else {
                pixel * self.columns + line
            };
            let next = here + if is_steep { 1 } else { self.columns };
            let (a, b) = (materials[here], materials[next]);
            for m in 0..3 {
                sums[m] += f64::from(a[m] + part * (b[m] - a[m]));
            }
        }
        sums.map(|v| v * self.pixel_mm / main.abs())
    }
}

/// Parts of water, bone and metal.
fn materials(hu: f32, metal: f32) -> [f32; 3] {
    let bone = ((f64::from(hu) - 40.0) / (BONE_HU - 40.0)).max(0.0);
    let water = ((f64::from(hu).min(40.0) / 1000.0 + 1.0) * (1.0 - bone)).max(0.0);
    [
        water as f32 * (1.0 - metal),
        bone as f32 * (1.0 - metal),
        metal,
    ]
}

/// Photons that arrive where so many are expected, and at least one: noise of counting, normal.
fn noisy(expected: f64, rng: &mut ChaCha8Rng) -> f64 {
    let unit = |rng: &mut ChaCha8Rng| (f64::from(rng.next_u32()) + 0.5) / 4_294_967_296.0;
    let normal = (-2.0 * unit(rng).ln()).sqrt() * (std::f64::consts::TAU * unit(rng)).cos();
    (expected + expected.sqrt() * normal).max(1.0)
}

/// Makes attenuation linear in water, as scanners do.
struct WaterTable {
    values: Vec<f64>,
}

impl WaterTable {
    const STEP_MM: f64 = 1.0;

    fn new() -> Self {
        let at = |mm: f64| {
            -(0..5)
                .map(|e| ENERGIES[e].1 * (-mm * WATER[e]).exp())
                .sum::<f64>()
                .ln()
        };
        let values: Vec<f64> = (0..1500)
            .map(|i| at(f64::from(i) * Self::STEP_MM))
            .collect();
        Self { values }
    }

    /// The water (mm) that attenuates as much.
    fn water_mm(&self, attenuation: f64) -> f64 {
        let i = self
            .values
            .partition_point(|v| *v <= attenuation)
            .clamp(1, self.values.len() - 1);
        let (a, b) = (self.values[i - 1], self.values[i]);
        ((i - 1) as f64 + (attenuation - a) / (b - a)) * Self::STEP_MM
    }
}

/// The ramp with Hann's window, by distance in bins: a soft kernel.
fn hann(bins: usize, pitch: f64) -> Vec<f64> {
    let count = 512;
    let tap = |distance: usize| {
        let of = |step: usize| {
            let f = (step as f64 + 0.5) / count as f64 / 2.0;
            let window = 0.5 + 0.5 * (2.0 * PI * f).cos();
            2.0 * f * window * (2.0 * PI * f * distance as f64).cos() / (2 * count) as f64
        };
        (0..count).map(of).sum::<f64>() / pitch
    };
    (0..bins).map(tap).collect()
}
