//! The ring that `OpenCV` draws: a circle of radius 150 pixels, 10 pixels thick.

/// Whether the pixel `(x, y)` from the centre belongs to the ring.
pub(super) fn ring(x: i32, y: i32) -> bool {
    let d = f64::from(x * x + y * y).sqrt();
    (144.4..=155.3).contains(&d)
}
