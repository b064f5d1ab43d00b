//! Which voxels are metal.
//!
//! 1. `bright::count`: how much there is from [`METAL_HU`] up; most scans have none, which one quick pass tells.
//!    `bounds`: the box around it.
//! 2. Pieces of such voxels that touch, of at least [`LEAST_MM3`].
//! 3. What is metal for certain: values beyond any tissue's ([`CERTAIN_HU`]), or a flat top where
//!    the scanner's scale ends.
//! 4. Any other piece, such as enamel that a sharp kernel overshoots, only where the slices it is in
//!    have streaks ([`STREAKED`] times the spread of those without).
//! 5. The rim: voxels beside metal that it shares.

use std::collections::{BTreeMap, BTreeSet};

use bonemesh_segment::{Connectivity, Mask, connected_components};
use bonemesh_task::{Cancelled, Task};
use bonemesh_volume::{Affine, CropBox, Geometry, Volume, Voxels};
use ndarray::Array3;

use crate::bright::{Bounds, bounds, count};
use crate::streaks::{Streaks, streaks_of};
use crate::{METAL_HU, MetalError};

/// Smaller pieces make no streaks that reach far: a ball of 2 mm has 4 mm3.
const LEAST_MM3: f64 = 4.0;
/// Part of a volume that metal may fill: where more of it is so bright, values are no Hounsfield units.
const MOST: f64 = 0.1;
/// No tissue comes near this, whatever the kernel.
const CERTAIN_HU: f32 = 4000.0;
/// Voxels beside metal from here up are partly metal.
const RIM_HU: f32 = 2000.0;
/// How many times as large the spread of soft tissue is in slices with streaks.
const STREAKED: f64 = 1.5;

/// Metal in a volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Metal {
    /// Pieces that do not touch.
    pub pieces: usize,
    /// Their volume, of whole voxels; metal blooms, so it has less.
    pub volume_mm3: f64,
    /// First and last slice with metal, counted from 0 as the volume is stored.
    pub slices: [usize; 2],
    /// Lowest and highest place of a voxel of it in the patient: z, to the head.
    pub z_mm: [f64; 2],
    /// How strong its streaks are; `None` where nothing is left to compare with.
    pub streaks: Option<Streaks>,
    /// Of the volume as stored.
    pub(crate) geometry: Geometry,
    /// Rows and columns of metal and its rim, by slice, in the volume's patient order.
    pub(crate) voxels: BTreeMap<usize, Vec<[usize; 2]>>,
}

/// Finds the metal in `volume`; `None` if there is none.
///
/// # Errors
/// [`MetalError::Cancelled`]; [`MetalError::Segment`] and [`MetalError::Volume`] for noise of some thousand million voxels.
pub fn find_metal(volume: &Volume, task: &Task) -> Result<Option<Metal>, MetalError> {
    task.begin("metal", volume.geometry().shape()[0]);
    let voxel_mm3 = volume.geometry().patient_from_voxel().determinant().abs();
    let voxels: usize = volume.geometry().shape().iter().product();
    let above = count(volume, task)?;
    if (above as f64) * voxel_mm3 < LEAST_MM3 || above as f64 > MOST * voxels as f64 {
        return Ok(None);
    }
    let ordered = volume.in_patient_order(task)?;
    let Some(bounds) = bounds(&ordered, task)? else {
        return Ok(None);
    };
    let scan = Scan {
        volume: &ordered,
        bounds,
    };
    let pieces = scan.pieces(task)?;
    let kept = scan.kept(pieces, task)?;
    if kept.is_empty() {
        return Ok(None);
    }
    let slices: BTreeSet<usize> = kept.iter().flat_map(Piece::slices).collect();
    let streaks = streaks_of(&ordered, &slices, task)?;
    let count: usize = kept.iter().map(|piece| piece.voxels.len()).sum();
    let (slices, z_mm) = scan.reach(&kept, volume.geometry());
    Ok(Some(Metal {
        pieces: kept.len(),
        volume_mm3: count as f64 * voxel_mm3,
        slices,
        z_mm,
        streaks,
        geometry: volume.geometry().clone(),
        voxels: scan.with_rim(&kept),
    }))
}

/// Voxels that touch.
#[derive(Clone, Debug, Default)]
struct Piece {
    /// `[slice, row, column]`.
    voxels: Vec<[usize; 3]>,
    is_certain: bool,
}

impl Piece {
    fn slices(&self) -> impl Iterator<Item = usize> + '_ {
        self.voxels.iter().map(|[slice, ..]| *slice)
    }
}

/// A volume in patient order and where in it metal may be.
struct Scan<'a> {
    volume: &'a Volume,
    bounds: Bounds,
}

impl Scan<'_> {
    fn hu(&self, at: [usize; 3]) -> f32 {
        match self.volume.voxels() {
            Voxels::I16(hu) => f32::from(hu[at]),
            Voxels::F32(hu) => hu[at],
        }
    }

    /// All pieces that are large enough.
    fn pieces(&self, task: &Task) -> Result<Vec<Piece>, MetalError> {
        let [slices, rows, columns] = self.bounds.clone();
        let start = [slices.start, rows.start, columns.start];
        let shape = [slices.len(), rows.len(), columns.len()];
        let at = |(k, j, i): (usize, usize, usize)| [start[0] + k, start[1] + j, start[2] + i];
        let voxels = Array3::from_shape_fn(shape, |index| self.hu(at(index)) >= METAL_HU);
        let crop = CropBox {
            columns,
            rows,
            slices,
        };
        let geometry = self.volume.geometry().cropped(&crop)?;
        let mask = Mask { voxels, geometry };
        let components = connected_components(&mask, Connectivity::Corners, task)?;
        let mut pieces = vec![Piece::default(); components.len()];
        for (index, label) in components.labels().indexed_iter() {
            if *label > 0 {
                pieces[*label as usize - 1].voxels.push(at(index));
            }
        }
        let voxel_mm3 = self
            .volume
            .geometry()
            .patient_from_voxel()
            .determinant()
            .abs();
        pieces.retain(|piece| piece.voxels.len() as f64 * voxel_mm3 >= LEAST_MM3);
        Ok(pieces)
    }

    /// The pieces that are metal.
    fn kept(&self, mut pieces: Vec<Piece>, task: &Task) -> Result<Vec<Piece>, MetalError> {
        let highest = pieces
            .iter()
            .flat_map(|piece| &piece.voxels)
            .map(|at| self.hu(*at))
            .fold(METAL_HU, f32::max);
        for piece in &mut pieces {
            let is_proof =
                |at: &[usize; 3]| self.hu(*at) >= CERTAIN_HU || self.is_flat_top(*at, highest);
            piece.is_certain = piece.voxels.iter().any(is_proof);
        }
        if pieces.iter().any(|piece| !piece.is_certain) {
            let is_metal = self.has_streaks(&pieces, task)?;
            pieces.retain(|piece| piece.is_certain || is_metal);
        }
        Ok(pieces)
    }

    /// Whether slices with a piece that is not certain have streaks.
    fn has_streaks(&self, pieces: &[Piece], task: &Task) -> Result<bool, Cancelled> {
        let doubtful = pieces.iter().filter(|piece| !piece.is_certain);
        let slices: BTreeSet<usize> = doubtful.flat_map(Piece::slices).collect();
        let streaks = streaks_of(self.volume, &slices, task)?;
        Ok(streaks.is_some_and(|s| s.with_metal_hu >= STREAKED * s.without_hu))
    }

    /// Whether a voxel and the eight around it in its slice have the highest value of all.
    fn is_flat_top(&self, [slice, row, column]: [usize; 3], highest: f32) -> bool {
        let [_, rows, columns] = self.volume.geometry().shape();
        let is_inside = row > 0 && column > 0 && row + 1 < rows && column + 1 < columns;
        is_inside
            && (row - 1..=row + 1)
                .all(|j| (column - 1..=column + 1).all(|i| self.hu([slice, j, i]) >= highest))
    }

    /// Metal and its rim, rows and columns by slice, in order.
    fn with_rim(&self, pieces: &[Piece]) -> BTreeMap<usize, Vec<[usize; 2]>> {
        let shape = self.volume.geometry().shape();
        let mut found: BTreeSet<[usize; 3]> = BTreeSet::new();
        for at in pieces.iter().flat_map(|piece| &piece.voxels) {
            let around = |axis: usize| at[axis].saturating_sub(1)..(at[axis] + 2).min(shape[axis]);
            for k in around(0) {
                for j in around(1) {
                    found.extend(
                        around(2)
                            .map(|i| [k, j, i])
                            .filter(|v| self.hu(*v) >= RIM_HU),
                    );
                }
            }
        }
        let mut by_slice: BTreeMap<usize, Vec<[usize; 2]>> = BTreeMap::new();
        for [slice, row, column] in found {
            by_slice.entry(slice).or_default().push([row, column]);
        }
        by_slice
    }

    /// First and last slice as `stored`, lowest and highest z (mm).
    fn reach(&self, pieces: &[Piece], stored: &Geometry) -> ([usize; 2], [f64; 2]) {
        let back = stored_from_ordered(self.volume.geometry(), stored);
        let mut slices = [usize::MAX, 0];
        let mut z_mm = [f64::INFINITY, f64::NEG_INFINITY];
        for at in pieces.iter().flat_map(|piece| &piece.voxels) {
            let [slice, ..] = back(*at);
            slices = [slices[0].min(slice), slices[1].max(slice)];
            let [k, j, i] = at.map(|index| index as f64);
            let [_, _, z] = self.volume.geometry().patient_from_voxel().apply([i, j, k]);
            z_mm = [z_mm[0].min(z), z_mm[1].max(z)];
        }
        (slices, z_mm)
    }
}

/// Where in the stored volume a voxel of the volume in patient order is.
pub(crate) fn stored_from_ordered(
    ordered: &Geometry,
    stored: &Geometry,
) -> impl Fn([usize; 3]) -> [usize; 3] {
    let inverse = stored.patient_from_voxel().inverse();
    let stored_from_patient: Affine = inverse.expect("a geometry has an inverse: else it is a bug");
    let patient_from_ordered = *ordered.patient_from_voxel();
    move |at| {
        let [k, j, i] = at.map(|index| index as f64);
        let place = patient_from_ordered.apply([i, j, k]);
        let [i, j, k] = stored_from_patient.apply(place);
        [k, j, i].map(|index| index.round().max(0.0) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Axis;

    const AFFINE: [[f64; 3]; 4] = [
        [0.5, 0.0, 0.0],
        [0.0, 0.5, 0.0],
        [0.0, 0.0, 2.0],
        [0.0, 0.0, -7.0],
    ];

    fn volume(hu: impl Fn([usize; 3]) -> i16) -> Volume {
        let [x, y, z, origin] = AFFINE;
        let shape = [24, 60, 60];
        let voxels = Array3::from_shape_fn(shape, |(k, j, i)| hu([k, j, i]));
        let geometry = Geometry::new(shape, Affine::from_axes(x, y, z, origin)).unwrap();
        Volume::new(Voxels::I16(voxels), geometry).unwrap()
    }

    /// A block of soft tissue with some noise, and within it 5 x 5 pixels of three slices.
    fn with_block(block: impl Fn([usize; 3]) -> i16, streak: i16) -> Volume {
        volume(|at @ [k, j, i]| {
            let is_block = (10..13).contains(&k) && j.abs_diff(30) < 3 && i.abs_diff(30) < 3;
            let noise = ((7 * i + 5 * j + 3 * k) % 11) as i16;
            let stripes = if (10..13).contains(&k) && i % 6 < 3 {
                streak
            } else {
                0
            };
            if is_block {
                block(at)
            } else {
                30 + noise + stripes
            }
        })
    }

    fn found(volume: &Volume) -> Option<Metal> {
        find_metal(volume, &Task::default()).unwrap()
    }

    #[test]
    fn what_saturates_the_scale_is_metal() {
        let metal = found(&with_block(|_| 3071, 200)).unwrap();
        assert_eq!((metal.pieces, metal.slices), (1, [10, 12]));
        assert!((metal.volume_mm3 - 37.5).abs() < 1e-9);
        assert!((metal.z_mm[0] - 13.0).abs() < 1e-9 && (metal.z_mm[1] - 17.0).abs() < 1e-9);
        let streaks = metal.streaks.unwrap();
        assert!(
            streaks.with_metal_hu > 5.0 * streaks.without_hu,
            "{streaks:?}"
        );
    }

    #[test]
    fn enamel_is_no_metal_even_where_a_sharp_kernel_overshoots() {
        assert!(found(&with_block(|_| 2900, 0)).is_none());
        let overshoot = |[k, j, i]: [usize; 3]| 3000 + ((3 * i + 5 * j + k) % 60) as i16;
        assert!(found(&with_block(overshoot, 0)).is_none());
        let streaked = found(&with_block(overshoot, 150));
        assert!(streaked.is_some(), "streaks tell");
    }

    #[test]
    fn a_few_voxels_are_no_metal() {
        assert!(found(&volume(|at| if at == [3, 9, 9] { 3071 } else { 0 })).is_none());
        assert!(found(&volume(|_| -1000)).is_none());
    }

    #[test]
    fn the_order_of_the_voxels_does_not_matter() {
        let ordered = with_block(|_| 3071, 200);
        let Voxels::I16(hu) = ordered.voxels() else {
            unreachable!()
        };
        let mut turned = hu.clone();
        turned.invert_axis(Axis(0));
        turned.invert_axis(Axis(2));
        let [x, y, z, origin] = AFFINE;
        let corner = [origin[0] + 59.0 * x[0], origin[1], origin[2] + 23.0 * z[2]];
        let affine = Affine::from_axes(x.map(|v| -v), y, z.map(|v| -v), corner);
        let geometry = Geometry::new([24, 60, 60], affine).unwrap();
        let turned = Volume::new(
            Voxels::I16(turned.as_standard_layout().into_owned()),
            geometry,
        );
        let (a, b) = (found(&ordered).unwrap(), found(&turned.unwrap()).unwrap());
        assert_eq!(b.slices, [11, 13]);
        assert_eq!((a.voxels, a.streaks, a.z_mm), (b.voxels, b.streaks, b.z_mm));
    }
}
