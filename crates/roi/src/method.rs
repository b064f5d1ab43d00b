//! The ways to find a region.

use std::fmt;
use std::str::FromStr;

use crate::RoiError;

/// How the region behind a selection is found.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// The bone under the patch, cut out as a closed solid.
    #[default]
    Solid,
    /// The thesis's: slice by slice along one normal, meshed as a point cloud.
    Thesis,
}

impl Method {
    /// Every method.
    pub const ALL: [Self; 2] = [Self::Solid, Self::Thesis];

    /// Its name in commands and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Solid => "solid",
            Self::Thesis => "thesis",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Method {
    type Err = RoiError;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .into_iter()
            .find(|method| method.name() == name)
            .ok_or_else(|| RoiError::UnknownMethod(name.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_has_a_name_that_finds_it() {
        for method in Method::ALL {
            assert_eq!(method.to_string().parse::<Method>().unwrap(), method);
        }
        let error = "hollow".parse::<Method>().unwrap_err().to_string();
        assert!(error.contains("hollow") && error.contains("solid, thesis"));
    }
}
