//! Where slices can be laid through a volume: axial, coronal and sagittal planes of its own stack.
//!
//! Planes lie along the stack, so that of a straight or oblique one they show the voxels as they were
//! measured. Only across a tilted gantry, whose slices step sideways, they differ from its voxels'
//! own planes: a picture has right angles.
//!
//! 1. `StackAxes::of`: the stored axes named left, back and head, as nearly as the stack allows, and
//!    made perpendicular: those within the slices keep theirs.
//! 2. `StackAxes::extent`: how far the voxels reach along each, outer faces included.
//! 3. [`Geometry::slice_plane`]: two of the three span the picture, the third is its normal.

use std::str::FromStr;

use crate::order::assigned;
use crate::{Affine, Geometry};

/// Longest side of a picture: of a long body with fine pixels in one direction only.
const MAX_PIXELS: f64 = 4096.0;

/// Part of a pixel that rounding may add to a picture's side.
const ROUNDING: f64 = 1e-6;

/// How a plane lies in the patient.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Anatomical {
    /// Across the body: left and right, front and back.
    Axial,
    /// Seen from the front: left and right, head and feet.
    Coronal,
    /// Seen from the side: front and back, head and feet.
    Sagittal,
}

impl Anatomical {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Axial, Self::Coronal, Self::Sagittal];

    /// The name in reports and arguments.
    pub fn name(self) -> &'static str {
        match self {
            Self::Axial => "axial",
            Self::Coronal => "coronal",
            Self::Sagittal => "sagittal",
        }
    }
}

impl FromStr for Anatomical {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|plane| plane.name() == name)
            .ok_or_else(|| {
                let names = Self::ALL.map(Self::name).join(", ");
                format!("there is no plane `{name}`; choose one of: {names}")
            })
    }
}

/// The pictures that can be taken along one normal of a volume.
///
/// Axial ones are seen from the feet and coronal ones from the front, with the patient's left on the
/// right side, as radiologists look at them; sagittal ones from the left, with the front on the left
/// side. Pixels are square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlicePlane {
    /// Which plane it is, of the stack's own: oblique stacks have oblique ones.
    pub anatomical: Anatomical,
    /// `(right, up, position)`, in mm, to the patient (LPS, mm): right and up from the middle of the
    /// picture, along its sides; the position along the normal to the head, back or left, which for
    /// straight stacks is the patient's own coordinate.
    pub patient_from_plane: Affine,
    /// Side of a pixel.
    pub pixel_mm: f64,
    /// Rows and columns of the picture.
    pub shape: [usize; 2],
    /// Positions of the outermost voxels' centres, the lower first.
    pub positions_mm: [f64; 2],
    /// From one of the volume's own slices to the next.
    pub step_mm: f64,
}

impl Geometry {
    /// The pictures along one normal of this grid.
    pub fn slice_plane(&self, anatomical: Anatomical) -> SlicePlane {
        let axes = StackAxes::of(self.patient_from_voxel());
        // Of left, back and head: what runs to the right of the picture, upwards, along the normal.
        let (right, (up, sign), normal) = match anatomical {
            Anatomical::Axial => (0, (1, -1.0), 2),
            Anatomical::Coronal => (0, (2, 1.0), 1),
            Anatomical::Sagittal => (1, (2, 1.0), 0),
        };
        let outer = axes.extent(self, 0.5);
        let centres = axes.extent(self, 0.0);
        let side = |axis: usize| outer[axis][1] - outer[axis][0];
        let finest = axes.steps_mm[right].min(axes.steps_mm[up]);
        let pixel_mm = finest.max(side(right).max(side(up)) / MAX_PIXELS);
        let pixels = |axis: usize| ((side(axis) / pixel_mm - ROUNDING).ceil() as usize).max(1);
        let [rows, columns] = [pixels(up), pixels(right)];
        let middle = |axis: usize, pixels: usize, sign: f64| {
            let [low, high] = outer[axis];
            let half = 0.5 * pixels as f64 * pixel_mm;
            if sign < 0.0 { high - half } else { low + half }
        };
        let [across, upward] = [middle(right, columns, 1.0), middle(up, rows, sign)];
        let directions = axes.directions;
        let origin = [0, 1, 2].map(|i| across * directions[right][i] + upward * directions[up][i]);
        SlicePlane {
            anatomical,
            patient_from_plane: Affine::from_axes(
                directions[right],
                directions[up].map(|c| sign * c),
                directions[normal],
                origin,
            ),
            pixel_mm,
            shape: [rows, columns],
            positions_mm: centres[normal],
            step_mm: axes.steps_mm[normal],
        }
    }
}

/// The stack's directions nearest to the patient's left, back and head; perpendicular, of length 1.
struct StackAxes {
    directions: [[f64; 3]; 3],
    /// From voxel to voxel along each.
    steps_mm: [f64; 3],
}

impl StackAxes {
    fn of(patient_from_voxel: &Affine) -> Self {
        let unit_of = |axis: usize| unit(patient_from_voxel.axis(axis));
        let rows = unit_of(0);
        let columns = unit(without(unit_of(1), rows));
        let slices = unit(without(without(unit_of(2), rows), columns));
        let stored = [rows, columns, slices];
        let of_patient = assigned(stored);
        let directions = [0, 1, 2].map(|patient| {
            let direction = stored[of_patient[patient]];
            let sign = if direction[patient] < 0.0 { -1.0 } else { 1.0 };
            direction.map(|c| sign * c)
        });
        let steps_mm = [0, 1, 2].map(|patient| {
            dot(
                patient_from_voxel.axis(of_patient[patient]),
                directions[patient],
            )
            .abs()
        });
        Self {
            directions,
            steps_mm,
        }
    }

    /// The lowest and highest place of the grid along each direction, `margin` voxels beyond the
    /// outermost centres.
    fn extent(&self, geometry: &Geometry, margin: f64) -> [[f64; 2]; 3] {
        let [slices, rows, columns] = geometry.shape();
        let ends = [columns, rows, slices].map(|n| [-margin, n as f64 - 1.0 + margin]);
        let corners = (0..8).map(|corner| {
            let index = [0, 1, 2].map(|axis| ends[axis][corner >> axis & 1]);
            geometry.patient_from_voxel().apply(index)
        });
        let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for corner in corners {
            for (direction, [low, high]) in self.directions.iter().zip(&mut extent) {
                let place = dot(*direction, corner);
                *low = low.min(place);
                *high = high.max(place);
            }
        }
        extent
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|c| c / length)
}

/// `a` less its part along the unit vector `b`.
fn without(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let along = dot(a, b);
    [0, 1, 2].map(|i| a[i] - along * b[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(affine: Affine, anatomical: Anatomical) -> SlicePlane {
        Geometry::new([5, 8, 6], affine)
            .unwrap()
            .slice_plane(anatomical)
    }

    fn near(a: [f64; 3], b: [f64; 3]) -> bool {
        (0..3).all(|i| (a[i] - b[i]).abs() < 1e-9)
    }

    /// 6 columns, 8 rows and 5 slices, stored as scanners do for a patient on the back.
    fn straight() -> Affine {
        Affine::from_axes(
            [0.5, 0.0, 0.0],
            [0.0, 0.5, 0.0],
            [0.0, 0.0, 2.0],
            [-10.0, 20.0, 100.0],
        )
    }

    #[test]
    fn pictures_lie_where_their_voxels_are() {
        let axial = plane(straight(), Anatomical::Axial);
        assert_eq!((axial.shape, axial.pixel_mm), ([8, 6], 0.5));
        let [first, last] = axial.positions_mm;
        assert!(near([first, last, axial.step_mm], [100.0, 108.0, 2.0]));
        // The middle of the picture is that of the voxels, and up is to the front.
        let middle = axial.patient_from_plane.apply([0.0, 0.0, 104.0]);
        assert!(near(middle, [-8.75, 21.75, 104.0]), "{middle:?}");
        let up = axial.patient_from_plane.apply([0.0, 1.0, 104.0]);
        assert!(near(up, [-8.75, 20.75, 104.0]), "{up:?}");
        let coronal = plane(straight(), Anatomical::Coronal);
        // Pixels are square: 2 mm of a slice are four rows of 0.5 mm.
        assert_eq!((coronal.shape, coronal.pixel_mm), ([20, 6], 0.5));
        let [first, last] = coronal.positions_mm;
        assert!(near([first, last, 0.0], [20.0, 23.5, 0.0]));
        let sagittal = plane(straight(), Anatomical::Sagittal);
        assert_eq!(sagittal.shape, [20, 8]);
        assert!(near(sagittal.patient_from_plane.axis(0), [0.0, 1.0, 0.0]));
        assert!(near(sagittal.patient_from_plane.axis(1), [0.0, 0.0, 1.0]));
    }

    #[test]
    fn planes_do_not_depend_on_how_voxels_were_stored() {
        let reversed = Affine::from_axes(
            [0.0, 0.0, -2.0],
            [-0.5, 0.0, 0.0],
            [0.0, 0.5, 0.0],
            [-7.5, 20.0, 108.0],
        );
        let stored = Geometry::new([8, 6, 5], reversed).unwrap();
        for anatomical in Anatomical::ALL {
            let (a, b) = (
                plane(straight(), anatomical),
                stored.slice_plane(anatomical),
            );
            assert_eq!((a.shape, a.pixel_mm), (b.shape, b.pixel_mm));
            for axis in 0..3 {
                let axes = (a.patient_from_plane, b.patient_from_plane);
                assert!(near(axes.0.axis(axis), axes.1.axis(axis)));
            }
            assert!(near(
                a.patient_from_plane.origin(),
                b.patient_from_plane.origin()
            ));
        }
    }

    #[test]
    fn oblique_stacks_keep_their_own_planes() {
        let (s, c) = 20.0_f64.to_radians().sin_cos();
        let affine = Affine::from_axes(
            [0.5 * c, 0.5 * s, 0.0],
            [-0.5 * s, 0.5 * c, 0.0],
            [0.0, 0.0, 2.0],
            [0.0; 3],
        );
        let coronal = plane(affine, Anatomical::Coronal);
        assert!(near(coronal.patient_from_plane.axis(0), [c, s, 0.0]));
        assert!(near(coronal.patient_from_plane.axis(2), [-s, c, 0.0]));
        assert_eq!(coronal.shape, [20, 6]);
    }

    #[test]
    fn a_tilted_gantry_still_has_right_angles() {
        let (s, c) = 15.0_f64.to_radians().sin_cos();
        let affine = Affine::from_axes(
            [0.5, 0.0, 0.0],
            [0.0, 0.5 * c, -0.5 * s],
            [0.0, 0.0, 2.0],
            [0.0; 3],
        );
        let sagittal = plane(affine, Anatomical::Sagittal);
        let axes = [0, 1, 2].map(|axis| sagittal.patient_from_plane.axis(axis));
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            assert!(dot(axes[a], axes[b]).abs() < 1e-12);
        }
        // Rows and columns within the slices are the stack's own.
        assert!(near(axes[0], [0.0, c, -s]));
        let axial = plane(affine, Anatomical::Axial);
        assert!((axial.step_mm - 2.0 * c).abs() < 1e-12);
    }

    #[test]
    fn every_plane_is_found_by_its_name() {
        for plane in Anatomical::ALL {
            assert_eq!(plane.name().parse::<Anatomical>(), Ok(plane));
        }
        let unknown = "diagonal".parse::<Anatomical>().unwrap_err();
        assert!(unknown.contains("axial, coronal, sagittal"));
    }
}
