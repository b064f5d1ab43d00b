//! What a folder holds is sorted out, and what is meant is never guessed.

mod common;

use bonemesh_dicom::{DicomError, SeriesChoice, find_series, read_series};
use bonemesh_task::{Cancel, Task};
use common::{Image, UID, error, file, folder, hu, read, scan, stored};
use dicom_core::VR;
use dicom_dictionary_std::tags;

#[test]
fn two_series_are_a_choice() {
    let folder = folder(8, |_, image| image);
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    for k in 0..5 {
        let image = Image::new(k).uid("1.2.3.5");
        image.write(&folder.path().join("sub").join(k.to_string()));
    }
    let scan = scan(folder.path());
    let found: Vec<(usize, &str, usize)> = scan
        .series
        .iter()
        .map(|s| (s.number, s.uid.as_str(), s.slices))
        .collect();
    assert_eq!(found, [(1, UID, 8), (2, "1.2.3.5", 5)]);
    let ambiguous = scan.choose(None).unwrap_err().to_string();
    assert!(ambiguous.contains("1 = test head, 8 slices"), "{ambiguous}");
    assert!(ambiguous.contains("1.2.3.5"), "{ambiguous}");
    let choose = |text: &str| scan.choose(Some(&text.parse::<SeriesChoice>().unwrap()));
    assert_eq!(choose("2").unwrap().slices, 5);
    assert_eq!(choose("1.2.3.4").unwrap().slices, 8);
    assert!(matches!(choose("3"), Err(DicomError::NoSuchSeries { .. })));
    assert!(matches!(
        choose("1.2.3.6"),
        Err(DicomError::NoSuchSeries { .. })
    ));
}

#[test]
fn a_few_marks_beside_a_long_stack_are_no_rival() {
    let folder = folder(30, |_, image| image);
    for k in 0..3 {
        let image = Image::new(k).uid("1.2.3.5");
        image.write(&folder.path().join(format!("mark{k}")));
    }
    let scan = scan(folder.path());
    assert_eq!(scan.series.len(), 2);
    assert_eq!(scan.choose(None).unwrap().slices, 30);
}

#[test]
fn what_is_no_slice_is_left_out_with_its_reason() {
    let folder = folder(4, |_, image| image);
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("a.txt"), "no image").unwrap();
    std::fs::write(path("b.dcm"), "").unwrap();
    let localizer = "ORIGINAL\\PRIMARY\\LOCALIZER";
    let spacing = |text| Image::new(9).text(tags::PIXEL_SPACING, VR::DS, text);
    for (name, image) in [
        ("c", Image::new(9).text(tags::IMAGE_TYPE, VR::CS, localizer)),
        ("d", Image::new(9).text(tags::MODALITY, VR::CS, "MR")),
        ("e", Image::new(9).without(tags::PIXEL_DATA)),
        ("f", spacing("0\\0.5")),
        ("g", spacing("nan\\0.5")),
        ("h", Image::new(9).without(tags::IMAGE_POSITION_PATIENT)),
        (
            "i",
            Image::new(9).orientation([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        ),
        ("j", Image::new(9).number(tags::SAMPLES_PER_PIXEL, 3)),
        ("k", Image::new(9).number(tags::ROWS, 400)),
        ("l", Image::new(9).number(tags::BITS_STORED, 17)),
        ("m", Image::new(9).text(tags::RESCALE_SLOPE, VR::DS, "0")),
    ] {
        image.write(&path(name));
    }
    let scan = scan(folder.path());
    let reasons: Vec<&str> = scan.left_out.iter().map(|f| f.reason.as_str()).collect();
    let expected = [
        "not a DICOM file",
        "empty file",
        "localizer",
        "modality MR, not CT",
        "no image: no pixels",
        "pixel spacing 0 x 0.5 mm",
        "no pixel spacing",
        "no position",
        "not two perpendicular directions",
        "a colour picture",
        "fewer pixels than rows and columns say",
        "make no sense",
        "rescale slope 0",
    ];
    assert_eq!(reasons.len(), expected.len(), "{reasons:?}");
    for (reason, part) in reasons.iter().zip(expected) {
        assert!(reason.contains(part), "{reason} does not say {part}");
    }
    assert_eq!(scan.series[0].slices, 4);
}

#[test]
fn copies_are_dropped_and_different_images_kept_apart() {
    let folder = folder(6, |_, image| image);
    Image::new(2).write(&folder.path().join("copy"));
    let copied = scan(folder.path());
    assert_eq!(copied.series.len(), 1);
    assert_eq!(copied.series[0].slices, 6);
    assert!(copied.series[0].warnings[0].contains("1 slice is at the place of another"));
    assert!(copied.left_out[0].path.ends_with("copy"));
    for k in 0..5 {
        let image = Image::new(k).pixels(|j, i| stored(k, j, i) + 7);
        let image = image.text(tags::INSTANCE_NUMBER, VR::IS, &(100 + k).to_string());
        image.write(&folder.path().join(format!("second{k}")));
    }
    let scan = scan(folder.path());
    let slices: Vec<usize> = scan.series.iter().map(|s| s.slices).collect();
    assert_eq!(slices, [6, 5]);
    let second = read_series(&scan.series[1], &Task::default()).unwrap().0;
    assert!((hu(&second, [3, 1, 1]) - (f64::from(stored(3, 1, 1)) + 7.0 - 1024.0)).abs() < 1e-9);
}

#[test]
fn acquisitions_are_one_stack_unless_they_overlap() {
    let stepping = folder(9, |k, image| {
        image.text(tags::ACQUISITION_NUMBER, VR::IS, &(k / 3).to_string())
    });
    assert_eq!(scan(stepping.path()).series.len(), 1);
    let overlapping = folder(12, |k, image| {
        let z = if k < 6 { k as f64 } else { k as f64 - 4.5 };
        let image = image.position([0.0, 0.0, z]);
        let image = image.text(tags::ACQUISITION_NUMBER, VR::IS, &(k / 6).to_string());
        image.pixels(move |j, i| stored(k, j, i))
    });
    let slices: Vec<usize> = scan(overlapping.path())
        .series
        .iter()
        .map(|s| s.slices)
        .collect();
    // Between one scan's slices lie those of another time: one stack would alternate.
    assert_eq!(slices, [6, 6]);
    let repeated = folder(12, |k, image| {
        let image = image.position([0.0, 0.0, (k % 6) as f64]);
        image.text(tags::ACQUISITION_NUMBER, VR::IS, &(k / 6).to_string())
    });
    let slices: Vec<usize> = scan(repeated.path())
        .series
        .iter()
        .map(|s| s.slices)
        .collect();
    assert_eq!(slices, [6, 6]);
}

#[test]
fn sizes_and_planes_do_not_mix() {
    let folder = folder(5, |_, image| image);
    for k in 0..4 {
        let image = Image::new(k).orientation([0.0, 1.0, 0.0, 0.0, 0.0, -1.0]);
        let image = image.position([k as f64, 0.0, 0.0]);
        image.write(&folder.path().join(format!("sagittal{k}")));
        let image = Image::new(k).text(tags::PIXEL_SPACING, VR::DS, "0.9\\0.9");
        image.write(&folder.path().join(format!("zoomed{k}")));
    }
    let slices: Vec<usize> = scan(folder.path())
        .series
        .iter()
        .map(|s| s.slices)
        .collect();
    assert_eq!(slices, [5, 4, 4]);
}

#[test]
fn a_cut_off_file_is_named_and_its_slice_filled() {
    let folder = folder(6, |_, image| image);
    let cut = file(folder.path(), 6, 3);
    let bytes = std::fs::read(&cut).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() - 5]).unwrap();
    let (volume, warnings) = read(folder.path());
    assert_eq!(volume.geometry().shape()[0], 6);
    let all = warnings.join("; ");
    assert!(
        all.contains("1 file is cut off") && all.contains("0003"),
        "{all}"
    );
    assert!((hu(&volume, [3, 0, 0]) - (f64::from(stored(3, 0, 0)) - 1024.0)).abs() < 1e-9);
}

#[test]
fn too_many_unreadable_slices_are_an_error_with_the_first_name() {
    let folder = folder(6, |_, image| image);
    let scan = scan(folder.path());
    for k in 0..4 {
        std::fs::write(file(folder.path(), 6, k), b"gone").unwrap();
    }
    let error = read_series(&scan.series[0], &Task::default()).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("only 2 of 6 slices") && text.contains("0006"),
        "{text}"
    );
}

#[test]
fn unusable_folders_are_refused_in_one_line_with_the_remedy() {
    let empty = tempfile::tempdir().unwrap();
    let text = folder(0, |_, image| image);
    std::fs::write(text.path().join("readme.txt"), "hello").unwrap();
    let single = folder(1, |_, image| image);
    let missing = empty.path().join("missing");
    let a_file = text.path().join("readme.txt");
    for (path, part) in [
        (empty.path(), "it is empty"),
        (text.path(), "1 left out: not a DICOM file"),
        (single.path(), "a volume needs at least 2"),
        (missing.as_path(), "does not exist; check the path"),
        (
            a_file.as_path(),
            "is a file, no volume by itself (not a DICOM file); give the folder",
        ),
    ] {
        let message = error(path).to_string();
        assert!(message.contains(part), "{message}");
        assert!(!message.contains('\n'));
    }
}

#[cfg(unix)]
#[test]
fn pipes_and_circular_links_do_not_hang() {
    let folder = folder(3, |_, image| image);
    let made = std::process::Command::new("mkfifo")
        .arg(folder.path().join("pipe"))
        .status();
    std::os::unix::fs::symlink(folder.path(), folder.path().join("round")).unwrap();
    let scan = scan(folder.path());
    assert_eq!(scan.series[0].slices, 3);
    let expected = 1 + usize::from(made.is_ok_and(|s| s.success()));
    assert_eq!(scan.left_out.len(), expected);
}

#[test]
fn the_report_says_nothing_about_the_patient() {
    let folder = folder(3, |_, image| image);
    let scan = scan(folder.path());
    let report = serde_json::to_string(&scan).unwrap();
    assert!(report.contains("test head"));
    for part in ["Secret", "SECRET", "Person"] {
        assert!(!report.contains(part));
        assert!(!format!("{scan:?}").contains(part));
    }
}

#[test]
fn a_cancelled_task_stops_both_steps() {
    let folder = folder(3, |_, image| image);
    let scan = scan(folder.path());
    let cancel = Cancel::default();
    cancel.cancel();
    let task = Task::new(cancel);
    let found = find_series(folder.path(), &task);
    assert!(matches!(found, Err(DicomError::Cancelled(_))));
    let read = read_series(&scan.series[0], &task);
    assert!(matches!(read, Err(DicomError::Cancelled(_))));
}
