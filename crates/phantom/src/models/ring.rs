//! The ring that `OpenCV` draws: a circle of radius 150 pixels, 10 pixels thick.
//!
//! A pixel belongs to the ring if its squared distance from the centre lies between two bounds,
//! the ones that come nearest to `OpenCV`'s ring. That drawing is the outline of a polygon in
//! thick strokes and differs from a round ring by 112 pixels at its rims; they are listed.

/// Smallest and largest squared distance from the centre, pixels.
const SQUARED: std::ops::RangeInclusive<i32> = 20_843..=24_148;

/// Whether the pixel `(x, y)` from the centre belongs to the ring.
pub(super) fn ring(x: i32, y: i32) -> bool {
    let round = SQUARED.contains(&(x * x + y * y));
    let differs = POLYGON
        .binary_search_by_key(&y, |(row, _)| *row)
        .is_ok_and(|i| POLYGON[i].1.contains(&x));
    round != differs
}

/// Pixels in which the polygon differs from the round ring: row, columns.
const POLYGON: &[(i32, &[i32])] = &[
    (-152, &[32]),
    (-150, &[-41]),
    (-149, &[44]),
    (-145, &[-56, 56]),
    (-144, &[-11, 11]),
    (-139, &[39]),
    (-138, &[-71]),
    (-137, &[-73]),
    (-136, &[-75]),
    (-135, &[-51, 77]),
    (-133, &[-56, 56]),
    (-130, &[-63]),
    (-129, &[-65]),
    (-128, &[-67]),
    (-122, &[-77]),
    (-119, &[-100, 100]),
    (-116, &[86]),
    (-113, &[90]),
    (-112, &[-91]),
    (-106, &[-98, 98]),
    (-105, &[-99, 99]),
    (-100, &[-119, 119]),
    (-97, &[-121, -107, 107, 121]),
    (-96, &[-122, -108, 108, 122]),
    (-92, &[-125, 125]),
    (-91, &[-112, 112]),
    (-77, &[-122, 122]),
    (-75, &[-136, 136]),
    (-63, &[-142, -130, 130, 142]),
    (-58, &[-144, 144]),
    (-56, &[-133, 133]),
    (-51, &[-135, 135]),
    (-41, &[-150, 150]),
    (-11, &[-144, 144]),
    (11, &[-144, 144]),
    (39, &[-139, 139]),
    (44, &[-149, 149]),
    (51, &[-135, 135]),
    (56, &[-133, 133]),
    (63, &[-142, 142]),
    (77, &[-135, -122, 122, 135]),
    (86, &[-116, 116]),
    (96, &[-122, 122]),
    (97, &[-107, 107]),
    (100, &[-119, 119]),
    (105, &[-99, 99]),
    (106, &[-98, 98]),
    (112, &[-91]),
    (113, &[90]),
    (116, &[86]),
    (119, &[-100, 100]),
    (122, &[-77]),
    (128, &[-67]),
    (129, &[-65]),
    (130, &[-63]),
    (133, &[-56, 56]),
    (135, &[-51, 77]),
    (136, &[-75]),
    (137, &[-73]),
    (138, &[-71]),
    (139, &[39]),
    (144, &[-11, 11]),
    (145, &[-56, 56]),
    (149, &[44]),
    (150, &[-41]),
    (152, &[32]),
];
