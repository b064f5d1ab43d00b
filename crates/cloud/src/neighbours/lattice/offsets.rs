//! The steps from a lattice point to the others around it, by distance.

/// A step `(column, row, slice)` and its class: the number of shorter distances there are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Offset {
    pub(super) step: [i32; 3],
    pub(super) class: u16,
}

/// All steps within a ball, nearest first.
pub(super) struct Offsets {
    pub(super) nearest_first: Vec<Offset>,
    /// The distance (mm) of each class.
    pub(super) distances_mm: Vec<f64>,
}

impl Offsets {
    /// About `wanted` steps of the lattice with these `axes` (mm), or `None` where there is no
    /// handy ball: the axes lie in one plane, nearly so, or cannot be squared.
    pub(super) fn new(axes: [[f64; 3]; 3], wanted: usize) -> Option<Self> {
        let (radius, reach) = ball(axes, wanted)?;
        let [x, y, z] = reach;
        let mut found = Vec::new();
        for dz in -z..=z {
            for dy in -y..=y {
                for dx in -x..=x {
                    let squared = squared_length(axes, [dx, dy, dz]);
                    if squared <= radius * radius {
                        found.push((squared, [dx, dy, dz]));
                    }
                }
            }
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut nearest_first = Vec::with_capacity(found.len());
        let mut distances_mm: Vec<f64> = Vec::new();
        let mut last = f64::NEG_INFINITY;
        for (squared, step) in found {
            if squared > last {
                last = squared;
                distances_mm.push(squared.sqrt());
            }
            let class = u16::try_from(distances_mm.len() - 1).ok()?;
            nearest_first.push(Offset { step, class });
        }
        Some(Self {
            nearest_first,
            distances_mm,
        })
    }

    /// The longest step along each axis.
    pub(super) fn reach(&self) -> [i32; 3] {
        std::array::from_fn(|axis| {
            let steps = self.nearest_first.iter().map(|o| o.step[axis]);
            steps.max().unwrap_or(0)
        })
    }
}

fn squared_length(axes: [[f64; 3]; 3], step: [i32; 3]) -> f64 {
    let step = step.map(f64::from);
    (0..3)
        .map(|i| step[0] * axes[0][i] + step[1] * axes[1][i] + step[2] * axes[2][i])
        .map(|length| length * length)
        .sum()
}

/// The radius (mm) of a ball of `wanted` steps, and how many steps it holds along each axis.
fn ball(axes: [[f64; 3]; 3], wanted: usize) -> Option<(f64, [i32; 3])> {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let volume = dot(axes[0], cross(axes[1], axes[2])).abs();
    let radius = (wanted as f64 * volume * 0.75 / std::f64::consts::PI).cbrt();
    if !(radius * radius).is_normal() {
        return None;
    }
    // Along an axis the ball reaches as many steps as layers of the other two axes fit into it.
    let reach: [f64; 3] = std::array::from_fn(|axis| {
        let normal = cross(axes[(axis + 1) % 3], axes[(axis + 2) % 3]);
        (radius * dot(normal, normal).sqrt() / volume).floor()
    });
    let steps: f64 = reach.iter().map(|reach| 2.0 * reach + 1.0).product();
    (steps <= 32.0 * wanted as f64).then(|| (radius, reach.map(|reach| reach as i32)))
}
