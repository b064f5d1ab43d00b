//! What is said of a series is what its files hold.

#![allow(clippy::unwrap_used, clippy::float_cmp)]

mod common;

use bonemesh_dicom::{DicomError, Gap, find_one_series, find_series, read_series};
use bonemesh_task::Task;
use common::{Image, file, folder, scan};
use dicom_core::VR;
use dicom_dictionary_std::tags;

#[test]
fn positions_gaps_and_duplicates_are_named() {
    let folder = folder(9, |k, image| image.position([0.0, 0.0, 2.0 * k as f64]));
    std::fs::remove_file(file(folder.path(), 9, 3)).unwrap();
    std::fs::remove_file(file(folder.path(), 9, 4)).unwrap();
    std::fs::copy(file(folder.path(), 9, 7), folder.path().join("copy")).unwrap();
    let scan = scan(folder.path());
    let series = &scan.series[0];
    assert_eq!(
        series.slice_positions_mm,
        [0.0, 2.0, 4.0, 10.0, 12.0, 14.0, 16.0]
    );
    let gap = Gap {
        after_mm: 4.0,
        missing: 2,
    };
    assert_eq!(series.gaps, [gap]);
    assert_eq!(series.duplicates, ["copy"]);
    assert!(!series.is_resampled);
    assert_eq!((series.slices, series.slices_found), (9, 7));
    let lines = series.lines();
    assert!(
        lines.contains(&"slices from 0.00 to 16.00 mm along their normal, 2 missing".to_owned()),
        "{lines:?}"
    );
    assert!(lines.iter().all(|l| !l.contains('\n')));
}

#[test]
fn the_largest_series_is_recommended_and_its_rivals_are_named() {
    let folder = folder(30, |_, image| image);
    for (uid, slices) in [("1.2.3.5", 12), ("1.2.3.6", 2)] {
        for k in 0..slices {
            let name = format!("{uid}-{k}");
            Image::new(k).uid(uid).write(&folder.path().join(name));
        }
    }
    let scan = scan(folder.path());
    assert_eq!(scan.series.len(), 3);
    assert_eq!((scan.recommended, &scan.alternatives[..]), (1, &[2][..]));
    let json = serde_json::to_value(&scan).unwrap();
    assert_eq!(json["recommended"], 1);
    assert_eq!(json["series"][2]["slices_found"], 2);
    assert_eq!(json["series"][0]["hu_range"], serde_json::Value::Null);
}

#[test]
fn broken_uids_make_one_series_where_it_is_asked_for() {
    let folder = folder(6, |k, image| {
        image.uid(&format!("1.2.3.{k}")).text(
            tags::ACQUISITION_NUMBER,
            VR::IS,
            &(k / 2).to_string(),
        )
    });
    let strict = find_series(folder.path(), &Task::default());
    let strict = strict.unwrap_err();
    assert!(matches!(strict, DicomError::NoSeries { .. }));
    assert!(
        strict.to_string().contains("take the folder as one series"),
        "{strict}"
    );
    let scan = find_one_series(folder.path(), &Task::default()).unwrap();
    assert_eq!(scan.series.len(), 1);
    let (volume, warnings) = read_series(&scan.series[0], &Task::default()).unwrap();
    assert_eq!(volume.geometry().shape()[0], 6);
    assert!(
        warnings.iter().any(|w| w.contains("6 series")),
        "{warnings:?}"
    );
}

#[test]
fn the_index_of_a_disc_stands_for_its_folder() {
    let folder = folder(4, |_, image| image);
    let index = folder.path().join("DICOMDIR");
    std::fs::write(&index, "an index, which is not needed").unwrap();
    let scan = find_series(&index, &Task::default()).unwrap();
    assert_eq!(scan.series[0].slices, 4);
}

#[test]
fn volumes_and_archives_among_the_slices_are_named_with_what_to_do() {
    let folder = folder(4, |_, image| image);
    for name in ["head.nii.gz", "head.zip", "notes"] {
        std::fs::write(folder.path().join(name), "anything").unwrap();
    }
    let scan = scan(folder.path());
    let reasons: Vec<&str> = scan.left_out.iter().map(|l| l.reason.as_str()).collect();
    assert!(
        reasons[0].contains("open it by its own path"),
        "{reasons:?}"
    );
    assert!(reasons[1].contains("unpack it"), "{reasons:?}");
    assert_eq!(reasons[2], "not a DICOM file");
}

#[test]
fn values_that_are_no_hounsfield_units_are_said_to_be_none() {
    let folder = folder(4, |_, image| image.text(tags::RESCALE_TYPE, VR::LO, "US"));
    let warnings = scan(folder.path()).series[0].warnings.clone();
    assert!(warnings[0].contains("`US`, not as HU"), "{warnings:?}");
    let honest = common::folder(4, |_, image| image.text(tags::RESCALE_TYPE, VR::LO, "HU"));
    assert!(scan(honest.path()).series[0].warnings.is_empty());
}

#[test]
fn magnetic_resonance_and_positron_series_are_named_and_refused() {
    for modality in ["MR", "PT"] {
        let folder = folder(4, |_, image| image.text(tags::MODALITY, VR::CS, modality));
        let error = find_series(folder.path(), &Task::default()).unwrap_err();
        let expected = format!("4 left out: modality {modality}, not CT");
        assert!(error.to_string().contains(&expected), "{error}");
    }
}

#[test]
fn a_crowd_of_slices_at_one_place_is_not_looked_through() {
    let folder = folder(3, |_, image| image);
    for n in 0..300 {
        let image = Image::new(1).pixels(|j, i| (1000 + 10 * (n % 2) + j + i) as u16);
        image.write(&folder.path().join(format!("crowd{n:03}")));
    }
    let scan = scan(folder.path());
    assert_eq!(scan.series[0].slices_found, 3);
    let reason = |wanted: &str| {
        let reasons = scan.left_out.iter().map(|l| l.reason.as_str());
        reasons.filter(|r| *r == wanted).count()
    };
    assert_eq!(reason("too many slices at one place"), 301 - 256);
    let notes = &scan.series[0].warnings;
    assert!(
        notes.iter().any(|n| n.contains("45 were left out unseen")),
        "{notes:?}"
    );
}
