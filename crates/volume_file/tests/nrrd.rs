//! What an NRRD file says is what the volume holds.

#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use bonemesh_task::Task;
use bonemesh_volume::Voxels;
use bonemesh_volume_file::{VolumeFile, VolumeFileError};
use common::{
    Folder, NRRD, Rows, SIDES, TYPES, assert_rows, gzip, nrrd, open, read, small_values, stored,
    values,
};

fn short(values: &[f64]) -> Vec<u8> {
    stored(4, values, false)
}

#[test]
fn every_type_byte_order_and_encoding_gives_the_same_volume() {
    let text: Vec<String> = small_values().iter().map(f64::to_string).collect();
    for (code, name, _) in TYPES {
        for is_big_endian in [false, true] {
            let data = stored(code, &small_values(), is_big_endian);
            for (encoding, data) in [
                ("raw", data.clone()),
                ("gzip", gzip(&data)),
                ("GZ", gzip(&data)),
                ("ascii", text.join(" ").into_bytes()),
                ("text", text.join("\r\n").into_bytes()),
            ] {
                let header = NRRD
                    .replace("type: short", &format!("type: {name}"))
                    .replace("little", if is_big_endian { "big" } else { "little" })
                    .replace("raw", encoding);
                let (volume, _) = read("volume.nrrd", &nrrd(&header, &data)).unwrap();
                let case = format!("{name}, {encoding}, big endian {is_big_endian}");
                assert_eq!(values(&volume), small_values(), "{case}");
                assert!(matches!(volume.voxels(), Voxels::I16(_)), "{case}");
                let [i, j, k] = SIDES;
                assert_eq!(volume.geometry().shape(), [k, j, i], "{case}");
            }
        }
    }
}

#[test]
fn the_header_is_shown_before_a_voxel_is_read() {
    let file = open("volume", &nrrd(NRRD, &short(&small_values()))).unwrap();
    assert_eq!(file.format(), "NRRD, uncompressed");
    assert_eq!(file.description(), "test head");
    assert_eq!(file.estimated_memory_bytes(), 48);
    assert!(file.warnings().is_empty());
}

#[test]
fn lines_may_end_as_windows_ends_them() {
    let bytes = nrrd(&NRRD.replace('\n', "\r\n"), &[]);
    let bytes = [&bytes[..bytes.len() - 1], b"\r\n", &short(&small_values())].concat();
    let (volume, _) = read("volume.nrrd", &bytes).unwrap();
    assert_eq!(values(&volume), small_values());
}

#[test]
fn every_space_is_turned_to_lps() {
    let cases: [(&str, [f64; 3], bool); 8] = [
        ("left-posterior-superior", [1.0, 1.0, 1.0], true),
        ("LPS", [1.0, 1.0, 1.0], true),
        ("right-anterior-superior", [-1.0, -1.0, 1.0], true),
        ("RAS", [-1.0, -1.0, 1.0], true),
        ("Left-Anterior-Superior", [1.0, -1.0, 1.0], true),
        ("LAS", [1.0, -1.0, 1.0], true),
        ("scanner-xyz", [1.0, 1.0, 1.0], false),
        ("3D-right-handed", [1.0, 1.0, 1.0], false),
    ];
    for (space, signs, is_known) in cases {
        let header = NRRD.replace("left-posterior-superior", space);
        let file = open("volume.nrrd", &nrrd(&header, &short(&small_values()))).unwrap();
        let mut rows: Rows = [
            [0.5, 0.0, 0.0, 10.0],
            [0.0, 0.75, 0.0, 20.0],
            [0.0, 0.0, 2.0, 30.0],
        ];
        for (row, sign) in rows.iter_mut().zip(signs) {
            *row = row.map(|v| v * sign);
        }
        assert_rows(file.geometry(), rows);
        assert_eq!(file.warnings().is_empty(), is_known, "{space}");
    }
}

#[test]
fn a_file_with_spacings_alone_keeps_them_and_says_so() {
    let header = NRRD
        .replace("space: left-posterior-superior\n", "")
        .replace(
            "space directions: (0.5,0,0) (0,0.75,0) (0,0,2)",
            "spacings: 0.5 0.75 nan",
        )
        .replace("space origin: (10,20,30)\n", "");
    let file = open("volume.nrrd", &nrrd(&header, &short(&small_values()))).unwrap();
    let rows = [
        [0.5, 0.0, 0.0, 0.0],
        [0.0, 0.75, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
    ];
    assert_rows(file.geometry(), rows);
    assert!(file.warnings()[0].contains("no orientation"));
    assert!(file.warnings()[1].contains("axis 3"));
}

#[test]
fn lengths_become_millimetres() {
    for (unit, mm, notes) in [
        ("mm", 1.0, 0),
        ("cm", 10.0, 1),
        ("m", 1000.0, 1),
        ("um", 0.001, 1),
        ("furlong", 1.0, 1),
    ] {
        let header = format!("{NRRD}space units: \"{unit}\" \"{unit}\" \"{unit}\"\n");
        let file = open("volume.nrrd", &nrrd(&header, &short(&small_values()))).unwrap();
        assert!(
            (file.geometry().spacing_mm()[2] / mm - 2.0).abs() < 1e-9,
            "{unit}"
        );
        assert_eq!(file.warnings().len(), notes, "{unit}");
    }
}

#[test]
fn a_detached_header_finds_its_data_beside_it() {
    let data = short(&small_values());
    for (field, encoding) in [
        ("data file", "raw"),
        ("datafile", "raw"),
        ("data file", "gzip"),
    ] {
        for name in [
            "voxels.raw",
            "./voxels.raw",
            "two words.raw",
            "below/voxels.raw",
        ] {
            let folder = Folder::new();
            std::fs::create_dir(folder.path().join("below")).unwrap();
            let header = format!("{}{field}: {name}\n", NRRD.replace("raw", encoding));
            let path = folder.write("volume.nhdr", header.as_bytes());
            let missing = VolumeFile::open(&path).unwrap_err();
            assert!(
                matches!(missing, VolumeFileError::DataFile { .. }),
                "{missing}"
            );
            folder.write(
                name,
                &if encoding == "raw" {
                    data.clone()
                } else {
                    gzip(&data)
                },
            );
            let (volume, _) = VolumeFile::open(&path)
                .unwrap()
                .read(&Task::default())
                .unwrap();
            assert_eq!(values(&volume), small_values(), "{name}");
        }
    }
}

#[test]
fn a_header_cannot_name_files_outside_its_folder() {
    let folder = Folder::new();
    let data = folder.write("voxels.raw", &short(&small_values()));
    std::fs::create_dir(folder.path().join("below")).unwrap();
    let absolute = data.display().to_string();
    for name in ["../voxels.raw", absolute.as_str(), "a/../../voxels.raw"] {
        let header = format!("{NRRD}data file: {name}\n");
        let path = folder.write("below/volume.nhdr", header.as_bytes());
        let error = VolumeFile::open(&path).unwrap_err();
        assert!(error.to_string().contains("outside"), "{error}");
    }
    let header = format!("{NRRD}data file: {absolute}\n");
    let path = folder.write("volume.nhdr", header.as_bytes());
    assert!(
        VolumeFile::open(&path).is_ok(),
        "an absolute path inside the folder is fine"
    );
}

#[test]
fn data_in_several_files_is_refused_by_name() {
    for name in ["LIST\nslice1.raw\nslice2.raw", "slice%02d.raw 1 2 1"] {
        let error = open(
            "volume.nhdr",
            format!("{NRRD}data file: {name}\n").as_bytes(),
        );
        let error = error.unwrap_err();
        assert!(error.to_string().contains("several files"), "{error}");
    }
}

#[test]
fn lines_and_bytes_before_the_data_are_skipped() {
    let data = short(&small_values());
    let header = format!("{NRRD}line skip: 2\nbyte skip: 3\n");
    let skipped = [b"one\ntwo\nabc".as_slice(), &data].concat();
    let (volume, _) = read("volume.nrrd", &nrrd(&header, &skipped)).unwrap();
    assert_eq!(values(&volume), small_values());
    // Lines are those of the file, bytes those of what is inflated.
    let packed = gzip(&[b"abc".as_slice(), &data].concat());
    let skipped = [b"one\ntwo\n".as_slice(), &packed].concat();
    let (volume, _) = read(
        "volume.nrrd",
        &nrrd(&header.replace("raw", "gzip"), &skipped),
    )
    .unwrap();
    assert_eq!(values(&volume), small_values());
    // The last bytes of the file.
    let header = format!("{NRRD}byteskip: -1\n");
    let skipped = [vec![9; 1001], data].concat();
    let (volume, _) = read("volume.nrrd", &nrrd(&header, &skipped)).unwrap();
    assert_eq!(values(&volume), small_values());
    for skip in [
        "byte skip: -2",
        "byte skip: x",
        "line skip: -1",
        "line skip: 99",
    ] {
        let bytes = nrrd(&format!("{NRRD}{skip}\n"), &short(&small_values()));
        let error = open("volume.nrrd", &bytes).unwrap_err();
        assert!(matches!(error, VolumeFileError::Header { .. }), "{error}");
    }
}

#[test]
fn vectors_colours_and_times_are_refused_by_name() {
    let four = NRRD
        .replace("dimension: 3", "dimension: 4")
        .replace("sizes: 4", "sizes: 3 4")
        .replace("space directions:", "space directions: none")
        .replace("kinds: domain", "kinds: vector domain");
    let error = open("volume.nrrd", &nrrd(&four, &[0; 144])).unwrap_err();
    assert!(error.to_string().contains("3 values a voxel"), "{error}");
    let one = four.replace("sizes: 3 4", "sizes: 1 4");
    let (volume, _) = read("volume.nrrd", &nrrd(&one, &short(&small_values()))).unwrap();
    assert_eq!(values(&volume), small_values());
    let colour = NRRD.replace("kinds: domain", "kinds: RGB-color");
    let error = open("volume.nrrd", &nrrd(&colour, &[0; 48])).unwrap_err();
    assert!(error.to_string().contains("RGB-color"), "{error}");
    let times = NRRD
        .replace("dimension: 3", "dimension: 4")
        .replace("sizes: 4 3 2", "sizes: 4 3 2 5")
        .replace(
            "space directions: (0.5,0,0) (0,0.75,0) (0,0,2)",
            "spacings: 1 1 1 1",
        )
        .replace("kinds: domain domain domain\n", "");
    let error = open("volume.nrrd", &nrrd(&times, &[0; 240])).unwrap_err();
    assert!(
        matches!(error, VolumeFileError::SeveralVolumes { volumes: 5, .. }),
        "{error}"
    );
    let plane = NRRD
        .replace("dimension: 3", "dimension: 2")
        .replace("sizes: 4 3 2", "sizes: 4 3")
        .replace("(0,0,2)", "")
        .replace("kinds: domain domain domain\n", "");
    let error = open("volume.nrrd", &nrrd(&plane, &[0; 24])).unwrap_err();
    assert!(
        matches!(error, VolumeFileError::TooFewSlices { .. }),
        "{error}"
    );
}

#[test]
fn damaged_headers_are_named() {
    let data = short(&small_values());
    for (good, bad, named) in [
        ("type: short\n", "", "`type`"),
        ("type: short", "type: block", "`block`"),
        ("dimension: 3", "dimension: 99", "99 dimensions"),
        ("dimension: 3", "dimension: 4", "3 sizes for 4"),
        ("sizes: 4 3 2", "sizes: 4 3 -2", "`-2`"),
        ("sizes: 4 3 2", "sizes: 4 3 0", "`0`"),
        ("endian: little\n", "", "`endian`"),
        ("endian: little", "endian: middle", "`middle`"),
        ("encoding: raw\n", "", "`encoding`"),
        ("encoding: raw", "encoding: bzip2", "`bzip2`"),
        ("(0.5,0,0)", "(0.5,0)", "`(0.5,0)`"),
        ("(0.5,0,0)", "(0.5,zero,0)", "`zero`"),
        ("(0.5,0,0)", "(0,0,0)", "degenerate"),
        ("(0.5,0,0)", "(inf,0,0)", "degenerate"),
        ("NRRD0004", "NRRD0009", "`NRRD0009`"),
    ] {
        assert!(NRRD.contains(good));
        let bytes = nrrd(&NRRD.replace(good, bad), &data);
        let error = open("volume.nrrd", &bytes).unwrap_err().to_string();
        assert!(error.contains(named), "{error}");
        assert!(error.contains("volume.nrrd"), "{error}");
    }
}

#[test]
fn words_among_written_numbers_are_named() {
    let header = NRRD.replace("raw", "ascii");
    let text = b"1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 x 24";
    let error = read("volume.nrrd", &nrrd(&header, text)).unwrap_err();
    assert!(matches!(error, VolumeFileError::Data { .. }), "{error}");
    let error = read(
        "volume.nrrd",
        &nrrd(&header, b"1000000 2000000 3000000 4000000 500000 60000"),
    );
    assert!(matches!(error.unwrap_err(), VolumeFileError::CutOff { .. }));
}
