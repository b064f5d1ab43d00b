//! A phantom on disk: the DICOM series and what is known about the body in it.

use std::fs;
use std::path::{Path, PathBuf};

use bonemesh_task::Task;
use serde_json::{Map, Value, json};

use crate::dicom::{check_target, move_into_place, workshop_beside};
use crate::{BONE_HU, Phantom, PhantomError, SOFT_HU, ScanSettings, SeriesLabels};
use crate::{scan, write_dicom_series};

/// Where a phantom was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenPhantom {
    /// Folder of the DICOM series.
    pub series: PathBuf,
    /// Files of the series in slice order.
    pub files: Vec<PathBuf>,
    /// JSON file that tells the truth about the body.
    pub truth: PathBuf,
}

/// Scans a phantom and writes `dir/dicom/*.dcm` and `dir/truth.json`.
///
/// # Errors
/// [`PhantomError`] for settings that make no scan, a folder that holds files already, failures
/// of the system, and when cancelled; nothing is left behind then.
pub fn write_phantom(
    phantom: Phantom,
    dir: &Path,
    settings: &ScanSettings,
    task: &Task,
) -> Result<WrittenPhantom, PhantomError> {
    check_target(dir)?;
    let volume = scan(phantom, settings, task)?;
    let workshop = workshop_beside(dir)?;
    let fresh = workshop.path().join("phantom");
    fs::create_dir(&fresh).map_err(|e| PhantomError::write(&fresh, &e))?;
    let labels = SeriesLabels {
        patient_name: format!("Phantom^{}", capitalised(phantom.name())),
        series_description: format!("Phantom {phantom}"),
        patient_position: settings.orientation.patient_position,
        ..SeriesLabels::default()
    };
    let files = write_dicom_series(&volume, &fresh.join("dicom"), &labels, task)?;
    let truth = truth(phantom, settings)?;
    let path = fresh.join("truth.json");
    fs::write(&path, format!("{truth:#}\n")).map_err(|e| PhantomError::write(&path, &e))?;
    move_into_place(&fresh, dir)?;
    let series = dir.join("dicom");
    let files = files
        .iter()
        .filter_map(|f| f.file_name())
        .map(|name| series.join(name))
        .collect();
    Ok(WrittenPhantom {
        files,
        series,
        truth: dir.join("truth.json"),
    })
}

/// What is known about a phantom scanned with `settings`, as JSON (patient frame LPS, mm).
///
/// # Errors
/// [`PhantomError`] for settings that make no scan.
pub fn truth(phantom: Phantom, settings: &ScanSettings) -> Result<Value, PhantomError> {
    let geometry = settings.geometry()?;
    let mut facts = Map::new();
    facts.insert("phantom".into(), json!(phantom.name()));
    facts.insert("description".into(), json!(phantom.description()));
    facts.insert(
        "frame".into(),
        json!("patient LPS, mm: +x to the patient's left"),
    );
    facts.insert("bone_hu".into(), json!(BONE_HU));
    facts.insert("soft_tissue_hu".into(), json!(SOFT_HU));
    if let Some(known) = phantom.known() {
        let parameters: Map<_, _> = pairs(&known.parameters);
        facts.insert("parameters".into(), parameters.into());
        facts.insert("landmarks_mm".into(), pairs(&known.landmarks).into());
        facts.insert("volume_mm3".into(), json!(known.volume_mm3));
    } else if let Some(model) = phantom.model() {
        let image = model.draw(settings.columns, settings.rows)?;
        let pixels = image.iter().filter(|bone| **bone).count();
        let voxel_mm3 = geometry.patient_from_voxel().determinant().abs();
        let volume_mm3 = pixels as f64 * settings.slices as f64 * voxel_mm3;
        facts.insert("parameters".into(), json!({ "pixels_per_slice": pixels }));
        facts.insert("volume_mm3".into(), json!(volume_mm3));
    }
    facts.insert("scan".into(), scan_facts(settings, &geometry));
    Ok(facts.into())
}

fn scan_facts(settings: &ScanSettings, geometry: &bonemesh_volume::Geometry) -> Value {
    json!({
        "columns": settings.columns,
        "rows": settings.rows,
        "slices": settings.slices,
        "pixel_mm": settings.pixel_mm,
        "slice_mm": settings.slice_mm,
        "orientation": settings.orientation.to_string(),
        "patient_position": settings.orientation.patient_position.code(),
        "psf_px": settings.psf_px,
        "noise_hu": settings.noise_hu,
        "seed": settings.seed,
        "patient_from_voxel": geometry.patient_from_voxel().matrix(),
    })
}

fn pairs<T: serde::Serialize>(facts: &[(&'static str, T)]) -> Map<String, Value> {
    facts
        .iter()
        .map(|(name, value)| ((*name).to_owned(), json!(value)))
        .collect()
}

fn capitalised(name: &str) -> String {
    let mut letters = name.chars();
    letters
        .next()
        .map(|first| first.to_uppercase().chain(letters).collect())
        .unwrap_or_default()
}
