//! Affine maps between index space and millimetres.

/// An affine map of 3D space: linear part and translation, rows of the upper 3x4 matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine([[f64; 4]; 3]);

impl Affine {
    /// The map that takes `(1,0,0)` to `origin + x_axis`, and so on.
    pub fn from_axes(
        x_axis: [f64; 3],
        y_axis: [f64; 3],
        z_axis: [f64; 3],
        origin: [f64; 3],
    ) -> Self {
        Self(std::array::from_fn(|r| {
            [x_axis[r], y_axis[r], z_axis[r], origin[r]]
        }))
    }

    /// A map from the upper three rows of a 4x4 matrix.
    pub fn from_rows(rows: [[f64; 4]; 3]) -> Self {
        Self(rows)
    }

    /// The full 4x4 matrix, row by row.
    pub fn matrix(&self) -> [[f64; 4]; 4] {
        let [a, b, c] = self.0;
        [a, b, c, [0.0, 0.0, 0.0, 1.0]]
    }

    /// The image of a point.
    pub fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        self.0
            .map(|r| r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3])
    }

    /// The image of a direction (no translation).
    pub fn apply_vector(&self, v: [f64; 3]) -> [f64; 3] {
        self.0.map(|r| r[0] * v[0] + r[1] * v[1] + r[2] * v[2])
    }

    /// Column `axis` (0, 1, 2) of the linear part: one index step along that axis.
    pub fn axis(&self, axis: usize) -> [f64; 3] {
        self.0.map(|r| r[axis])
    }

    /// The image of the origin.
    pub fn origin(&self) -> [f64; 3] {
        self.0.map(|r| r[3])
    }

    /// Length of one index step along each axis.
    pub fn spacing(&self) -> [f64; 3] {
        std::array::from_fn(|i| {
            let a = self.axis(i);
            dot(a, a).sqrt()
        })
    }

    /// Gram matrix of the axes: the metric that index space inherits from millimetres.
    pub fn gram(&self) -> [[f64; 3]; 3] {
        std::array::from_fn(|i| std::array::from_fn(|j| dot(self.axis(i), self.axis(j))))
    }

    /// Determinant of the linear part; negative when the axes are left-handed.
    pub fn determinant(&self) -> f64 {
        let (x, y, z) = (self.axis(0), self.axis(1), self.axis(2));
        dot(x, cross(y, z))
    }

    /// The inverse map, or `None` where space is flattened.
    pub fn inverse(&self) -> Option<Self> {
        let det = self.determinant();
        let (x, y, z) = (self.axis(0), self.axis(1), self.axis(2));
        let rows = [cross(y, z), cross(z, x), cross(x, y)].map(|r| r.map(|v| v / det));
        let o = self.origin();
        let rows = rows.map(|r| [r[0], r[1], r[2], -dot(r, o)]);
        rows.iter()
            .flatten()
            .all(|v| v.is_finite())
            .then_some(Self(rows))
    }

    /// The same map after index space was shifted: the new `(0,0,0)` is the old `start`.
    #[must_use]
    pub fn shifted(&self, start: [f64; 3]) -> Self {
        let o = self.apply(start);
        Self(std::array::from_fn(|r| {
            [self.0[r][0], self.0[r][1], self.0[r][2], o[r]]
        }))
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
#[allow(
    clippy::float_cmp,
    reason = "the numbers are chosen so that no step rounds"
)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_inverse_undoes_the_map(
            m in proptest::array::uniform12(-3.0..3.0f64),
            p in proptest::array::uniform3(-100.0..100.0f64),
        ) {
            let affine = Affine::from_rows([
                [m[0], m[1], m[2], m[3]],
                [m[4], m[5], m[6], m[7]],
                [m[8], m[9], m[10], m[11]],
            ]);
            prop_assume!(affine.determinant().abs() > 0.1);
            let back = affine.inverse().unwrap().apply(affine.apply(p));
            for (b, a) in back.into_iter().zip(p) {
                prop_assert!((b - a).abs() < 1e-7);
            }
        }
    }

    #[test]
    fn a_flat_map_has_no_inverse() {
        let flat = Affine::from_axes([1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        assert!(flat.inverse().is_none());
    }

    #[test]
    fn swapping_two_axes_changes_the_hand() {
        let (x, y, z) = ([0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 2.0]);
        assert!(Affine::from_axes(x, y, z, [0.0; 3]).determinant() > 0.0);
        assert!(Affine::from_axes(y, x, z, [0.0; 3]).determinant() < 0.0);
    }
}
