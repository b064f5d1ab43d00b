//! Sphere shell, tube and box with hole: distances exact everywhere, volumes by formula.

use std::f64::consts::PI;
use std::sync::Arc;

use super::Known;
use crate::body::Layers;
use crate::shape::Shape;

/// Spherical shell about the origin.
pub(crate) fn sphere_shell() -> Known {
    let (inner, outer) = (30.0_f64, 36.0_f64);
    known(
        Shape::BallShell { inner, outer },
        4.0 / 3.0 * PI * (outer.powi(3) - inner.powi(3)),
        vec![("inner_radius_mm", inner), ("outer_radius_mm", outer)],
    )
}

/// Upright tube about the origin.
pub(crate) fn tube() -> Known {
    let (inner, outer, tall) = (9.0_f64, 15.0_f64, 60.0);
    let (a, b) = ([0.0, 0.0, -tall / 2.0], [0.0, 0.0, tall / 2.0]);
    known(
        Shape::Tube { a, b, inner, outer },
        PI * (outer * outer - inner * inner) * tall,
        vec![
            ("inner_radius_mm", inner),
            ("outer_radius_mm", outer),
            ("length_mm", tall),
        ],
    )
}

/// Box about the origin, its hole along z.
pub(crate) fn box_with_hole() -> Known {
    let (half, hole) = ([20.0, 15.0, 15.0], 7.5);
    known(
        Shape::HoledBox { half, hole },
        8.0 * half[0] * half[1] * half[2] - 8.0 * hole * hole * half[2],
        vec![
            ("width_mm", 2.0 * half[0]),
            ("depth_mm", 2.0 * half[1]),
            ("height_mm", 2.0 * half[2]),
            ("hole_side_mm", 2.0 * hole),
        ],
    )
}

fn known(shape: Shape, volume_mm3: f64, parameters: Vec<(&'static str, f64)>) -> Known {
    Known {
        layers: Layers::bone_in_soft_tissue(Arc::new(shape)),
        volume_mm3: Some(volume_mm3),
        parameters,
        landmarks: vec![("centre", [0.0; 3])],
        structures: Vec::new(),
    }
}
