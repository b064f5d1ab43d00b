//! The two frames of a patient that files are written in.

use std::borrow::Cow;
use std::str::FromStr;

use crate::TriangleMesh;

/// Where the axes of a file's coordinates point in the patient.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum PatientFrame {
    /// To the left, the back and the head: DICOM's, and that of every mesh here.
    #[default]
    Lps,
    /// To the right, the front and the head: that of NIfTI and of many viewers. It is LPS turned by half a
    /// turn about the axis to the head, so nothing is mirrored.
    Ras,
}

impl PatientFrame {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Lps, Self::Ras];

    /// The name used in arguments.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lps => "lps",
            Self::Ras => "ras",
        }
    }

    /// A mesh in LPS, in this frame.
    pub(super) fn of(self, mesh: &TriangleMesh) -> Cow<'_, TriangleMesh> {
        match self {
            Self::Lps => Cow::Borrowed(mesh),
            Self::Ras => {
                let (mut vertices_mm, triangles) = mesh.clone().into_parts();
                for [x, y, _] in &mut vertices_mm {
                    // Not by a sign, which would make -0 of 0.
                    (*x, *y) = (0.0 - *x, 0.0 - *y);
                }
                Cow::Owned(TriangleMesh::from_sound_parts(vertices_mm, triangles))
            }
        }
    }

    /// What lengths and axes mean, for every format that has a place for words.
    pub(super) fn in_words(self) -> &'static str {
        match self {
            Self::Lps => {
                "millimetres, patient space LPS (x to the left, y to the back, z to the head)"
            }
            Self::Ras => {
                "millimetres, patient space RAS (x to the right, y to the front, z to the head)"
            }
        }
    }
}

impl FromStr for PatientFrame {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL
            .into_iter()
            .find(|frame| frame.name().eq_ignore_ascii_case(name));
        found.ok_or_else(|| format!("there is no frame `{name}`; choose lps or ras"))
    }
}
