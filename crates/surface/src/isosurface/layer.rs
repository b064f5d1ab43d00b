//! Bone under a thin layer of soft tissue, with air beyond: the crown, the shin, the chin.
//!
//! Blurred together, the steps from air to soft tissue and from there to bone look like one, whose
//! middle lies in the soft tissue. Where a scan shows soft tissue at all, each edge towards air is
//! taken for two steps of the scan's blur: the distance between the middles of both, as the profile
//! shows it, tells how thick the layer is, down to none, and so the grey at the bone's edge.

use std::sync::LazyLock;

use super::edge::Edge;

/// Grey of soft tissue, HU: fat has some -100, muscle 50.
pub(super) const SOFT_HU: f32 = 40.0;
/// Around soft tissue's grey, HU.
const SOFT_SPAN_HU: f32 = 200.0;
/// What lies around bone is air below this, HU.
const AIR_HU: f32 = -400.0;
/// Part of the edges which end in soft tissue where a patient was scanned, not dry bone.
const LEAST_SOFT: f64 = 0.1;
/// Edges looked at.
const SAMPLES: usize = 1 << 16;

/// Whether the bone lies in soft tissue.
pub(super) fn has_soft_tissue(edges: &[Vec<Edge>]) -> bool {
    let count: usize = edges.iter().map(Vec::len).sum();
    let stride = count.div_ceil(SAMPLES).max(1);
    let sampled = || edges.iter().flatten().step_by(stride);
    let soft = sampled().filter(|edge| (edge.low_hu - SOFT_HU).abs() < SOFT_SPAN_HU);
    soft.count() as f64 > LEAST_SOFT * sampled().count() as f64
}

/// Whether there is air around the bone of an edge between these greys, and room for soft tissue
/// between.
pub(super) fn may_hide(low_hu: f32, high_hu: f32) -> bool {
    low_hu < AIR_HU && high_hu > SOFT_HU + SOFT_SPAN_HU
}

/// The grey, as a part of the way from air to bone, at the bone's edge under a layer: `soft` is
/// that part of soft tissue, `apart` the distance between the two steps' middles in standard
/// deviations of the blur.
pub(super) fn part_at_edge(soft: f32, apart: f32) -> f32 {
    let row = ((soft - FIRST_SOFT) / SOFT_STEP).clamp(0.0, (ROWS - 1) as f32);
    let low = (row as usize).min(ROWS - 2);
    let [a, b] = [0, 1].map(|beside| in_row(&LAYERS[low + beside], apart));
    a + (row - low as f32) * (b - a)
}

fn in_row(row: &[Layer], apart: f32) -> f32 {
    let place = row.partition_point(|layer| layer.apart <= apart);
    let high = &row[place.min(row.len() - 1)];
    let low = &row[place.saturating_sub(1)];
    if high.apart <= low.apart {
        return high.part_at_edge;
    }
    let part = ((apart - low.apart) / (high.apart - low.apart)).clamp(0.0, 1.0);
    low.part_at_edge + part * (high.part_at_edge - low.part_at_edge)
}

/// What a layer looks like after a Gaussian blur of standard deviation 1.
struct Layer {
    /// Distance between the middle of soft tissue and bone and that of air and soft tissue.
    apart: f32,
    part_at_edge: f32,
}

const FIRST_SOFT: f32 = 0.15;
const SOFT_STEP: f32 = 0.05;
const ROWS: usize = 15;
/// Thicknesses from none to where both steps are seen apart.
const THICKNESSES: i32 = 60;
const THICKNESS_STEP: f64 = 0.1;

static LAYERS: LazyLock<Vec<Vec<Layer>>> = LazyLock::new(|| {
    let soft = |row: usize| f64::from(FIRST_SOFT) + f64::from(SOFT_STEP) * row as f64;
    let row = |soft| {
        let thicknesses = (0..=THICKNESSES).map(|i| f64::from(i) * THICKNESS_STEP);
        thicknesses.map(|t| Layer::of(soft, t)).collect()
    };
    (0..ROWS).map(|i| row(soft(i))).collect()
});

impl Layer {
    fn of(soft: f64, thickness: f64) -> Self {
        let below = |x: f64| 0.5 * (1.0 + libm::erf(x / std::f64::consts::SQRT_2));
        // From bone at the left, whose edge is at 0, to air.
        let grey = |x: f64| 1.0 - (1.0 - soft) * below(x) - soft * below(x - thickness);
        let passes = |part: f64| {
            let (mut bone, mut air) = (-8.0, thickness + 8.0);
            for _ in 0..40 {
                let middle = f64::midpoint(bone, air);
                if grey(middle) > part {
                    bone = middle;
                } else {
                    air = middle;
                }
            }
            bone
        };
        Self {
            apart: (passes(0.5 * soft) - passes(0.5 + 0.5 * soft)) as f32,
            part_at_edge: grey(0.0) as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_layer_the_edge_is_in_the_middle_and_under_a_thick_one_above_soft_tissue() {
        for soft in [0.2, 0.46, 0.8] {
            assert!((part_at_edge(soft, 0.0) - 0.5).abs() < 0.02, "{soft}");
            assert!((part_at_edge(soft, 9.0) - (0.5 + 0.5 * soft)).abs() < 1e-3);
        }
    }

    #[test]
    fn a_layer_of_two_deviations_is_told_by_how_far_its_steps_are_apart() {
        let layer = Layer::of(0.46, 2.0);
        let found = part_at_edge(0.46, layer.apart);
        assert!((found - layer.part_at_edge).abs() < 2e-3, "{found}");
        // 1 - 0.54 / 2 - 0.46 * 0.0228
        assert!((found - 0.7195).abs() < 2e-3, "{found}");
    }
}
