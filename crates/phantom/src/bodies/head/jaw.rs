//! The lower jaw, a body of its own: a gap of at least 4 mm parts it from the skull.

use crate::shape::build::{Solid, band, blended, both_sides, cone, cord, union};
use crate::vector::Vec3;

/// Middle of the left condyle.
pub(super) const CONDYLE: Vec3 = [52.0, -4.0, -49.0];
/// Foremost point of the chin, in the midline.
pub(super) const CHIN: Vec3 = [0.0, -93.0, -117.0];

pub(super) fn jaw() -> Solid {
    both_sides(blended(3.0, vec![body(), ramus(), chin()]))
}

fn body() -> Solid {
    let upper = [
        [0.0, -84.0, -97.0],
        [11.0, -81.0, -97.0],
        [19.5, -71.0, -97.0],
        [24.5, -57.0, -96.5],
        [29.0, -42.0, -95.0],
        [37.0, -32.0, -88.0],
    ];
    let lower = [
        [0.0, -85.0, -117.0],
        [13.0, -82.0, -117.0],
        [25.0, -70.0, -115.5],
        [33.0, -53.0, -112.0],
        [40.0, -35.0, -108.0],
        [45.0, -20.0, -102.0],
    ];
    let base: Vec<[f64; 4]> = lower.iter().map(|p| [p[0], p[1], p[2], 5.4]).collect();
    blended(4.0, vec![band(&upper, &lower, 4.6), cord(&base)])
}

fn ramus() -> Solid {
    let front = [
        [37.0, -32.0, -88.0],
        [42.0, -32.0, -74.0],
        [45.5, -31.0, -56.0],
    ];
    let back = [
        [45.5, -14.0, -101.0],
        [47.5, -7.0, -80.0],
        [48.5, -4.0, -60.0],
    ];
    // The notch between coronoid process and neck stays open.
    let sheet = band(&front[..2], &back[..2], 3.2);
    let coronoid = cone(front[1], 3.8, front[2], 2.6);
    let root = band(
        &[front[1], [45.0, -28.0, -66.0]],
        &[back[1], [48.0, -9.0, -66.0]],
        2.8,
    );
    let neck = cone(back[1], 4.0, [51.0, -4.5, -54.0], 3.6);
    let head = cone([48.0, -3.0, -49.0], 4.0, [56.0, -5.0, -49.0], 4.0);
    let angle = cone(back[0], 4.8, back[1], 4.0);
    let flat = union(vec![sheet, root]);
    blended(
        3.0,
        vec![flat, blended(3.0, vec![coronoid, neck, head]), angle],
    )
}

fn chin() -> Solid {
    cone([0.0, -87.0, -116.0], 6.0, [9.0, -85.5, -116.5], 5.0)
}
