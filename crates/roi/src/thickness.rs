//! Lengths that a user gives.

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

/// The gap between the bone and a plate that lies on it, in mm: 0 to 20.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct ClearanceMm(f64);

impl ClearanceMm {
    const LARGEST_MM: f64 = 20.0;

    /// A gap of `mm`.
    ///
    /// # Errors
    /// [`RoiError::Clearance`] when it is negative, above 20 mm or no number.
    pub fn new(mm: f64) -> Result<Self, RoiError> {
        if (0.0..=Self::LARGEST_MM).contains(&mm) {
            Ok(Self(mm))
        } else {
            Err(RoiError::Clearance(mm))
        }
    }

    /// The gap in mm.
    pub fn mm(self) -> f64 {
        self.0
    }
}

impl Default for ClearanceMm {
    /// 0.2 mm, which a printed guide needs to slip on.
    fn default() -> Self {
        Self(0.2)
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

    #[test]
    fn a_clearance_may_be_nothing_but_neither_negative_nor_huge() {
        for mm in [-0.1, 20.1, f64::NAN, f64::INFINITY] {
            let error = ClearanceMm::new(mm).unwrap_err();
            assert!(matches!(error, RoiError::Clearance(_)), "{mm}");
        }
        assert!(ClearanceMm::new(0.0).unwrap() < ClearanceMm::default());
    }
}
