//! Bodies that know the exact place of their surface.

use std::sync::Arc;

use crate::shape::Shape;

/// Hounsfield units of the compact bone of every body.
pub const BONE_HU: f64 = 1240.0;
/// Hounsfield units of the soft tissue around it; 640 HU lies halfway to bone.
pub const SOFT_HU: f64 = 40.0;
/// Hounsfield units of air.
pub const AIR_HU: f64 = -1000.0;

/// A body in patient space (DICOM LPS, mm) whose bone surface is known.
pub trait Body: Send + Sync {
    /// Signed distance (mm) of `p` to the bone surface, negative inside bone.
    ///
    /// Sign and zero set are exact, and its size never exceeds the true distance; where it
    /// equals it is said at each [`Phantom`](crate::Phantom).
    fn signed_distance_mm(&self, p: [f64; 3]) -> f64;

    /// Hounsfield units of the ideal body at `p`, before any blur, partial volume or noise.
    fn hu(&self, p: [f64; 3]) -> f64;
}

/// One material of a body.
#[derive(Clone, Debug)]
pub(crate) struct Tissue {
    pub(crate) shape: Arc<Shape>,
    pub(crate) hu: f64,
    /// Whether its surface counts as bone surface.
    pub(crate) bone: bool,
}

/// Materials painted one over the other on a background.
#[derive(Clone, Debug)]
pub(crate) struct Layers {
    pub(crate) background_hu: f64,
    pub(crate) tissues: Vec<Tissue>,
}

impl Layers {
    /// Bone alone in soft tissue without end.
    pub(crate) fn bone_in_soft_tissue(shape: Arc<Shape>) -> Self {
        let mut layers = Self {
            background_hu: SOFT_HU,
            tissues: Vec::new(),
        };
        layers.bone(shape, BONE_HU);
        layers
    }

    pub(crate) fn bone(&mut self, shape: Arc<Shape>, hu: f64) {
        let bone = true;
        self.tissues.push(Tissue { shape, hu, bone });
    }

    pub(crate) fn soft(&mut self, shape: Arc<Shape>, hu: f64) {
        let bone = false;
        self.tissues.push(Tissue { shape, hu, bone });
    }

    /// Puts a material below all others.
    pub(crate) fn under(&mut self, shape: Arc<Shape>, hu: f64) {
        let bone = false;
        self.tissues.insert(0, Tissue { shape, hu, bone });
    }

    /// What remains to be painted within `radius` of `centre`.
    pub(crate) fn near(&self, centre: [f64; 3], radius: f64) -> Self {
        let mut layers = Self {
            background_hu: self.background_hu,
            tissues: Vec::with_capacity(self.tissues.len()),
        };
        for tissue in &self.tissues {
            let (shape, d) = tissue.shape.near(centre, radius);
            if d < -radius {
                layers.background_hu = tissue.hu;
                layers.tissues.clear();
            } else if d <= radius {
                layers.tissues.push(Tissue { shape, ..*tissue });
            }
        }
        layers
    }

    /// Mean Hounsfield units of a cube of side `side` mm about `p`, each surface taken as flat
    /// in it: along any direction a cube's shadow has the variance of its side's box.
    ///
    /// What a material leaves free is filled by those below it as far as they reach, as if they
    /// shared no space: where a sinus ends at bone, both fill the cube, and no film of soft tissue
    /// comes between them.
    pub(crate) fn mean_hu(&self, p: [f64; 3], side: f64) -> f64 {
        let (mut free, mut hu) = (1.0, 0.0);
        for tissue in self.tissues.iter().rev() {
            let reach = (0.5 - tissue.shape.distance(p) / side).clamp(0.0, 1.0);
            let filled = reach.min(free);
            hu += filled * tissue.hu;
            free -= filled;
        }
        hu + free * self.background_hu
    }
}

impl Body for Layers {
    fn signed_distance_mm(&self, p: [f64; 3]) -> f64 {
        self.tissues
            .iter()
            .filter(|t| t.bone)
            .map(|t| t.shape.distance(p))
            .fold(f64::INFINITY, f64::min)
    }

    fn hu(&self, p: [f64; 3]) -> f64 {
        self.tissues
            .iter()
            .rev()
            .find(|t| t.shape.distance(p) < 0.0)
            .map_or(self.background_hu, |t| t.hu)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::build::{ball, below, cut};

    #[test]
    fn bone_beside_air_blurs_straight_from_one_to_the_other() {
        let (head, sinus) = (ball([0.0; 3], 50.0), below([0.0; 3], [1.0, 0.0, 0.0]));
        let mut layers = Layers {
            background_hu: AIR_HU,
            tissues: Vec::new(),
        };
        layers.soft(Arc::clone(&head), SOFT_HU);
        layers.soft(Arc::clone(&sinus), AIR_HU);
        layers.bone(cut(head, sinus, 0.0), BONE_HU);
        for i in -10..=10 {
            let x = f64::from(i) / 20.0;
            let expected = AIR_HU + (0.5 + x) * (BONE_HU - AIR_HU);
            let hu = layers.mean_hu([x, 1.0, 2.0], 1.0);
            assert!((hu - expected).abs() < 1e-9, "{x}: {hu}");
        }
    }
}
