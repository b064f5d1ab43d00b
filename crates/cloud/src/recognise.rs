//! Finds the lattice behind points that were written down in mm.
//!
//! A cloud in a file has lost its lattice, but for its coordinates: along each axis they are
//! whole steps apart. With the lattice, neighbours and spheres are decided exactly, ties are ties
//! again, and all of it is faster; without, the last bits of the coordinates would decide.

use bonemesh_volume::Affine;

use crate::{Lattice, PointCloud};

/// Distance of a point from its place on the lattice, as a part of a step, that is rounding.
const ROUNDING: f64 = 1e-6;
/// Steps along an axis that a lattice may have, which 15 bits hold.
const MOST_STEPS: f64 = 32_767.0;

impl PointCloud {
    /// The same points with their lattice, if they have one along the axes of their frame: all
    /// coordinates within a millionth of a step.
    ///
    /// The points themselves do not move. A lattice that is turned in its frame is not looked
    /// for.
    #[must_use]
    pub fn with_lattice_recognised(self) -> Self {
        if self.lattice().is_some() {
            return self;
        }
        let [Some(x), Some(y), Some(z)] = [0, 1, 2].map(|axis| Steps::of(self.points_mm(), axis))
        else {
            return self;
        };
        let place = |p: &[f64; 3]| [x.of_place(p[0]), y.of_place(p[1]), z.of_place(p[2])];
        let lattice = Lattice {
            coordinates: self.points_mm().iter().map(place).collect(),
            frame_from_lattice: Affine::from_axes(
                [x.length, 0.0, 0.0],
                [0.0, y.length, 0.0],
                [0.0, 0.0, z.length],
                [x.first, y.first, z.first],
            ),
        };
        self.on(lattice)
    }
}

/// Equal steps along one axis.
struct Steps {
    first: f64,
    length: f64,
}

impl Steps {
    /// The largest steps that lead to all coordinates.
    fn of(points_mm: &[[f64; 3]], axis: usize) -> Option<Self> {
        let mut values = distinct(points_mm, axis)?;
        values.sort_unstable_by(f64::total_cmp);
        let (&first, &last) = (values.first()?, values.last()?);
        let extent = last - first;
        if extent == 0.0 {
            return Some(Self { first, length: 1.0 });
        }
        let least = 0.5 * extent / MOST_STEPS;
        let gaps = values.windows(2).map(|pair| pair[1] - pair[0]);
        let gap = gaps.fold(extent, |common, gap| common_measure(common, gap, least));
        let count = (extent / gap).round();
        let steps = Self {
            first,
            length: extent / count,
        };
        let is_whole = |value: &f64| {
            let along = (value - first) / steps.length;
            (along - along.round()).abs() <= ROUNDING
        };
        (count <= MOST_STEPS && values.iter().all(is_whole)).then_some(steps)
    }

    fn of_place(&self, value: f64) -> i32 {
        ((value - self.first) / self.length).round() as i32
    }
}

/// The largest length that goes into both a whole number of times, but for less than `least`.
fn common_measure(mut a: f64, mut b: f64, least: f64) -> f64 {
    // Euclid's algorithm with the nearest multiple: the rest at least halves.
    while b >= least {
        (a, b) = (b, (a - (a / b).round() * b).abs());
    }
    a
}

/// The different coordinates along an axis; `None` if they are too many for a lattice.
fn distinct(points_mm: &[[f64; 3]], axis: usize) -> Option<Vec<f64>> {
    // Rounding may write each step in a few ways.
    let most = 8 * MOST_STEPS as usize;
    let mut seen = rustc_hash::FxHashSet::default();
    for point in points_mm {
        // Adding 0 makes -0 and 0 one coordinate.
        seen.insert((point[axis] + 0.0).to_bits());
        if seen.len() > most {
            return None;
        }
    }
    Some(seen.into_iter().map(f64::from_bits).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn recognised(points: &[[f64; 3]]) -> Option<Lattice> {
        let cloud = PointCloud::from_points(points.to_vec()).unwrap();
        let found = cloud.with_lattice_recognised();
        assert_eq!(found.points_mm(), points);
        found.lattice().cloned()
    }

    proptest! {
        #[test]
        fn pixel_centres_find_their_lattice(
            coordinates in prop::collection::vec([0..400i32, 0..300i32, 0..90i32], 2..200),
            spacing in [0.2..1.0f64, 0.2..1.0f64, 0.3..5.0f64],
            origin in prop::array::uniform3(-300.0..300.0f64),
        ) {
            let mm = |c: &[i32; 3]| [0, 1, 2].map(|k| origin[k] + f64::from(c[k]) * spacing[k]);
            let points: Vec<[f64; 3]> = coordinates.iter().map(mm).collect();
            let lattice = recognised(&points).unwrap();
            for (at, point) in lattice.coordinates.iter().zip(&points) {
                let place = lattice.frame_from_lattice.apply(at.map(f64::from));
                for k in 0..3 {
                    prop_assert!((place[k] - point[k]).abs() < 1e-5 * spacing[k]);
                }
            }
        }

        #[test]
        fn random_points_are_free(points in prop::collection::vec(prop::array::uniform3(0.0..9.0f64), 40..80)) {
            prop_assert_eq!(recognised(&points), None);
        }
    }

    #[test]
    fn a_moved_point_leaves_no_lattice() {
        let mut points: Vec<[f64; 3]> = (0..60)
            .map(|i| {
                [
                    f64::from(i % 5) * 0.5,
                    f64::from(i / 5 % 4) * 0.5,
                    f64::from(i / 20),
                ]
            })
            .collect();
        assert!(recognised(&points).is_some());
        points[7][1] += 1e-5;
        assert_eq!(recognised(&points), None);
    }
}
