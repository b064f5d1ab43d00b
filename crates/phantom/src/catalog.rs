//! The phantoms by name.

use std::fmt;
use std::str::FromStr;

use crate::bodies::{self, Known};
use crate::body::Body;
use crate::models::Model;
use crate::{Orientation, PhantomError, ScanSettings};

/// A phantom: one of the thesis's models drawn in pixels, or a body of known distance field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Phantom {
    /// Line model of the thesis.
    Line,
    /// Hollow cylinder of the thesis.
    Cylinder,
    /// Filled cube of the thesis.
    Cube,
    /// Two filled cubes side by side.
    TwoCubes,
    /// Filled cube with a square hole through it.
    CubeWithHole,
    /// Outline with one sharp and three round corners.
    Curved,
    /// Spherical shell; its distance is exact everywhere.
    SphereShell,
    /// Straight tube with flat ends; its distance is exact everywhere.
    Tube,
    /// Left femur; its distance is exact around the shaft, in its wall and in the canal, a lower
    /// bound near the blends of head, neck, trochanters and condyles.
    Femur,
    /// Box with a square hole through it; its distance is exact everywhere.
    BoxWithHole,
    /// Head with skull, jaw and teeth; its distance is exact only where one part is near.
    Head,
}

impl Phantom {
    /// Every phantom, the thesis's models first.
    pub const ALL: [Self; 11] = [
        Self::Line,
        Self::Cylinder,
        Self::Cube,
        Self::TwoCubes,
        Self::CubeWithHole,
        Self::Curved,
        Self::SphereShell,
        Self::Tube,
        Self::Femur,
        Self::BoxWithHole,
        Self::Head,
    ];

    /// Name as `FromStr` reads it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Cylinder => "cylinder",
            Self::Cube => "cube",
            Self::TwoCubes => "two-cubes",
            Self::CubeWithHole => "cube-with-hole",
            Self::Curved => "curved",
            Self::SphereShell => "sphere-shell",
            Self::Tube => "tube",
            Self::Femur => "femur",
            Self::BoxWithHole => "box-with-hole",
            Self::Head => "head",
        }
    }

    /// What it is, in one line.
    pub fn description(self) -> &'static str {
        match self {
            Self::Line => "line of 21 x 277 pixels with round ends, the same in every slice",
            Self::Cylinder => "hollow cylinder, radius 150 pixels, wall 11 pixels",
            Self::Cube => "filled cube of 100 x 100 pixels, as high as the stack",
            Self::TwoCubes => "two filled cubes of 100 x 100 pixels, 50 pixels apart",
            Self::CubeWithHole => "filled cube of 100 x 100 pixels with a hole of 50 x 50",
            Self::Curved => "outline with one sharp and three round corners, 2 slices",
            Self::SphereShell => "spherical shell of bone, radii 30 and 36 mm",
            Self::Tube => "upright tube of bone, radii 9 and 15 mm, 60 mm long",
            Self::Femur => "left femur: shaft with marrow, head, neck, trochanters, condyles",
            Self::BoxWithHole => "box of bone, 40 x 30 x 30 mm, with a hole of 15 x 15 mm",
            Self::Head => "head with skull, jaw and teeth, different left and right",
        }
    }

    /// The body in patient space, or `None` for the models that are drawn in pixels.
    pub fn body(self) -> Option<Box<dyn Body>> {
        self.known()
            .map(|known| Box::new(known.layers) as Box<dyn Body>)
    }

    pub(crate) fn known(self) -> Option<Known> {
        Some(match self {
            Self::SphereShell => bodies::sphere_shell(),
            Self::Tube => bodies::tube(),
            Self::Femur => bodies::femur(),
            Self::BoxWithHole => bodies::box_with_hole(),
            Self::Head => bodies::head(),
            _ => return None,
        })
    }

    pub(crate) fn model(self) -> Option<Model> {
        Some(match self {
            Self::Line => Model::Line,
            Self::Cylinder => Model::Ring,
            Self::Cube => Model::Cube,
            Self::TwoCubes => Model::TwoCubes,
            Self::CubeWithHole => Model::CubeWithHole,
            Self::Curved => Model::Curved,
            _ => return None,
        })
    }

    /// A scan that suits the phantom: the thesis's grids without blur and noise for its models,
    /// a clinical grid with 0.8 pixels of blur and 15 HU of noise for the bodies.
    pub fn settings(self) -> ScanSettings {
        let model = |pixel: f64, slices, slice_mm| ScanSettings {
            columns: 512,
            rows: 512,
            slices,
            pixel_mm: [pixel; 2],
            slice_mm,
            centre_mm: [0.0; 3],
            orientation: Orientation::axial(),
            psf_px: 0.0,
            noise_hu: 0.0,
            seed: 0,
        };
        let body =
            |[columns, rows, slices]: [usize; 3], pixel: f64, slice_mm, centre_mm| ScanSettings {
                columns,
                rows,
                centre_mm,
                psf_px: 0.8,
                noise_hu: 15.0,
                ..model(pixel, slices, slice_mm)
            };
        match self {
            Self::Line | Self::Cylinder => model(0.4492, 10, 1.0),
            Self::Curved => model(0.4492, 2, 1.0),
            Self::Cube | Self::TwoCubes | Self::CubeWithHole => {
                model(0.351_562_5, 100, 0.351_562_5)
            }
            Self::SphereShell => body([176, 176, 60], 0.5, 1.5, [0.0; 3]),
            Self::Tube => body([96, 96, 52], 0.5, 1.5, [0.0; 3]),
            Self::BoxWithHole => body([112, 96, 32], 0.5, 1.5, [0.0; 3]),
            Self::Femur => body([192, 192, 226], 0.6, 2.0, bodies::FEMUR_CENTRE),
            Self::Head => body([320, 320, 146], 0.7, 1.5, [0.0, -8.0, -25.0]),
        }
    }
}

impl FromStr for Phantom {
    type Err = PhantomError;

    fn from_str(name: &str) -> Result<Self, PhantomError> {
        Self::ALL
            .into_iter()
            .find(|p| p.name() == name)
            .ok_or_else(|| PhantomError::UnknownPhantom {
                name: name.to_owned(),
                known: Self::ALL.map(Self::name).join(", "),
            })
    }
}

impl fmt::Display for Phantom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
