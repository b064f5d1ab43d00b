//! The braincase: a shell with a flat base, mastoids and the hole of the spinal cord.

use crate::shape::build::{
    Solid, ball, below, blended, both_sides, chain, common, cone, cut, ellipsoid, grow, rod, union,
};
use crate::vector::Vec3;

/// Wall of the braincase.
const WALL: f64 = 5.5;

/// Where the burr hole enters, on the patient's left.
pub(super) const BURR_ENTRY: Vec3 = [44.0, -36.0, 50.0];
pub(super) const BURR_RADIUS: f64 = 7.0;

fn form() -> Solid {
    let main = ellipsoid([0.0, 6.0, 8.0], [66.0, 82.0, 65.0]);
    let occiput = ellipsoid([0.0, 48.0, -4.0], [54.0, 46.0, 44.0]);
    let forehead = ellipsoid([0.0, -36.0, 12.0], [53.0, 50.0, 48.0]);
    let bosses = both_sides(ellipsoid([30.0, 26.0, 18.0], [42.0, 46.0, 42.0]));
    // Two at a time: three that meet at once would leave a crease.
    let long = blended(20.0, vec![blended(20.0, vec![main, occiput]), forehead]);
    let rounds = blended(24.0, vec![long, bosses]);
    let hollow_temples = both_sides(ball([103.0, -50.0, -22.0], 52.0));
    cut(rounds, hollow_temples, 14.0)
}

/// Everything above the base, moved up by `up`: the front fossa over the orbits, a step down
/// to the middle one, and the rear one that falls to the nape.
fn above_base(up: f64) -> Solid {
    let front = below([0.0, -60.0, -18.0 + up], [0.0, 0.1, -1.0]);
    let middle = below([0.0, -10.0, -37.0 + up], [0.0, 0.05, -1.0]);
    let behind_the_step = below([0.0, -40.0 + up, 0.0], [0.0, -1.0, 0.0]);
    let rear = below([0.0, 30.0, -50.0 + up], [0.0, 0.35, -1.0]);
    let lower = blended(
        4.0,
        vec![
            middle,
            common(
                4.0,
                vec![rear, below([0.0, 8.0 + up, 0.0], [0.0, -1.0, 0.0])],
            ),
        ],
    );
    blended(4.0, vec![front, common(4.0, vec![lower, behind_the_step])])
}

fn outer() -> Solid {
    common(8.0, vec![form(), above_base(0.0)])
}

fn inner() -> Solid {
    common(8.0, vec![grow(&form(), -WALL), above_base(WALL)])
}

/// Surfaces by name.
pub(super) fn structures() -> Vec<(&'static str, Solid)> {
    vec![
        ("braincase, outside", outer()),
        ("braincase, inside", inner()),
        ("skull base", shell()),
        ("spinal and ear canals", openings()),
    ]
}

/// The wall of the braincase with what grows on it.
pub(super) fn shell() -> Solid {
    let (outer, inner) = (outer(), inner());
    let mastoid = cone([51.0, 26.0, -36.0], 13.0, [49.0, 21.0, -60.0], 5.5);
    let petrous = cone([48.0, 16.0, -38.0], 10.0, [16.0, -6.0, -36.0], 6.0);
    let occipital_condyle = cone([13.0, 24.0, -50.0], 5.0, [9.0, 14.0, -51.0], 4.0);
    let styloid = cone([43.0, 18.0, -46.0], 2.8, [35.0, 8.0, -70.0], 1.4);
    let clivus = chain(
        &[
            ([0.0, 18.0, -47.0], 5.0),
            ([0.0, -10.0, -36.0], 7.0),
            ([0.0, -30.0, -34.0], 10.0),
        ],
        3.0,
    );
    let inion = cone([0.0, 88.0, -8.0], 5.0, [0.0, 80.0, -24.0], 4.0);
    let wall = cut(outer, inner, 2.0);
    blended(
        4.0,
        vec![
            wall,
            both_sides(union(vec![mastoid, petrous, occipital_condyle, styloid])),
            clivus,
            inion,
        ],
    )
}

/// Spinal cord and ear canals.
pub(super) fn openings() -> Solid {
    let cord = cone([0.0, 33.0, -36.0], 15.0, [0.0, 35.0, -70.0], 16.5);
    let ear = both_sides(cone([74.0, 8.0, -36.0], 4.5, [46.0, 6.0, -34.0], 3.0));
    union(vec![cord, ear])
}

/// A drilled hole through the wall, square to it.
pub(super) fn burr_hole() -> Solid {
    let out = [0.56, -0.44, 0.70];
    let along = |s: f64| std::array::from_fn(|i| BURR_ENTRY[i] + s * out[i]);
    rod(along(-18.0), along(18.0), BURR_RADIUS)
}
