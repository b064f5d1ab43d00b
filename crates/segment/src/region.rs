//! Regions that grow from seeds through everything above a threshold.
//!
//! What is connected with a seed does not depend on the way there, so instead of walking from
//! voxel to voxel the connected pieces above the threshold are found, all at once and in
//! parallel, and those that hold a seed are kept.
//!
//! Sources: R. Adams, L. Bischof, "Seeded region growing", IEEE TPAMI 16(6), 1994, for seeds;
//! J. Canny, "A computational approach to edge detection", IEEE TPAMI 8(6), 1986, for two
//! thresholds.

use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};

use crate::{Connectivity, HuThreshold, Mask, SegmentError, connected_components, threshold};

/// The part of what lies above `above` that is connected with any of `seeds`, each
/// `[slice, row, column]`.
///
/// Limits: bones that touch above the threshold grow into one another, and into metal and the
/// scanner's table where these touch.
///
/// # Errors
/// [`SegmentError::NoSeeds`], [`SegmentError::SeedOutside`] and [`SegmentError::SeedBelow`] for
/// seeds that cannot grow, and those of [`threshold()`](crate::threshold) and
/// [`connected_components`].
pub fn grow_region(
    volume: &Volume,
    seeds: &[[usize; 3]],
    above: HuThreshold,
    connectivity: Connectivity,
    task: &Task,
) -> Result<Mask, SegmentError> {
    if seeds.is_empty() {
        return Err(SegmentError::NoSeeds);
    }
    let shape = volume.geometry().shape();
    for seed in seeds {
        if (0..3).any(|axis| seed[axis] >= shape[axis]) {
            return Err(SegmentError::SeedOutside { seed: *seed, shape });
        }
        let hu = hu_at(volume, *seed);
        // NaN lies above nothing.
        if hu.is_nan() || hu <= above.hu() {
            return Err(SegmentError::SeedBelow {
                seed: *seed,
                hu,
                threshold_hu: above.hu(),
            });
        }
    }
    let mask = threshold(volume, above, task)?;
    let components = connected_components(&mask, connectivity, task)?;
    let mut is_seeded = vec![false; components.len()];
    for component in seeds.iter().filter_map(|seed| components.at(*seed)) {
        is_seeded[component] = true;
    }
    Ok(components.mask(|component| is_seeded[component]))
}

/// The part of what lies above `low` that is connected with anything above `high`: thin bone
/// that hangs on dense bone, without the soft tissue and noise that `low` alone would let in.
///
/// # Errors
/// [`SegmentError::ThresholdOrder`] unless `low` is at most `high`, and those of
/// [`threshold()`](crate::threshold) and [`connected_components`].
pub fn hysteresis_threshold(
    volume: &Volume,
    low: HuThreshold,
    high: HuThreshold,
    connectivity: Connectivity,
    task: &Task,
) -> Result<Mask, SegmentError> {
    if low > high {
        return Err(SegmentError::ThresholdOrder {
            low_hu: low.hu(),
            high_hu: high.hu(),
        });
    }
    let seeds = threshold(volume, high, task)?;
    let mask = threshold(volume, low, task)?;
    let components = connected_components(&mask, connectivity, task)?;
    let is_seeded = components.holding_any(&seeds);
    Ok(components.mask(|component| is_seeded[component]))
}

fn hu_at(volume: &Volume, voxel: [usize; 3]) -> f64 {
    match volume.voxels() {
        Voxels::I16(hu) => f64::from(hu[voxel]),
        Voxels::F32(hu) => f64::from(hu[voxel]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bonemesh_volume::{Affine, Geometry};
    use ndarray::Array3;

    fn volume(rows: &[&[i16]]) -> Volume {
        let shape = [1, rows.len(), rows[0].len()];
        let hu = Array3::from_shape_fn(shape, |(_, j, i)| rows[j][i]);
        let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        Volume::new(Voxels::I16(hu), Geometry::new(shape, affine).unwrap()).unwrap()
    }

    fn hu(hu: f64) -> HuThreshold {
        HuThreshold::new(hu).unwrap()
    }

    fn marked(mask: &Mask) -> Vec<Vec<usize>> {
        let rows = mask.voxels.index_axis(ndarray::Axis(0), 0);
        let row = |row: ndarray::ArrayView1<'_, bool>| (0..row.len()).filter(|i| row[*i]).collect();
        rows.outer_iter().map(row).collect()
    }

    #[test]
    fn a_region_is_what_its_seeds_are_connected_with() {
        let volume = volume(&[
            &[500, 400, 0, 900, 900],
            &[0, 0, 351, 0, 0],
            &[350, 0, 0, 0, 700],
        ]);
        let grow = |seeds: &[[usize; 3]], connectivity| {
            grow_region(&volume, seeds, hu(350.0), connectivity, &Task::default()).unwrap()
        };
        let corners = grow(&[[0, 0, 0]], Connectivity::Corners);
        assert_eq!(marked(&corners), [vec![0, 1, 3, 4], vec![2], vec![]]);
        let faces = grow(&[[0, 0, 0], [0, 2, 4]], Connectivity::Faces);
        assert_eq!(marked(&faces), [vec![0, 1], vec![], vec![4]]);
    }

    #[test]
    fn seeds_that_cannot_grow_are_refused() {
        let volume = volume(&[&[500, 350]]);
        let grow = |seeds: &[[usize; 3]]| {
            grow_region(
                &volume,
                seeds,
                hu(350.0),
                Connectivity::Faces,
                &Task::default(),
            )
            .unwrap_err()
        };
        assert!(matches!(grow(&[]), SegmentError::NoSeeds));
        assert!(matches!(
            grow(&[[0, 0, 2]]),
            SegmentError::SeedOutside { .. }
        ));
        let below = grow(&[[0, 0, 0], [0, 0, 1]]);
        assert!(below.to_string().contains("350"), "{below}");
    }

    #[test]
    fn weak_voxels_stay_only_where_strong_ones_hold_them() {
        let volume = volume(&[&[250, 700, 250, 0, 250, 250]]);
        let held = hysteresis_threshold(
            &volume,
            hu(200.0),
            hu(600.0),
            Connectivity::Corners,
            &Task::default(),
        );
        assert_eq!(marked(&held.unwrap()), [vec![0, 1, 2]]);
        let turned = hysteresis_threshold(
            &volume,
            hu(600.0),
            hu(200.0),
            Connectivity::Corners,
            &Task::default(),
        );
        assert!(matches!(turned, Err(SegmentError::ThresholdOrder { .. })));
    }
}
