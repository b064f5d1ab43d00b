//! The attributes of the CT Image IOD (DICOM PS3.3 A.3), module by module.

use bonemesh_volume::Volume;
use dicom_core::{DataElement, PrimitiveValue, Tag, VR};
use dicom_dictionary_std::{tags, uids};
use dicom_object::{FileMetaTableBuilder, InMemDicomObject};

use super::SeriesLabels;
use super::decimal::{decimal, decimals};
use super::stored::Rescale;
use super::uid::Fingerprint;
use crate::PhantomError;

/// Longest text of the value representations LO and PN.
const LONGEST_TEXT: usize = 64;

/// A series about to be written: what its files share.
pub(super) struct Series<'a> {
    volume: &'a Volume,
    labels: &'a SeriesLabels,
    rescale: Rescale,
    content: Fingerprint,
}

impl<'a> Series<'a> {
    pub(super) fn new(volume: &'a Volume, labels: &'a SeriesLabels) -> Result<Self, PhantomError> {
        for (what, text) in [
            ("PatientName", &labels.patient_name),
            ("PatientID", &labels.patient_id),
            ("StudyDescription", &labels.study_description),
            ("SeriesDescription", &labels.series_description),
        ] {
            let plain = |c: char| c.is_ascii() && !c.is_ascii_control() && c != '\\';
            if text.len() > LONGEST_TEXT || !text.chars().all(plain) {
                return Err(PhantomError::Dicom {
                    what,
                    value: format!("{text:?}"),
                    remedy: "use at most 64 ASCII letters without a backslash",
                });
            }
        }
        let rescale = Rescale::of(volume)?;
        let content = fingerprint(volume, labels, &rescale);
        Ok(Self {
            volume,
            labels,
            rescale,
            content,
        })
    }

    /// The bytes of one slice's file.
    pub(super) fn file(&self, slice: usize) -> Result<Vec<u8>, PhantomError> {
        let mut data = InMemDicomObject::new_empty();
        self.patient_and_study(&mut data);
        self.series_and_equipment(&mut data);
        self.image(&mut data, slice);
        self.plane(&mut data, slice);
        self.pixels(&mut data, slice);
        let failed = |e: &dyn std::error::Error| PhantomError::Dicom {
            what: "the data set",
            value: e.to_string(),
            remedy: "report this as a bug",
        };
        let meta = FileMetaTableBuilder::new().transfer_syntax(uids::EXPLICIT_VR_LITTLE_ENDIAN);
        let file = data.with_meta(meta).map_err(|e| failed(&e))?;
        let mut bytes = Vec::new();
        file.write_all(&mut bytes).map_err(|e| failed(&e))?;
        Ok(bytes)
    }

    fn patient_and_study(&self, data: &mut InMemDicomObject) {
        text(data, tags::PATIENT_NAME, VR::PN, &self.labels.patient_name);
        text(data, tags::PATIENT_ID, VR::LO, &self.labels.patient_id);
        text(data, tags::PATIENT_BIRTH_DATE, VR::DA, "");
        text(data, tags::PATIENT_SEX, VR::CS, "O");
        let study = self.content.with(b"study").uid();
        text(data, tags::STUDY_INSTANCE_UID, VR::UI, &study);
        text(data, tags::STUDY_DATE, VR::DA, "20000101");
        text(data, tags::STUDY_TIME, VR::TM, "000000");
        text(data, tags::REFERRING_PHYSICIAN_NAME, VR::PN, "");
        text(data, tags::STUDY_ID, VR::SH, "1");
        text(data, tags::ACCESSION_NUMBER, VR::SH, "");
        let description = &self.labels.study_description;
        text(data, tags::STUDY_DESCRIPTION, VR::LO, description);
    }

    fn series_and_equipment(&self, data: &mut InMemDicomObject) {
        text(data, tags::MODALITY, VR::CS, "CT");
        let series = self.content.with(b"series").uid();
        text(data, tags::SERIES_INSTANCE_UID, VR::UI, &series);
        let number = self.labels.series_number.to_string();
        text(data, tags::SERIES_NUMBER, VR::IS, &number);
        let description = &self.labels.series_description;
        text(data, tags::SERIES_DESCRIPTION, VR::LO, description);
        // Which of a pair of limbs it is remains open.
        text(data, tags::LATERALITY, VR::CS, "");
        let position = self.labels.patient_position.code();
        text(data, tags::PATIENT_POSITION, VR::CS, position);
        let frame = self.content.with(b"frame of reference").uid();
        text(data, tags::FRAME_OF_REFERENCE_UID, VR::UI, &frame);
        text(data, tags::POSITION_REFERENCE_INDICATOR, VR::LO, "");
        text(data, tags::MANUFACTURER, VR::LO, "Bonemesh");
        text(data, tags::MANUFACTURER_MODEL_NAME, VR::LO, "Phantom");
        text(
            data,
            tags::SOFTWARE_VERSIONS,
            VR::LO,
            env!("CARGO_PKG_VERSION"),
        );
    }

    fn image(&self, data: &mut InMemDicomObject, slice: usize) {
        let instance = self.content.with(&(slice as u64).to_le_bytes()).uid();
        text(data, tags::SOP_CLASS_UID, VR::UI, uids::CT_IMAGE_STORAGE);
        text(data, tags::SOP_INSTANCE_UID, VR::UI, &instance);
        text(data, tags::IMAGE_TYPE, VR::CS, "ORIGINAL\\PRIMARY\\AXIAL");
        let number = (slice + 1).to_string();
        text(data, tags::INSTANCE_NUMBER, VR::IS, &number);
        text(data, tags::ACQUISITION_NUMBER, VR::IS, "1");
        text(data, tags::CONTENT_DATE, VR::DA, "20000101");
        text(data, tags::CONTENT_TIME, VR::TM, "000000");
        text(data, tags::BURNED_IN_ANNOTATION, VR::CS, "NO");
        text(data, tags::KVP, VR::DS, "");
        text(
            data,
            tags::RESCALE_INTERCEPT,
            VR::DS,
            &decimal(self.rescale.intercept),
        );
        text(
            data,
            tags::RESCALE_SLOPE,
            VR::DS,
            &decimal(self.rescale.slope),
        );
        text(data, tags::RESCALE_TYPE, VR::LO, "HU");
        text(data, tags::WINDOW_CENTER, VR::DS, "400");
        text(data, tags::WINDOW_WIDTH, VR::DS, "2000");
    }

    fn plane(&self, data: &mut InMemDicomObject, slice: usize) {
        let geometry = self.volume.geometry();
        let affine = geometry.patient_from_voxel();
        let [dx, dy, dz] = geometry.spacing_mm();
        let position = affine.apply([0.0, 0.0, slice as f64]);
        let directions: Vec<f64> = affine
            .axis(0)
            .map(|v| v / dx)
            .into_iter()
            .chain(affine.axis(1).map(|v| v / dy))
            .collect();
        let location = geometry.image_from_voxel().apply([0.0, 0.0, slice as f64])[2];
        text(
            data,
            tags::IMAGE_POSITION_PATIENT,
            VR::DS,
            &decimals(&position),
        );
        text(
            data,
            tags::IMAGE_ORIENTATION_PATIENT,
            VR::DS,
            &decimals(&directions),
        );
        // Between rows first, then between columns.
        text(data, tags::PIXEL_SPACING, VR::DS, &decimals(&[dy, dx]));
        text(data, tags::SLICE_THICKNESS, VR::DS, &decimal(dz));
        text(data, tags::SLICE_LOCATION, VR::DS, &decimal(location));
    }

    fn pixels(&self, data: &mut InMemDicomObject, slice: usize) {
        let [_, rows, columns] = self.volume.geometry().shape();
        word(data, tags::SAMPLES_PER_PIXEL, 1);
        text(
            data,
            tags::PHOTOMETRIC_INTERPRETATION,
            VR::CS,
            "MONOCHROME2",
        );
        word(data, tags::ROWS, rows as u16);
        word(data, tags::COLUMNS, columns as u16);
        word(data, tags::BITS_ALLOCATED, 16);
        word(data, tags::BITS_STORED, 16);
        word(data, tags::HIGH_BIT, 15);
        word(
            data,
            tags::PIXEL_REPRESENTATION,
            u16::from(self.rescale.signed),
        );
        let stored = self.rescale.slice(self.volume, slice);
        let value = PrimitiveValue::U16(stored.into());
        data.put(DataElement::new(tags::PIXEL_DATA, VR::OW, value));
    }
}

fn text(data: &mut InMemDicomObject, tag: Tag, vr: VR, value: &str) {
    let value = if value.is_empty() {
        PrimitiveValue::Empty
    } else {
        PrimitiveValue::from(value)
    };
    data.put(DataElement::new(tag, vr, value));
}

fn word(data: &mut InMemDicomObject, tag: Tag, value: u16) {
    data.put(DataElement::new(tag, VR::US, PrimitiveValue::from(value)));
}

/// Hash of labels, geometry and voxels.
fn fingerprint(volume: &Volume, labels: &SeriesLabels, rescale: &Rescale) -> Fingerprint {
    let mut hash = Fingerprint::new()
        .with(labels.patient_name.as_bytes())
        .with(labels.patient_id.as_bytes())
        .with(labels.study_description.as_bytes())
        .with(labels.series_description.as_bytes())
        .with(&labels.series_number.to_le_bytes());
    for value in volume
        .geometry()
        .patient_from_voxel()
        .matrix()
        .iter()
        .flatten()
    {
        hash = hash.with(&value.to_bits().to_le_bytes());
    }
    for slice in 0..volume.geometry().shape()[0] {
        let stored = rescale.slice(volume, slice);
        let bytes: Vec<u8> = stored.into_iter().flat_map(u16::to_le_bytes).collect();
        hash = hash.with(&bytes);
    }
    hash
}
