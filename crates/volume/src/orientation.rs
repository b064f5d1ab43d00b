//! Directions in words.

use crate::Geometry;

/// Angles below this are not worth a word (degrees).
const WORTH_A_WORD: f64 = 0.5;

/// The arc cosine near 1 turns rounding into angles of this size (degrees).
const ROUNDING: f64 = 1e-4;

impl Geometry {
    /// Angle between the normal of the slices and the line along which they are stacked
    /// (degrees): the tilt of the gantry.
    pub fn tilt_degrees(&self) -> f64 {
        let step = self.patient_from_voxel().axis(2);
        let degrees = degrees(dot(unit(step), self.slice_normal()));
        if degrees < ROUNDING { 0.0 } else { degrees }
    }

    /// The plane of the slices, and where columns, rows and slices are counted to.
    ///
    /// Directions are those of the patient (DICOM LPS).
    pub fn orientation_in_words(&self) -> String {
        let normal = self.slice_normal();
        let (axis, cosine) = (0..3)
            .map(|i| (i, normal[i].abs()))
            .fold((0, 0.0), |a, b| if b.1 > a.1 { b } else { a });
        let plane = ["sagittal", "coronal", "axial"][axis];
        let named = |name: &str, degrees: f64| {
            if degrees < WORTH_A_WORD {
                String::new()
            } else {
                format!(", {name} {degrees:.1} degrees")
            }
        };
        let oblique = named("oblique by", degrees(cosine));
        let tilted = named("gantry tilt", self.tilt_degrees());
        let towards_of = |axis| towards(self.patient_from_voxel().axis(axis));
        let (x, y, z) = (towards_of(0), towards_of(1), towards(normal));
        format!(
            "{plane}{oblique}{tilted}; columns run to the {x}, rows to the {y}, slices to the {z}"
        )
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|v| v / length)
}

fn degrees(cosine: f64) -> f64 {
    cosine.clamp(-1.0, 1.0).acos().to_degrees()
}

fn towards(direction: [f64; 3]) -> &'static str {
    let names = [["left", "right"], ["back", "front"], ["head", "feet"]];
    let axis = (0..3).fold(0, |a, b| {
        if direction[b].abs() > direction[a].abs() + 1e-9 {
            b
        } else {
            a
        }
    });
    names[axis][usize::from(direction[axis] < 0.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Affine;

    fn words(x: [f64; 3], y: [f64; 3], step: [f64; 3]) -> String {
        let affine = Affine::from_axes(x, y, step, [0.0; 3]);
        let geometry = Geometry::new([2, 2, 2], affine).unwrap();
        geometry.orientation_in_words()
    }

    #[test]
    fn planes_and_directions_are_the_patients() {
        let axial = words([0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 2.0]);
        let expected = "axial; columns run to the left, rows to the back, slices to the head";
        assert_eq!(axial, expected);
        let sagittal = words([0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]);
        let expected = "sagittal; columns run to the back, rows to the feet, slices to the right";
        assert_eq!(sagittal, expected);
    }

    #[test]
    fn tilt_and_obliqueness_are_named_in_degrees() {
        let (s, c) = 15.0_f64.to_radians().sin_cos();
        let text = words([1.0, 0.0, 0.0], [0.0, c, s], [0.0, 0.0, 1.0]);
        assert!(
            text.starts_with("axial, oblique by 15.0 degrees, gantry tilt 15.0 degrees;"),
            "{text}"
        );
    }

    #[test]
    fn a_straight_stack_has_no_tilt_at_all() {
        let affine = Affine::from_axes(
            [0.3, 0.1, 0.0],
            [-0.1, 0.3, 0.0],
            [0.0, 0.0, 0.7],
            [1.0, 2.0, 3.0],
        );
        let geometry = Geometry::new([2, 2, 2], affine).unwrap();
        assert!(geometry.tilt_degrees().abs() < f64::EPSILON);
    }
}
