//! Which threshold to take: what the volume itself suggests, and what the literature does.
//!
//! Of a patient in air most voxels are air, so one threshold of Otsu's only finds the body. Bone
//! is found in two ways, the first of which that works being the one recommended:
//! 1. halfway between soft tissue and bone at the edges between them ([`edge_threshold`]);
//! 2. the upper threshold of three classes, which are air, soft tissue and bone ([`multi_otsu`]);
//!    where there are but two values, the one between them ([`otsu`]).

use bonemesh_task::Task;
use bonemesh_volume::{Histogram, Volume};

use crate::{
    EdgeThreshold, HuThreshold, SegmentError, ThresholdFinder, ThresholdPreset, edge_threshold,
    multi_otsu, otsu,
};

/// A threshold with its name and its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct Suggestion {
    /// Short name: `edges`, `multi-otsu`, `otsu` or that of a preset.
    pub name: &'static str,
    /// The threshold.
    pub threshold: HuThreshold,
    /// What it separates, and on what grounds.
    pub reason: String,
    /// The publication it is taken from.
    pub source: &'static str,
}

/// Thresholds for one volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Suggestions {
    /// Those found in the volume, then those of the literature.
    pub all: Vec<Suggestion>,
    /// Index of the recommended one; `None` where all voxels have the same value.
    recommended: Option<usize>,
}

impl Suggestions {
    /// The one for bone.
    ///
    /// # Errors
    /// [`SegmentError::NoSuggestion`] where nothing tells bone from anything else.
    pub fn recommended(&self) -> Result<&Suggestion, SegmentError> {
        let index = self.recommended.ok_or(SegmentError::NoSuggestion)?;
        Ok(&self.all[index])
    }

    /// The one that a finder has found.
    ///
    /// # Errors
    /// [`SegmentError::NoSuggestion`] or [`SegmentError::NotFound`] if there is none.
    pub fn by(&self, finder: ThresholdFinder) -> Result<&Suggestion, SegmentError> {
        let recommended = self.recommended()?;
        if finder == ThresholdFinder::Auto {
            return Ok(recommended);
        }
        let found = self.all.iter().find(|s| s.name == finder.name());
        found.ok_or(SegmentError::NotFound(finder))
    }
}

const RATHNAYAKA: &str = "after Rathnayaka et al., Medical Engineering & Physics 33(2), 2011";
const LIAO: &str = "Liao et al., Journal of Information Science and Engineering 17(5), 2001";
const OTSU: &str = "Otsu, IEEE Transactions on Systems, Man, and Cybernetics 9(1), 1979";

/// Soft tissue without contrast agent seldom lies above.
const SOFT_TISSUE_HU: f64 = 150.0;

/// Suggests thresholds for the bone in `volume`, whose `histogram` in bins of 1 HU is at hand.
///
/// Limits: a volume without bone still gets suggestions, since nothing says that there is none; a
/// threshold below 150 HU is told to be doubtful. Values that are no Hounsfield units (cone-beam
/// scanners) get no threshold from edges, and the presets mean nothing there. Metal and padding
/// do not matter: the one is rare, the other is left out.
///
/// # Errors
/// [`SegmentError::Cancelled`].
pub fn suggest_thresholds(
    volume: &Volume,
    histogram: &Histogram,
    task: &Task,
) -> Result<Suggestions, SegmentError> {
    let mut all = Vec::new();
    match edge_threshold(volume, task) {
        Ok(found) => all.push(from_edges(&found)),
        Err(SegmentError::FewBoneEdges { .. }) => {}
        Err(other) => return Err(other),
    }
    if let Ok(thresholds) = multi_otsu(histogram, 3) {
        all.push(from_classes(&thresholds));
    }
    if let Ok(threshold) = otsu(histogram) {
        all.push(Suggestion {
            name: ThresholdFinder::Otsu.name(),
            threshold,
            reason: "two classes: of a patient in air, the body".to_owned(),
            source: OTSU,
        });
    }
    let recommended = (!all.is_empty()).then_some(0);
    if let Some(first) = all.first_mut()
        && first.threshold.hu() < SOFT_TISSUE_HU
    {
        first
            .reason
            .push_str("; so low that there may be no bone, or no Hounsfield units");
    }
    all.extend(ThresholdPreset::ALL.map(|preset| Suggestion {
        name: preset.name(),
        threshold: preset.threshold(),
        reason: preset.description().to_owned(),
        source: preset.source(),
    }));
    Ok(Suggestions { all, recommended })
}

fn from_edges(found: &EdgeThreshold) -> Suggestion {
    let [low, high] = found.quartiles_hu;
    Suggestion {
        name: ThresholdFinder::Edges.name(),
        threshold: found.threshold,
        reason: format!(
            "halfway between soft tissue and bone at {} edge pixels, half of them between {low} and {high} HU",
            found.edges
        ),
        source: RATHNAYAKA,
    }
}

fn from_classes(thresholds: &[HuThreshold]) -> Suggestion {
    let [lower, upper] = [thresholds[0], thresholds[1]];
    Suggestion {
        name: ThresholdFinder::MultiOtsu.name(),
        threshold: upper,
        reason: format!(
            "the upper of three classes, which part at {} and {} HU",
            lower.hu(),
            upper.hu()
        ),
        source: LIAO,
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "suggestions are whole numbers")]
mod tests {
    use super::*;
    use bonemesh_phantom::{Phantom, scan};
    use bonemesh_volume::{Affine, Geometry, Voxels};
    use ndarray::{Array3, Axis, Slice};
    use std::num::NonZeroU16;

    fn suggestions(volume: &Volume) -> Suggestions {
        let task = Task::default();
        let histogram = Histogram::of(volume, NonZeroU16::MIN, &task).unwrap();
        suggest_thresholds(volume, &histogram, &task).unwrap()
    }

    fn volume(hu: Array3<i16>) -> Volume {
        let affine = Affine::from_axes([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
        let (k, j, i) = hu.dim();
        Volume::new(Voxels::I16(hu), Geometry::new([k, j, i], affine).unwrap()).unwrap()
    }

    #[test]
    fn every_body_in_soft_tissue_is_parted_halfway() {
        for phantom in [Phantom::Femur, Phantom::Head, Phantom::Tube] {
            let settings = phantom.settings().coarser(1.5);
            let volume = scan(phantom, &settings, &Task::default()).unwrap();
            let found = suggestions(&volume);
            let best = found.recommended().unwrap();
            assert_eq!(best.name, "edges", "{phantom}");
            let hu = best.threshold.hu();
            assert!((hu - 640.0).abs() < 60.0, "{phantom}: {hu} HU");
        }
    }

    #[test]
    fn a_body_of_two_values_is_parted_halfway() {
        let hu = Array3::from_shape_fn([4, 20, 20], |(_, j, i)| {
            if (8..12).contains(&j) && (8..12).contains(&i) {
                1240
            } else {
                40
            }
        });
        let found = suggestions(&volume(hu));
        // Too few edges to count on them.
        assert_eq!(found.recommended().unwrap().name, "otsu");
        assert_eq!(found.recommended().unwrap().threshold.hu(), 640.0);
    }

    #[test]
    fn bone_in_air_above_a_holder_is_parted_from_the_holder() {
        let hu = Array3::from_shape_fn([40, 60, 60], |(_, j, i)| match (j, i) {
            (10..40, 10..40) => 800,
            (45..55, 10..50) => 90,
            _ => -1000,
        });
        let found = suggestions(&volume(hu));
        let best = found.recommended().unwrap();
        assert_eq!((best.name, best.threshold.hu()), ("multi-otsu", 445.0));
    }

    #[test]
    fn padding_does_not_pull_at_the_threshold() {
        let settings = Phantom::Tube.settings().coarser(1.5);
        let scanned = scan(Phantom::Tube, &settings, &Task::default()).unwrap();
        let Voxels::I16(hu) = scanned.voxels() else {
            unreachable!("phantoms are whole: anything else is a bug")
        };
        let [padded, air] = [-2000, -1024].map(|fill| {
            let mut hu = hu.clone();
            hu.slice_axis_mut(Axis(1), Slice::from(..20)).fill(fill);
            suggestions(&volume(hu))
        });
        let hu = |s: &Suggestions| s.recommended().unwrap().threshold.hu();
        assert_eq!(hu(&padded), hu(&air));
    }

    #[test]
    fn a_flat_volume_has_no_suggestion_but_the_presets() {
        let found = suggestions(&volume(Array3::from_elem([3, 4, 5], 40)));
        assert!(matches!(
            found.recommended(),
            Err(SegmentError::NoSuggestion)
        ));
        assert_eq!(found.all.len(), ThresholdPreset::ALL.len());
    }

    #[test]
    fn a_volume_without_bone_is_doubted() {
        let hu = Array3::from_shape_fn([4, 40, 40], |(k, j, i)| match (j, i) {
            (10..30, 10..30) => 40 + ((k + j + i) % 5) as i16,
            _ => -1000,
        });
        let found = suggestions(&volume(hu));
        assert!(
            found
                .recommended()
                .unwrap()
                .reason
                .contains("may be no bone")
        );
    }
}
