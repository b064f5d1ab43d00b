//! Two rows of teeth; the patient's right upper canine is missing.

use crate::shape::build::{Solid, blended, cone, turned_block, union};
use crate::vector::{Vec3, add, scale};

/// Half of an ellipse on which a row of teeth stands, and the heights of gum and cutting edge.
struct Row {
    half_width: f64,
    depth: f64,
    back_y: f64,
    gum_z: f64,
    edge_z: f64,
    root: f64,
    /// Widths along the row from the middle, one side.
    widths: [f64; 7],
}

const UPPER: Row = Row {
    half_width: 27.5,
    depth: 45.0,
    back_y: -43.5,
    gum_z: -73.0,
    edge_z: -83.0,
    root: 11.0,
    widths: [8.4, 6.6, 7.6, 7.0, 6.8, 10.0, 9.4],
};
const LOWER: Row = Row {
    half_width: 25.0,
    depth: 43.0,
    back_y: -43.0,
    gum_z: -96.5,
    edge_z: -87.0,
    root: -11.0,
    widths: [5.5, 6.0, 6.9, 7.0, 7.1, 10.6, 10.0],
};

/// Place in the row of the tooth that is missing (upper, patient's right).
const MISSING: usize = 2;

pub(super) fn teeth() -> Solid {
    let mut parts = Vec::new();
    for (row, upper) in [(&UPPER, true), (&LOWER, false)] {
        for side in [1.0, -1.0] {
            for number in 0..row.widths.len() {
                if !(upper && side < 0.0 && number == MISSING) {
                    parts.push(tooth(row, side, number));
                }
            }
        }
    }
    union(parts)
}

pub(super) fn count() -> usize {
    UPPER.widths.len() * 2 + LOWER.widths.len() * 2 - 1
}

/// Where the crown of the missing tooth would be.
pub(super) fn missing() -> Vec3 {
    let (foot, _) = place(&UPPER, -1.0, MISSING);
    [foot[0], foot[1], f64::midpoint(UPPER.gum_z, UPPER.edge_z)]
}

/// Middle of a tooth at the gum, and the direction along the row there.
fn place(row: &Row, side: f64, number: usize) -> (Vec3, Vec3) {
    let before: f64 = row.widths[..number].iter().sum();
    let wanted = before + row.widths[number] / 2.0;
    // Walk along the ellipse in small steps until the arc is long enough.
    let at = |angle: f64| [row.half_width * angle.sin(), -row.depth * angle.cos()];
    let (mut angle, mut arc) = (0.0, 0.0);
    let step = 1e-3;
    while arc < wanted {
        let (p, q) = (at(angle), at(angle + step));
        arc += (q[0] - p[0]).hypot(q[1] - p[1]);
        angle += step;
    }
    let p = at(angle);
    let along = [
        side * row.half_width * angle.cos(),
        row.depth * angle.sin(),
        0.0,
    ];
    let foot = [side * p[0], row.back_y + p[1], row.gum_z];
    (foot, crate::vector::unit(along))
}

fn tooth(row: &Row, side: f64, number: usize) -> Solid {
    let (foot, along) = place(row, side, number);
    let across = [along[1], -along[0], 0.0];
    let down = (row.edge_z - row.gum_z).signum();
    let tall = (row.edge_z - row.gum_z).abs() - if number > 3 { 2.0 } else { 0.0 };
    let width = row.widths[number];
    let thick = [6.0, 6.0, 7.2, 7.8, 8.0, 9.6, 9.4][number];
    let crown = turned_block(
        add(foot, [0.0, 0.0, down * tall / 2.0]),
        [along, across, [0.0, 0.0, 1.0]],
        [width / 2.0 - 0.25, thick / 2.0 - 0.6, tall / 2.0],
        2.2,
    );
    let tip = scale([0.0, 0.0, row.root], 1.0);
    let root = cone(foot, width * 0.3, add(foot, tip), 1.2);
    blended(1.5, vec![crown, root])
}
