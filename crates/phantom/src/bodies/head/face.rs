//! The face above the teeth: orbits, cheeks, nose, upper jaw and their air spaces.

use crate::shape::build::{
    Solid, ball, band, below, blended, block, both_sides, common, cone, cord, ellipsoid, plate,
    union,
};
use crate::vector::Vec3;

/// Centre of the left orbit's opening.
const ORBIT: Vec3 = [33.0, -82.0, -29.0];

/// Bone before the air spaces are taken out.
pub(super) fn solid() -> Solid {
    let upper_jaw = ellipsoid([0.0, -59.0, -57.0], [36.0, 26.0, 17.0]);
    let between_the_eyes = block([0.0, -60.0, -32.0], [15.0, 22.0, 18.0], 6.0);
    let brow = ellipsoid([0.0, -59.0, -2.0], [47.0, 27.0, 15.0]);
    let middle = blended(
        6.0,
        vec![
            blended(6.0, vec![upper_jaw, between_the_eyes]),
            upper_ridge(),
        ],
    );
    let sides = both_sides(blended(4.0, vec![cheek(), rim()]));
    blended(
        5.0,
        vec![
            blended(5.0, vec![middle, sides]),
            blended(6.0, vec![brow, nose()]),
        ],
    )
}

/// Surfaces by name.
pub(super) fn structures() -> Vec<(&'static str, Solid)> {
    vec![
        ("orbit", both_sides(orbit())),
        ("nasal cavity", nasal_cavity()),
        ("sinuses", sinuses()),
        ("face", solid()),
    ]
}

/// The bone that holds the upper teeth.
fn upper_ridge() -> Solid {
    let line = |z: f64, reach: f64| -> Vec<Vec3> {
        (-4..=4)
            .map(|i| {
                let angle = f64::from(i) / 4.0 * 1.45;
                [
                    (27.0 + reach) * angle.sin(),
                    -43.0 - (44.0 + reach) * angle.cos(),
                    z,
                ]
            })
            .collect()
    };
    let palate = plate(
        [
            [0.0, -84.0, -63.0],
            [24.0, -40.0, -63.0],
            [-24.0, -40.0, -63.0],
        ],
        2.0,
    );
    blended(
        3.0,
        vec![band(&line(-59.0, -2.5), &line(-69.5, 0.0), 5.4), palate],
    )
}

fn cheek() -> Solid {
    let bone = ellipsoid([45.5, -63.0, -51.0], [9.5, 9.0, 8.5]);
    let buttress = cone([42.0, -63.0, -55.0], 7.0, [29.0, -60.0, -65.0], 5.5);
    let front = band(
        &[
            [14.0, -81.0, -47.0],
            [27.0, -77.0, -51.0],
            [40.0, -70.0, -51.0],
        ],
        &[
            [15.0, -82.0, -64.0],
            [24.0, -73.0, -64.0],
            [29.0, -62.0, -64.0],
        ],
        2.6,
    );
    let arch = cord(&[
        [50.0, -61.0, -50.0, 6.0],
        [59.0, -47.0, -48.0, 4.4],
        [64.5, -29.0, -45.0, 3.5],
        [65.5, -12.0, -41.5, 3.4],
        [61.0, 5.0, -36.0, 5.0],
    ]);
    let arch_below = cord(&[
        [50.0, -61.0, -53.0, 5.0],
        [59.0, -47.0, -51.0, 3.4],
        [64.0, -29.0, -47.0, 2.9],
        [65.0, -14.0, -43.0, 2.9],
    ]);
    let wall = band(
        &[
            [50.0, -65.0, -47.0],
            [49.0, -67.0, -28.0],
            [48.0, -66.0, -8.0],
        ],
        &[
            [37.0, -38.0, -45.0],
            [38.0, -37.0, -28.0],
            [43.0, -36.0, -8.0],
        ],
        2.3,
    );
    blended(
        4.0,
        vec![
            blended(4.0, vec![bone, buttress, front]),
            union(vec![arch, arch_below]),
            wall,
        ],
    )
}

/// The rim of the orbit, brow included.
fn rim() -> Solid {
    let brow = cord(&[
        [6.0, -84.0, -14.0, 5.0],
        [18.0, -86.0, -9.0, 5.4],
        [33.0, -82.5, -6.5, 5.0],
        [46.0, -73.0, -11.0, 4.6],
        [51.0, -67.0, -20.0, 4.4],
        [51.0, -64.0, -32.0, 4.2],
        [49.0, -65.0, -44.0, 5.0],
    ]);
    let floor = cord(&[
        [49.0, -65.0, -44.0, 5.0],
        [38.0, -74.0, -49.0, 4.4],
        [25.0, -79.0, -49.5, 4.2],
        [15.0, -81.0, -43.0, 4.0],
        [11.0, -82.0, -30.0, 4.0],
        [10.0, -83.0, -18.0, 4.5],
    ]);
    union(vec![brow, floor])
}

fn nose() -> Solid {
    let bridge = plate(
        [
            [1.0, -84.0, -12.0],
            [1.2, -97.0, -37.0],
            [8.5, -85.0, -38.0],
        ],
        2.2,
    );
    let sides = cord(&[
        [8.0, -84.0, -22.0, 4.0],
        [11.0, -83.0, -40.0, 3.6],
        [15.5, -81.5, -54.0, 4.0],
        [12.0, -84.0, -65.0, 4.0],
    ]);
    let spine = cone([0.0, -84.0, -64.0], 3.0, [0.0, -93.0, -63.0], 1.2);
    blended(3.0, vec![both_sides(union(vec![bridge, sides])), spine])
}

/// What is taken out of the bone: orbits, nasal cavity, sinuses.
pub(super) fn openings() -> Solid {
    union(vec![both_sides(orbit()), nasal_cavity(), sinuses()])
}

/// The part of the openings that holds air, as far as the skin.
pub(super) fn air() -> Solid {
    let inside = below([0.0, -91.0, 0.0], [0.0, -1.0, 0.0]);
    union(vec![common(0.0, vec![nasal_cavity(), inside]), sinuses()])
}

fn orbit() -> Solid {
    let [x, y, z] = ORBIT;
    let apex: Vec3 = [19.0, -43.0, -27.0];
    let outer = cone([x + 3.5, y - 8.0, z + 1.0], 17.0, apex, 4.0);
    let inner = cone([x - 3.0, y - 12.0, z + 1.5], 16.5, apex, 4.0);
    let lower = cone([x + 1.5, y - 8.0, z - 2.0], 16.5, apex, 4.0);
    blended(3.0, vec![outer, inner, lower])
}

/// Pear-shaped in front, two passages behind.
fn nasal_cavity() -> Solid {
    let pear = union(vec![
        cone([0.0, -110.0, -41.0], 5.5, [0.0, -60.0, -38.0], 5.5),
        both_sides(cone([2.8, -110.0, -49.0], 7.0, [4.0, -40.0, -47.0], 7.0)),
        both_sides(cone([5.0, -110.0, -55.5], 7.0, [6.5, -24.0, -54.0], 7.5)),
    ]);
    let upper = block([0.0, -58.0, -34.0], [9.5, 16.0, 12.0], 3.0);
    blended(3.0, vec![pear, upper])
}

fn sinuses() -> Solid {
    let cheek = both_sides(ellipsoid([25.5, -61.0, -55.0], [9.5, 13.5, 8.0]));
    // The frontal sinus is larger on the patient's right.
    let front = union(vec![
        ellipsoid([-9.0, -79.0, -4.0], [9.0, 3.2, 6.0]),
        ellipsoid([6.0, -80.0, -6.0], [4.5, 3.0, 4.0]),
    ]);
    let sphenoid = union(vec![
        ball([5.0, -31.0, -35.0], 6.5),
        ball([-5.0, -29.0, -34.0], 5.0),
    ]);
    union(vec![cheek, front, sphenoid])
}

/// Thin bone set into the openings: septum, conchae, the plates behind the palate.
pub(super) fn partitions() -> Solid {
    // The septum leans to the patient's right.
    let septum = union(vec![
        plate(
            [
                [0.0, -84.0, -36.0],
                [-2.5, -76.0, -63.0],
                [0.0, -30.0, -36.0],
            ],
            0.9,
        ),
        plate(
            [
                [-2.5, -76.0, -63.0],
                [0.0, -30.0, -63.0],
                [0.0, -30.0, -36.0],
            ],
            0.9,
        ),
    ]);
    let concha = |z: f64, outside: f64, reach: f64| {
        cord(&[
            [outside, -76.0, z + 3.5, 1.2],
            [reach, -74.0, z, 1.4],
            [reach + 1.0, -50.0, z - 1.0, 1.4],
            [outside, -38.0, z + 2.5, 1.2],
        ])
    };
    let pterygoid = plate(
        [
            [13.0, -38.0, -44.0],
            [15.0, -28.0, -44.0],
            [15.0, -33.0, -70.0],
        ],
        1.8,
    );
    union(vec![
        septum,
        both_sides(union(vec![
            concha(-56.0, 14.0, 8.0),
            concha(-46.0, 11.5, 7.0),
            pterygoid,
        ])),
    ])
}
