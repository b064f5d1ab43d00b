//! Sums of three coordinates, rounded as doubles are, for whoever measures on meshes.

/// Three coordinates, or a direction.
pub type Vector = [f64; 3];

/// `a - b`
#[inline]
pub fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + factor * b`
#[inline]
pub fn plus_scaled(a: Vector, factor: f64, b: Vector) -> Vector {
    [0, 1, 2].map(|axis| a[axis] + factor * b[axis])
}

/// Scalar product.
#[inline]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
#[inline]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The length of a vector.
#[inline]
pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The same direction with the length 1; `None` if there is no direction.
#[inline]
pub fn unit(a: Vector) -> Option<Vector> {
    let length = length(a);
    (length > 0.0 && length.is_finite()).then(|| a.map(|component| component / length))
}

/// [`unit()`], or nothing at all where there is no direction.
#[inline]
pub fn unit_or_zero(a: Vector) -> Vector {
    unit(a).unwrap_or_default()
}
