//! Where in the patient the voxels lie.

use bonemesh_volume::Affine;

use super::fields::Fields;
use crate::header::{lps_from_ras, scaled};

/// Quaternions this close to their longest have no real part left.
const NO_REAL_PART: f64 = 1e-7;

/// Share of a voxel's side by which two maps may differ: rounding and a slight shear.
const SAME_SIZE: f64 = 0.01;

/// First code of a space that is no longer this patient's (Talairach, then MNI and others).
const TALAIRACH: i32 = 3;

/// The map of the header in LPS millimetres: its sform, else its qform, else its spacings alone.
pub(super) fn patient_from_voxel(fields: &Fields, warnings: &mut Vec<String>) -> Affine {
    let spacing = spacing(fields, warnings);
    let quaternion = (fields.qform_code > 0).then(|| by_quaternion(fields, spacing));
    let matrix = (fields.sform_code > 0).then_some(fields.srow);
    let is_flat = |rows: [[f64; 4]; 3]| Affine::from_rows(rows).inverse().is_none();
    let (rows, code) = match (matrix, quaternion) {
        (Some(matrix), Some(quaternion)) if is_flat(matrix) => {
            warnings.push("the sform matrix is degenerate; the qform is taken".to_owned());
            (quaternion, fields.qform_code)
        }
        (Some(matrix), quaternion) => {
            warnings.extend(
                quaternion
                    .into_iter()
                    .flat_map(|q| disagreements(matrix, q)),
            );
            (matrix, fields.sform_code)
        }
        (None, Some(quaternion)) => (quaternion, fields.qform_code),
        (None, None) => {
            warnings.push(
                "the file gives no orientation (sform and qform codes are 0): columns are taken to run to the right, rows to the front and slices to the head, so left and right may be swapped"
                    .to_owned(),
            );
            let [x, y, z] = spacing;
            let rows = [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]];
            (rows, 0)
        }
    };
    if code >= TALAIRACH {
        warnings.push(
            "the coordinates are those of a template (Talairach, MNI or the like), not of this patient: sizes may differ"
                .to_owned(),
        );
    }
    Affine::from_rows(lps_from_ras(scaled(rows, unit_mm(fields, warnings))))
}

/// Spacings, in the header's unit; the standard wants them positive.
fn spacing(fields: &Fields, warnings: &mut Vec<String>) -> [f64; 3] {
    let [_, x, y, z, ..] = fields.pixdim;
    if [x, y, z].iter().any(|s| *s < 0.0) && fields.sform_code <= 0 {
        warnings.push(format!(
            "negative voxel sizes ({x}, {y}, {z}) are taken as positive"
        ));
    }
    [x, y, z].map(f64::abs)
}

/// The map by rotation, spacings and offset ("method 2" of the standard).
fn by_quaternion(fields: &Fields, [dx, dy, dz]: [f64; 3]) -> [[f64; 4]; 3] {
    let [mut b, mut c, mut d] = fields.quaternion;
    let rest = 1.0 - (b * b + c * c + d * d);
    let a = if rest < NO_REAL_PART {
        // Rounding may have left the imaginary part longer than 1.
        let length = (b * b + c * c + d * d).sqrt();
        [b, c, d] = [b / length, c / length, d / length];
        0.0
    } else {
        rest.sqrt()
    };
    let dz = if fields.pixdim[0] < 0.0 { -dz } else { dz };
    let [x, y, z] = fields.quaternion_offset;
    [
        [
            (a * a + b * b - c * c - d * d) * dx,
            2.0 * (b * c - a * d) * dy,
            2.0 * (b * d + a * c) * dz,
            x,
        ],
        [
            2.0 * (b * c + a * d) * dx,
            (a * a + c * c - b * b - d * d) * dy,
            2.0 * (c * d - a * b) * dz,
            y,
        ],
        [
            2.0 * (b * d - a * c) * dx,
            2.0 * (c * d + a * b) * dy,
            (a * a + d * d - b * b - c * c) * dz,
            z,
        ],
    ]
}

/// Warnings where matrix and quaternion count to opposite sides, or by other steps.
fn disagreements(matrix: [[f64; 4]; 3], quaternion: [[f64; 4]; 3]) -> Vec<String> {
    let [sform, qform] = [matrix, quaternion].map(Affine::from_rows);
    let mut found = Vec::new();
    if sform.determinant() * qform.determinant() < 0.0 {
        found.push("sform and qform disagree about left and right; the sform is taken".to_owned());
    }
    let ([x, y, z], [u, v, w]) = (sform.spacing(), qform.spacing());
    // What is no number agrees with nothing.
    let agrees = |s: f64, q: f64| (s - q).abs() <= SAME_SIZE * s;
    if !(agrees(x, u) && agrees(y, v) && agrees(z, w)) {
        found.push(format!(
            "sform and qform disagree about the size of a voxel ({x:.4} x {y:.4} x {z:.4} against {u:.4} x {v:.4} x {w:.4}); the sform is taken, check a known length"
        ));
    }
    found
}

/// Millimetres of the header's unit of length.
fn unit_mm(fields: &Fields, warnings: &mut Vec<String>) -> f64 {
    let (mm, unit) = match fields.xyzt_units & 7 {
        1 => (1000.0, "metres"),
        3 => (0.001, "micrometres"),
        // 0 is what most writers leave when they mean millimetres.
        0 | 2 => return 1.0,
        code => {
            warnings.push(format!(
                "the unit of length is unknown (code {code}); millimetres are taken"
            ));
            return 1.0;
        }
    };
    warnings.push(format!(
        "lengths are given in {unit} and turned into millimetres"
    ));
    mm
}
