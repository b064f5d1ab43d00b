//! A head: skull, jaw and teeth in soft tissue, different on its two sides.
//!
//! Lengths are those of an adult; the origin lies in the middle of the braincase, x runs to the
//! patient's left, y to the back, z up (DICOM LPS, mm).

mod face;
mod jaw;
mod skin;
mod teeth;
mod vault;

use super::Known;
use crate::body::{AIR_HU, BONE_HU, Layers};
use crate::shape::build::{Solid, cut, union};

/// Enamel and dentine as one (HU).
const TOOTH_HU: f64 = 2000.0;

/// The head and what is known about it.
pub(crate) fn head() -> Known {
    let skull = {
        let solid = crate::shape::build::blended(5.0, vec![vault::shell(), face::solid()]);
        let hollow = cut(solid, vault::openings(), 1.5);
        let carved = cut(hollow, face::openings(), 1.5);
        union(vec![
            cut(carved, vault::burr_hole(), 0.0),
            face::partitions(),
        ])
    };
    let mut layers = Layers {
        background_hu: AIR_HU,
        tissues: Vec::new(),
    };
    layers.soft(skin::outer(), crate::body::SOFT_HU);
    layers.soft(skin::air_ways(), AIR_HU);
    layers.bone(skull, BONE_HU);
    layers.bone(jaw::jaw(), BONE_HU);
    layers.bone(teeth::teeth(), TOOTH_HU);
    Known {
        layers,
        volume_mm3: None,
        parameters: vec![
            ("burr_hole_radius_mm", vault::BURR_RADIUS),
            ("teeth", teeth::count() as f64),
            ("bodies", 2.0),
        ],
        landmarks: vec![
            ("burr_hole_on_the_patients_left", vault::BURR_ENTRY),
            ("missing_tooth_on_the_patients_right", teeth::missing()),
            ("left_jaw_condyle", jaw::CONDYLE),
            (
                "right_jaw_condyle",
                [-jaw::CONDYLE[0], jaw::CONDYLE[1], jaw::CONDYLE[2]],
            ),
            ("chin", jaw::CHIN),
        ],
        structures: structures(),
    }
}

/// Whose surfaces make up the surface of the bone.
fn structures() -> Vec<(&'static str, Solid)> {
    let mut parts = vec![
        ("jaw", jaw::jaw()),
        ("teeth", teeth::teeth()),
        ("burr hole", vault::burr_hole()),
        ("septum, conchae, pterygoid plates", face::partitions()),
    ];
    parts.extend(vault::structures());
    parts.extend(face::structures());
    parts
}
