//! Images of different times, acquisitions and patients never end up in one volume unsaid.

#![allow(clippy::unwrap_used)]

mod common;

use std::path::Path;

use bonemesh_dicom::{Scan, find_one_series, find_series, read_series};
use bonemesh_task::Task;
use bonemesh_volume::Voxels;
use common::{Image, file, folder, scan};
use dicom_core::{Tag, VR};
use dicom_dictionary_std::tags;

const GUESSED: &str = "nothing in the files tells the times apart";

/// Slice `k` of a phase: every pixel tells which phase it is of.
fn image(k: usize, phase: u16) -> Image {
    let image = Image::new(k).pixels(move |j, i| 1000 * (phase + 1) + (10 * j + i) as u16);
    image.without(tags::INSTANCE_NUMBER)
}

/// The phases of the slices of each series, by series.
fn phases(scan: &Scan) -> Vec<Vec<u16>> {
    let read = |series| {
        let (volume, _) = read_series(series, &Task::default()).unwrap();
        let Voxels::I16(hu) = volume.voxels() else {
            return Vec::new();
        };
        let of = |k| (hu[[k, 0, 0]] + 1024) as u16 / 1000 - 1;
        (0..series.slices).map(of).collect()
    };
    scan.series.iter().map(read).collect()
}

/// Two phases of 6 slices, named so that file names shuffle them, changed by `change`.
fn two_phases(change: impl Fn(usize, u16, Image) -> Image) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for k in 0..6 {
        for phase in 0..2 {
            let name = format!("{k}{}", (usize::from(phase) + k) % 2);
            let image = change(k, phase, image(k, phase));
            image.write(&folder.path().join(name));
        }
    }
    folder
}

fn warns(scan: &Scan, of: &str) -> bool {
    scan.series[0].warnings.iter().any(|w| w.contains(of))
}

fn assert_apart(folder: &Path, why: &str) {
    let scan = scan(folder);
    let mut found = phases(&scan);
    found.sort();
    assert_eq!(found, [vec![0; 6], vec![1; 6]], "{why}");
    assert!(!warns(&scan, GUESSED), "{why}");
}

#[test]
fn phases_are_told_apart_by_every_tag_that_names_a_time() {
    let times: [(Tag, VR, [&str; 2]); 7] = [
        (tags::TEMPORAL_POSITION_IDENTIFIER, VR::IS, ["1", "2"]),
        (tags::ACQUISITION_NUMBER, VR::IS, ["1", "2"]),
        (tags::ACQUISITION_TIME, VR::TM, ["095959.5", "100000"]),
        (
            tags::ACQUISITION_DATE_TIME,
            VR::DT,
            ["20240102095959.5+0100", "20240102100000.25+0100"],
        ),
        (tags::TRIGGER_TIME, VR::DS, ["0", "120.5"]),
        (tags::CONTENT_TIME, VR::TM, ["0959", "1000"]),
        (tags::SERIES_INSTANCE_UID, VR::UI, ["1.2.5", "1.2.6"]),
    ];
    for (tag, vr, values) in times {
        let folder = two_phases(|_, p, image| image.text(tag, vr, values[usize::from(p)]));
        assert_apart(folder.path(), &format!("{tag}"));
    }
}

#[test]
fn series_taken_as_one_are_still_told_apart_by_their_uids() {
    let folder = two_phases(|_, p, image| image.uid(["1.2.5", "1.2.6"][usize::from(p)]));
    let scan = find_one_series(folder.path(), &Task::default()).unwrap();
    assert_eq!(phases(&scan), [vec![0; 6], vec![1; 6]]);
}

#[test]
fn a_clock_that_runs_on_over_the_places_orders_each_place() {
    let folder = two_phases(|k, p, image| {
        let seconds = if k % 2 == 0 { 10 * k } else { 10 * k + 3 } + 5 * usize::from(p);
        image.text(tags::ACQUISITION_TIME, VR::TM, &format!("1000{seconds:02}"))
    });
    assert_apart(folder.path(), "clock");
}

#[test]
fn phases_without_any_time_are_said_to_be_mixed() {
    let folder = two_phases(|_, _, image| image);
    assert!(warns(&scan(folder.path()), GUESSED));
}

#[test]
fn slices_that_look_the_same_at_all_times_stay_in_each_phase() {
    let folder = two_phases(|k, p, image| {
        let image = image.text(tags::TRIGGER_TIME, VR::DS, &p.to_string());
        if k == 3 {
            image.pixels(|_, _| 1)
        } else {
            image
        }
    });
    let scan = scan(folder.path());
    let slices: Vec<usize> = scan.series.iter().map(|s| s.slices_found).collect();
    assert_eq!(slices, [6, 6]);
    assert!(scan.left_out.is_empty());
}

#[test]
fn a_longer_and_a_shorter_scan_never_alternate() {
    for (by, part) in [("instance", 0), ("instance", 12), ("folder", 0)] {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a", "b"] {
            std::fs::create_dir(folder.path().join(name)).unwrap();
        }
        for k in 0..24 {
            let number = |image: Image, n: usize| match by {
                "instance" => image.text(tags::INSTANCE_NUMBER, VR::IS, &n.to_string()),
                _ => image,
            };
            let long = number(image(k, 0), 13 + k);
            long.write(&folder.path().join(format!("b/{k:02}")));
            if (part..part + 12).contains(&k) {
                let place = if part == 0 { 2 * k } else { k };
                let short = number(image(place, 1), 1 + k - part);
                short.write(&folder.path().join(format!("a/{k:02}")));
            }
        }
        let scan = scan(folder.path());
        assert_eq!(phases(&scan), [vec![0; 24], vec![1; 12]], "{by} {part}");
        assert!(!warns(&scan, GUESSED));
    }
}

#[test]
fn acquisitions_half_a_step_apart_are_two_stacks() {
    let folder = tempfile::tempdir().unwrap();
    for k in 0..8 {
        for phase in 0..2_u16 {
            let z = k as f64 + 0.5 * f64::from(phase);
            let image = image(k, phase).position([0.0, 0.0, z]);
            let image = image.text(tags::ACQUISITION_NUMBER, VR::IS, &(phase + 1).to_string());
            image.write(&folder.path().join(format!("{k}{phase}")));
        }
    }
    let mut found = phases(&scan(folder.path()));
    found.sort();
    assert_eq!(found, [vec![0; 8], vec![1; 8]]);
}

#[test]
fn patients_with_one_series_uid_are_told_apart_unless_all_is_to_be_taken() {
    for tag in [tags::STUDY_INSTANCE_UID, tags::FRAME_OF_REFERENCE_UID] {
        let folder = tempfile::tempdir().unwrap();
        for k in 0..6 {
            for phase in 0..2_u16 {
                let image = image(k, phase).position([0.0, 0.0, f64::from(phase) + 2.0 * k as f64]);
                let image = image.text(tag, VR::UI, &format!("1.2.8.{phase}"));
                image.write(&folder.path().join(format!("{k}{phase}")));
            }
        }
        let mut found = phases(&scan(folder.path()));
        found.sort();
        assert_eq!(found, [vec![0; 6], vec![1; 6]], "{tag}");
        let all = find_one_series(folder.path(), &Task::default()).unwrap();
        assert_eq!(all.series[0].slices, 12);
    }
}

/// A scan in rotations of 4 slices, each an acquisition.
fn stepping(slices: usize) -> tempfile::TempDir {
    folder(slices, |k, image| rotation(k / 4, image))
}

fn rotation(number: usize, image: Image) -> Image {
    image.text(tags::ACQUISITION_NUMBER, VR::IS, &(number + 1).to_string())
}

#[test]
fn a_copy_does_not_shatter_a_scan_in_steps() {
    let folder = stepping(24);
    rotation(2, Image::new(9)).write(&folder.path().join("copy"));
    let scan = scan(folder.path());
    assert_eq!(scan.series.len(), 1);
    assert_eq!(scan.series[0].slices, 24);
    assert_eq!(scan.left_out.len(), 1);
}

#[test]
fn rotations_that_share_their_boundary_are_one_stack() {
    let folder = tempfile::tempdir().unwrap();
    for number in 0..6 {
        for k in 4 * number..=4 * number + 4 {
            let image = rotation(number, image(k, number as u16));
            image.write(&folder.path().join(format!("{number}{k}")));
        }
    }
    let scan = scan(folder.path());
    assert_eq!(scan.series[0].slices_found, 25);
    assert!(!warns(&scan, GUESSED) && !warns(&scan, "different slices"));
}

#[test]
fn missing_slices_do_not_shatter_a_scan_in_steps() {
    let folder = stepping(24);
    for k in 10..15 {
        std::fs::remove_file(file(folder.path(), 24, k)).unwrap();
    }
    let scan = scan(folder.path());
    assert_eq!(scan.series.len(), 1);
    assert_eq!(
        (scan.series[0].slices, scan.series[0].slices_found),
        (24, 19)
    );
}

#[test]
fn a_scan_in_steps_that_is_repeated_is_two_volumes() {
    for (first, second) in [(24, 24), (24, 32)] {
        let folder = tempfile::tempdir().unwrap();
        for (phase, count) in [(0, first), (1, second)] {
            for k in 0..count {
                let number = k / 4 + usize::from(phase) * first / 4;
                let image = rotation(number, image(k, phase));
                image.write(&folder.path().join(format!("{k:02}{phase}")));
            }
        }
        let mut found = phases(&scan(folder.path()));
        found.sort();
        assert_eq!(found, [vec![0; first], vec![1; second]]);
    }
}

#[test]
fn frames_in_all_directions_are_sorted_without_comparing_all_with_all() {
    // Rounding is one group, whatever came between.
    let folder = folder(40, |k, image| {
        let angle = if k % 2 == 0 { 4e-4 } else { 0.1 * k as f64 };
        let angle = if k % 4 == 0 { 0.0 } else { angle };
        image.orientation([
            angle.cos(),
            angle.sin(),
            0.0,
            -angle.sin(),
            angle.cos(),
            0.0,
        ])
    });
    let scan = find_series(folder.path(), &Task::default()).unwrap();
    assert_eq!(scan.series.len(), 1);
    assert_eq!(scan.series[0].slices_found, 20);
    assert_eq!(scan.left_out.len(), 20);
}
