//! The outline of the head, and the air in it.

use super::face;
use crate::shape::build::{Solid, ball, blended, both_sides, chain, cone, cut, ellipsoid, union};

/// Skin: everything inside is soft tissue unless something else is painted over it.
pub(super) fn outer() -> Solid {
    let cranium = blended(
        16.0,
        vec![
            ellipsoid([0.0, 6.0, 8.0], [73.0, 89.0, 72.0]),
            ellipsoid([0.0, 46.0, -6.0], [60.0, 52.0, 50.0]),
            ellipsoid([0.0, -36.0, 12.0], [59.0, 57.0, 54.0]),
        ],
    );
    let face = ellipsoid([0.0, -42.0, -55.0], [68.0, 52.0, 60.0]);
    let jaw = ellipsoid([0.0, -46.0, -92.0], [54.0, 52.0, 38.0]);
    let chin = ball([0.0, -82.0, -113.0], 19.0);
    let nose = chain(
        &[
            ([0.0, -88.0, -18.0], 7.0),
            ([0.0, -104.0, -48.0], 8.0),
            ([0.0, -100.0, -56.0], 11.0),
        ],
        3.0,
    );
    let lips = ellipsoid([0.0, -88.0, -84.0], [26.0, 12.0, 16.0]);
    let neck = cone([0.0, 8.0, -60.0], 62.0, [0.0, 18.0, -190.0], 62.0);
    let ear = cut(
        ellipsoid([76.0, 14.0, -34.0], [5.0, 17.0, 29.0]),
        ellipsoid([83.0, 10.0, -32.0], [5.0, 10.0, 18.0]),
        2.0,
    );
    let eye = ball([33.0, -78.0, -29.0], 14.0);
    blended(
        10.0,
        vec![
            cranium,
            face,
            jaw,
            chin,
            neck,
            union(vec![nose, lips]),
            both_sides(union(vec![ear, eye])),
        ],
    )
}

/// Nose, sinuses and throat.
pub(super) fn air_ways() -> Solid {
    let throat = chain(
        &[
            ([0.0, -26.0, -52.0], 8.0),
            ([0.0, -14.0, -70.0], 8.0),
            ([0.0, -8.0, -110.0], 8.0),
            ([0.0, -8.0, -200.0], 9.0),
        ],
        2.0,
    );
    union(vec![face::air(), throat])
}
