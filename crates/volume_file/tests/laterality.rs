//! However a file stores the patient, what is on the left stays on the left.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Nifti, Rows, assert_rows, nrrd, read, stored, values};

/// Hounsfield units at a place in the patient (LPS mm): no turn or mirror image has the same.
fn hu([x, y, z]: [f64; 3]) -> f64 {
    (40.0 * x - 25.0 * y + 13.0 * z).round()
}

/// Maps from voxels to LPS: any order and direction of the axes, oblique, and sheared by a tilt.
fn orientations() -> [Rows; 8] {
    let origin = [-3.0, 5.0, 8.0];
    let with = |axes: [[f64; 3]; 3]| -> Rows {
        std::array::from_fn(|r| [axes[0][r], axes[1][r], axes[2][r], origin[r]])
    };
    let (sin, cos) = 0.4_f64.sin_cos();
    [
        with([[0.5, 0.0, 0.0], [0.0, 0.75, 0.0], [0.0, 0.0, 2.0]]),
        with([[0.5, 0.0, 0.0], [0.0, 0.75, 0.0], [0.0, 0.0, -2.0]]),
        with([[-0.5, 0.0, 0.0], [0.0, -0.75, 0.0], [0.0, 0.0, 2.0]]),
        with([[-0.5, 0.0, 0.0], [0.0, 0.75, 0.0], [0.0, 0.0, 2.0]]),
        with([[0.0, 0.5, 0.0], [0.0, 0.0, -0.75], [2.0, 0.0, 0.0]]),
        with([[0.5, 0.0, 0.0], [0.0, 0.0, -0.75], [0.0, -2.0, 0.0]]),
        with([
            [0.5 * cos, 0.5 * sin, 0.0],
            [-0.75 * sin, 0.75 * cos, 0.0],
            [0.0, 0.0, 2.0],
        ]),
        with([
            [0.5, 0.0, 0.0],
            [0.0, 0.75 * cos, -0.75 * sin],
            [0.0, 0.0, 2.0],
        ]),
    ]
}

fn at(rows: Rows, [i, j, k]: [usize; 3]) -> [f64; 3] {
    rows.map(|r| r[0] * i as f64 + r[1] * j as f64 + r[2] * k as f64 + r[3])
}

/// Stored values, columns fastest.
fn voxels(rows: Rows) -> Vec<f64> {
    let mut voxels = Vec::new();
    for k in 0..2 {
        for j in 0..3 {
            for i in 0..4 {
                voxels.push(hu(at(rows, [i, j, k])));
            }
        }
    }
    voxels
}

/// LPS rows as the other spaces count.
fn turned(rows: Rows, signs: [f64; 3]) -> Rows {
    std::array::from_fn(|r| rows[r].map(|v| v * signs[r]))
}

fn check(name: &str, bytes: &[u8], lps: Rows) {
    let (volume, _) = read(name, bytes).unwrap();
    assert_rows(volume.geometry(), lps);
    let found = values(&volume);
    let place = volume.geometry().patient_from_voxel();
    for (n, value) in found.into_iter().enumerate() {
        let index = [n % 4, n / 4 % 3, n / 12].map(|v| v as f64);
        let expected = hu(place.apply(index));
        assert!((value - expected).abs() <= 1.0, "{value} is not {expected}");
    }
}

#[test]
fn nifti_by_matrix() {
    for lps in orientations() {
        for version in [1, 2] {
            let mut file = Nifti::new(version).with(4, &voxels(lps));
            file.srow = turned(lps, [-1.0, -1.0, 1.0]);
            check("volume.nii", &file.bytes(), lps);
        }
    }
}

#[test]
fn nrrd_in_every_space() {
    for lps in orientations() {
        for (space, signs) in [
            ("LPS", [1.0, 1.0, 1.0]),
            ("RAS", [-1.0, -1.0, 1.0]),
            ("LAS", [1.0, -1.0, 1.0]),
        ] {
            let rows = turned(lps, signs);
            let column = |c: usize| format!("({},{},{})", rows[0][c], rows[1][c], rows[2][c]);
            let header = format!(
                "NRRD0005\ntype: int16\ndimension: 3\nspace: {space}\nsizes: 4 3 2\n\
                 space directions: {} {} {}\nendian: little\nencoding: raw\nspace origin: {}\n",
                column(0),
                column(1),
                column(2),
                column(3)
            );
            check(
                "volume.nrrd",
                &nrrd(&header, &stored(4, &voxels(lps), false)),
                lps,
            );
        }
    }
}
