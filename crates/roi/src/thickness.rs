//! How deep a region reaches.

use crate::RoiError;

/// Depth of a region below the selection in mm: finite and above 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct ThicknessMm(f64);

impl ThicknessMm {
    /// A depth of `mm`.
    ///
    /// # Errors
    /// [`RoiError::Thickness`] when it is 0, negative, infinite or no number.
    pub fn new(mm: f64) -> Result<Self, RoiError> {
        if mm.is_finite() && mm > 0.0 {
            Ok(Self(mm))
        } else {
            Err(RoiError::Thickness(mm))
        }
    }

    /// The depth in mm.
    pub fn mm(self) -> f64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_positive_length_is_a_thickness() {
        for mm in [0.0, -0.0, -5.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let error = ThicknessMm::new(mm).unwrap_err();
            assert!(matches!(error, RoiError::Thickness(_)), "{mm}");
        }
        assert!((ThicknessMm::new(5.0).unwrap().mm() - 5.0).abs() < 1e-15);
    }
}
