//! The order of a volume's axes that its voxels alone decide.
//!
//! The same voxels can be stored head to feet or feet to head, turned because the patient lay on
//! the side, or cut into sagittal slices. What is worked out slice by slice must not depend on
//! that, so the axes are put into one order first:
//!
//! 1. Each axis belongs to the patient's axis it lies nearest to, and counts to the left, the
//!    back or the head.
//! 2. Slices are counted along the axis with the longest step: the other two resolve most in
//!    their plane. Where no step is longest, along the axis that runs to the head.
//! 3. Of the other two, columns come first in the order left, back, head.

use std::borrow::Cow;

use bonemesh_task::{Cancelled, Task};
use ndarray::parallel::prelude::*;
use ndarray::{Array3, ArrayView2, ArrayView3, ArrayViewMut2, Axis};

use crate::{Affine, Geometry, Volume, Voxels};

/// Steps whose lengths differ by less than this part are equally long: scanners round them.
const SAME_STEP: f64 = 0.01;

/// Cosines are compared in whole multiples of this, so that rounding decides nothing.
const COSINE: f64 = 1e-6;

/// Side of the squares that are copied at a time: as many 16-bit voxels as a line of the
/// processor's cache holds, so that of each line that is read or written all is used at once.
const TILE: usize = 32;

/// Every way to give three axes to the patient's three.
const ASSIGNMENTS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
];

/// A stored axis: 0 column, 1 row, 2 slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Counted {
    axis: usize,
    backwards: bool,
}

/// What become columns, rows and slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct AxisOrder([Counted; 3]);

impl AxisOrder {
    fn of(affine: &Affine) -> Self {
        let steps = affine.spacing();
        let toward = |axis: usize| affine.axis(axis).map(|c| c / steps[axis]);
        let assigned = assigned([toward(0), toward(1), toward(2)]);
        let [left, back, head] = std::array::from_fn(|patient| Counted {
            axis: assigned[patient],
            backwards: toward(assigned[patient])[patient] < 0.0,
        });
        let longest = |a: Counted, b: Counted, c: Counted| {
            steps[a.axis] > (1.0 + SAME_STEP) * steps[b.axis].max(steps[c.axis])
        };
        Self(if longest(left, back, head) {
            [back, head, left]
        } else if longest(back, left, head) {
            [left, head, back]
        } else {
            [left, back, head]
        })
    }

    /// Whether the stored order is this one already.
    fn is_stored(self) -> bool {
        let is = |(new, counted): (usize, &Counted)| new == counted.axis && !counted.backwards;
        self.0.iter().enumerate().all(is)
    }
}

/// The axis nearest to each of the patient's axes: the three cosines are largest in sum. Turned
/// by half a right angle two sums are equal; then the directions themselves decide.
pub(crate) fn assigned(directions: [[f64; 3]; 3]) -> [usize; 3] {
    let whole = |cosine: f64| (cosine / COSINE).round() as i64;
    let key = |axes: &[usize; 3]| {
        let cosine = |patient: usize| directions[axes[patient]][patient];
        let nearness: f64 = (0..3).map(|patient| cosine(patient).abs()).sum();
        let ahead = |patient: usize, side: usize| {
            whole(cosine(patient).signum() * directions[axes[patient]][side])
        };
        [whole(nearness), ahead(0, 1), ahead(0, 2), ahead(1, 2)]
    };
    let best = ASSIGNMENTS.iter().max_by_key(|axes| key(axes));
    *best.expect("there are six assignments; otherwise this is a bug")
}

impl Geometry {
    fn reordered(&self, order: AxisOrder) -> Self {
        let [slices, rows, columns] = self.shape();
        let stored = [columns, rows, slices];
        let affine = self.patient_from_voxel();
        let mut corner = [0.0; 3];
        for counted in order.0.iter().filter(|c| c.backwards) {
            corner[counted.axis] = (stored[counted.axis] - 1) as f64;
        }
        let [x, y, z] = order.0.map(|c| {
            let sign = if c.backwards { -1.0 } else { 1.0 };
            affine.axis(c.axis).map(|v| sign * v)
        });
        let [columns, rows, slices] = order.0.map(|c| stored[c.axis]);
        let turned = Affine::from_axes(x, y, z, affine.apply(corner));
        let geometry = Self::new([slices, rows, columns], turned)
            .expect("turning a sound grid leaves it sound; otherwise this is a bug");
        let slice = order.0[2];
        if slice.axis != 2 {
            return geometry;
        }
        let location = |index: f64| self.image_from_voxel().apply([0.0, 0.0, index])[2];
        let first = location(corner[2]);
        let next = if slice.backwards {
            corner[2] - 1.0
        } else {
            1.0
        };
        geometry.with_slice_locations_mm(first, location(next) - first)
    }
}

impl Volume {
    /// The same voxels at the same places, in the one order of axes that does not depend on how
    /// they were stored; a copy only where the stored order is another.
    ///
    /// Columns run to the patient's left, rows to the back and slices to the head, each as nearly
    /// as the grid allows. Where one of the three steps is longer than the others by more than
    /// 1 %, slices are counted along it instead (thick sagittal slices stay slices): then columns
    /// and rows are the other two in the order left, back, head. Nothing is resampled.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn in_patient_order(&self, task: &Task) -> Result<Cow<'_, Self>, Cancelled> {
        let order = AxisOrder::of(self.geometry.patient_from_voxel());
        if order.is_stored() {
            return Ok(Cow::Borrowed(self));
        }
        let voxels = match &self.voxels {
            Voxels::I16(hu) => Voxels::I16(reordered(hu, order, task)?),
            Voxels::F32(hu) => Voxels::F32(reordered(hu, order, task)?),
        };
        let geometry = self.geometry.reordered(order);
        Ok(Cow::Owned(Self { voxels, geometry }))
    }
}

fn reordered<T>(stored: &Array3<T>, order: AxisOrder, task: &Task) -> Result<Array3<T>, Cancelled>
where
    T: Copy + Default + Send + Sync,
{
    let [columns, rows, slices] = order.0;
    // Arrays count their axes the other way round: slices come first.
    let mut view: ArrayView3<'_, T> =
        stored
            .view()
            .permuted_axes([2 - slices.axis, 2 - rows.axis, 2 - columns.axis]);
    for (axis, counted) in [slices, rows, columns].into_iter().enumerate() {
        if counted.backwards {
            view.invert_axis(Axis(axis));
        }
    }
    let mut turned = Array3::from_elem(view.dim(), T::default());
    turned
        .axis_chunks_iter_mut(Axis(0), TILE)
        .into_par_iter()
        .zip(view.axis_chunks_iter(Axis(0), TILE))
        .try_for_each(|(mut into, from)| {
            // The plane in which stored columns turn into new ones lies along the other axis.
            let other = Axis(usize::from(slices.axis == 0));
            for (mut into, from) in into.axis_iter_mut(other).zip(from.axis_iter(other)) {
                task.check()?;
                if columns.axis == 0 {
                    into.assign(&from);
                } else {
                    copy_by_tiles(&mut into, &from);
                }
            }
            Ok(())
        })?;
    Ok(turned)
}

/// Copies a plane whose columns are stored far apart and its rows next to each other.
fn copy_by_tiles<T: Copy>(into: &mut ArrayViewMut2<'_, T>, from: &ArrayView2<'_, T>) {
    let (rows, columns) = (Axis(0), Axis(1));
    for (mut into, from) in into
        .axis_chunks_iter_mut(rows, TILE)
        .zip(from.axis_chunks_iter(rows, TILE))
    {
        for (mut into, from) in into
            .axis_chunks_iter_mut(columns, TILE)
            .zip(from.axis_chunks_iter(columns, TILE))
        {
            into.assign(&from);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A grid whose axis `a` runs along the patient's axis `axes[a]`, forwards or backwards, with
    /// `steps` and `counts` by patient axis; the voxels tell themselves apart.
    fn stored(
        axes: [usize; 3],
        backwards: [bool; 3],
        steps: [[f64; 3]; 3],
        counts: [usize; 3],
    ) -> Volume {
        let mut origin = [-40.0, 7.0, 300.0];
        let [x, y, z] = [0, 1, 2].map(|a| {
            let step = steps[axes[a]];
            if !backwards[a] {
                return step;
            }
            let last = (counts[axes[a]] - 1) as f64;
            origin = std::array::from_fn(|c| origin[c] + last * step[c]);
            step.map(|v| -v)
        });
        let shape = [counts[axes[2]], counts[axes[1]], counts[axes[0]]];
        let hu = Array3::from_shape_fn(shape, |(k, j, i)| {
            let mut at = [0; 3];
            for (a, index) in [i, j, k].into_iter().enumerate() {
                let last = counts[axes[a]] - 1;
                at[axes[a]] = if backwards[a] { last - index } else { index };
            }
            (5041 * at[2] + 71 * at[1] + at[0]) as i16
        });
        let geometry = Geometry::new(shape, Affine::from_axes(x, y, z, origin)).unwrap();
        Volume::new(Voxels::I16(hu), geometry).unwrap()
    }

    fn ordered(volume: &Volume) -> Volume {
        volume
            .in_patient_order(&Task::default())
            .unwrap()
            .into_owned()
    }

    fn upright(x: f64, y: f64, z: f64) -> [[f64; 3]; 3] {
        [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
    }

    fn hu(volume: &Volume) -> &Array3<i16> {
        let Voxels::I16(hu) = volume.voxels() else {
            unreachable!()
        };
        hu
    }

    fn near(a: [f64; 3], b: [f64; 3]) -> bool {
        (0..3).all(|c| (a[c] - b[c]).abs() < 1e-9)
    }

    #[test]
    fn an_ordinary_series_is_not_copied() {
        for z in [0.4, 0.7, 2.0] {
            let volume = stored([0, 1, 2], [false; 3], upright(0.7, 0.7, z), [5, 4, 3]);
            let same = volume.in_patient_order(&Task::default()).unwrap();
            assert!(matches!(same, Cow::Borrowed(_)), "{z}");
        }
    }

    #[test]
    fn thick_slices_stay_slices_and_cubes_are_cut_across_the_body() {
        // Sagittal: columns to the back, rows to the feet, slices to the right.
        let (axes, backwards) = ([1, 2, 0], [false, true, true]);
        let thick = ordered(&stored(axes, backwards, upright(3.0, 0.5, 0.5), [6, 5, 4]));
        assert_eq!(thick.geometry().shape(), [6, 4, 5]);
        let affine = thick.geometry().patient_from_voxel();
        assert!(near(affine.axis(0), [0.0, 0.5, 0.0]));
        assert!(near(affine.axis(1), [0.0, 0.0, 0.5]));
        assert!(near(affine.axis(2), [3.0, 0.0, 0.0]));
        let cubes = ordered(&stored(
            axes,
            backwards,
            upright(0.5, 0.5, 0.502),
            [6, 5, 4],
        ));
        assert_eq!(cubes.geometry().shape(), [4, 5, 6]);
        assert!(near(
            cubes.geometry().patient_from_voxel().axis(2),
            [0.0, 0.0, 0.502]
        ));
    }

    #[test]
    fn slice_locations_follow_their_slices() {
        let volume = stored(
            [0, 1, 2],
            [true, false, true],
            upright(0.5, 0.5, 2.0),
            [5, 4, 3],
        );
        let (voxels, geometry) = volume.into_parts();
        let geometry = geometry.with_slice_locations_mm(10.0, -2.5);
        let turned = ordered(&Volume::new(voxels, geometry).unwrap());
        let z = |k| turned.geometry().image_from_voxel().apply([0.0, 0.0, k])[2];
        assert!((z(0.0) - 5.0).abs() < 1e-12 && (z(2.0) - 10.0).abs() < 1e-12);
    }

    #[test]
    fn cancelling_stops_the_copy() {
        let task = Task::default();
        task.cancel().cancel();
        let volume = stored(
            [0, 1, 2],
            [true, false, false],
            upright(0.5, 0.5, 2.0),
            [5, 4, 3],
        );
        assert_eq!(volume.in_patient_order(&task), Err(Cancelled));
    }

    proptest! {
        #[test]
        fn every_storage_of_the_same_voxels_comes_to_one_order(
            assignment in 0..6_usize,
            backwards in proptest::array::uniform3(proptest::bool::ANY),
            steps in proptest::array::uniform3(prop_oneof![Just(0.5), Just(0.502), Just(0.7), Just(2.0)]),
            counts in proptest::array::uniform3(1..9_usize),
            // Mostly a corner of a tile, sometimes several tiles.
            longest in prop_oneof![4 => Just(None), 1 => (0..3_usize, 30..70_usize).prop_map(Some)],
            // Turned about the head-feet axis, also by half a right angle, and sheared by a tilt.
            turn in prop_oneof![Just(0.0), Just(45.0), Just(-30.0)],
            tilt in prop_oneof![Just(0.0), Just(20.0)],
        ) {
            let mut counts = counts;
            if let Some((axis, count)) = longest {
                counts[axis] = count;
                counts[(axis + 1) % 3] = count - 3;
            }
            let (s, c) = f64::to_radians(turn).sin_cos();
            let (ts, tc) = f64::to_radians(tilt).sin_cos();
            let directions = [[c, s, 0.0], [-s * tc, c * tc, ts], [0.0, 0.0, 1.0]];
            let steps = [0, 1, 2].map(|a| directions[a].map(|v| v * steps[a]));
            let one = ordered(&stored([0, 1, 2], [false; 3], steps, counts));
            let volume = stored(ASSIGNMENTS[assignment], backwards, steps, counts);
            let other = ordered(&volume);
            prop_assert_eq!(hu(&one), hu(&other));
            let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            for corner in corners {
                let at = |v: &Volume| v.geometry().patient_from_voxel().apply(corner);
                prop_assert!(near(at(&one), at(&other)));
            }
            let again = other.in_patient_order(&Task::default()).unwrap();
            prop_assert!(matches!(again, Cow::Borrowed(_)));

            // Every voxel is where it was.
            let back = volume.geometry().patient_from_voxel().inverse().unwrap();
            let affine = other.geometry().patient_from_voxel();
            for ((k, j, i), value) in hu(&other).indexed_iter() {
                let at = back.apply(affine.apply([i as f64, j as f64, k as f64]));
                let [i, j, k] = at.map(|v| v.round() as usize);
                prop_assert_eq!(hu(&volume)[[k, j, i]], *value);
            }

            // Columns, rows and slices run to the left, the back and the head.
            let cosines = [0, 1, 2].map(|a| {
                let step = affine.axis(a);
                step.map(|v| v / affine.spacing()[a])
            });
            let toward = cosines.map(|d| d.map(|v| v > 0.6));
            for axis in toward {
                prop_assert!(axis.contains(&true));
            }
        }
    }
}
