//! Directions in words.

/// The plane of a stack, and where columns, rows and slices are counted to.
///
/// Directions are those of the patient (DICOM LPS).
pub(crate) fn in_words(columns: [f64; 3], rows: [f64; 3], normal: [f64; 3], tilt: f64) -> String {
    let (axis, cosine) = (0..3)
        .map(|i| (i, normal[i].abs()))
        .fold((0, 0.0), |a, b| if b.1 > a.1 { b } else { a });
    let plane = ["sagittal", "coronal", "axial"][axis];
    let angle = cosine.min(1.0).acos().to_degrees();
    let oblique = if angle < 0.5 {
        String::new()
    } else {
        format!(", oblique by {angle:.1} degrees")
    };
    let tilted = if tilt < 0.5 {
        String::new()
    } else {
        format!(", gantry tilt {tilt:.1} degrees")
    };
    let (x, y, z) = (towards(columns), towards(rows), towards(normal));
    format!("{plane}{oblique}{tilted}; columns run to the {x}, rows to the {y}, slices to the {z}")
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

    #[test]
    fn planes_and_directions_are_the_patients() {
        let axial = in_words([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], 0.0);
        let expected = "axial; columns run to the left, rows to the back, slices to the head";
        assert_eq!(axial, expected);
        let sagittal = in_words([0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], 0.0);
        let expected = "sagittal; columns run to the back, rows to the feet, slices to the right";
        assert_eq!(sagittal, expected);
    }

    #[test]
    fn tilt_and_obliqueness_are_named_in_degrees() {
        let (s, c) = 15.0_f64.to_radians().sin_cos();
        let text = in_words([1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c], 15.0);
        assert!(text.starts_with("axial, oblique by 15.0 degrees, gantry tilt 15.0 degrees;"));
    }
}
