//! The face above the teeth: orbits, cheeks, nose, upper jaw and their air spaces.

use crate::shape::build::{
    Solid, ball, band, below, blended, block, both_sides, chain, common, cone, ellipsoid, plate,
    union,
};
use crate::vector::Vec3;

/// Centre of the left orbit's opening.
const ORBIT: Vec3 = [33.0, -82.0, -29.0];

/// Bone before the air spaces are taken out.
pub(super) fn solid() -> Solid {
    let upper_jaw = ellipsoid([0.0, -60.0, -58.0], [33.0, 27.0, 16.0]);
    let between_the_eyes = block([0.0, -62.0, -32.0], [15.0, 21.0, 18.0], 6.0);
    let middle = blended(6.0, vec![upper_jaw, between_the_eyes, upper_ridge()]);
    blended(
        4.0,
        vec![middle, both_sides(cheek()), both_sides(rim()), nose()],
    )
}

/// The bone that holds the upper teeth.
fn upper_ridge() -> Solid {
    let line: Vec<Vec3> = (-6..=6)
        .map(|i| {
            let angle = f64::from(i) / 6.0 * 1.45;
            [27.0 * angle.sin(), -43.0 - 44.0 * angle.cos(), -62.0]
        })
        .collect();
    let lower: Vec<Vec3> = line.iter().map(|p| [p[0], p[1], -69.0]).collect();
    let palate = plate(
        [
            [0.0, -84.0, -62.0],
            [24.0, -42.0, -62.0],
            [-24.0, -42.0, -62.0],
        ],
        2.0,
    );
    blended(3.0, vec![band(&line, &lower, 5.2, 0.0), palate])
}

fn cheek() -> Solid {
    let bone = ellipsoid([45.0, -63.0, -51.0], [10.0, 10.0, 9.0]);
    let root = cone([40.0, -66.0, -55.0], 8.0, [30.0, -64.0, -62.0], 6.0);
    let arch = chain(
        &[
            ([50.0, -60.0, -49.0], 5.5),
            ([60.0, -44.0, -47.0], 3.6),
            ([65.0, -26.0, -44.0], 3.0),
            ([65.5, -10.0, -41.0], 3.0),
            ([61.0, 6.0, -36.0], 4.5),
        ],
        2.0,
    );
    let wall = union(vec![
        plate(
            [
                [50.0, -66.0, -40.0],
                [50.0, -68.0, -18.0],
                [34.0, -42.0, -26.0],
            ],
            2.0,
        ),
        plate(
            [
                [50.0, -66.0, -40.0],
                [34.0, -42.0, -26.0],
                [34.0, -42.0, -40.0],
            ],
            2.0,
        ),
    ]);
    blended(4.0, vec![bone, root, arch, wall])
}

/// The rim of the orbit, brow included.
fn rim() -> Solid {
    let brow = chain(
        &[
            ([8.0, -84.0, -12.0], 5.5),
            ([20.0, -86.5, -8.5], 5.0),
            ([34.0, -83.0, -6.5], 4.6),
            ([47.0, -73.0, -11.0], 4.4),
            ([51.0, -67.0, -20.0], 4.4),
            ([51.0, -64.0, -32.0], 4.0),
            ([49.0, -65.0, -44.0], 5.0),
        ],
        3.0,
    );
    let floor = chain(
        &[
            ([49.0, -65.0, -44.0], 5.0),
            ([38.0, -74.0, -49.0], 4.4),
            ([25.0, -79.0, -49.5], 4.2),
            ([15.0, -81.0, -43.0], 4.0),
            ([11.0, -82.0, -30.0], 4.0),
        ],
        3.0,
    );
    blended(3.0, vec![brow, floor])
}

fn nose() -> Solid {
    let bridge = plate(
        [
            [1.5, -85.0, -14.0],
            [1.5, -98.0, -36.0],
            [8.5, -85.0, -36.0],
        ],
        2.2,
    );
    let sides = cone([9.0, -84.0, -26.0], 4.0, [16.0, -80.0, -56.0], 5.0);
    let spine = cone([0.0, -86.0, -62.0], 2.6, [0.0, -92.0, -62.0], 1.2);
    blended(2.5, vec![both_sides(union(vec![bridge, sides])), spine])
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
    let upper_outer = cone(
        [x + 4.0, y - 10.0, z + 1.5],
        17.0,
        [19.0, -42.0, -26.0],
        4.0,
    );
    let upper_inner = cone(
        [x - 3.0, y - 14.0, z + 1.0],
        16.0,
        [19.0, -42.0, -26.0],
        4.0,
    );
    let lower = cone(
        [x + 2.0, y - 10.0, z - 3.0],
        16.0,
        [19.0, -42.0, -28.0],
        4.0,
    );
    blended(3.0, vec![upper_outer, upper_inner, lower])
}

fn nasal_cavity() -> Solid {
    let pear = blended(
        5.0,
        vec![
            cone([0.0, -110.0, -40.0], 6.0, [0.0, -60.0, -36.0], 6.0),
            both_sides(cone([5.5, -110.0, -55.0], 6.5, [7.0, -24.0, -54.0], 7.5)),
        ],
    );
    let upper = block([0.0, -58.0, -34.0], [9.5, 16.0, 12.0], 3.0);
    blended(3.0, vec![pear, upper])
}

fn sinuses() -> Solid {
    let cheek = both_sides(ellipsoid([25.5, -61.0, -56.0], [9.5, 15.0, 9.0]));
    // The frontal sinus is larger on the patient's right.
    let front = blended(
        2.0,
        vec![
            ellipsoid([-9.0, -80.0, -4.0], [9.0, 3.5, 7.0]),
            ball([6.0, -81.0, -7.0], 3.5),
        ],
    );
    union(vec![cheek, front])
}

/// Thin bone set into the openings: septum, conchae, the plates behind the palate.
pub(super) fn partitions() -> Solid {
    // The septum leans to the patient's right.
    let septum = union(vec![
        plate(
            [
                [0.0, -88.0, -36.0],
                [-2.5, -74.0, -62.0],
                [0.0, -30.0, -36.0],
            ],
            0.9,
        ),
        plate(
            [
                [-2.5, -74.0, -62.0],
                [0.0, -30.0, -62.0],
                [0.0, -30.0, -36.0],
            ],
            0.9,
        ),
    ]);
    let concha = |z: f64, reach: f64| {
        chain(
            &[
                ([13.5, -78.0, z + 3.0], 1.1),
                ([reach, -76.0, z], 1.3),
                ([reach + 1.0, -50.0, z - 1.0], 1.3),
                ([12.0, -36.0, z + 2.0], 1.1),
            ],
            1.0,
        )
    };
    let pterygoid = plate(
        [
            [13.0, -38.0, -44.0],
            [15.0, -28.0, -44.0],
            [15.0, -33.0, -70.0],
        ],
        1.6,
    );
    union(vec![
        septum,
        both_sides(union(vec![
            concha(-54.0, 8.0),
            concha(-43.0, 7.0),
            pterygoid,
        ])),
    ])
}
