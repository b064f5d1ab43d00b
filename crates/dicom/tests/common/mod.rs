//! Small DICOM series, written as the tests need them.

#![allow(dead_code, clippy::panic, clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use bonemesh_dicom::{DicomError, Scan, find_series, read_series};
use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};
use dicom_core::{DataElement, PrimitiveValue, Tag, VR};
use dicom_dictionary_std::{tags, uids};
use dicom_object::{FileMetaTableBuilder, InMemDicomObject};

pub(crate) const ROWS: usize = 3;
pub(crate) const COLUMNS: usize = 4;
pub(crate) const UID: &str = "1.2.3.4";

/// Stored value of the pixel at slice, row, column: no two mirror images agree.
pub(crate) fn stored(k: usize, j: usize, i: usize) -> u16 {
    (1000 + 100 * k + 10 * j + i) as u16
}

/// One image to be changed and written.
pub(crate) struct Image {
    pub(crate) elements: InMemDicomObject,
    pub(crate) syntax: &'static str,
}

impl Image {
    /// Slice `k` at z = 2 k, pixels 0.5 mm wide and 0.75 mm high, HU = stored - 1024.
    pub(crate) fn new(k: usize) -> Self {
        let mut image = Self {
            elements: InMemDicomObject::new_empty(),
            syntax: uids::EXPLICIT_VR_LITTLE_ENDIAN,
        };
        let z = 2 * k;
        for (tag, vr, text) in [
            (
                tags::SOP_CLASS_UID,
                VR::UI,
                uids::CT_IMAGE_STORAGE.to_owned(),
            ),
            (tags::SOP_INSTANCE_UID, VR::UI, format!("1.2.3.9.{}", k + 1)),
            (
                tags::IMAGE_TYPE,
                VR::CS,
                "ORIGINAL\\PRIMARY\\AXIAL".to_owned(),
            ),
            (tags::MODALITY, VR::CS, "CT".to_owned()),
            (tags::SERIES_DESCRIPTION, VR::LO, "test head".to_owned()),
            (tags::PATIENT_NAME, VR::PN, "Secret^Person".to_owned()),
            (tags::PATIENT_ID, VR::LO, "SECRET-17".to_owned()),
            (tags::SERIES_INSTANCE_UID, VR::UI, UID.to_owned()),
            (tags::INSTANCE_NUMBER, VR::IS, (k + 1).to_string()),
            (
                tags::IMAGE_POSITION_PATIENT,
                VR::DS,
                format!("-10\\20\\{z}"),
            ),
            (
                tags::IMAGE_ORIENTATION_PATIENT,
                VR::DS,
                "1\\0\\0\\0\\1\\0".to_owned(),
            ),
            (tags::PIXEL_SPACING, VR::DS, "0.75\\0.5".to_owned()),
            (
                tags::PHOTOMETRIC_INTERPRETATION,
                VR::CS,
                "MONOCHROME2".to_owned(),
            ),
            (tags::RESCALE_INTERCEPT, VR::DS, "-1024".to_owned()),
            (tags::RESCALE_SLOPE, VR::DS, "1".to_owned()),
        ] {
            image = image.text(tag, vr, &text);
        }
        for (tag, number) in [
            (tags::SAMPLES_PER_PIXEL, 1),
            (tags::ROWS, ROWS as u16),
            (tags::COLUMNS, COLUMNS as u16),
            (tags::BITS_ALLOCATED, 16),
            (tags::BITS_STORED, 16),
            (tags::HIGH_BIT, 15),
            (tags::PIXEL_REPRESENTATION, 0),
        ] {
            image = image.number(tag, number);
        }
        image.pixels(|j, i| stored(k, j, i))
    }

    pub(crate) fn text(mut self, tag: Tag, vr: VR, text: &str) -> Self {
        let element = DataElement::new(tag, vr, PrimitiveValue::from(text));
        self.elements.put(element);
        self
    }

    pub(crate) fn number(mut self, tag: Tag, number: u16) -> Self {
        let element = DataElement::new(tag, VR::US, PrimitiveValue::from(number));
        self.elements.put(element);
        self
    }

    pub(crate) fn without(mut self, tag: Tag) -> Self {
        self.elements.remove_element(tag);
        self
    }

    pub(crate) fn pixels(mut self, value: impl Fn(usize, usize) -> u16) -> Self {
        let values: Vec<u16> = (0..ROWS * COLUMNS)
            .map(|n| value(n / COLUMNS, n % COLUMNS))
            .collect();
        let value = PrimitiveValue::U16(values.into());
        let element = DataElement::new(tags::PIXEL_DATA, VR::OW, value);
        self.elements.put(element);
        self
    }

    pub(crate) fn position(self, p: [f64; 3]) -> Self {
        let text = format!("{}\\{}\\{}", p[0], p[1], p[2]);
        self.text(tags::IMAGE_POSITION_PATIENT, VR::DS, &text)
    }

    pub(crate) fn orientation(self, o: [f64; 6]) -> Self {
        let text = o.map(|v| v.to_string()).join("\\");
        self.text(tags::IMAGE_ORIENTATION_PATIENT, VR::DS, &text)
    }

    pub(crate) fn uid(self, uid: &str) -> Self {
        self.text(tags::SERIES_INSTANCE_UID, VR::UI, uid)
    }

    pub(crate) fn write(self, path: &Path) {
        let meta = FileMetaTableBuilder::new()
            .transfer_syntax(self.syntax)
            .media_storage_sop_class_uid(uids::CT_IMAGE_STORAGE)
            .media_storage_sop_instance_uid("1.2.3.9");
        let file = self.elements.with_meta(meta).unwrap();
        file.write_to_file(path).unwrap();
    }
}

/// A folder of `slices` images, each changed by `change`; named against their order.
pub(crate) fn folder(slices: usize, change: impl Fn(usize, Image) -> Image) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for k in 0..slices {
        change(k, Image::new(k)).write(&file(folder.path(), slices, k));
    }
    folder
}

pub(crate) fn file(folder: &Path, slices: usize, k: usize) -> PathBuf {
    folder.join(format!("{:04}", slices - k))
}

pub(crate) fn scan(folder: &Path) -> Scan {
    find_series(folder, &Task::default()).unwrap()
}

pub(crate) fn error(folder: &Path) -> DicomError {
    find_series(folder, &Task::default()).unwrap_err()
}

/// The volume of a folder's only series, and the warnings.
pub(crate) fn read(folder: &Path) -> (Volume, Vec<String>) {
    let scan = scan(folder);
    assert_eq!(scan.series.len(), 1, "{:?}", scan.left_out);
    read_series(&scan.series[0], &Task::default()).unwrap()
}

pub(crate) fn hu(volume: &Volume, at: [usize; 3]) -> f64 {
    match volume.voxels() {
        Voxels::I16(hu) => f64::from(hu[at]),
        Voxels::F32(hu) => f64::from(hu[at]),
    }
}

pub(crate) fn assert_near(a: [f64; 3], b: [f64; 3]) {
    for (x, y) in a.into_iter().zip(b) {
        assert!((x - y).abs() < 1e-6, "{a:?} is not {b:?}");
    }
}
