//! A left femur: the shaft bows forwards, the head points to the middle of the body.

use super::Known;
use crate::body::Layers;
use crate::shape::build::{ball, blended, cone, cord, cut, ellipsoid};

/// Middle of the bone's bounding box (mm).
pub(crate) const FEMUR_CENTRE: [f64; 3] = [-10.0, 0.0, 7.0];

/// Fatty marrow (HU).
const MARROW_HU: f64 = -60.0;
const HEAD_CENTRE: [f64; 3] = [-44.0, -9.0, 196.0];
const HEAD_RADIUS: f64 = 23.0;

pub(crate) fn femur() -> Known {
    let shaft = cord(&[
        [0.0, 0.0, 160.0, 16.0],
        [0.0, -6.0, 50.0, 13.5],
        [0.0, -8.0, -40.0, 13.5],
        [0.0, -2.0, -130.0, 18.0],
        [0.0, 2.0, -172.0, 25.0],
    ]);
    let neck = cone([0.0, 1.0, 158.0], 15.0, HEAD_CENTRE, 13.0);
    let greater = cone([11.0, 5.0, 160.0], 15.0, [14.0, 13.0, 186.0], 8.5);
    let lesser = cone([-5.0, 6.0, 132.0], 11.0, [-15.0, 16.0, 128.0], 5.5);
    let medial = ellipsoid([-22.0, 12.0, -186.0], [15.0, 30.0, 21.0]);
    let lateral = ellipsoid([22.0, 9.0, -184.0], [15.0, 31.0, 21.0]);
    let notch = cone([0.0, 48.0, -196.0], 10.0, [0.0, 8.0, -206.0], 8.0);
    let groove = cone([0.0, -34.0, -160.0], 9.0, [0.0, -26.0, -208.0], 9.0);
    let solid = blended(
        6.0,
        vec![
            shaft,
            neck,
            greater,
            lesser,
            blended(4.0, vec![medial, lateral]),
            ball(HEAD_CENTRE, HEAD_RADIUS),
        ],
    );
    let outer = cut(cut(solid, notch, 5.0), groove, 5.0);
    let canal = cord(&[
        [0.0, 0.0, 150.0, 9.0],
        [0.0, -6.0, 50.0, 6.5],
        [0.0, -8.0, -40.0, 6.5],
        [0.0, -2.0, -135.0, 11.0],
    ]);
    let mut layers = Layers::bone_in_soft_tissue(cut(outer, canal.clone(), 0.0));
    layers.under(canal, MARROW_HU);
    Known {
        layers,
        volume_mm3: None,
        parameters: vec![
            ("head_radius_mm", HEAD_RADIUS),
            ("canal_radius_at_z_50_mm", 6.5),
            ("shaft_radius_at_z_50_mm", 13.5),
        ],
        landmarks: vec![
            ("head_centre", HEAD_CENTRE),
            ("greater_trochanter", [14.0, 13.0, 186.0]),
            ("medial_condyle", [-22.0, 12.0, -186.0]),
            ("lateral_condyle", [22.0, 9.0, -184.0]),
        ],
        structures: Vec::new(),
    }
}
