//! Series from the world outside, one pitfall each; skipped without `BONEMESH_CT`.

// Helpers of these tests may panic; exact places are exact.
#![allow(clippy::panic, clippy::unwrap_used, clippy::float_cmp)]

use std::path::PathBuf;

use bonemesh_dicom::{Scan, find_series, read_series};
use bonemesh_task::Task;
use bonemesh_volume::{Volume, Voxels};
use ndarray::{Array3, s};

fn folder(name: &str) -> Option<PathBuf> {
    let Some(root) = std::env::var_os("BONEMESH_CT") else {
        eprintln!("skipped: BONEMESH_CT is not set");
        return None;
    };
    Some(PathBuf::from(root).join(name))
}

fn scan(name: &str) -> Option<Scan> {
    let folder = folder(name)?;
    Some(find_series(&folder, &Task::default()).unwrap_or_else(|e| panic!("{name}: {e}")))
}

fn read(name: &str) -> Option<(Volume, Vec<String>)> {
    let scan = scan(name)?;
    let series = scan.choose(None).unwrap_or_else(|e| panic!("{name}: {e}"));
    Some(read_series(series, &Task::default()).unwrap_or_else(|e| panic!("{name}: {e}")))
}

fn whole(volume: &Volume) -> &Array3<i16> {
    match volume.voxels() {
        Voxels::I16(hu) => hu,
        Voxels::F32(_) => panic!("expected 16-bit voxels"),
    }
}

fn float(volume: &Volume) -> Array3<f32> {
    match volume.voxels() {
        Voxels::I16(hu) => hu.mapv(f32::from),
        Voxels::F32(hu) => hu.clone(),
    }
}

const BASE: &str = "hard/00_base_explicit_le";

/// The series must be voxel for voxel the base, at the same place, with nothing to warn of.
fn assert_is_base(name: &str) {
    let Some((base, _)) = read(BASE) else { return };
    let Some((volume, warnings)) = read(name) else {
        return;
    };
    assert!(volume.voxels() == base.voxels(), "{name} differs");
    assert_eq!(volume.geometry(), base.geometry(), "{name}");
    assert!(warnings.is_empty(), "{name}: {warnings:?}");
}

/// Largest difference (HU) from the base, at the same place.
fn difference_from_base(name: &str) -> f32 {
    let Some((base, _)) = read(BASE) else {
        return 0.0;
    };
    let Some((volume, _)) = read(name) else {
        return 0.0;
    };
    assert_eq!(volume.geometry(), base.geometry(), "{name}");
    let difference = float(&volume) - float(&base);
    difference.iter().fold(0.0, |m: f32, d| m.max(d.abs()))
}

#[test]
fn the_base_has_24_slices_where_its_header_says() {
    let Some((volume, warnings)) = read(BASE) else {
        return;
    };
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(volume.geometry().shape(), [24, 64, 64]);
    let affine = volume.geometry().patient_from_voxel();
    assert_eq!(affine.apply([0.0, 0.0, 0.0]), [-100.8, -100.8, 60.0]);
    let last = affine.apply([1.0, 2.0, 23.0]);
    for (a, b) in last.into_iter().zip([-97.6, -94.4, 94.5]) {
        assert!((a - b).abs() < 1e-9);
    }
    let image = volume.geometry().image_from_voxel().apply([0.0, 0.0, 2.0]);
    assert_eq!(image, [-1.6, -1.6, 63.0]);
}

macro_rules! same_as_base {
    ($($test:ident: $folder:literal,)*) => {$(
        #[test]
        fn $test() {
            assert_is_base(concat!("hard/", $folder));
        }
    )*};
}

same_as_base! {
    implicit_little_endian_is_the_base: "01_implicit_le",
    explicit_big_endian_is_the_base: "02_explicit_be",
    deflated_is_the_base: "03_deflated",
    rle_is_the_base: "04_rle",
    jpeg_lossless_first_order_is_the_base: "05_jpeg_lossless_sv1",
    jpeg_lossless_is_the_base: "06_jpeg_lossless_p14",
    jpeg_ls_lossless_is_the_base: "07_jpegls_lossless",
    jpeg_2000_lossless_is_the_base: "09_j2k_lossless",
    names_and_numbers_do_not_order_slices: "20_no_instance_no_location_random_names",
    monochrome1_changes_no_hounsfield_unit: "24_monochrome1_label_only",
    unsigned_12_bit_is_the_base: "25_unsigned_12bit",
    bits_above_the_high_bit_are_ignored: "26_12bit_garbage_in_high_nibble",
    head_to_foot_is_put_in_order: "28_reverse_order_head_to_foot",
    a_file_without_preamble_is_read: "41_no_preamble_no_meta_implicit",
}

#[test]
fn jpeg_ls_near_lossless_is_within_2_hu() {
    assert!(difference_from_base("hard/08_jpegls_near_unsigned12") <= 2.0);
}

#[test]
fn jpeg_2000_lossy_is_within_31_hu() {
    assert!(difference_from_base("hard/10_j2k_lossy") <= 31.0);
}

#[test]
fn each_slice_has_its_own_rescale() {
    assert!(difference_from_base("hard/23_slope_intercept_per_slice") <= 1.0);
}

#[test]
fn missing_slices_are_filled_between_their_neighbours() {
    let (Some((base, _)), Some((volume, warnings))) =
        (read(BASE), read("hard/21_missing_2_slices"))
    else {
        return;
    };
    assert_eq!(volume.geometry(), base.geometry());
    assert!(
        warnings.iter().any(|w| w.contains("2 slices are missing")),
        "{warnings:?}"
    );
    let (a, b) = (whole(&base), whole(&volume));
    assert_eq!(a.slice(s![..9, .., ..]), b.slice(s![..9, .., ..]));
    assert_eq!(a.slice(s![11.., .., ..]), b.slice(s![11.., .., ..]));
    let (below, above) = (f64::from(a[[8, 32, 20]]), f64::from(a[[11, 32, 20]]));
    let expected = below + (above - below) / 3.0;
    assert!((f64::from(b[[9, 32, 20]]) - expected).abs() <= 0.5);
}

#[test]
fn a_copy_of_a_slice_is_dropped_and_said() {
    let Some(scan) = scan("hard/22_duplicate_slice") else {
        return;
    };
    assert_eq!(scan.series.len(), 1);
    assert_eq!(scan.left_out.len(), 1);
    let (volume, warnings) = read_series(&scan.series[0], &Task::default()).unwrap();
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("1 slice is at the place of another"))
    );
    assert!(volume.voxels() == read(BASE).unwrap().0.voxels());
}

#[test]
fn padding_is_air_and_everything_else_the_base() {
    let (Some((base, _)), Some((volume, _))) =
        (read(BASE), read("hard/27_pixel_padding_minus2000"))
    else {
        return;
    };
    let mut padded = 0;
    for (a, b) in whole(&base).iter().zip(whole(&volume)) {
        if a != b {
            assert_eq!(*b, -1000);
            padded += 1;
        }
    }
    assert!(padded > 0);
}

#[test]
fn uneven_slices_are_resampled_to_the_finer_step() {
    let (Some((base, _)), Some((volume, warnings))) =
        (read(BASE), read("hard/29_variable_spacing_1.5_then_3"))
    else {
        return;
    };
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("vary from 1.500 to 3.000 mm")),
        "{warnings:?}"
    );
    assert_eq!(volume.geometry().shape(), [36, 64, 64]);
    assert!((volume.geometry().spacing_mm()[2] - 1.5).abs() < 1e-9);
    let (a, b) = (whole(&base), whole(&volume));
    assert_eq!(a.slice(s![..12, .., ..]), b.slice(s![..12, .., ..]));
    assert_eq!(a.slice(s![12, .., ..]), b.slice(s![13, .., ..]));
    assert_eq!(a.slice(s![23, .., ..]), b.slice(s![35, .., ..]));
}

#[test]
fn a_coarser_second_half_is_told_step_by_step() {
    let Some(scan) = scan("hard/29_variable_spacing_1.5_then_3") else {
        return;
    };
    let series = &scan.series[0];
    assert!(series.is_resampled);
    assert_eq!((series.slices_found, series.slices), (24, 36));
    let after: Vec<f64> = series.gaps.iter().map(|g| g.after_mm).collect();
    assert_eq!(after, &series.slice_positions_mm[11..23]);
    assert!(series.gaps.iter().all(|g| g.missing == 1));
    let lines = series.lines().join("\n");
    assert!(
        lines.contains("24 slices found, 36 with those between interpolated"),
        "{lines}"
    );
    assert!(lines.contains("unevenly spaced"), "{lines}");
    assert!(!lines.contains("more slices are interpolated"), "{lines}");
}

#[test]
fn a_tilted_gantry_keeps_its_shear() {
    let Some(scan) = scan("hard/30_gantry_tilt_header_15deg") else {
        return;
    };
    assert!(
        scan.series[0]
            .orientation
            .contains("gantry tilt 15.0 degrees")
    );
    let (volume, _) = read_series(&scan.series[0], &Task::default()).unwrap();
    let geometry = volume.geometry();
    assert!((geometry.spacing_mm()[2] - 1.5 * 15.0_f64.to_radians().cos()).abs() < 1e-6);
    let [x, y, z] = geometry.patient_from_voxel().apply([0.0, 0.0, 23.0]);
    assert!((x + 100.8).abs() < 1e-9 && (y + 100.8).abs() < 1e-9 && (z - 94.5).abs() < 1e-9);
}

#[test]
fn pixels_need_not_be_square() {
    let Some((volume, _)) = read("hard/31_nonsquare_matrix_and_pixels") else {
        return;
    };
    assert_eq!(volume.geometry().shape(), [24, 64, 48]);
    let [dx, dy, _] = volume.geometry().spacing_mm();
    assert_eq!((dx, dy), (1.6, 3.2));
}

#[test]
fn a_mixed_folder_gives_its_series_and_names_the_rest() {
    let Some(scan) = scan("hard/40_mixed_folder") else {
        return;
    };
    let reason = |name: &str| {
        let file = scan.left_out.iter().find(|f| f.path.ends_with(name));
        file.unwrap_or_else(|| panic!("{name} is not left out"))
            .reason
            .clone()
    };
    let slices = |n: usize| (scan.series[n].slices_found, scan.series[n].slices);
    assert_eq!(scan.series.len(), 2);
    assert_eq!((slices(0), slices(1)), ((24, 24), (8, 31)));
    let sparse = scan.series[1].lines().join("\n");
    for said in [
        "8 slices found, 31 with those between interpolated",
        "unevenly spaced",
        "more slices are interpolated than found: 8 were found, 23 are",
    ] {
        assert!(sparse.contains(said), "{sparse}");
    }
    let missing: usize = scan.series[1].gaps.iter().map(|g| g.missing).sum();
    assert_eq!(missing, 23);
    assert_eq!(scan.left_out.len(), 6);
    assert!(reason("DICOMDIR").contains("directory"));
    assert_eq!(reason("Thumbs.db"), "not a DICOM file");
    assert_eq!(reason("readme.txt"), "not a DICOM file");
    assert_eq!(reason("empty.dcm"), "empty file");
    assert_eq!(reason("scout_I10"), "localizer");
    assert!(reason("truncated.dcm").contains("cut off"));
    let (volume, warnings) = read_series(&scan.series[0], &Task::default()).unwrap();
    assert!(volume.voxels() == read(BASE).unwrap().0.voxels());
    assert!(
        warnings.iter().any(|w| w.contains("truncated.dcm")),
        "{warnings:?}"
    );
}

#[test]
fn a_multi_frame_image_is_the_base() {
    let (Some((base, _)), Some((volume, _))) = (read(BASE), read("hard/42_enhanced_multiframe"))
    else {
        return;
    };
    assert!(volume.voxels() == base.voxels());
    let place = volume.geometry().patient_from_voxel();
    assert_eq!(place, base.geometry().patient_from_voxel());
}

#[test]
fn a_full_size_series_is_read_beside_its_directory_file() {
    let Some(scan) = scan("philips-skull") else {
        return;
    };
    assert_eq!(scan.series.len(), 1);
    assert_eq!(scan.left_out.len(), 1);
    let (volume, warnings) = read_series(&scan.series[0], &Task::default()).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(volume.geometry().shape(), [140, 512, 512]);
    let image = volume.geometry().image_from_voxel().apply([0.0; 3]);
    assert!((image[2] - scan.series[0].patient_from_voxel[2][3]).abs() < 1e-9);
}
