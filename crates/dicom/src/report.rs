//! What is said of a series before any pixel is decoded.

use std::cmp::Ordering;
use std::path::PathBuf;

use serde::Serialize;

/// What is said of a series; nothing in it says who the patient is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeriesReport {
    /// Number in its folder, 1 is the largest.
    pub number: usize,
    /// Series Instance UID; several volumes of one series share it. Empty where the files have none.
    pub uid: String,
    /// What the scanner's operator called it.
    pub description: String,
    /// `CT`, or empty where the files do not say.
    pub modality: String,
    /// Slices of the volume, those that reading interpolates included.
    pub slices: usize,
    /// Slices that the files hold.
    pub slices_found: usize,
    /// Pixels in a column.
    pub rows: usize,
    /// Pixels in a row.
    pub columns: usize,
    /// Distance between columns, between rows, and between slices along their normal (mm).
    pub spacing_mm: [f64; 3],
    /// Voxel indices (column, row, slice) to patient millimetres (LPS), voxel centres.
    pub patient_from_voxel: [[f64; 4]; 4],
    /// Plane, tilt, and where columns, rows and slices are counted to, in words.
    pub orientation: String,
    /// Angle between the slices' normal and the line along which they are stacked (degrees).
    pub tilt_degrees: f64,
    /// Where each slice found lies along the slices' normal (mm), ascending.
    pub slice_positions_mm: Vec<f64>,
    /// Where slices are missing or lie more than 1.5 of the volume's steps apart; reading fills the
    /// places.
    pub gaps: Vec<Gap>,
    /// Whether the distances differ so that reading resamples the slices evenly.
    pub is_resampled: bool,
    /// Files (and frames) that were dropped because the same slice is there already.
    pub duplicates: Vec<String>,
    /// How the files hold the pixels.
    pub transfer_syntax: String,
    /// Memory that the volume takes (bytes).
    pub estimated_memory_bytes: u64,
    /// Smallest and largest value of the volume (HU); `None` as long as no pixel was decoded.
    pub hu_range: Option<[f64; 2]>,
    /// What a user should know: missing, uneven, doubled or cut-off slices, and the like.
    pub warnings: Vec<String>,
    /// The files, in the order of their slices.
    #[serde(serialize_with = "crate::scan::as_texts")]
    pub files: Vec<PathBuf>,
}

/// A place where slices are missing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Gap {
    /// Position of the slice before it along the slices' normal (mm).
    pub after_mm: f64,
    /// How many are missing.
    pub missing: usize,
}

impl SeriesReport {
    /// What the operator called it, or that there is no name.
    pub fn title(&self) -> &str {
        if self.description.is_empty() {
            "no description"
        } else {
            &self.description
        }
    }

    /// One line that tells this series from the others.
    pub fn in_words(&self) -> String {
        let uid = if self.uid.is_empty() {
            "no UID"
        } else {
            &self.uid
        };
        format!(
            "{} = {}, {} of {} x {}, {:.2} mm apart ({uid})",
            self.number,
            self.title(),
            self.counted(),
            self.columns,
            self.rows,
            self.spacing_mm[2],
        )
    }

    /// The whole report, a line for each subject, without the line of its name.
    pub fn lines(&self) -> Vec<String> {
        let [dx, dy, dz] = self.spacing_mm;
        let modality = if self.modality.is_empty() {
            "modality unknown"
        } else {
            &self.modality
        };
        let mut lines = vec![
            format!(
                "{modality}, {} of {} x {} pixels ({:.1} x {:.1} x {:.1} mm)",
                self.counted(),
                self.columns,
                self.rows,
                dx * self.columns as f64,
                dy * self.rows as f64,
                dz * self.slices as f64,
            ),
            format!("{dx:.4} mm between columns, {dy:.4} between rows, {dz:.4} between slices"),
            self.orientation.clone(),
        ];
        if let (Some(first), Some(last)) = (
            self.slice_positions_mm.first(),
            self.slice_positions_mm.last(),
        ) {
            lines.push(format!(
                "slices from {first:.2} to {last:.2} mm along their normal, {}",
                self.evenness()
            ));
        }
        lines.push(format!(
            "{}; about {} MiB in memory",
            self.transfer_syntax,
            self.estimated_memory_bytes.div_ceil(1 << 20)
        ));
        if let Some([low, high]) = self.hu_range {
            lines.push(format!("values from {low} to {high} HU"));
        }
        lines.push(if self.uid.is_empty() {
            "no UID".to_owned()
        } else {
            format!("UID {}", self.uid)
        });
        lines.extend(self.warnings.iter().map(|w| format!("note: {w}")));
        lines
    }

    /// How many slices there are, and how many of them the files hold.
    fn counted(&self) -> String {
        let (slices, found) = (self.slices, self.slices_found);
        match slices.cmp(&found) {
            Ordering::Equal => format!("{slices} slices"),
            Ordering::Greater => {
                format!("{found} slices found, {slices} with those between interpolated,")
            }
            Ordering::Less => format!("{found} slices found, {slices} after resampling,"),
        }
    }

    fn evenness(&self) -> String {
        let missing: usize = self.gaps.iter().map(|g| g.missing).sum();
        match (self.is_resampled, missing) {
            (true, _) => "unevenly spaced".to_owned(),
            (false, 0) => "evenly spaced".to_owned(),
            (false, missing) => format!("{missing} missing"),
        }
    }
}
