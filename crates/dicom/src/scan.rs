//! What a folder holds: its series, and what was left out and why.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use bonemesh_task::Task;
use rayon::prelude::*;
use serde::{Serialize, Serializer};

use crate::choice::plausible;
use crate::error::{DicomError, FileError};
use crate::group::{Grouping, Stack, stacks};
use crate::header::Header;
use crate::placed::consistent;
use crate::series::Series;

/// Why a file that is alone in its series is left out.
const SINGLE: &str = "a single slice; a volume needs at least 2 of one orientation and size";

/// Kinds of reasons that an error message lists.
const MAX_REASONS: usize = 4;

/// The series of a folder, largest first, and the files that belong to none.
#[derive(Clone, Debug, Serialize)]
pub struct Scan {
    /// Number of the series that is most likely meant: the largest.
    pub recommended: usize,
    /// Numbers of the others that could be meant as well, see [`Scan::choose`].
    pub alternatives: Vec<usize>,
    /// Most slices first, then most voxels.
    pub series: Vec<Series>,
    /// Files and folders that are in no series.
    pub left_out: Vec<LeftOut>,
}

/// A file or folder that is in no series.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct LeftOut {
    /// The file or folder.
    #[serde(serialize_with = "as_text")]
    pub path: PathBuf,
    /// Why it was left out.
    pub reason: String,
}

/// A path as text, its unreadable bytes replaced: serde refuses paths that are no Unicode.
fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&path.to_string_lossy())
}

/// Paths as texts, see [`as_text`].
pub(crate) fn as_texts<S: Serializer>(paths: &[PathBuf], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(paths.iter().map(|p| p.to_string_lossy()))
}

impl LeftOut {
    fn new(path: &Path, reason: &impl ToString) -> Self {
        Self {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}

/// Finds the CT series in a folder and its sub-folders, by content and not by name.
///
/// Only headers are read, except where two slices are at the same place and their pixels decide
/// whether one is a copy. Links to folders are not followed. A single file is looked at alone (a
/// multi-frame image can be a whole series), the index `DICOMDIR` stands for its folder.
///
/// # Errors
/// [`DicomError::NotFound`], [`DicomError::Folder`]; [`DicomError::NoSeries`] when no two slices
/// make a volume, [`DicomError::NotAFolder`] when a single file does not;
/// [`DicomError::Cancelled`].
pub fn find_series(path: &Path, task: &Task) -> Result<Scan, DicomError> {
    find(path, Grouping::ByUid, task)
}

/// Finds series as [`find_series`] does, but takes all slices of the same orientation, size and
/// pixel spacing for one series, whatever UIDs, acquisitions and image types they name.
///
/// For folders whose UIDs were broken by anonymising or copying.
///
/// # Errors
/// As [`find_series`].
pub fn find_one_series(path: &Path, task: &Task) -> Result<Scan, DicomError> {
    find(path, Grouping::WholeFolder, task)
}

fn find(path: &Path, grouping: Grouping, task: &Task) -> Result<Scan, DicomError> {
    let mut left_out = Vec::new();
    let files = files(path, &mut left_out, task)?;
    task.begin("scan", files.len());
    let headers = files.par_iter().map(|file| {
        let header = Header::read(file);
        task.advance(1)?;
        Ok((file, header))
    });
    let headers: Result<Vec<_>, DicomError> = headers.collect();
    let mut usable = Vec::new();
    let mut cut_off: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (file, header) in headers? {
        match header {
            Ok(header) if header.is_cut_off => {
                let name = file.file_name().unwrap_or_default().to_string_lossy();
                let names = cut_off.entry(header.series_uid).or_default();
                names.push(name.into_owned());
                let reason = "cut off: its pixels are not complete";
                left_out.push(LeftOut::new(file, &reason));
            }
            Ok(header) => usable.push(header),
            Err(FileError::NotDicom) => left_out.push(LeftOut::new(file, &foreign(file))),
            Err(error) => left_out.push(LeftOut::new(file, &error)),
        }
    }
    let usable = consistent(usable, grouping, &mut left_out);
    let mut series = Vec::new();
    for stack in stacks(usable, grouping, task)? {
        add(stack, &cut_off, &mut series, &mut left_out);
    }
    left_out.sort();
    // A file of several frames is named once for each reason.
    left_out.dedup();
    if series.is_empty() {
        return Err(no_series(path, &left_out));
    }
    Ok(Scan::new(series, left_out))
}

fn no_series(path: &Path, left_out: &[LeftOut]) -> DicomError {
    let path = path.to_owned();
    match left_out {
        [only] if only.path == path => DicomError::NotAFolder {
            path,
            reason: only.reason.clone(),
        },
        _ => DicomError::NoSeries {
            path,
            summary: summary(left_out),
        },
    }
}

/// The files that `path` stands for.
fn files(
    path: &Path,
    left_out: &mut Vec<LeftOut>,
    task: &Task,
) -> Result<Vec<PathBuf>, DicomError> {
    let metadata = fs::metadata(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => DicomError::NotFound(path.to_owned()),
        _ => folder_error(path, &e),
    })?;
    if metadata.is_dir() {
        return list(path, left_out, task);
    }
    let is_index = path
        .file_name()
        .is_some_and(|name| name.eq_ignore_ascii_case("DICOMDIR"));
    match path.parent() {
        Some(folder) if is_index && folder.as_os_str().is_empty() => {
            list(".".as_ref(), left_out, task)
        }
        Some(folder) if is_index => list(folder, left_out, task),
        _ => Ok(vec![path.to_owned()]),
    }
}

impl Scan {
    /// Sorts and numbers the series.
    fn new(mut series: Vec<Series>, left_out: Vec<LeftOut>) -> Self {
        series.sort_by(|a, b| {
            let voxels = |s: &Series| s.slices * s.rows * s.columns;
            (b.slices_found, voxels(b))
                .cmp(&(a.slices_found, voxels(a)))
                .then_with(|| a.uid.cmp(&b.uid))
                .then_with(|| a.files.cmp(&b.files))
        });
        for (index, series) in series.iter_mut().enumerate() {
            series.report.number = index + 1;
        }
        let plausible = plausible(series.iter());
        let alternatives = plausible.iter().skip(1).map(|s| s.number).collect();
        Self {
            recommended: 1,
            alternatives,
            series,
            left_out,
        }
    }
}

/// What a file is that is no DICOM file, as far as its name tells.
fn foreign(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_ascii_lowercase();
    let ends = |endings: &[&str]| endings.iter().any(|e| name.ends_with(e));
    let what = if ends(&[".nii", ".nii.gz", ".nrrd", ".nhdr"]) {
        ": a volume in a file of its own; open it by its own path"
    } else if ends(&[".zip", ".7z", ".rar", ".tar", ".tgz", ".gz", ".bz2", ".iso"]) {
        ": an archive; unpack it first"
    } else {
        ""
    };
    format!("{}{what}", FileError::NotDicom)
}

fn folder_error(path: &Path, error: &std::io::Error) -> DicomError {
    DicomError::Folder {
        path: path.to_owned(),
        reason: error.to_string(),
    }
}

/// All files below `root`, sorted; sub-folders that cannot be listed are left out.
fn list(root: &Path, left_out: &mut Vec<LeftOut>, task: &Task) -> Result<Vec<PathBuf>, DicomError> {
    let mut folders = vec![root.to_owned()];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        task.check()?;
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) if folder == root => return Err(folder_error(root, &error)),
            Err(error) => {
                left_out.push(LeftOut::new(&folder, &FileError::Io(error)));
                continue;
            }
        };
        for entry in entries {
            match entry.and_then(|e| Ok((e.path(), e.file_type()?))) {
                Ok((path, kind)) if kind.is_dir() => folders.push(path),
                // A link to a folder could lead round in circles; a link to a file is a file.
                Ok((path, kind)) if kind.is_symlink() && path.is_dir() => {
                    left_out.push(LeftOut::new(&path, &"a link to a folder"));
                }
                Ok((path, _)) => files.push(path),
                Err(error) => left_out.push(LeftOut::new(&folder, &FileError::Io(error))),
            }
        }
    }
    files.sort();
    Ok(files)
}

/// Makes a series of a stack, or leaves its files out.
fn add(
    stack: Stack,
    cut_off: &BTreeMap<String, Vec<String>>,
    series: &mut Vec<Series>,
    left_out: &mut Vec<LeftOut>,
) {
    for copy in &stack.copies {
        let reason = "at the place of another slice, and the same or unreadable";
        left_out.push(LeftOut::new(&copy.header.path, &reason));
    }
    for surplus in &stack.surplus {
        let reason = "too many slices at one place";
        left_out.push(LeftOut::new(&surplus.header.path, &reason));
    }
    let files: Vec<PathBuf> = stack.slices.iter().map(|s| s.header.path.clone()).collect();
    if files.len() < 2 {
        left_out.extend(files.iter().map(|f| LeftOut::new(f, &SINGLE)));
        return;
    }
    match Series::new(stack) {
        Ok(mut found) => {
            if let Some(names) = cut_off.get(&found.uid) {
                let (count, first) = (names.len(), &names[0]);
                found.report.warnings.push(format!(
                    "{count} {} cut off and left out, first {first}; copy the series again",
                    if count == 1 { "file is" } else { "files are" }
                ));
            }
            series.push(found);
        }
        Err(error) => left_out.extend(files.iter().map(|f| LeftOut::new(f, &error))),
    }
}

/// The most frequent reasons with their counts.
fn summary(left_out: &[LeftOut]) -> String {
    if left_out.is_empty() {
        return "it is empty".to_owned();
    }
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for file in left_out {
        *counts.entry(&file.reason).or_default() += 1;
    }
    let broken_uids = if counts.get(SINGLE).is_some_and(|singles| *singles > 2) {
        "; if they are slices of one scan with broken UIDs, take the folder as one series"
    } else {
        ""
    };
    let mut counts: Vec<(&str, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let more = if counts.len() > MAX_REASONS {
        "; and others"
    } else {
        ""
    };
    let parts: Vec<String> = counts
        .into_iter()
        .take(MAX_REASONS)
        .map(|(reason, count)| format!("{count} left out: {reason}"))
        .collect();
    parts.join("; ") + more + broken_uids
}
